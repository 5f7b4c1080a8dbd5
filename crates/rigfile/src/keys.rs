//! Every key of a rig file: its place, unit, bounds, meaning, and the field it sets.

use tracelight_sim::{Day, LawName, Model, ObserverName, RigConfig};
use tracelight_units::{ANGLES, ANGULAR_ACCELERATIONS, ANGULAR_JERKS, ANGULAR_SPEEDS, LENGTHS, TIMES, Unit};

/// The field a key sets.
#[derive(Clone, Copy)]
pub(crate) enum Slot<T> {
    /// A quantity or a pure number.
    Real(fn(&mut T) -> &mut f64),
    /// The same, which a rig need not have.
    Maybe(fn(&mut T) -> &mut Option<f64>),
    /// A day, which nobody need know.
    Day(fn(&mut T) -> &mut Option<Day>),
    /// A whole number.
    Count(fn(&mut T) -> &mut u32),
    /// Yes or no.
    Flag(fn(&mut T) -> &mut bool),
    /// One of some names.
    Choice(Choice<T>),
}

/// A key whose value is a name.
#[derive(Clone, Copy)]
pub(crate) struct Choice<T> {
    /// What fits.
    pub(crate) names: fn() -> Vec<&'static str>,
    /// The name that holds.
    pub(crate) get: fn(&T) -> &'static str,
    /// Takes one of `names`.
    pub(crate) set: fn(&mut T, &str),
}

/// A key of `T`.
#[derive(Clone, Copy)]
pub(crate) struct Key<T: 'static> {
    /// Dotted path under its section.
    pub(crate) path: &'static str,
    /// Units that fit; empty for a pure number.
    pub(crate) units: &'static [Unit],
    /// Lowest and highest value, SI.
    pub(crate) bounds: (f64, f64),
    /// What it is.
    pub(crate) meaning: &'static str,
    /// Where it goes.
    pub(crate) slot: Slot<T>,
}

pub(crate) const PURE: &[Unit] = &[];
const MASS: &[Unit] = &[("kg", 1.0), ("g", 1e-3)];
pub(crate) const INERTIA: &[Unit] = &[("kgm2", 1.0), ("gcm2", 1e-7)];
const GRAVITY: &[Unit] = &[("m/s2", 1.0)];
pub(crate) const TORQUE: &[Unit] = &[("Nm", 1.0), ("mNm", 1e-3)];
const FREQUENCIES: &[Unit] = &[("Hz", 1.0)];
pub(crate) const STIFFNESS: &[Unit] = &[("Nm/rad", 1.0), ("mNm/rad", 1e-3)];
pub(crate) const VISCOUS: &[Unit] = &[("Nms/rad", 1.0), ("mNms/rad", 1e-3)];
const GAIN: &[Unit] = &[("Nm/V", 1.0), ("mNm/V", 1e-3)];
const VOLTAGE: &[Unit] = &[("V", 1.0), ("mV", 1e-3)];
const BACK_EMF: &[Unit] = &[("Vs/rad", 1.0), ("mVs/rad", 1e-3)];

type Real = fn(&mut Model) -> &mut f64;

pub(crate) const fn real<T>(
    path: &'static str,
    units: &'static [Unit],
    bounds: (f64, f64),
    meaning: &'static str,
    field: fn(&mut T) -> &mut f64,
) -> Key<T> {
    Key { path, units, bounds, meaning, slot: Slot::Real(field) }
}

pub(crate) const fn count<T>(
    path: &'static str,
    bounds: (f64, f64),
    meaning: &'static str,
    field: fn(&mut T) -> &mut u32,
) -> Key<T> {
    Key { path, units: PURE, bounds, meaning, slot: Slot::Count(field) }
}

pub(crate) const fn flag<T>(
    path: &'static str,
    meaning: &'static str,
    field: fn(&mut T) -> &mut bool,
) -> Key<T> {
    Key { path, units: PURE, bounds: (0.0, 0.0), meaning, slot: Slot::Flag(field) }
}

pub(crate) const fn choice<T>(path: &'static str, meaning: &'static str, choice: Choice<T>) -> Key<T> {
    Key { path, units: PURE, bounds: (0.0, 0.0), meaning, slot: Slot::Choice(choice) }
}

/// A body's mass, centre and inertia.
macro_rules! body {
    ($name:literal, $field:ident) => {
        [
            real(
                concat!($name, ".body.mass"),
                MASS,
                (0.0, 100.0),
                "mass of what the joint carries by itself",
                (|m| &mut m.bodies.$field.mass_kg) as Real,
            ),
            real(
                concat!($name, ".body.centre_x"),
                LENGTHS,
                (-1.0, 1.0),
                "its centre of mass, forward",
                |m| &mut m.bodies.$field.centre_m[0],
            ),
            real(concat!($name, ".body.centre_y"), LENGTHS, (-1.0, 1.0), "left", |m| {
                &mut m.bodies.$field.centre_m[1]
            }),
            real(concat!($name, ".body.centre_z"), LENGTHS, (-1.0, 1.0), "up", |m| {
                &mut m.bodies.$field.centre_m[2]
            }),
            real(
                concat!($name, ".body.inertia_xx"),
                INERTIA,
                (0.0, 10.0),
                "its inertia tensor about that centre",
                |m| &mut m.bodies.$field.inertia.xx,
            ),
            real(concat!($name, ".body.inertia_xy"), INERTIA, (-10.0, 10.0), "entry 12 of it", |m| {
                &mut m.bodies.$field.inertia.xy
            }),
            real(concat!($name, ".body.inertia_xz"), INERTIA, (-10.0, 10.0), "entry 13", |m| {
                &mut m.bodies.$field.inertia.xz
            }),
            real(concat!($name, ".body.inertia_yy"), INERTIA, (0.0, 10.0), "entry 22", |m| {
                &mut m.bodies.$field.inertia.yy
            }),
            real(concat!($name, ".body.inertia_yz"), INERTIA, (-10.0, 10.0), "entry 23", |m| {
                &mut m.bodies.$field.inertia.yz
            }),
            real(concat!($name, ".body.inertia_zz"), INERTIA, (0.0, 10.0), "entry 33", |m| {
                &mut m.bodies.$field.inertia.zz
            }),
        ]
    };
}

/// A joint's drive.
macro_rules! drive {
    ($name:literal, $joint:ident) => {
        [
            real(
                concat!($name, ".rotor_inertia"),
                INERTIA,
                (0.0, 100.0),
                "motor's inertia as felt at the joint (motor × ratio²)",
                (|m| &mut m.bodies.rotor_kg_m2.$joint) as Real,
            ),
            real(concat!($name, ".motor.torque_per_volt"), GAIN, (1e-9, 1e3), "joint torque per volt", |m| {
                &mut m.motors.$joint.torque_nm_per_v
            }),
            real(concat!($name, ".motor.limit"), VOLTAGE, (1e-3, 1e3), "largest command", |m| {
                &mut m.motors.$joint.limit_v
            }),
            real(
                concat!($name, ".motor.back_emf"),
                BACK_EMF,
                (0.0, 1e3),
                "volts of command that the turning motor works against, of an amplifier that gives a voltage (H-bridge); 0 of one that gives a current",
                |m| &mut m.motors.$joint.back_emf_v_s_per_rad,
            ),
            real(
                concat!($name, ".motor.dead_band"),
                VOLTAGE,
                (0.0, 1e3),
                "command of which nothing comes, either sign",
                |m| &mut m.motors.$joint.dead_band_v,
            ),
            real(
                concat!($name, ".friction.viscous_pos"),
                VISCOUS,
                (0.0, 10.0),
                "slope of friction, turning positively",
                |m| &mut m.friction.$joint.viscous_pos,
            ),
            real(concat!($name, ".friction.viscous_neg"), VISCOUS, (0.0, 10.0), "turning negatively", |m| {
                &mut m.friction.$joint.viscous_neg
            }),
            real(
                concat!($name, ".friction.coulomb_pos"),
                TORQUE,
                (0.0, 100.0),
                "friction that does not grow with speed, turning positively",
                |m| &mut m.friction.$joint.coulomb_pos_nm,
            ),
            real(
                concat!($name, ".friction.coulomb_neg"),
                TORQUE,
                (-100.0, 0.0),
                "turning negatively; negative itself",
                |m| &mut m.friction.$joint.coulomb_neg_nm,
            ),
            real(concat!($name, ".range_min"), ANGLES, (-3.2, 0.0), "lowest angle", |m| {
                &mut m.geometry.range_rad.$joint.0
            }),
            real(concat!($name, ".range_max"), ANGLES, (0.0, 3.2), "highest angle", |m| {
                &mut m.geometry.range_rad.$joint.1
            }),
        ]
    };
}

/// What belongs to no joint.
const WHOLE: [Key<Model>; 16] = [
    real("gravity", GRAVITY, (0.0, 30.0), "along −z", (|m| &mut m.bodies.gravity_m_s2) as Real),
    count("encoder.counts_per_rev", (16.0, 1e8), "counts a turn of the joint", |m| {
        &mut m.encoder.counts_per_rev
    }),
    Key {
        path: "encoder.edge_stamps",
        units: PURE,
        bounds: (0.0, 1.0),
        meaning: "whether the hardware stamps edges with their time",
        slot: Slot::Flag(|m| &mut m.encoder.edge_stamps),
    },
    real("relay.on", TIMES, (0.0, 0.05), "from the gate's rise to light", |m| &mut m.relay.on_s),
    real("relay.off", TIMES, (0.0, 0.05), "from the gate's fall to dark", |m| &mut m.relay.off_s),
    real("enable.on", TIMES, (0.0, 0.05), "the same of the laser's second switch", |m| &mut m.enable.on_s),
    real("enable.off", TIMES, (0.0, 0.05), "the same of the laser's second switch", |m| &mut m.enable.off_s),
    real(
        "foot.inertia",
        INERTIA,
        (1e-4, 100.0),
        "inertia of head and what it stands on together, about each axis",
        |m| &mut m.foot.inertia_kg_m2,
    ),
    real(
        "foot.resonance",
        FREQUENCIES,
        (0.0, 50.0),
        "how often they swing on it; 0 for one that stands firm",
        |m| &mut m.foot.resonance_hz,
    ),
    real("foot.damping", PURE, (0.0, 2.0), "share of critical damping of that", |m| &mut m.foot.damping),
    real(
        "laser.forward",
        LENGTHS,
        (-0.5, 0.5),
        "where the beam leaves, from the crossing of the axes",
        |m| &mut m.geometry.laser_offset_m[0],
    ),
    real("laser.left", LENGTHS, (-0.5, 0.5), "the same, to the left", |m| &mut m.geometry.laser_offset_m[1]),
    real("laser.up", LENGTHS, (-0.5, 0.5), "the same, upwards", |m| &mut m.geometry.laser_offset_m[2]),
    real("laser.points_left", ANGLES, (-0.2, 0.2), "how far the beam points left of straight ahead", |m| {
        &mut m.geometry.beam_off_rad[0]
    }),
    real("laser.points_down", ANGLES, (-0.2, 0.2), "the same, downwards", |m| {
        &mut m.geometry.beam_off_rad[1]
    }),
    real(
        "axis_skew",
        ANGLES,
        (-0.2, 0.2),
        "how much higher the tilt axis's left end is than square to pan's",
        |m| &mut m.geometry.axis_skew_rad,
    ),
];

/// Keys of `[model]` and of `[truth]`.
pub(crate) fn model_keys() -> Vec<Key<Model>> {
    let mut keys = WHOLE.to_vec();
    keys.extend(drive!("pan", pan));
    keys.extend(body!("pan", pan_body));
    keys.extend(drive!("tilt", tilt));
    keys.extend(body!("tilt", tilt_body));
    keys
}

/// Keys of `[truth.gyroscope]`, `[truth.wear]`, `[control]` and `[motion]`.
pub(crate) const RIG_KEYS: [Key<RigConfig>; 41] = [
    flag("truth.gyroscope.fitted", "whether a gyroscope is fixed to what it stands on", |r| {
        &mut r.truth.gyroscope.fitted
    }),
    real(
        "truth.gyroscope.noise",
        ANGULAR_SPEEDS,
        (0.0, 1.0),
        "standard deviation of each of its readings",
        |r| &mut r.truth.gyroscope.noise_rad_s,
    ),
    real(
        "truth.gyroscope.bias",
        ANGULAR_SPEEDS,
        (0.0, 0.05),
        "most that it reads at rest; how much is drawn from the seed",
        |r| &mut r.truth.gyroscope.bias_rad_s,
    ),
    real("truth.wear.stribeck_ratio", PURE, (1.0, 10.0), "break-away over Coulomb friction", |r| {
        &mut r.truth.wear.stribeck_ratio
    }),
    real(
        "truth.wear.stribeck_speed",
        ANGULAR_SPEEDS,
        (1e-6, 10.0),
        "speed at which that excess has fallen to 1/e",
        |r| &mut r.truth.wear.stribeck_speed_rad_s,
    ),
    real(
        "truth.wear.friction_ripple",
        PURE,
        (0.0, 0.9),
        "share by which friction ripples over a turn",
        |r| &mut r.truth.wear.friction_ripple,
    ),
    real("truth.wear.edge_error", PURE, (0.0, 0.4), "largest misplacement of an encoder edge, counts", |r| {
        &mut r.truth.wear.edge_error_counts
    }),
    real("truth.wear.backlash", ANGLES, (0.0, 0.1), "play between encoder and beam", |r| {
        &mut r.truth.wear.backlash_rad
    }),
    real("truth.wear.gain_spread", PURE, (0.0, 0.9), "largest relative error of an amplifier's gain", |r| {
        &mut r.truth.wear.gain_spread
    }),
    real(
        "truth.wear.belt_resonance",
        FREQUENCIES,
        (0.0, 1e3),
        "how often what a joint carries swings on its belt; 0 for belts that do not give",
        |r| &mut r.truth.wear.belt_resonance_hz,
    ),
    real("truth.wear.belt_damping", PURE, (0.0, 2.0), "share of critical damping of that", |r| {
        &mut r.truth.wear.belt_damping
    }),
    Key {
        path: "truth.wear.encoders_at_motors",
        units: PURE,
        bounds: (0.0, 1.0),
        meaning: "whether encoders sit on the motors' side of the belts; else on the joints",
        slot: Slot::Flag(|r| &mut r.truth.wear.encoders_at_motors),
    },
    real(
        "truth.wear.eccentricity",
        PURE,
        (0.0, 100.0),
        "what an encoder reads wrong over a turn because its disc sits beside its axis, counts",
        |r| &mut r.truth.wear.eccentricity_counts,
    ),
    real(
        "truth.wear.back_emf",
        VISCOUS,
        (0.0, 10.0),
        "how much less torque a motor has for each rad/s, by its own voltage",
        |r| &mut r.truth.wear.back_emf_nm_s_per_rad,
    ),
    real(
        "truth.wear.current_lag",
        TIMES,
        (0.0, 0.1),
        "time constant with which an amplifier's current follows its command",
        |r| &mut r.truth.wear.current_lag_s,
    ),
    real(
        "truth.wear.supply_ripple",
        PURE,
        (0.0, 0.9),
        "share by which the supply, and every volt's torque, ripples with 100 Hz",
        |r| &mut r.truth.wear.supply_ripple,
    ),
    real(
        "truth.wear.cable",
        STIFFNESS,
        (0.0, 10.0),
        "spring of the cables on each joint; where they do not pull is drawn from the seed",
        |r| &mut r.truth.wear.cable_nm_per_rad,
    ),
    real("truth.wear.jitter", TIMES, (0.0, 2e-4), "how far a control tick comes early or late", |r| {
        &mut r.truth.wear.jitter_s
    }),
    real("truth.wear.lost_counts", PURE, (0.0, 0.1), "share of edges the counter misses", |r| {
        &mut r.truth.wear.lost_counts
    }),
    choice(
        "control.law",
        "from error to torque",
        Choice {
            names: || LawName::ALL.map(LawName::name).to_vec(),
            get: |r| r.control.law.name(),
            set: |r, name| r.control.law = LawName::named(name).unwrap_or(r.control.law),
        },
    ),
    choice(
        "control.observer",
        "from counts to position and speed; own: the one the law is meant for",
        Choice {
            names: || std::iter::once("own").chain(ObserverName::ALL.map(ObserverName::name)).collect(),
            get: |r| r.control.observer.map_or("own", ObserverName::name),
            set: |r, name| r.control.observer = ObserverName::named(name),
        },
    ),
    real(
        "control.observer_interval",
        TIMES,
        (1e-3, 0.064),
        "how long observers look back that have such a time, to whole milliseconds; 1 over it is the corner of the others",
        |r| &mut r.control.observer_interval_s,
    ),
    choice(
        "control.creep",
        "how law state with its own observer goes where a plan is slower than friction lets go: in hops, or following it",
        Choice {
            names: || vec!["hop", "follow"],
            get: |r| if r.control.hops { "hop" } else { "follow" },
            set: |r, name| r.control.hops = name == "hop",
        },
    ),
    real(
        "control.pan_bandwidth",
        ANGULAR_SPEEDS,
        (0.1, 500.0),
        "how far pan's closed-loop poles lie from the origin",
        |r| &mut r.control.bandwidth_rad_s.pan,
    ),
    real("control.tilt_bandwidth", ANGULAR_SPEEDS, (0.1, 500.0), "the same for tilt", |r| {
        &mut r.control.bandwidth_rad_s.tilt
    }),
    real(
        "control.tolerance",
        LENGTHS,
        (1e-5, 0.05),
        "distance on the target beyond which the laser is darkened",
        |r| &mut r.control.tolerance_m,
    ),
    real("control.hold_limit", TIMES, (0.1, 600.0), "how long the head may need to come back", |r| {
        &mut r.control.hold_limit_s
    }),
    real(
        "control.host_silence",
        TIMES,
        (5e-3, 1.0),
        "how long a host may be silent before it is dark and the plan waits for it",
        |r| &mut r.control.host_silence_s,
    ),
    real("control.host_lost", TIMES, (0.05, 60.0), "how long it may be silent before that is a fault", |r| {
        &mut r.control.host_lost_s
    }),
    real(
        "control.scale_tolerance",
        PURE,
        (0.02, 2.0),
        "by how much what an encoder shows of a motion may differ from what its motor must have made, as a share",
        |r| &mut r.control.scale_tolerance,
    ),
    real(
        "control.motor_continuous",
        PURE,
        (0.01, 1.0),
        "share of its amplifier's limit a motor stands for ever",
        |r| &mut r.control.motor_continuous,
    ),
    real("control.motor_heating", TIMES, (0.1, 3e3), "time constant of a motor's temperature", |r| {
        &mut r.control.motor_heating_s
    }),
    real("motion.torque_share", PURE, (0.05, 0.95), "share of the motors' torque a plan may use", |r| {
        &mut r.motion.torque_share
    }),
    real("motion.pan_speed", ANGULAR_SPEEDS, (1e-3, 1e3), "highest speed of pan", |r| {
        &mut r.motion.speed_limit_rad_s.pan
    }),
    real("motion.tilt_speed", ANGULAR_SPEEDS, (1e-3, 1e3), "highest speed of tilt", |r| {
        &mut r.motion.speed_limit_rad_s.tilt
    }),
    real(
        "motion.pan_acceleration",
        ANGULAR_ACCELERATIONS,
        (1e-3, 1e6),
        "highest acceleration wished for; the motors decide where they allow less",
        |r| &mut r.motion.acceleration_limit_rad_s2.pan,
    ),
    real("motion.tilt_acceleration", ANGULAR_ACCELERATIONS, (1e-3, 1e6), "the same for tilt", |r| {
        &mut r.motion.acceleration_limit_rad_s2.tilt
    }),
    real(
        "motion.pan_jerk",
        ANGULAR_JERKS,
        (10.0, 1e9),
        "highest jerk of pan, from tick to tick; 1e9 is none",
        |r| &mut r.motion.jerk_limit_rad_s3.pan,
    ),
    real("motion.tilt_jerk", ANGULAR_JERKS, (10.0, 1e9), "the same for tilt", |r| {
        &mut r.motion.jerk_limit_rad_s3.tilt
    }),
    real(
        "motion.ramp",
        TIMES,
        (1e-3, 1.0),
        "time over which the acceleration along a stroke builds up",
        |r| &mut r.motion.ramp_s,
    ),
    real("motion.settle", TIMES, (0.0, 5.0), "rest before a stroke is lit", |r| &mut r.motion.settle_s),
];
