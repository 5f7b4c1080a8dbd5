use tracelight_control::{Config, Estimate, LawConfig, Reference, Servo};
use tracelight_plant::Plant;
use tracelight_rig::{Actuation, Joint, Measurement, PanTilt, Setpoint};

use crate::config::RigConfig;
use crate::linear::LinearHead;
use crate::pid_law::{PidLaw, PidMemory};
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
    /// Commands at the amplifiers, V.
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
        self.step_with(reference, |_, volts| volts)
    }

    /// One tick, one joint driven by a PID beside what its own law adds.
    pub(crate) fn step_by_pid(
        &mut self,
        reference: &Reference,
        joint: Joint,
        (law, memory): (&PidLaw, &mut PidMemory),
    ) -> BenchTick {
        self.step_with(reference, |bench, mut command_v| {
            let axis = &bench.config.axes[joint];
            let angle_rad = f64::from(bench.measured[joint].count) * f64::from(axis.count_rad);
            let setpoint_rad = f64::from(reference.now[joint].position_rad);
            let (nm_per_v, limit_v) = (f64::from(axis.torque_nm_per_v), f64::from(axis.limit_v));
            let beyond_v = f64::from(axis.beyond_v(command_v[joint]));
            let asked_v = beyond_v + law.torque_nm(memory, setpoint_rad, angle_rad) / nm_per_v;
            let given_v = asked_v.clamp(-limit_v, limit_v);
            law.settle(memory, (given_v - asked_v) * nm_per_v);
            command_v[joint] = axis.command_v(given_v as f32);
            bench.servo.apply(&bench.config, command_v);
            command_v
        })
    }

    fn step_with(
        &mut self,
        reference: &Reference,
        decide: impl FnOnce(&mut Self, PanTilt<f32>) -> PanTilt<f32>,
    ) -> BenchTick {
        if self.begun {
            self.servo.observe(&self.config, &self.measured);
        }
        self.begun = true;
        let (angle_rad, beam_rad) = (self.head.angle_rad(), self.head.beam_rad());
        let estimates = *self.servo.estimates();
        let driven_v = self.servo.drive(&self.config, reference);
        let command_v = decide(self, driven_v);
        let measured = self.measured;
        self.measured = self.head.exchange(&Actuation { command_v, ..Actuation::default() }).encoders;
        BenchTick { setpoint: reference.now, angle_rad, beam_rad, measured, estimates, command_v }
    }
}
