//! The base of the head: it may sway, be bumped and carry a gyroscope.

use tracelight_rig::{Joint, PanTilt, TICK_F64_S};

use crate::dice::Dice;

/// How a foot gives, about pan's and about tilt's axis alike: head and foot together swing on what they stand on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FootConfig {
    /// Inertia of foot and head together about each axis, kg m².
    pub inertia_kg_m2: f64,
    /// With how many Hz they swing; zero for a foot that stands firm.
    pub resonance_hz: f64,
    /// How that is damped, as a share of critical damping.
    pub damping: f64,
}

impl FootConfig {
    /// A foot that is one with the wall. Its inertia is a light tripod's, should it begin to swing.
    pub const FIRM: Self = Self { inertia_kg_m2: 0.05, resonance_hz: 0.0, damping: 0.05 };
}

/// A gyroscope of three axes, fixed to the foot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GyroscopeConfig {
    /// Whether there is one.
    pub fitted: bool,
    /// Standard deviation of each reading, rad/s.
    pub noise_rad_s: f64,
    /// Most that it reads at rest, rad/s; how much is drawn from the seed.
    pub bias_rad_s: f64,
}

impl GyroscopeConfig {
    /// None, but what one would be: 0.005 °/s/√Hz over half of a kilohertz, and half a degree a second at rest, as data sheets of those for
    /// telephones and drones have it.
    pub const NONE: Self = Self { fitted: false, noise_rad_s: 2e-3, bias_rad_s: 9e-3 };
}

/// Time constant of a gyroscope's own filter, s: some 300 Hz.
const GYROSCOPE_S: f64 = 0.5e-3;
/// How long somebody bumps, ticks: what stands on rubber feet comes to rest in two or three hundredths of a second.
const BUMP_TICKS: u32 = 30;

/// The foot of a head, with what it carries.
#[derive(Clone, Debug)]
pub(crate) struct Foot {
    config: FootConfig,
    /// What each joint feels when its foot is sped up, and its foot when the joint is, kg m²: what it carries. Its rotor turns about an
    /// axis of its own, and of what that is worth at the joint only the gears' share acts.
    carried_kg_m2: PanTilt<f64>,
    sway_rad: PanTilt<f64>,
    sway_rad_s: PanTilt<f64>,
    sway_rad_s2: PanTilt<f64>,
    bump: Option<Bump>,
    /// What bumps have left, rad.
    bumped_rad: PanTilt<f64>,
    /// What a bump makes of this tick, rad/s, rad/s².
    bump_rad_s: PanTilt<f64>,
    bump_rad_s2: PanTilt<f64>,
    gyroscope: Option<Gyroscope>,
}

impl Foot {
    pub(crate) fn new(
        config: FootConfig,
        gyroscope: GyroscopeConfig,
        carried_kg_m2: PanTilt<f64>,
        seed: u64,
    ) -> Self {
        Self {
            config,
            carried_kg_m2,
            sway_rad: PanTilt::default(),
            sway_rad_s: PanTilt::default(),
            sway_rad_s2: PanTilt::default(),
            bump: None,
            bumped_rad: PanTilt::default(),
            bump_rad_s: PanTilt::default(),
            bump_rad_s2: PanTilt::default(),
            gyroscope: gyroscope.fitted.then(|| Gyroscope::new(gyroscope, seed)),
        }
    }

    /// Somebody bumps into it: it turns by so much, rad, and stays so.
    pub(crate) const fn bump(&mut self, by_rad: PanTilt<f64>) {
        self.bump = Some(Bump { by_rad, ticks: 0 });
    }

    /// How far it is turned about pan's and tilt's axes, rad.
    pub(crate) fn angle_rad(&self) -> PanTilt<f64> {
        PanTilt::from_fn(|j| self.bumped_rad[j] + self.sway_rad[j])
    }

    /// How fast it turns, rad/s.
    fn rate_rad_s(&self) -> PanTilt<f64> {
        PanTilt::from_fn(|j| self.bump_rad_s[j] + self.sway_rad_s[j])
    }

    pub(crate) fn begin_tick(&mut self) {
        let step = self.bump.as_mut().and_then(Bump::tick);
        let (by_rad, sped_up) = step.unwrap_or_default();
        self.bumped_rad = PanTilt::from_fn(|j| self.bumped_rad[j] + by_rad[j]);
        self.bump_rad_s = by_rad.map(|by| by / TICK_F64_S);
        self.bump_rad_s2 = sped_up;
        self.bump = self.bump.filter(|_| step.is_some());
    }

    /// Torque that each joint feels because its foot is sped up, N m: what it carries stays behind.
    pub(crate) fn torque_nm(&self) -> PanTilt<f64> {
        PanTilt::from_fn(|j| -self.carried_kg_m2[j] * (self.bump_rad_s2[j] + self.sway_rad_s2[j]))
    }

    /// A part of a tick in which the joints sped up so, rad/s²: the foot feels it the other way.
    pub(crate) fn substep(&mut self, sped_up_rad_s2: PanTilt<f64>, step_s: f64) {
        if self.config.resonance_hz > 0.0 {
            let rate = std::f64::consts::TAU * self.config.resonance_hz;
            for j in Joint::BOTH {
                let back = -self.carried_kg_m2[j] * sped_up_rad_s2[j] / self.config.inertia_kg_m2;
                let swing =
                    rate * rate * self.sway_rad[j] + 2.0 * self.config.damping * rate * self.sway_rad_s[j];
                self.sway_rad_s2[j] = back - swing;
                self.sway_rad_s[j] += step_s * self.sway_rad_s2[j];
                self.sway_rad[j] += step_s * self.sway_rad_s[j];
            }
        }
        let turns = self.rate_rad_s();
        if let Some(gyroscope) = &mut self.gyroscope {
            // about the head's x, y and z as it stands: nothing turns it about x
            gyroscope.follow([0.0, turns.tilt, turns.pan], step_s);
        }
    }

    /// What its gyroscope reads now, rad/s about the head's x, y and z, if there is one.
    pub(crate) fn read_rad_s(&mut self) -> Option<[f32; 3]> {
        self.gyroscope.as_mut().map(Gyroscope::read)
    }
}

/// Somebody bumps: from rest to rest with the least jerk (Flash & Hogan, *The coordination of arm movements*, 1985, eq. 4).
#[derive(Clone, Copy, Debug)]
struct Bump {
    by_rad: PanTilt<f64>,
    ticks: u32,
}

impl Bump {
    /// One tick: how far it turns in it, rad, and how it is sped up meanwhile, rad/s²; nothing once it is over.
    fn tick(&mut self) -> Option<(PanTilt<f64>, PanTilt<f64>)> {
        let way = |s: f64| s * s * s * (10.0 - 15.0 * s + 6.0 * s * s);
        let share = |ticks: u32| f64::from(ticks) / f64::from(BUMP_TICKS);
        if self.ticks == BUMP_TICKS {
            return None;
        }
        let step = way(share(self.ticks + 1)) - way(share(self.ticks));
        let s = share(self.ticks) + 0.5 / f64::from(BUMP_TICKS);
        let bent = s * (60.0 - 180.0 * s + 120.0 * s * s);
        self.ticks += 1;
        let time_s = f64::from(BUMP_TICKS) * TICK_F64_S;
        Some((self.by_rad.map(|by| step * by), self.by_rad.map(|by| by * bent / (time_s * time_s))))
    }
}

#[derive(Clone, Debug)]
struct Gyroscope {
    noise_rad_s: f64,
    bias_rad_s: [f64; 3],
    turns_rad_s: [f64; 3],
    dice: Dice,
}

impl Gyroscope {
    fn new(config: GyroscopeConfig, seed: u64) -> Self {
        /// Draws of its own: a head with a gyroscope is else the head without.
        const OWN: u64 = 0x6779_726f;
        let mut dice = Dice::new(seed ^ OWN);
        let bias_rad_s = [0; 3].map(|_| config.bias_rad_s * dice.signed());
        Self { noise_rad_s: config.noise_rad_s, bias_rad_s, turns_rad_s: [0.0; 3], dice }
    }

    fn follow(&mut self, turns_rad_s: [f64; 3], step_s: f64) {
        let share = (step_s / GYROSCOPE_S).min(1.0);
        for (seen, now) in self.turns_rad_s.iter_mut().zip(turns_rad_s) {
            *seen += share * (now - *seen);
        }
    }

    fn read(&mut self) -> [f32; 3] {
        let mut axis = 0;
        self.turns_rad_s.map(|turns| {
            let read = turns + self.bias_rad_s[axis] + self.noise_rad_s * self.dice.normal();
            axis += 1;
            read as f32
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CARRIED: PanTilt<f64> = PanTilt::new(2e-3, 1e-3);
    const TRIPOD: FootConfig = FootConfig { resonance_hz: 8.0, ..FootConfig::FIRM };
    const FITTED: GyroscopeConfig = GyroscopeConfig { fitted: true, ..GyroscopeConfig::NONE };

    fn foot(config: FootConfig, gyroscope: GyroscopeConfig) -> Foot {
        Foot::new(config, gyroscope, CARRIED, 5)
    }

    /// Ticks under an acceleration of the joints; what the gyroscope read in each.
    fn ticks(foot: &mut Foot, sped_up: f64, count: usize) -> Vec<[f32; 3]> {
        let tick = |_| {
            foot.begin_tick();
            (0..10).for_each(|_| foot.substep(PanTilt::new(sped_up, 0.0), 1e-4));
            foot.read_rad_s().unwrap_or_default()
        };
        (0..count).map(tick).collect()
    }

    #[test]
    fn a_bump_turns_it_by_as_much_as_asked_and_what_it_carries_is_thrown_to_and_fro() {
        let mut foot = foot(FootConfig::FIRM, GyroscopeConfig::NONE);
        foot.bump(PanTilt::new(0.1, -0.02));
        let mut torque = Vec::new();
        for _ in 0..40 {
            foot.begin_tick();
            torque.push(foot.torque_nm().pan);
        }
        let angle = foot.angle_rad();
        assert!((angle.pan - 0.1).abs() < 1e-12 && (angle.tilt + 0.02).abs() < 1e-12, "{angle:?}");
        // the same to and fro: 5.77 times the way over the time squared, at most
        let (least, most) = torque.iter().fold((0.0f64, 0.0f64), |(a, b), &t| (a.min(t), b.max(t)));
        assert!((most / 2e-3 / (5.77 * 0.1 / 9e-4) - 1.0).abs() < 0.01 && (least + most).abs() < 1e-9);
        assert!(torque.iter().sum::<f64>().abs() < 1e-9 && torque[35] == 0.0);
    }

    #[test]
    fn a_tripod_gives_way_to_a_joint_and_swings_as_often_as_it_is_said_to() {
        let mut foot = foot(TRIPOD, GyroscopeConfig::NONE);
        ticks(&mut foot, 50.0, 5000);
        // at rest the spring holds what the joint pushes: 0.1 N m against 0.05 kg m² that swing 8 times a second
        let rest = -0.1 / (0.05 * (std::f64::consts::TAU * 8.0).powi(2));
        assert!((foot.angle_rad().pan / rest - 1.0).abs() < 1e-3, "{:?}", foot.angle_rad());
        let mut crossings = 0;
        let mut before = foot.angle_rad().pan;
        for _ in 0..1000 {
            ticks(&mut foot, 0.0, 1);
            crossings += usize::from(before < 0.0 && foot.angle_rad().pan >= 0.0);
            before = foot.angle_rad().pan;
        }
        assert!((7..=8).contains(&crossings), "{crossings} swings in a second");
    }

    #[test]
    fn a_gyroscope_reads_how_it_turns_with_noise_about_a_bias() {
        let mut foot = foot(FootConfig::FIRM, FITTED);
        let at_rest = ticks(&mut foot, 0.0, 4000);
        for axis in 0..3 {
            let all: Vec<f64> = at_rest.iter().map(|read| f64::from(read[axis])).collect();
            let mean = all.iter().sum::<f64>() / all.len() as f64;
            let variance = all.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / all.len() as f64;
            assert!((variance.sqrt() / FITTED.noise_rad_s - 1.0).abs() < 0.1, "{}", variance.sqrt());
            assert!(mean.abs() < FITTED.bias_rad_s + 1e-4 && mean != 0.0, "{mean}");
        }
        let bias = foot.gyroscope.as_ref().unwrap().bias_rad_s;
        foot.bump(PanTilt::new(0.02, 0.01));
        let turned = ticks(&mut foot, 0.0, 60).iter().fold([0.0; 3], |sum, read| {
            let mut axis = 0;
            sum.map(|s| {
                axis += 1;
                s + 1e-3 * (f64::from(read[axis - 1]) - bias[axis - 1])
            })
        });
        assert!((turned[2] - 0.02).abs() < 1e-4 && (turned[1] - 0.01).abs() < 1e-4, "{turned:?}");
        assert!(turned[0].abs() < 1e-4, "{turned:?}");
    }
}
