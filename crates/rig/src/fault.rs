/// A reason that stops a job: the laser is dark and stays dark.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Fault {
    /// An encoder's count moved faster than the joint can.
    EncoderJumped,
    /// The model says the joint moved several counts, its encoder says nothing.
    EncoderDead,
    /// Segments ran out in the middle of a job.
    SetpointsStale,
    /// A segment leaves the joint limits, does not join the one before it, or says nothing of its tolerance.
    SetpointInvalid,
    /// The joint itself left its limits.
    LimitReached,
    /// The head did not come back to its stroke in time.
    HoldTimedOut,
}

impl Fault {
    /// Stable code for scripts and `explain`.
    pub const fn code(self) -> &'static str {
        match self {
            Fault::EncoderJumped => "encoder-jumped",
            Fault::EncoderDead => "encoder-dead",
            Fault::SetpointsStale => "setpoints-stale",
            Fault::SetpointInvalid => "setpoint-invalid",
            Fault::LimitReached => "limit-reached",
            Fault::HoldTimedOut => "hold-timed-out",
        }
    }
}

/// A reason why the gate is shut in this tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u8)]
pub enum Darkness {
    /// The plan wants no light here.
    Planned = 0,
    /// Nobody armed the rig.
    Disarmed = 1,
    /// A joint's following error is over its segment's tolerance.
    FollowingError = 2,
    /// The two following errors together put the spot too far from its setpoint.
    SpotError = 3,
    /// The plan's clock stands still until the head is back on its stroke.
    Holding = 4,
    /// A setpoint lies outside the joint limits.
    OutOfBounds = 5,
    /// No valid setpoint for this tick.
    Stale = 6,
    /// A [`Fault`] is latched.
    Faulted = 7,
}

impl Darkness {
    /// Every reason, in bit order.
    pub const ALL: [Darkness; 8] = [
        Darkness::Planned,
        Darkness::Disarmed,
        Darkness::FollowingError,
        Darkness::SpotError,
        Darkness::Holding,
        Darkness::OutOfBounds,
        Darkness::Stale,
        Darkness::Faulted,
    ];

    /// Stable code for logs and `explain`.
    pub const fn code(self) -> &'static str {
        match self {
            Darkness::Planned => "planned",
            Darkness::Disarmed => "disarmed",
            Darkness::FollowingError => "following-error",
            Darkness::SpotError => "spot-error",
            Darkness::Holding => "holding",
            Darkness::OutOfBounds => "out-of-bounds",
            Darkness::Stale => "stale",
            Darkness::Faulted => "faulted",
        }
    }
}

/// The reasons that hold at once; empty means the gate is open.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct DarknessSet(u8);

impl DarknessSet {
    /// Adds a reason when `holds` is true.
    pub fn insert_if(&mut self, holds: bool, reason: Darkness) {
        if holds {
            self.0 |= 1 << reason as u8;
        }
    }

    /// Whether a reason is in the set.
    pub const fn contains(self, reason: Darkness) -> bool {
        self.0 & (1 << reason as u8) != 0
    }

    /// Whether nothing speaks against light.
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// One bit a reason, [`Darkness::ALL`] order.
    pub const fn bits(self) -> u8 {
        self.0
    }
}
