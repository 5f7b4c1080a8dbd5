//! What follows for planner and controller from a drive that nothing measures, and what is told of it.

use std::f64::consts::{PI, TAU};

use tracelight_control::Gentle;
use tracelight_dynamics::Motor;
use tracelight_maths::hypot;
use tracelight_plant::{EncoderConfig, ServoDrive, StepperDrive, Wear};
use tracelight_rig::{Joint, PanTilt};

use crate::config::{Model, RigConfig};
use crate::drive::DriveKind;

/// Command that stands for all the torque of a drive that takes pulses and no volts, V.
const FULL_COMMAND_V: f64 = 10.0;
/// Step in which an angle is told where a board sets any width of a pulse, rad.
const FINEST_RAD: f64 = 1e-4;
const MM: f64 = 1e3;

impl RigConfig {
    /// Gives model and truth what follows from a drive that measures nothing: torque, rotor inertia, top speed, time to settle and range, no wear,
    /// and counts that are steps of what is told. A stepper's torque is that at its top speed, where it is least. A rig of motors stays as it is.
    #[must_use]
    pub fn driven(mut self) -> Self {
        let drive = self.drive;
        if drive.kind == DriveKind::Servo {
            let motion = &mut self.motion;
            motion.speed_limit_rad_s = motion.speed_limit_rad_s.map(|top| top.min(drive.servo.speed_rad_s));
            motion.settle_s = motion.settle_s.max(drive.servo.settles_s());
        }
        let top = self.motion.speed_limit_rad_s;
        let (torque_nm, step_rad) = match drive.kind {
            DriveKind::Motor => return self,
            DriveKind::Stepper => {
                (top.map(|top| drive.stepper.pull_out_nm(top)), drive.stepper.microstep_rad())
            }
            DriveKind::Servo => {
                let stall_nm = drive.servo.stall_torque_nm;
                (PanTilt::new(stall_nm, stall_nm), drive.servo.pulse_step_rad().max(FINEST_RAD))
            }
        };
        let encoder = EncoderConfig { counts_per_rev: steps_per_rev(step_rad), edge_stamps: false };
        let motors = torque_nm.map(|torque_nm| Motor::by_current(torque_nm / FULL_COMMAND_V, FULL_COMMAND_V));
        for model in [&mut self.model, &mut self.truth.model] {
            model.motors = motors;
            if drive.kind == DriveKind::Stepper {
                let rotor = drive.stepper.rotor_kg_m2 * drive.stepper.gear_ratio * drive.stepper.gear_ratio;
                model.bodies.rotor_kg_m2 = PanTilt::new(rotor, rotor);
            }
            model.encoder = encoder;
            if drive.kind == DriveKind::Servo {
                stay_within(model, 0.5 * drive.servo.range_rad);
            }
        }
        self.truth.wear = Wear::NONE;
        self
    }

    /// What a plan for a head without encoders has to be told of, for a target at that distance, m, at that speed of the light, m/s; empty for
    /// one that has some.
    pub fn open_loop_remarks(&self, distance_m: f64, speed_m_s: f64) -> Vec<String> {
        let expected = match self.drive.kind {
            DriveKind::Motor => return Vec::new(),
            DriveKind::Stepper => stepper_remark(&self.drive.stepper, self.load_angle_rad(), distance_m),
            DriveKind::Servo => servo_remark(&self.drive.servo, distance_m, speed_m_s),
        };
        let believed = "open loop: this head has no encoders. Where it is, it was told to be and nobody measured; a joint that is blocked goes \
                        unnoticed, and its light stands";
        vec![believed.into(), expected]
    }

    /// The angle within which a joint may stand still although its set angle moves, rad.
    pub(crate) fn unseen_rad(&self) -> f64 {
        let (stepper, servo) = (&self.drive.stepper, &self.drive.servo);
        match self.drive.kind {
            DriveKind::Motor => 0.0,
            DriveKind::Stepper => {
                let placed_rad = 2.0 * stepper.microstep_error * stepper.full_step_rad();
                stepper.microstep_rad() + placed_rad + self.load_angle_rad()
            }
            DriveKind::Servo => 2.0 * servo.dead_band_rad() + servo.pulse_step_rad() + servo.play_rad,
        }
    }

    /// What joints that nothing measures surely follow; `None` of a rig with encoders. Half of the torque that friction and gravity leave is kept
    /// for all else.
    pub(crate) fn gentle(&self) -> Option<Gentle> {
        const SHARE: f64 = 0.5;
        /// Of a motor that friction and gravity leave nothing: it does not move whatever it is told.
        const LEAST: f64 = 1e-3;
        if !self.drive.kind.is_open_loop() {
            return None;
        }
        let torque_share = PanTilt::from_fn(|j| {
            let left = 1.0 - self.carried_nm(j) / self.model.motors[j].torque_limit_nm();
            SHARE * left.max(LEAST)
        });
        Some(Gentle {
            rate_rad_s: self.motion.speed_limit_rad_s.map(|rate| rate as f32),
            acceleration_rad_s2: self.motion.acceleration_limit_rad_s2.map(|most| most as f32),
            torque_share: torque_share.map(|share| share as f32),
        })
    }

    /// Torque that friction at top speed and gravity take at most, N m.
    fn carried_nm(&self, joint: Joint) -> f64 {
        let lumped = self.model.bodies.lumped();
        let top = self.motion.speed_limit_rad_s[joint];
        let friction = &self.model.friction[joint];
        let friction_nm = friction.torque(top).max(-friction.torque(-top));
        match joint {
            Joint::Pan => friction_nm,
            Joint::Tilt => friction_nm + hypot(lumped.gravity_c, lumped.gravity_s),
        }
    }

    /// By how much friction and gravity turn a stepper's rotor from where its pulses put it, at most, rad at the joint.
    fn load_angle_rad(&self) -> f64 {
        let load_nm = self.carried_nm(Joint::Pan).max(self.carried_nm(Joint::Tilt));
        self.drive.stepper.load_angle_rad(load_nm)
    }
}

/// How many steps make a turn of the joint: as many as a rig file may say.
fn steps_per_rev(step_rad: f64) -> u32 {
    (TAU / step_rad).round().clamp(16.0, 1e8) as u32
}

fn stay_within(model: &mut Model, half_rad: f64) {
    for joint in Joint::BOTH {
        let (lower, upper) = model.geometry.range_rad[joint];
        model.geometry.range_rad[joint] = (lower.max(-half_rad), upper.min(half_rad));
    }
}

fn stepper_remark(drive: &StepperDrive, load_rad: f64, distance_m: f64) -> String {
    let mm = |angle_rad: f64| MM * distance_m * angle_rad;
    let half_mm = mm(0.5 * drive.microstep_rad());
    let [off_mm, load_mm] = [drive.full_step_rad() * drive.microstep_error, load_rad].map(mm);
    format!(
        "expect up to {:.2} mm of error a joint at {distance_m:.3} m: {half_mm:.2} mm is half a microstep, by {off_mm:.2} mm the motor places them \
         wrong, and by {load_mm:.2} mm friction and weight turn it",
        half_mm + off_mm + load_mm
    )
}

fn servo_remark(drive: &ServoDrive, distance_m: f64, speed_m_s: f64) -> String {
    let dead_mm = MM * distance_m * drive.resolution_rad();
    let play_mm = MM * distance_m * drive.play_rad;
    let between_mm = MM * speed_m_s * drive.refresh_s;
    format!(
        "expect up to {:.1} mm of error a joint at {distance_m:.3} m: {dead_mm:.1} mm ({:.2} degrees) is what the servos do not answer, {:.1} mm half of \
         their play, and {:.1} mm half of the way at {speed_m_s:.3} m/s from one pulse to the next, {:.0} ms later. A shorter --distance makes it less",
        dead_mm + 0.5 * play_mm + 0.5 * between_mm,
        drive.resolution_rad() * 180.0 / PI,
        0.5 * play_mm,
        0.5 * between_mm,
        MM * drive.refresh_s,
    )
}
