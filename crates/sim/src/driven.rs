//! What follows for planner and controller from a drive that nothing measures, and what is told of it.

use std::f64::consts::PI;

use tracelight_dynamics::Motor;
use tracelight_plant::{EncoderConfig, ServoDrive, StepperDrive};
use tracelight_rig::{Joint, PanTilt, TICK_F64_S};

use crate::config::{Model, RigConfig};
use crate::drive::DriveKind;

/// Command that stands for all the torque of a drive that takes pulses and no volts, V.
const FULL_COMMAND_V: f64 = 10.0;
const MM: f64 = 1e3;

impl RigConfig {
    /// Gives model and truth what follows from a drive that measures nothing: torque, top speed and range, and counts that are steps of what is told.
    /// A stepper's torque is that at its top speed, where it is least. A rig of motors stays as it is.
    #[must_use]
    pub fn driven(mut self) -> Self {
        let drive = self.drive;
        if drive.kind == DriveKind::Servo {
            let speed = &mut self.motion.speed_limit_rad_s;
            *speed = speed.map(|top| top.min(drive.servo.speed_rad_s));
        }
        let torque_nm = |top_rad_s: f64| match drive.kind {
            DriveKind::Motor => None,
            DriveKind::Stepper => Some(drive.stepper.pull_out_nm(top_rad_s)),
            DriveKind::Servo => Some(drive.servo.stall_torque_nm),
        };
        let top = self.motion.speed_limit_rad_s;
        let (Some(pan_nm), Some(tilt_nm)) = (torque_nm(top.pan), torque_nm(top.tilt)) else { return self };
        let motors = PanTilt::new(pan_nm, tilt_nm)
            .map(|torque_nm| Motor { torque_nm_per_v: torque_nm / FULL_COMMAND_V, limit_v: FULL_COMMAND_V });
        for model in [&mut self.model, &mut self.truth.model] {
            model.motors = motors;
            model.encoder = EncoderConfig { counts_per_rev: drive.steps_per_rev(), edge_stamps: false };
            if drive.kind == DriveKind::Servo {
                stay_within(model, 0.5 * drive.servo.range_rad);
            }
        }
        self
    }

    /// What a plan for a head without encoders has to be told of, for a target at that distance, m, at that speed of the light, m/s; empty for
    /// one that has some.
    pub fn open_loop_remarks(&self, distance_m: f64, speed_m_s: f64) -> Vec<String> {
        let expected = match self.drive.kind {
            DriveKind::Motor => return Vec::new(),
            DriveKind::Stepper => stepper_remark(&self.drive.stepper, distance_m),
            DriveKind::Servo => servo_remark(&self.drive.servo, distance_m, speed_m_s),
        };
        let believed = "open loop: this head has no encoders. Where it is, it was told to be and nobody measured; a joint that is blocked goes \
                        unnoticed, and its light stands";
        vec![believed.into(), expected]
    }

    /// The angle within which a joint may stand still although its set angle moves, rad.
    pub(crate) fn unseen_rad(&self) -> f64 {
        match self.drive.kind {
            DriveKind::Motor => 0.0,
            DriveKind::Stepper => self.drive.stepper.microstep_rad(),
            DriveKind::Servo => 2.0 * self.drive.servo.resolution_rad() + self.drive.servo.play_rad,
        }
    }
}

fn stay_within(model: &mut Model, half_rad: f64) {
    for joint in Joint::BOTH {
        let (lower, upper) = model.geometry.range_rad[joint];
        model.geometry.range_rad[joint] = (lower.max(-half_rad), upper.min(half_rad));
    }
}

fn stepper_remark(drive: &StepperDrive, distance_m: f64) -> String {
    let step_mm = MM * distance_m * drive.microstep_rad();
    let off_mm = MM * distance_m * drive.full_step_rad() * drive.microstep_error;
    format!(
        "a microstep is {step_mm:.2} mm at {distance_m:.3} m, so expect {:.2} mm of error a joint: half a microstep, and {off_mm:.2} mm by which \
         the motor places them wrong. Load adds to it",
        0.5 * step_mm + off_mm
    )
}

fn servo_remark(drive: &ServoDrive, distance_m: f64, speed_m_s: f64) -> String {
    let dead_mm = MM * distance_m * drive.resolution_rad();
    let play_mm = MM * distance_m * drive.play_rad;
    let refresh_s = f64::from(drive.refresh_ticks) * TICK_F64_S;
    let between_mm = MM * speed_m_s * refresh_s;
    format!(
        "the servos do not answer less than {:.2} degrees, {dead_mm:.1} mm at {distance_m:.3} m, and have {play_mm:.1} mm of play: expect {:.1} mm of \
         error a joint. A pulse comes every {:.0} ms, in which the light goes {between_mm:.1} mm at {speed_m_s:.3} m/s: curves become steps; a \
         lower --speed makes them smaller, and a shorter --distance all of it",
        drive.resolution_rad() * 180.0 / PI,
        dead_mm + 0.5 * play_mm,
        MM * refresh_s,
    )
}
