use tracelight_control::{Config, Estimate, LawConfig, Reference, Servo};
use tracelight_plant::Plant;
use tracelight_rig::{Actuation, Joint, Measurement, PanTilt, Setpoint};

use crate::config::RigConfig;
use crate::linear::LinearHead;
use crate::truth::Truth;

/// Observers and laws on a head, without plan, supervisor and light: what a control engineer puts on the bench.
#[derive(Clone, Debug)]
pub(crate) struct Bench<H> {
    config: Config,
    servo: Servo,
    head: H,
    measured: PanTilt<Measurement>,
    begun: bool,
}

/// One tick on the bench; all of it at the tick's start.
#[derive(Clone, Copy, Debug)]
pub struct BenchTick {
    /// Where the joints should be.
    pub setpoint: PanTilt<Setpoint>,
    /// True joint angles, rad.
    pub angle_rad: PanTilt<f64>,
    /// Direction of the beam, rad.
    pub beam_rad: PanTilt<f64>,
    /// What the encoders read.
    pub measured: PanTilt<Measurement>,
    /// Estimates of the observers.
    pub estimates: PanTilt<Estimate>,
    /// What is done about it, V.
    pub command_v: PanTilt<f32>,
}

impl Bench<Plant> {
    /// The rig's head as it truly is, at rest at zero.
    pub(crate) fn nonlinear(rig: &RigConfig, seed: u64) -> Self {
        Self::nonlinear_at(rig, PanTilt::default(), seed)
    }

    /// Starts the bench at rest at other angles.
    pub(crate) fn nonlinear_at(rig: &RigConfig, angle_rad: PanTilt<f64>, seed: u64) -> Self {
        let plant = Plant::resting_at(&rig.plant_config(), angle_rad, seed);
        let measured = plant.measured();
        Self::new(rig.control_config(), plant, measured)
    }

    /// What somebody pushes the joints with from now on, N m.
    pub(crate) fn push(&mut self, torque_nm: PanTilt<f64>) {
        self.head.push(torque_nm);
    }
}

impl Bench<LinearHead> {
    /// Makes a bench with the head linearized at rest at `pose_rad` and an ideal encoder and amplifier. The law is configured accordingly.
    pub(crate) fn linear(rig: &RigConfig, pose_rad: PanTilt<f64>) -> Self {
        let head = LinearHead::new(rig, pose_rad);
        Self::new(head.control_config(rig), head, PanTilt::default())
    }
}

impl<H: Truth> Bench<H> {
    fn new(config: Config, head: H, measured: PanTilt<Measurement>) -> Self {
        Self { servo: Servo::at_rest(&config, &measured), config, head, measured, begun: false }
    }

    /// With another law for one joint.
    pub(crate) fn driven_by(mut self, joint: Joint, law: LawConfig) -> Self {
        self.config.axes[joint].law = law;
        Self::new(self.config, self.head, self.measured)
    }

    /// One tick.
    pub(crate) fn step(&mut self, reference: &Reference) -> BenchTick {
        if self.begun {
            self.servo.observe(&self.config, &self.measured);
        }
        self.begun = true;
        let (angle_rad, beam_rad) = (self.head.angle_rad(), self.head.beam_rad());
        let estimates = *self.servo.estimates();
        let command_v = self.servo.drive(&self.config, reference);
        let measured = self.measured;
        self.measured = self.head.exchange(&Actuation { command_v, ..Actuation::default() }).encoders;
        BenchTick { setpoint: reference.now, angle_rad, beam_rad, measured, estimates, command_v }
    }
}
