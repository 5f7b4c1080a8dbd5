//! Which head is linearized, and where it stands.

use tracelight_dynamics::HeadBodies;
use tracelight_lab::{Linearization, Operation};
use tracelight_rig::PanTilt;
use tracelight_sim::RigConfig;
use tracelight_task::Failure;

/// Which head is linearized, and where.
#[derive(Clone, Debug)]
pub struct HeadChoice {
    /// Its masses.
    pub masses: Masses,
    /// Where it stands, rad; if not given, at half the report's range of motion.
    pub at_rad: Option<PanTilt<f64>>,
    /// How fast it turns, steadily, rad/s.
    pub rates_rad_s: PanTilt<f64>,
    /// Keep poles that a zero takes back but for a ten thousandth.
    pub keep_cancellations: bool,
}

/// Whose masses.
#[derive(Clone, Debug)]
pub enum Masses {
    /// The 2006 report's, with its viscous friction of 0.01 N m s/rad and g = 9.8 m/s².
    Set(Set),
    /// What is believed of a rig: with the mean of its viscous friction in both directions, and its gravity.
    Rig(Box<RigConfig>),
}

/// One of the report's parameter sets.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Set {
    /// The model file's.
    A,
    /// The simulation's start file's.
    B,
}

impl Set {
    /// What it says of the bodies.
    #[must_use]
    pub const fn bodies(self) -> HeadBodies {
        match self {
            Self::A => HeadBodies::set_a(),
            Self::B => HeadBodies::set_b(),
        }
    }

    /// Returns a rig with these masses and rotor inertias, believed and true, and otherwise unchanged.
    #[must_use]
    pub fn on(self, mut rig: RigConfig) -> RigConfig {
        for bodies in [&mut rig.model.bodies, &mut rig.truth.model.bodies] {
            // gravity is the place's, not the set's
            *bodies = HeadBodies { gravity_m_s2: bodies.gravity_m_s2, ..self.bodies() };
        }
        rig.name += match self {
            Self::A => ", set A",
            Self::B => ", set B",
        };
        rig
    }

    const fn name(self) -> &'static str {
        match self {
            Self::A => "parameter set A",
            Self::B => "parameter set B",
        }
    }
}

/// What is linearized, in words and in numbers.
pub(crate) struct Head {
    /// What it is.
    pub(crate) name: String,
    /// Where pan stands, rad.
    pub(crate) pan_rad: f64,
    pub(crate) operation: Operation,
}

impl HeadChoice {
    pub(crate) fn head(&self) -> Head {
        /// atan 1/2: 18 in beside what is 36 in away.
        const HALF_RANGE_RAD: f64 = 0.463_647_609_000_806_1;
        let (name, bodies, viscous) = match &self.masses {
            Masses::Rig(rig) => {
                let viscous = PanTilt::from_fn(|j| rig.model.felt_friction(j).mean_viscous());
                (format!("rig {}", rig.name), rig.model.bodies, viscous)
            }
            Masses::Set(set) => {
                // what the report's own helper had
                let bodies = HeadBodies { gravity_m_s2: 9.8, ..set.bodies() };
                (set.name().to_owned(), bodies, PanTilt::new(0.01, 0.01))
            }
        };
        let at = self.at_rad.unwrap_or(PanTilt::new(HALF_RANGE_RAD, HALF_RANGE_RAD));
        let operation =
            Operation { head: bodies.lumped(), viscous, tilt_rad: at.tilt, rate_rad_s: self.rates_rad_s };
        let gravity = bodies.gravity_m_s2;
        let name =
            format!("{name}, viscous {} and {} N m s/rad, g = {gravity} m/s²", viscous.pan, viscous.tilt);
        Head { name, pan_rad: at.pan, operation }
    }
}

impl Head {
    pub(crate) fn linearize(&self) -> Result<Linearization, Failure> {
        self.operation
            .linearize()
            .map_err(|e| Failure::failed("no-linear-model", format!("{}: {e}", self.name)))
    }

    /// Where it is and how it moves.
    pub(crate) fn place(&self) -> String {
        let rates = &self.operation.rate_rad_s;
        let moving = match (rates.pan, rates.tilt) {
            (0.0, 0.0) => "at rest".to_owned(),
            (pan, tilt) => format!("turning with {pan} and {tilt} rad/s"),
        };
        let (pan, tilt) = (self.pan_rad.to_degrees(), self.operation.tilt_rad.to_degrees());
        format!("pan {pan:.3}°, tilt {tilt:.3}°, {moving}")
    }
}
