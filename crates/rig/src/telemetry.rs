use crate::{Actuation, DarknessSet, Fault, FaultRecord, Inputs, Measurement, PanTilt, Setpoint};

/// Where the supervisor stands.
///
/// ```text
///          Arm             first segment            off its stroke
///  Dark ─────────► Armed ───────────────► Tracing ◄────────────────► Holding
///   ▲                │                       │      back on it          │
///   │     Disarm     │                       │ last segment done        │ too long
///   ├────────────────┴───────────────────────┴──► Done                  │
///   │                                        │                          ▼
///   └──── power-up            any Fault, from anywhere ────────────► Faulted ── Arm ─► Armed
/// ```
///
/// Back on its stroke, a head whose encoders are not trusted makes a little move in the dark first: Holding ◄─► Testing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Phase {
    /// Power-up: no light allowed; joints are held where they are.
    #[default]
    Dark,
    /// Light allowed, nothing to draw yet.
    Armed,
    /// The plan's clock runs.
    Tracing,
    /// The plan's clock stands: dark until the head is back where it left its stroke.
    Holding,
    /// The plan's clock stands, and the head makes a little move in the dark that shows whether its encoders follow its motors.
    Testing,
    /// All segments done.
    Done,
    /// A fault is latched.
    Faulted,
}

impl Phase {
    /// Every phase, in the order of their numbers on a wire, from 0.
    pub const ALL: [Self; 7] =
        [Self::Dark, Self::Armed, Self::Tracing, Self::Holding, Self::Testing, Self::Done, Self::Faulted];
}

/// One tick as the controller saw it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Telemetry {
    /// Ticks since power-up.
    pub tick: u32,
    /// The plan's own clock, whole ticks; it stands still while [`Phase::Holding`].
    pub plan_tick: u32,
    /// What the encoders read at the start of the tick.
    pub measured: PanTilt<Measurement>,
    /// What the safety inputs said then, and which there are.
    pub inputs: Inputs,
    /// Where the joints should be at the start of the tick.
    pub setpoint: PanTilt<Setpoint>,
    /// Where the observer believes the joints are, rad.
    pub position_rad: PanTilt<f32>,
    /// How fast the observer believes they turn, rad/s.
    pub velocity_rad_s: PanTilt<f32>,
    /// How fast it believes that changes, rad/s².
    pub acceleration_rad_s2: PanTilt<f32>,
    /// Counts that are to be added to what the encoders read, because they lost some or made some up, as far as the
    /// observer noticed.
    pub lost_counts: PanTilt<i32>,
    /// Rotation of the base since it last stood still, rad about the head's x, y and z (ahead, left, up). Slow rotation is forgotten within a
    /// second. `None` without a gyroscope on the base.
    pub foot_turned_rad: Option<[f32; 3]>,
    /// What is done about it until the next tick.
    pub actuation: Actuation,
    /// Why the gate is shut; empty when it is open.
    pub darkness: DarknessSet,
    /// Whether the rig was homed ([`Command::Home`](crate::Command::Home)) and has lost neither power nor counts since.
    pub homed: bool,
    /// Supervisor's state.
    pub phase: Phase,
    /// The latched fault, if any: the first since somebody armed.
    pub latched: Option<FaultRecord>,
    /// How many faults were latched since power-up; 0 for none. While one is latched, each other kind that comes counts once. What
    /// [`Command::Arm`](crate::Command::Arm) acknowledges.
    pub fault_number: u32,
}

impl Telemetry {
    /// Which fault is latched, if any.
    pub fn fault(&self) -> Option<Fault> {
        self.latched.map(|record| record.fault)
    }
}
