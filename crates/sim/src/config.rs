use tracelight_aim::HeadGeometry;
use tracelight_dynamics::{Friction, HeadBodies, Motor};
use tracelight_plant::{EncoderConfig, FootConfig, GyroscopeConfig, RelayConfig, Wear};
use tracelight_rig::{Joint, PanTilt};

use crate::control_settings::ControlSettings;
use crate::drive::DriveSettings;
use crate::laws::{LawName, ObserverName};
use crate::light_settings::LightSettings;
use crate::link::Emulation;
use crate::safety_settings::SafetySettings;

/// A rig, whole: what we believe it is, what it really is (in simulation), and how it is to be driven.
#[derive(Clone, Debug, PartialEq)]
pub struct RigConfig {
    /// Short name, as in `--rig`.
    pub name: String,
    /// One line on what it is.
    pub description: String,
    /// What turns its joints.
    pub drive: DriveSettings,
    /// What trajectory and control believe.
    pub model: Model,
    /// What the simulated plant is.
    pub truth: Truth,
    /// What was identified of this very head beyond the equations of the model, if it ever was.
    pub identified: Option<Identified>,
    /// How the controller is set.
    pub control: ControlSettings,
    /// How the planner is set.
    pub motion: MotionSettings,
    /// Its laser, how long that may stand, and where it is parked.
    pub light: LightSettings,
    /// When it is dark although nothing is wrong with the head.
    pub safety: SafetySettings,
    /// Where its joints come up against their end stops, lower and upper, rad: all four where that was measured, or none.
    pub stops_rad: PanTilt<(Option<f64>, Option<f64>)>,
    /// Whether a board drives it that is emulated behind a wire, in place of a controller in this process; no part of a rig file.
    pub emulated: Option<Emulation>,
}

/// A head in numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Model {
    /// Masses and gravity.
    pub bodies: HeadBodies,
    /// Friction as identified at speed.
    pub friction: PanTilt<Friction>,
    /// Amplifiers and motors.
    pub motors: PanTilt<Motor>,
    /// Encoders.
    pub encoder: EncoderConfig,
    /// The laser's relay.
    pub relay: RelayConfig,
    /// The laser's second switch, in series with it.
    pub enable: RelayConfig,
    /// What it stands on.
    pub foot: FootConfig,
    /// Where the beam leaves, and how far the joints turn.
    pub geometry: HeadGeometry,
}

/// By how much of a motor's torque a model is wrong at least.
const LEAST_UNKNOWN_SHARE: f64 = 0.01;

impl Model {
    /// What each joint feels at rest straight ahead, kg m².
    pub fn own_inertia_kg_m2(&self) -> PanTilt<f64> {
        self.bodies.lumped().mass(0.0).own_inertia()
    }

    /// Makes it another, kg m²: bodies keep theirs, the rotor has nearly all of it.
    pub fn set_own_inertia(&mut self, joint: Joint, inertia_kg_m2: f64) {
        let missing = inertia_kg_m2 - self.own_inertia_kg_m2()[joint];
        self.bodies.rotor_kg_m2[joint] += missing;
    }

    /// Moves the mass that tilt carries so that gravity exerts these torques, N m, with the beam level and upright. A massless head is left
    /// unchanged.
    pub fn set_weight(&mut self, [level_nm, upright_nm]: [f64; 2]) {
        let weight = self.bodies.tilt_body.mass_kg * self.bodies.gravity_m_s2;
        if weight > 0.0 {
            let centre = &mut self.bodies.tilt_body.centre_m;
            (centre[0], centre[2]) = (level_nm / weight, upright_nm / weight);
        }
    }

    /// What a joint's motion costs its motor beside inertia and gravity: friction, and what the motor's own voltage takes from an amplifier that
    /// gives a voltage.
    pub fn felt_friction(&self, joint: Joint) -> Friction {
        self.friction[joint].with_viscous(self.motors[joint].back_emf_nm_s_per_rad())
    }

    /// Makes it that much: what is more than the motor's own voltage takes is friction, which is never less than none.
    pub fn set_felt_friction(&mut self, joint: Joint, felt: Friction) {
        let own = felt.with_viscous(-self.motors[joint].back_emf_nm_s_per_rad());
        let (viscous_pos, viscous_neg) = (own.viscous_pos.max(0.0), own.viscous_neg.max(0.0));
        self.friction[joint] = Friction { viscous_pos, viscous_neg, ..own };
    }

    /// Torque by which the model of a joint may be wrong, N m: its Coulomb friction, where it has any to speak of.
    pub fn unknown_nm(&self, joint: Joint) -> f64 {
        let least_nm = LEAST_UNKNOWN_SHARE * self.motors[joint].torque_limit_nm();
        self.friction[joint].coulomb_nm().max(least_nm)
    }
}

/// What was identified of a head besides its model.
#[derive(Clone, Debug, PartialEq)]
pub struct Identified {
    /// Date of it, as year-month-day; empty if not given.
    pub date: String,
    /// How far the model is off what it was identified from, root mean square over stretches of motion, counts.
    pub residual_counts: PanTilt<f64>,
    /// What each joint has beyond its equations.
    pub quirks: PanTilt<Quirks>,
}

/// What a joint has beyond its equations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quirks {
    /// Friction above its Coulomb level near standstill, N m.
    pub break_away_nm: f64,
    /// Speed at which that excess has fallen to 1/e, rad/s.
    pub break_away_rad_s: f64,
    /// How far the four kinds of encoder edges lie beyond their places, counts; edge n is the one below count n, and n mod 4
    /// its kind.
    pub edges_counts: [f64; 4],
    /// Change of Coulomb friction with the angle.
    pub ripple: Ripple,
    /// What its cables do.
    pub cable: Cable,
}

/// Cables that hang on a joint: `load_nm` − `spring_nm_per_rad` q acts on it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Cable {
    /// N m at zero.
    pub load_nm: f64,
    /// N m/rad.
    pub spring_nm_per_rad: f64,
}

impl Identified {
    /// Of a head of which nothing is known.
    pub const NONE: Self = Self {
        date: String::new(),
        residual_counts: PanTilt::new(0.0, 0.0),
        quirks: PanTilt::new(Quirks::NONE, Quirks::NONE),
    };
}

impl RigConfig {
    /// What was identified of a joint beyond its equations.
    pub fn quirks_of(&self, joint: Joint) -> Quirks {
        self.identified.as_ref().map_or(Quirks::NONE, |identified| identified.quirks[joint])
    }

    /// Where its joints come up against their end stops, lower and upper, rad; `None` where that was not measured.
    pub fn known_stops_rad(&self) -> Option<PanTilt<(f64, f64)>> {
        let PanTilt { pan, tilt } = self.stops_rad;
        Some(PanTilt::new((pan.0?, pan.1?), (tilt.0?, tilt.1?)))
    }

    /// Sets a law, and an observer: the rig's own where it is the rig's own law, the law's for another.
    pub fn set_law(&mut self, law: LawName, observer: Option<ObserverName>) {
        let own = self.control.observer.filter(|_| law == self.control.law);
        self.control.law = law;
        self.control.observer = observer.or(own);
    }

    /// Returns the rig without hops, for motion that is studied for its own sake.
    pub fn following(&self) -> Self {
        Self { control: ControlSettings { hops: false, ..self.control }, ..self.trusting() }
    }

    /// Returns the rig with encoders trusted from the first tick on. For simulated trials of single moves, or of motors that
    /// differ from the model, in which encoder faults are not the question.
    #[must_use]
    pub fn trusting(&self) -> Self {
        Self { control: ControlSettings { scale_tolerance: f64::INFINITY, ..self.control }, ..self.clone() }
    }
}

impl Quirks {
    /// Of a joint of which nothing is known.
    pub const NONE: Self = Self {
        break_away_nm: 0.0,
        break_away_rad_s: 0.02,
        edges_counts: [0.0; 4],
        ripple: Ripple { periods: 0.0, sin_nm: 0.0, cos_nm: 0.0 },
        cable: Cable { load_nm: 0.0, spring_nm_per_rad: 0.0 },
    };
}

/// Friction that ripples over a turn of a joint, as gears make it: `sin_nm` sin(nq) + `cos_nm` cos(nq) on top of the Coulomb
/// level, either way.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Ripple {
    /// n, periods a turn; zero where none was found.
    pub periods: f64,
    /// N m.
    pub sin_nm: f64,
    /// N m.
    pub cos_nm: f64,
}

/// The simulated plant: a head and its wear.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Truth {
    /// The head as it really is.
    pub model: Model,
    /// What is fixed to its foot.
    pub gyroscope: GyroscopeConfig,
    /// What is worse than its equations.
    pub wear: Wear,
}

/// Settings of the planner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotionSettings {
    /// Share of the motors' torque a plan may use; the rest is the feedback's.
    pub torque_share: f64,
    /// Highest joint speed, rad/s.
    pub speed_limit_rad_s: PanTilt<f64>,
    /// Highest joint acceleration that is wished for, rad/s²; the motors decide where they allow less.
    pub acceleration_limit_rad_s2: PanTilt<f64>,
    /// Highest jerk of each joint, from one tick to the next, rad/s³; so high that it binds nothing if no limit is set.
    pub jerk_limit_rad_s3: PanTilt<f64>,
    /// Time over which the acceleration along a lit stroke builds up, s: the S of its run-up and run-down.
    pub ramp_s: f64,
    /// Rest before a stroke is lit, s.
    pub settle_s: f64,
}
