/// How long a session stays armed before a job begins: 10 s.
pub const ARMED_TICKS: u32 = 10_000;
/// How long a paused job goes on without arming anew: 60 s.
pub const PAUSED_TICKS: u32 = 60_000;
/// How long a job is done again and again without anything that is asked: 10 min. Somebody stands there, or light goes on for nobody.
pub const ATTENDED_TICKS: u32 = 600_000;

/// What a session does.
///
/// ```text
///              homed            Arm               Trace            gate shut
///  Unhomed ───────────► Ready ◄─────► Armed ───────────► Tracing ◄──────────► Returning
///     ▲                  ▲ ▲   10 s     ▲                 │  │ ▲   off its stroke
///     │ counts lost      │ │            │           Pause │  │ └───── Resume ─────┐
///     │                  │ └─ Parking ◄─┼── Park ──┐      ▼  └──► Done            │
///     │                  │              │          │   Pausing ───────────────► Paused
///     │     no job begun │              │ Arm      │              at rest, dark   │
///   Fault ◄─ any         └── Stopped ◄──┴──────────┴──── Stop, from anywhere ─────┘
///     └── Clear ──────────────►┘
/// ```
///
/// ```text
///  Unhomed ◄── Arm ──► Armed ── Seek ──► Homing ── Home ──► Ready        Paused ── Mark ──► Marking ── its end ──► Paused
///     ▲                                     │
///     └──────────────── Stop ───────────────┘
///                                                    Unhomed, Ready, Done ── Jog ──► Jogging ── its end, Stop ──► Unhomed, Ready
/// ```
///
/// A job that is done again and again is `Stepping`, `Pointing` or `Framing` where another one is `Tracing`; `Next` parks it and begins another one. A dry job needs no arming: it goes from `Ready`, `Done`, `Stopped` or `Paused` to `Tracing`. `Unhome` leads from anywhere to `Unhomed`, `Park` also from there and from `Homing`; `Disarm` and `Stop` end a dot. `Lost` is entered from anywhere, and never left.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum State {
    /// The rig does not know where it points.
    Unhomed,
    /// The head is turned in the dark and lets out dots, to find where it points.
    Homing,
    /// The head is turned in the dark, as somebody wants it.
    Jogging,
    /// Dark, at rest, without a job.
    Ready,
    /// Somebody armed: a job may begin, or go on, within [`ARMED_TICKS`](crate::ARMED_TICKS). Still dark.
    Armed,
    /// The plan's clock runs.
    Tracing,
    /// A stroke is drawn again and again, until something else is asked; dark between two times.
    Stepping,
    /// A point is marked again and again, likewise.
    Pointing,
    /// The frame of a drawing is drawn again and again, likewise.
    Framing,
    /// The plan's clock stands until the head is back on its stroke. Dark.
    Returning,
    /// The stroke that is lit is drawn to its end.
    Pausing,
    /// Dark on the way of a job that goes on by [`Request::Resume`](crate::Request::Resume).
    Paused,
    /// Dark on the way of a job that was stopped. It goes on only after somebody has armed again.
    Stopped,
    /// A dot is let out where the head rests on the way of a job.
    Marking,
    /// Returns to zero in the dark; the job is forgotten.
    Parking,
    /// The job is done.
    Done,
    /// A fault is latched. Dark until it is cleared.
    Fault,
    /// The rig is gone. It darkens by itself.
    Lost,
}

impl State {
    /// Every state.
    pub const ALL: [Self; 18] = [
        Self::Unhomed,
        Self::Homing,
        Self::Jogging,
        Self::Ready,
        Self::Armed,
        Self::Tracing,
        Self::Stepping,
        Self::Pointing,
        Self::Framing,
        Self::Returning,
        Self::Pausing,
        Self::Paused,
        Self::Stopped,
        Self::Marking,
        Self::Parking,
        Self::Done,
        Self::Fault,
        Self::Lost,
    ];

    /// Stable name for scripts.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Unhomed => "unhomed",
            Self::Homing => "homing",
            Self::Jogging => "jogging",
            Self::Ready => "ready",
            Self::Armed => "armed",
            Self::Tracing => "tracing",
            Self::Stepping => "stepping",
            Self::Pointing => "pointing",
            Self::Framing => "framing",
            Self::Returning => "returning",
            Self::Pausing => "pausing",
            Self::Paused => "paused",
            Self::Stopped => "stopped",
            Self::Marking => "marking",
            Self::Parking => "parking",
            Self::Done => "done",
            Self::Fault => "fault",
            Self::Lost => "lost",
        }
    }

    /// Whether light may leave the head.
    pub const fn may_light(self) -> bool {
        self.traces() || matches!(self, Self::Pausing | Self::Homing | Self::Marking)
    }

    /// Whether the plan's clock runs for a job, done once or again and again.
    pub const fn traces(self) -> bool {
        matches!(self, Self::Tracing) || self.repeats()
    }

    /// Whether a job is done again and again.
    pub const fn repeats(self) -> bool {
        matches!(self, Self::Stepping | Self::Pointing | Self::Framing)
    }

    /// Whether a job goes on by itself.
    pub const fn is_on(self) -> bool {
        self.traces() || matches!(self, Self::Returning | Self::Pausing)
    }
}
