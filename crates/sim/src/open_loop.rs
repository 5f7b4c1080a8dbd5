//! Joints that go where their pulses tell them, without encoders.

use tracelight_dynamics::{Friction, Lumped};
use tracelight_plant::{ServoJoint, StepperDemand, StepperJoint};
use tracelight_rig::{Joint, Measurement, PanTilt, Setpoint, TICK_F64_S};

use crate::config::RigConfig;
use crate::drive::DriveKind;

/// Both joints of a head without encoders, with what sends their pulses.
#[derive(Clone, Debug)]
pub(crate) struct OpenLoop {
    joints: PanTilt<OpenJoint>,
    lumped: Lumped,
    friction: PanTilt<Friction>,
    /// Where the joints truly stand before the first pulse, rad.
    start_rad: PanTilt<f64>,
    /// By how much they stay behind what their steps count, rad, besides what a motor lost by itself.
    behind_rad: PanTilt<f64>,
    /// A step of the angle that is told, rad.
    step_rad: f64,
    /// By how much pulses are sent early, s.
    lead_s: f64,
    /// Where the last pulses led, rad from the start, and how fast, rad/s.
    told_rad: PanTilt<f64>,
    told_rad_s: PanTilt<f64>,
}

#[derive(Clone, Copy, Debug)]
enum OpenJoint {
    Stepper(StepperJoint),
    Servo(ServoJoint),
}

impl OpenLoop {
    /// Joints at rest at these angles, rad, where their steps are counted from; `None` for a rig of motors with encoders.
    pub(crate) fn at_rest(config: &RigConfig, start_rad: PanTilt<f64>) -> Option<Self> {
        let joint = match config.drive.kind {
            DriveKind::Motor => return None,
            DriveKind::Stepper => OpenJoint::Stepper(StepperJoint::new(config.drive.stepper)),
            DriveKind::Servo => OpenJoint::Servo(ServoJoint::new(config.drive.servo)),
        };
        let model = &config.truth.model;
        Some(Self {
            joints: PanTilt::new(joint, joint),
            lumped: model.bodies.lumped(),
            friction: model.friction,
            start_rad,
            behind_rad: PanTilt::default(),
            step_rad: model.encoder.count_rad(),
            lead_s: config.drive.lead_s(),
            told_rad: PanTilt::default(),
            told_rad_s: PanTilt::default(),
        })
    }

    /// Sends the pulses of a tick at whose start the joints are told to be there, of a controller that adds `home` to the steps it is told, while somebody
    /// leans on them with `pushed_nm`; where the joints truly are at its end, rad. The torque is that of what is told: a place that jumps asks for more
    /// than a motor has.
    pub(crate) fn turn(
        &mut self,
        told: &PanTilt<Setpoint>,
        home: &PanTilt<i32>,
        pushed_nm: PanTilt<f64>,
    ) -> PanTilt<f64> {
        let to_rad = PanTilt::from_fn(|j| at_end(&told[j]) - f64::from(home[j]) * self.step_rad);
        let rate = PanTilt::from_fn(|j| (to_rad[j] - self.told_rad[j]) / TICK_F64_S);
        let acceleration = PanTilt::from_fn(|j| (rate[j] - self.told_rad_s[j]) / TICK_F64_S);
        (self.told_rad, self.told_rad_s) = (to_rad, rate);
        let mut at_rad = PanTilt::from_fn(|j| self.start_rad[j] - self.behind_rad[j]);
        let rigid = self.lumped.inverse(at_rad.tilt + to_rad.tilt, rate, acceleration);
        for j in Joint::BOTH {
            at_rad[j] += match &mut self.joints[j] {
                OpenJoint::Stepper(stepper) => stepper.turn(StepperDemand {
                    position_rad: to_rad[j],
                    velocity_rad_s: rate[j],
                    torque_nm: rigid[j] + self.friction[j].torque(rate[j]) - pushed_nm[j],
                }),
                OpenJoint::Servo(servo) => servo.turn(to_rad[j] + self.lead_s * rate[j]),
            };
        }
        at_rad
    }

    /// Counts steps from where the joints are now, which nobody tells to move any more. Servos know their own angle, and go to where a pulse of the
    /// first tick tells them.
    pub(crate) fn power_up(&mut self, at_rad: PanTilt<f64>) {
        for j in Joint::BOTH {
            match &mut self.joints[j] {
                OpenJoint::Stepper(stepper) => {
                    (*stepper, self.start_rad[j]) = (stepper.anew(), at_rad[j]);
                }
                OpenJoint::Servo(_) => self.start_rad[j] -= self.behind_rad[j],
            }
        }
        self.behind_rad = PanTilt::default();
        (self.told_rad, self.told_rad_s) = (PanTilt::default(), PanTilt::default());
    }

    /// A joint stays behind by so many steps from now on.
    pub(crate) fn lose(&mut self, joint: Joint, steps: i32) {
        self.behind_rad[joint] += f64::from(steps) * self.step_rad;
    }

    /// Steps that were told, counted from where true zero would be.
    pub(crate) fn measured(&self) -> PanTilt<Measurement> {
        PanTilt::from_fn(|j| {
            let count = ((self.start_rad[j] + self.told_rad[j]) / self.step_rad).round() as i32;
            Measurement { count, edge_age_ticks: None }
        })
    }

    /// Full steps that each joint is behind its pulses for good; 0 of a servo.
    pub(crate) fn lost_steps(&self) -> PanTilt<i64> {
        self.joints.map(|joint| match joint {
            OpenJoint::Stepper(stepper) => stepper.lost_steps(),
            OpenJoint::Servo(_) => 0,
        })
    }
}

/// Where a setpoint leads by the end of its tick, rad.
fn at_end(told: &Setpoint) -> f64 {
    let (rate, acceleration) = (f64::from(told.velocity_rad_s), f64::from(told.acceleration_rad_s2));
    f64::from(told.position_rad) + TICK_F64_S * (rate + 0.5 * TICK_F64_S * acceleration)
}
