//! What is known of each tick of a rig, whoever tells it: the truth of a simulation, or the encoders of a head.

use tracelight_aim::{HeadGeometry, HeadPose};
use tracelight_rig::{Command, Rig, Telemetry};
use tracelight_session::{Session, Untrimmed};

use crate::RigConfig;
use crate::run::{Simulated, SimulatedRig, Tick, asked_spot, patience_ticks};

/// Who tells where the spot was.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LightFrom {
    /// The equations of a simulated head, which know.
    #[default]
    Simulation,
    /// What a head without encoders was told, which nobody measured, and the gate. Nobody saw the light.
    Commands,
    /// Encoders, by how the head is said to be built and to stand, and the gate. Nobody saw the light.
    Encoders,
}

impl LightFrom {
    /// Stable name for scripts.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Simulation => "simulation",
            Self::Commands => "commands",
            Self::Encoders => "encoders",
        }
    }
}

/// Where what is told of a run comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Origin {
    /// The head was one of equations: nothing moved, no light fell.
    pub simulated: bool,
    /// Who tells where the spot was.
    pub light_from: LightFrom,
}

impl Origin {
    /// A simulated head in this process.
    pub const SIMULATION: Self = Self { simulated: true, light_from: LightFrom::Simulation };
}

/// A rig of which more is known in each tick than its telemetry tells.
pub trait Observed: Rig {
    /// Lets it run for a tick; `None` once it is gone.
    fn observe(&mut self) -> Option<Tick>;

    /// Where that comes from.
    fn origin(&self) -> Origin;

    /// Ticks beyond a plan after which a run is given up.
    fn patience_ticks(&self) -> usize;
}

impl<O: Observed + ?Sized> Observed for &mut O {
    fn observe(&mut self) -> Option<Tick> {
        (**self).observe()
    }

    fn origin(&self) -> Origin {
        (**self).origin()
    }

    fn patience_ticks(&self) -> usize {
        (**self).patience_ticks()
    }
}

impl Observed for SimulatedRig {
    fn observe(&mut self) -> Option<Tick> {
        Some(self.step())
    }

    fn origin(&self) -> Origin {
        Origin::SIMULATION
    }

    fn patience_ticks(&self) -> usize {
        Simulated::patience_ticks(self)
    }
}

/// A rig that tells nothing but its telemetry: where its spot is follows from what its controller believes of the joints, by how the head is said to be built and
/// to stand. Its ticks are counted from the first one that it tells.
#[derive(Clone, Debug)]
pub struct ByEncoders<R> {
    rig: R,
    geometry: HeadGeometry,
    pose: HeadPose,
    laser: Laser,
    origin: Origin,
    patience_ticks: usize,
    /// Number of the first tick that was told: of a board that has been up for long it is a large one.
    first_tick: Option<u32>,
}

/// A laser behind a relay, as it is said to be: when it lights follows from its gate.
#[derive(Clone, Copy, Debug)]
struct Laser {
    on_ticks: u32,
    off_ticks: u32,
    gate: bool,
    /// Ticks since that was opened or shut; it was shut for ever before the first.
    since: u32,
}

impl Laser {
    /// Whether it shines at the start of the tick that follows what was heard.
    const fn is_lit(&self) -> bool {
        if self.gate { self.since >= self.on_ticks } else { self.since < self.off_ticks }
    }

    /// What its gate does for a tick.
    const fn hear(&mut self, gate: bool) {
        self.since = if gate == self.gate { self.since.saturating_add(1) } else { 1 };
        self.gate = gate;
    }
}

impl<R: Rig> ByEncoders<R> {
    /// A rig with a head that is said to be built so and to stand there; whether it is known to be one of equations.
    pub fn new(rig: R, config: &RigConfig, pose: HeadPose, simulated: bool) -> Self {
        let geometry = config.model.geometry;
        let control = config.control_config();
        let (on_ticks, off_ticks) = (control.laser_on_ticks, control.laser_off_ticks);
        let laser = Laser { on_ticks, off_ticks, gate: false, since: u32::MAX };
        let patience_ticks = patience_ticks(&control);
        let open_loop = config.drive.kind.is_open_loop();
        let light_from = if open_loop { LightFrom::Commands } else { LightFrom::Encoders };
        let origin = Origin { simulated, light_from };
        Self { rig, geometry, pose, laser, origin, patience_ticks, first_tick: None }
    }

    /// The rig itself.
    pub const fn rig(&self) -> &R {
        &self.rig
    }

    /// The rig itself, to do with it what is no command.
    pub const fn rig_mut(&mut self) -> &mut R {
        &mut self.rig
    }
}

impl<R: Rig> Rig for ByEncoders<R> {
    fn send(&mut self, command: Command) -> Result<(), Command> {
        self.rig.send(command)
    }

    fn next(&mut self) -> Option<Telemetry> {
        let mut told = self.rig.next()?;
        let first_tick = *self.first_tick.get_or_insert(told.tick);
        told.tick = told.tick.wrapping_sub(first_tick);
        if let Some(record) = &mut told.latched {
            record.tick = record.tick.wrapping_sub(first_tick);
        }
        Some(told)
    }
}

impl<R: Rig> Observed for ByEncoders<R> {
    fn observe(&mut self) -> Option<Tick> {
        let telemetry = self.next()?;
        let angle_rad = telemetry.position_rad.map(f64::from);
        let light = self.laser.is_lit();
        self.laser.hear(telemetry.actuation.lights());
        Some(Tick {
            angle_rad,
            rate_rad_s: telemetry.velocity_rad_s.map(f64::from),
            spot: self.geometry.spot(&self.pose, angle_rad),
            asked: asked_spot(&self.geometry, &self.pose, &telemetry),
            light,
            telemetry,
        })
    }

    fn origin(&self) -> Origin {
        self.origin
    }

    fn patience_ticks(&self) -> usize {
        self.patience_ticks
    }
}

/// Lets a session with any rig run for a tick, with what is known of it; `None` once the rig is gone.
pub fn observed_tick<R: Observed>(session: &mut Session<R>) -> Option<Tick> {
    session.tick_by(R::observe, |tick| tick.as_ref().map(|tick| &tick.telemetry), &mut Untrimmed)
}
