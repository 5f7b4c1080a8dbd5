//! Built-in rigs.

use std::f64::consts::PI;

use tracelight_aim::HeadGeometry;
use tracelight_dynamics::{Body, Friction, HeadBodies, Inertia, Motor};
use tracelight_plant::{EncoderConfig, FootConfig, GyroscopeConfig, RelayConfig, Wear};
use tracelight_rig::PanTilt;

use crate::config::{Model, MotionSettings, RigConfig, Truth};
use crate::control_settings::ControlSettings;
use crate::drive::{DriveKind, DriveSettings};
use crate::light_settings::LightSettings;
use crate::safety_settings::SafetySettings;
use crate::{HandTuned, LawName};

/// Motor torque constant × gearhead × belt, N m at the joint per A.
const JOINT_TORQUE_NM_PER_A: f64 = 0.0432 * 6.3 * 2.8435;
/// Pan's amplifier as measured with the motor turning, A/V.
const PAN_A_PER_V: f64 = 0.08;
/// Tilt's amplifier, A/V.
const TILT_A_PER_V: f64 = 0.1;
/// Range of such amplifiers' inputs, V.
const COMMAND_LIMIT_V: f64 = 10.0;
/// Supply of an H-bridge, V, resistance of the winding of a motor of that constant, ohm, and what the dead time of the bridge's switches takes, V:
/// 2 µs of 50.
const BRIDGE_SUPPLY_V: f64 = 12.0;
const WINDING_OHM: f64 = 8.0;
const BRIDGE_DEAD_BAND_V: f64 = 0.48;

impl RigConfig {
    /// Every preset, in the order they are listed.
    pub fn presets() -> Vec<Self> {
        vec![Self::report(), Self::report_b(), Self::worn(), Self::bridge(), Self::stepper(), Self::servo()]
    }

    /// The preset of that name.
    pub fn preset(name: &str) -> Option<Self> {
        Self::presets().into_iter().find(|p| p.name == name)
    }

    /// The rig of the 2006 report: parameter set A, friction as its tables have it, 4096 counts a turn.
    pub fn report() -> Self {
        let model = report_model();
        Self {
            name: "report".into(),
            description: "the rig of the 2006 report, as good as new".into(),
            drive: DriveSettings::MOTOR,
            model,
            truth: Truth { model, gyroscope: GyroscopeConfig::NONE, wear: Wear::NONE },
            identified: None,
            control: ControlSettings {
                law: LawName::State,
                observer: None,
                observer_interval_s: 5e-3,
                hand_tuned: PanTilt::new(HandTuned::FIRST, HandTuned::FIRST),
                hops: true,
                bandwidth_rad_s: PanTilt::new(120.0, 120.0),
                tolerance_m: 3e-3,
                hold_limit_s: 3.0,
                host_silence_s: 0.05,
                host_lost_s: 1.0,
                // amplifiers differ by a tenth, inertia and friction by as much again
                scale_tolerance: 0.35,
                // small geared motors stand 1.4 times their rated current for half a minute
                motor_continuous: 0.7,
                motor_heating_s: 60.0,
            },
            motion: MotionSettings {
                torque_share: 0.85,
                speed_limit_rad_s: PanTilt::new(24.0, 24.0),
                acceleration_limit_rad_s2: PanTilt::new(100.0, 100.0),
                jerk_limit_rad_s3: PanTilt::new(1e9, 1e9),
                ramp_s: 0.02,
                settle_s: 0.04,
            },
            light: LightSettings::POINTER,
            safety: SafetySettings::USUAL,
            stops_rad: PanTilt::new((None, None), (None, None)),
            emulated: None,
        }
    }

    /// Returns the rig of the 2006 report with parameter set B, the one of its simulation's start file: rotor inertias as the encoder feels
    /// them, 20 times less. The report's own friction protocol gives its own tables on this set.
    pub fn report_b() -> Self {
        let report = Self::report();
        let model = Model { bodies: HeadBodies::set_b(), ..report.model };
        Self {
            name: "report-b".into(),
            description: "the rig of the 2006 report with the masses of its simulation's start file".into(),
            model,
            truth: Truth { model, ..report.truth },
            ..report
        }
    }

    /// Returns the rig after some years of wear: the model is unchanged, the truth has worn.
    pub fn worn() -> Self {
        const ARCMINUTE_RAD: f64 = PI / 180.0 / 60.0;
        let wear = Wear {
            // greased plain bearings and gearheads break away at 1.2 to 1.5 times what they slide at, from some mrad/s on
            stribeck_ratio: 1.3,
            stribeck_speed_rad_s: 0.02,
            // teeth that were ground for a smooth run
            friction_ripple: 0.1,
            // a quarter of what data sheets of optical encoders allow between their two lines
            edge_error_counts: 0.1,
            // a good gearhead behind a tight belt
            backlash_rad: ARCMINUTE_RAD,
            // amplifiers without a shunt; the original rig's pan gave a fifth less than its data sheet
            gain_spread: 0.1,
            // what hangs on a joint is light, and a belt of some 50 N m/rad is soft: it swings slowly, and nothing damps it
            belt_resonance_hz: 25.0,
            belt_damping: 0.03,
            encoders_at_motors: true,
            // a disc of 20 mm that sits 1.5 µm beside its axis
            eccentricity_counts: 0.1,
            // an inductance of 1 mH a resistance of 1 ohm
            current_lag_s: 1e-3,
            // inside what was identified as viscous friction
            back_emf_nm_s_per_rad: 0.0,
            // an unregulated supply under load
            supply_ripple: 0.05,
            // two wires and a plug: 9 mN m at the edge of the picture
            cable_nm_per_rad: 0.02,
            // a tick that waits for another interrupt
            jitter_s: 50e-6,
            lost_counts: 1e-6,
        };
        let new = Self::report();
        Self {
            name: "worn".into(),
            description:
                "the same rig with all that wears: sticking, play, soft belts, uneven edges, weak supply, cables"
                    .into(),
            truth: Truth { wear, ..new.truth },
            ..new
        }
    }
}

/// A head on amplifiers that give a voltage.
impl RigConfig {
    /// Returns the report's head on two H-bridges with a supply of 12 V, in place of amplifiers that give a current: torque fades as the motor speeds up, and
    /// nothing comes of the smallest commands.
    pub fn bridge() -> Self {
        let report = Self::report();
        let bridge = Motor {
            torque_nm_per_v: JOINT_TORQUE_NM_PER_A / WINDING_OHM,
            limit_v: BRIDGE_SUPPLY_V,
            // a motor's constant is the same in V s/rad as in N m/A
            back_emf_v_s_per_rad: JOINT_TORQUE_NM_PER_A,
            dead_band_v: BRIDGE_DEAD_BAND_V,
        };
        let model = Model { motors: PanTilt::new(bridge, bridge), ..report.model };
        Self {
            name: "bridge".into(),
            description:
                "the rig of the 2006 report on H-bridges, which give a voltage: 12 V, with a dead band".into(),
            model,
            truth: Truth { model, ..report.truth },
            ..report
        }
    }
}

/// Heads without encoders.
impl RigConfig {
    /// Returns a head on two NEMA 17 stepper motors behind belts.
    pub fn stepper() -> Self {
        let drive = DriveSettings { kind: DriveKind::Stepper, ..DriveSettings::MOTOR };
        // tilt's motor rides on pan
        let light = small_model(0.45, 0.0);
        let name = ("stepper", "two NEMA 17 stepper motors behind belts, no encoders (open loop)");
        // where its torque begins to fall, 51 rad/s over 3
        Self::open_loop(name, drive, light, 17.0)
    }

    /// Returns a head on two MG996R hobby servos.
    pub fn servo() -> Self {
        let drive = DriveSettings { kind: DriveKind::Servo, ..DriveSettings::MOTOR };
        // a core motor of some 10 g cm2 behind 1 to 200 or so
        let light = small_model(0.1, 2e-3);
        let name = ("servo", "two MG996R hobby servos, which tell nobody where they are (open loop)");
        Self::open_loop(name, drive, light, drive.servo.speed_rad_s)
    }

    fn open_loop(
        (name, description): (&str, &str),
        drive: DriveSettings,
        model: Model,
        top_rad_s: f64,
    ) -> Self {
        let report = Self::report();
        Self {
            name: name.into(),
            description: description.into(),
            drive,
            model,
            truth: Truth { model, ..report.truth },
            motion: MotionSettings {
                torque_share: 0.6,
                speed_limit_rad_s: PanTilt::new(top_rad_s, top_rad_s),
                settle_s: 0.1,
                ..report.motion
            },
            ..report
        }
        .driven()
    }
}

/// A laser module of 60 g in a tilting holder, on a pan body of that mass: blocks of 6 cm, with plain bearings.
fn small_model(pan_kg: f64, rotor_kg_m2: f64) -> Model {
    const LASER_KG: f64 = 0.06;
    const EDGE_M: f64 = 0.06;
    let cube = |mass_kg: f64| {
        let own = mass_kg * EDGE_M * EDGE_M / 6.0;
        let inertia = Inertia { xx: own, yy: own, zz: own, ..Inertia::default() };
        Body { mass_kg, centre_m: [0.0; 3], inertia }
    };
    let bodies = HeadBodies {
        pan_body: cube(pan_kg),
        // held a centimetre before the axis
        tilt_body: Body { centre_m: [0.01, 0.0, 0.0], ..cube(LASER_KG) },
        rotor_kg_m2: PanTilt::new(rotor_kg_m2, rotor_kg_m2),
        gravity_m_s2: 9.81,
    };
    let friction = Friction::symmetric(0.001, 0.03);
    let half_turn = (-0.5 * PI, 0.5 * PI);
    Model {
        bodies,
        friction: PanTilt::new(friction, friction),
        geometry: HeadGeometry::centred(PanTilt::new(half_turn, half_turn)),
        ..report_model()
    }
}

fn report_model() -> Model {
    let motor = |a_per_v: f64| Motor::by_current(a_per_v * JOINT_TORQUE_NM_PER_A, COMMAND_LIMIT_V);
    Model {
        bodies: HeadBodies::set_a(),
        friction: PanTilt::new(
            Friction {
                viscous_pos: 0.0009,
                viscous_neg: 0.0009,
                coulomb_pos_nm: 0.0406,
                coulomb_neg_nm: -0.0385,
            },
            Friction {
                viscous_pos: 0.0019,
                viscous_neg: 0.0017,
                coulomb_pos_nm: 0.0584,
                coulomb_neg_nm: -0.0569,
            },
        ),
        motors: PanTilt::new(motor(PAN_A_PER_V), motor(TILT_A_PER_V)),
        encoder: EncoderConfig { counts_per_rev: 4096, edge_stamps: true },
        relay: RelayConfig { on_s: 5e-3, off_s: 3e-3 },
        enable: RelayConfig { on_s: 0.0, off_s: 0.0 },
        foot: FootConfig::FIRM,
        geometry: HeadGeometry::centred(PanTilt::new((-PI, PI), (-95.0 * PI / 180.0, 95.0 * PI / 180.0))),
    }
}
