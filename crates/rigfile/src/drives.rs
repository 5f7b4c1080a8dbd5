//! Keys of what turns the joints: `drive`, and the table of stepper motors or hobby servos.

use tracelight_grbl::BoardAxis;
use tracelight_sim::{DriveKind, LawName, ObserverName, RigConfig};
use tracelight_task::Failure;
use tracelight_units::{ANGLES, ANGULAR_SPEEDS, TIMES, Unit};

use crate::keys::{Choice, INERTIA, Key, PURE, TORQUE, choice, count, real};

/// The key that says which drive a rig has.
pub(crate) const DRIVE: &str = "drive";
const STEPPER: &str = "stepper.";
const SERVO: &str = "servo.";
/// Times of pulses are read in microseconds too.
const PULSES: &[Unit] = &[("s", 1.0), ("ms", 1e-3), ("us", 1e-6)];

/// Returns the key that says which drive a rig has.
pub(crate) const fn drive_key() -> Key<RigConfig> {
    choice(
        DRIVE,
        "what turns the joints: motors with encoders, or steppers or hobby servos without (open loop)",
        Choice {
            names: || DriveKind::ALL.map(DriveKind::name).to_vec(),
            get: |r| r.drive.kind.name(),
            set: |r, name| r.drive.kind = DriveKind::named(name).unwrap_or(r.drive.kind),
        },
    )
}

const STEPPER_KEYS: [Key<RigConfig>; 10] = [
    count(
        "stepper.steps_per_turn",
        (4.0, 1e4),
        "full steps of a turn of the motor, a multiple of 4; 200 of 1.8 degrees",
        |r| &mut r.drive.stepper.full_steps_per_turn,
    ),
    count("stepper.microsteps", (1.0, 1024.0), "microsteps of a full step, as the driver is set", |r| {
        &mut r.drive.stepper.microsteps
    }),
    real("stepper.gear_ratio", PURE, (0.1, 1e3), "turns of the motor for one of the joint", |r| {
        &mut r.drive.stepper.gear_ratio
    }),
    real(
        "stepper.holding_torque",
        TORQUE,
        (1e-4, 100.0),
        "of the motor at rest, with the driver's current",
        |r| &mut r.drive.stepper.holding_torque_nm,
    ),
    real(
        "stepper.corner_speed",
        ANGULAR_SPEEDS,
        (0.1, 1e4),
        "speed of the motor from which on its torque falls as one over the speed",
        |r| &mut r.drive.stepper.corner_rad_s,
    ),
    real(
        "stepper.pull_in_speed",
        ANGULAR_SPEEDS,
        (0.0, 1e4),
        "greatest speed of the field at which a motor at rest falls into step",
        |r| &mut r.drive.stepper.pull_in_rad_s,
    ),
    real("stepper.rotor_inertia", INERTIA, (0.0, 1.0), "of the motor's rotor", |r| {
        &mut r.drive.stepper.rotor_kg_m2
    }),
    real(
        "stepper.microstep_error",
        PURE,
        (0.0, 0.5),
        "furthest that a microstep lies beside its place, as a share of a full step",
        |r| &mut r.drive.stepper.microstep_error,
    ),
    choice(
        "stepper.pan_axis",
        "axis of a Grbl board that turns pan; with a minus if the motor turns the other way",
        Choice {
            names: || BoardAxis::NAMES.to_vec(),
            get: |r| r.drive.axes.pan.name(),
            set: |r, name| r.drive.axes.pan = BoardAxis::read(name).unwrap_or(r.drive.axes.pan),
        },
    ),
    choice(
        "stepper.tilt_axis",
        "axis of a Grbl board that turns tilt; with a minus if the motor turns the other way",
        Choice {
            names: || BoardAxis::NAMES.to_vec(),
            get: |r| r.drive.axes.tilt.name(),
            set: |r, name| r.drive.axes.tilt = BoardAxis::read(name).unwrap_or(r.drive.axes.tilt),
        },
    ),
];

const SERVO_KEYS: [Key<RigConfig>; 9] = [
    real("servo.range", ANGLES, (0.1, 6.4), "from end to end", |r| &mut r.drive.servo.range_rad),
    real("servo.pulse_span", PULSES, (1e-4, 5e-3), "change of the pulse's width over that range", |r| {
        &mut r.drive.servo.pulse_span_s
    }),
    real(
        "servo.pulse_resolution",
        PULSES,
        (0.0, 1e-3),
        "step in which the board sets the width; 0 where it sets any",
        |r| &mut r.drive.servo.pulse_resolution_s,
    ),
    real("servo.dead_band", PULSES, (0.0, 1e-3), "change of the width that the servo does not answer", |r| {
        &mut r.drive.servo.dead_band_s
    }),
    real(
        "servo.refresh",
        TIMES,
        (1e-3, 0.1),
        "from one pulse to the next, in whole ms: 20 ms at 50 Hz",
        |r| &mut r.drive.servo.refresh_s,
    ),
    real(
        "servo.speed",
        ANGULAR_SPEEDS,
        (0.01, 1e3),
        "greatest speed: 60 degrees over the catalogue's seconds",
        |r| &mut r.drive.servo.speed_rad_s,
    ),
    real(
        "servo.response",
        TIMES,
        (0.0, 1.0),
        "time in which it covers all but 1/e of what is left near its goal",
        |r| &mut r.drive.servo.response_s,
    ),
    real("servo.play", ANGLES, (0.0, 0.2), "how far the beam turns freely in its gear", |r| {
        &mut r.drive.servo.play_rad
    }),
    real("servo.stall_torque", TORQUE, (1e-3, 100.0), "greatest torque", |r| {
        &mut r.drive.servo.stall_torque_nm
    }),
];

/// Refuses what needs encoders on a rig that has none.
///
/// # Errors
/// `open-loop-rig`, which says why `what` cannot be done.
pub fn measured(rig: &RigConfig, what: &str) -> Result<(), Failure> {
    let kind = rig.drive.kind;
    if !kind.is_open_loop() {
        return Ok(());
    }
    let message = format!(
        "{what} needs encoders, and the rig {} has none: its {}s follow their pulses unmeasured (open loop); take a rig whose drive is \"motor\"",
        rig.name,
        kind.name()
    );
    Err(Failure::usage("open-loop-rig", message))
}

/// Gives a rig the law and the observer that were asked for, if any were.
///
/// # Errors
/// `open-loop-rig` of a rig without encoders.
pub fn set_law(
    rig: &mut RigConfig,
    law: Option<LawName>,
    observer: Option<ObserverName>,
) -> Result<(), Failure> {
    if law.is_some() || observer.is_some() {
        measured(rig, "--law or --observer")?;
    }
    rig.set_law(law.unwrap_or(rig.control.law), observer);
    Ok(())
}

/// Returns the keys of the table that a drive has.
pub(crate) const fn drive_keys(kind: DriveKind) -> &'static [Key<RigConfig>] {
    match kind {
        DriveKind::Motor => &[],
        DriveKind::Stepper => &STEPPER_KEYS,
        DriveKind::Servo => &SERVO_KEYS,
    }
}

/// Returns every key of a drive.
pub(crate) fn all_drive_keys() -> Vec<Key<RigConfig>> {
    [drive_key()].into_iter().chain(STEPPER_KEYS).chain(SERVO_KEYS).collect()
}

/// Tells whether a key's value follows from the drive of a rig without encoders, so that no file of it has the key.
pub(crate) fn follows(path: &str, kind: DriveKind) -> bool {
    let own = path.strip_prefix("model.").or_else(|| path.strip_prefix("truth."));
    let Some(own) = own.filter(|_| kind.is_open_loop()) else { return false };
    let is_rotor = kind == DriveKind::Stepper && own.ends_with(".rotor_inertia");
    let is_motor = own.ends_with(".motor.torque_per_volt") || own.ends_with(".motor.limit");
    is_rotor || is_motor || own.starts_with("encoder.") || own.starts_with("wear.")
}

/// Says what is wrong with a key that belongs to another drive than the rig's.
pub(crate) fn of_other_drive(path: &str, kind: DriveKind) -> Option<String> {
    if follows(path, kind) {
        return Some(format!(
            "{path} follows from [{}] on a rig without encoders and cannot be set: leave it out",
            kind.name()
        ));
    }
    let needed = [(STEPPER, DriveKind::Stepper), (SERVO, DriveKind::Servo)]
        .into_iter()
        .find_map(|(table, needed)| path.starts_with(table).then_some(needed))?;
    (needed != kind).then(|| {
        format!(
            "{path} is of a rig with drive = \"{}\", and this one has drive = \"{}\": set {DRIVE}, or leave the key out",
            needed.name(),
            kind.name()
        )
    })
}

/// Refuses a drive that there cannot be.
pub(crate) fn impossible_drive(config: &RigConfig) -> Option<String> {
    let drive = &config.drive;
    let steps = drive.stepper.full_steps_per_turn;
    if drive.kind == DriveKind::Stepper && !steps.is_multiple_of(4) {
        return Some(format!(
            "[stepper] steps_per_turn: {steps} is no multiple of 4, which a two-phase motor has"
        ));
    }
    let servo = &drive.servo;
    (drive.kind == DriveKind::Servo && servo.dead_band_s.max(servo.pulse_resolution_s) >= servo.pulse_span_s).then(|| {
        "[servo] dead_band and pulse_resolution must be less than pulse_span: else the servo answers nothing".into()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{parse, write};

    #[test]
    fn rigs_with_other_drives_come_back_as_they_were_written() {
        let mut own = RigConfig::stepper();
        own.drive.stepper.gear_ratio = 4.5;
        own.motion.speed_limit_rad_s.pan = 12.0;
        let mut quick = RigConfig::servo();
        quick.drive.servo.refresh_s = 3e-3;
        quick.drive.servo.speed_rad_s = 4.0;
        // as far as keys go
        let mut far = RigConfig::stepper();
        let stepper = &mut far.drive.stepper;
        (stepper.gear_ratio, stepper.holding_torque_nm, stepper.corner_rad_s) = (1000.0, 100.0, 1e4);
        for rig in [RigConfig::stepper(), RigConfig::servo(), own.driven(), quick.driven(), far.driven()] {
            let text = write(&rig);
            let read = parse("own.toml", &text).unwrap();
            assert_eq!(read, rig, "{text}");
            assert_eq!(write(&read), text);
        }
    }

    #[test]
    fn a_key_of_another_drive_is_refused_and_a_drive_that_there_is_not() {
        let of = |text: &str| parse("my.toml", text).unwrap_err();
        let other = of("base = \"report\"\n[stepper]\nmicrosteps = 8\n");
        assert!(
            other.contains("stepper.microsteps is of a rig with drive = \"stepper\"")
                && other.contains("my.toml:3"),
            "{other}"
        );
        let none = of("base = \"report\"\ndrive = \"galvo\"\n");
        assert!(none.contains("drive: must be one of motor, stepper, servo"), "{none}");
        let odd = of("base = \"stepper\"\n[stepper]\nsteps_per_turn = 201\n");
        assert!(odd.contains("201 is no multiple of 4"), "{odd}");
        let deaf = of("base = \"servo\"\n[servo]\ndead_band = \"1ms\"\npulse_span = \"0.5ms\"\n");
        assert!(deaf.contains("less than pulse_span"), "{deaf}");
        let derived = of("base = \"stepper\"\n[model.encoder]\ncounts_per_rev = 4096\n");
        assert!(derived.contains("follows from [stepper]") && derived.contains("my.toml:3"), "{derived}");
        let worn = of("base = \"servo\"\n[truth.wear]\nbacklash = \"1deg\"\n");
        assert!(worn.contains("follows from [servo]"), "{worn}");
        let typo = of("base = \"stepper\"\n[stepper]\nmicrostep = 8\n");
        assert!(typo.contains("did you mean stepper.microsteps?"), "{typo}");
    }

    #[test]
    fn what_needs_encoders_is_refused_in_a_sentence() {
        let refused = measured(&RigConfig::servo(), "calibrate head").unwrap_err();
        assert!(refused.message.starts_with("calibrate head needs encoders, and the rig servo has none"));
        assert!(measured(&RigConfig::worn(), "calibrate head").is_ok());
    }

    #[test]
    fn a_few_lines_on_a_preset_make_a_rig_of_steppers() {
        let rig =
            parse("my.toml", "base = \"stepper\"\n[stepper]\nmicrosteps = 32\nholding_torque = \"0.28Nm\"\n")
                .unwrap();
        assert_eq!((rig.drive.stepper.microsteps, rig.drive.stepper.holding_torque_nm), (32, 0.28));
        // what it plans with follows
        assert!(
            rig.model.motors.pan.torque_limit_nm() < RigConfig::stepper().model.motors.pan.torque_limit_nm()
        );
    }
}
