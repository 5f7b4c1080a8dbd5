use tracelight_rig::{Actuation, Joint, Measurement, PanTilt, Sensed, TICK_S};

/// Inertia of either joint, kg m².
const INERTIA: f32 = 0.0755;
/// Coulomb friction, N m: 10 % more than is believed of pan, 10 % less of tilt.
const COULOMB: PanTilt<f32> = PanTilt::new(0.0436, 0.052);
/// Weight on tilt, N m.
const WEIGHT: f32 = -0.15;
const TORQUE_PER_VOLT: PanTilt<f32> = PanTilt::new(0.0619, 0.0774);
const COUNT_RAD: f32 = core::f32::consts::TAU / 4096.0;
/// As far as either joint turns, rad.
const STOP_RAD: f32 = 1.5;
/// Substeps in a tick.
const SUBSTEPS: u32 = 8;

/// A head with friction that sticks, in so few operations that they are the same everywhere.
#[derive(Default)]
pub(crate) struct Head {
    angle_rad: PanTilt<f32>,
    rate_rad_s: PanTilt<f32>,
    edge_age: PanTilt<Option<f32>>,
    gate: bool,
    lost: i32,
    pub(crate) push_nm: PanTilt<f32>,
}

impl Head {
    pub(crate) fn sensed(&self) -> Sensed {
        let read = |j: Joint| Measurement {
            count: count(self.angle_rad[j]) - self.lost,
            edge_age_ticks: self.edge_age[j],
        };
        Sensed { encoders: PanTilt::from_fn(read), ..Sensed::default() }
    }

    /// Both encoders lose a count.
    pub(crate) const fn lose_counts(&mut self) {
        self.lost += 1;
    }

    pub(crate) fn exchange(&mut self, actuation: &Actuation) {
        self.gate = actuation.gate;
        for j in Joint::BOTH {
            let weight = if j == Joint::Tilt { WEIGHT } else { 0.0 };
            let torque = actuation.command_v[j] * TORQUE_PER_VOLT[j] + self.push_nm[j] - weight;
            self.edge_age[j] = None;
            for step in 0..SUBSTEPS {
                self.substep(j, torque, step);
            }
        }
    }

    fn substep(&mut self, j: Joint, torque_nm: f32, step: u32) {
        let length_s = TICK_S / SUBSTEPS as f32;
        let (before, from) = (self.rate_rad_s[j], self.angle_rad[j]);
        let momentum = INERTIA * before + length_s * torque_nm;
        let most = length_s * COULOMB[j];
        let after = if momentum > most {
            (momentum - most) / INERTIA
        } else if momentum < -most {
            (momentum + most) / INERTIA
        } else {
            0.0
        };
        let to = from + 0.5 * length_s * (before + after);
        self.angle_rad[j] = to.clamp(-STOP_RAD, STOP_RAD);
        // a head without volts falls onto its stop
        self.rate_rad_s[j] = if to == self.angle_rad[j] { after } else { 0.0 };
        if count(self.angle_rad[j]) != count(from) {
            self.edge_age[j] = Some(1.0 - (step as f32 + 0.5) / SUBSTEPS as f32);
        }
    }
}

fn count(angle_rad: f32) -> i32 {
    libm::floorf(angle_rad / COUNT_RAD + 0.5) as i32
}
