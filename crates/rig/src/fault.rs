/// A reason that stops a job: the laser is dark and stays dark until somebody arms again.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Fault {
    /// An encoder's count moved faster than the joint can.
    EncoderJumped,
    /// The model says the joint moved several counts, its encoder says nothing.
    EncoderDead,
    /// Edges came where the joint was not, again and again.
    EncoderNoisy,
    /// What an encoder shows and what its motor must have done do not belong together.
    EncoderSlipping,
    /// Segments ran out in the middle of a job.
    SetpointsStale,
    /// A segment leaves the joint limits, does not join the one before it, or says nothing of its tolerance.
    SetpointInvalid,
    /// The joint itself left its limits.
    LimitReached,
    /// The head did not come back to its stroke in time.
    HoldTimedOut,
    /// An amplifier gave all it has for too long.
    AmplifierSaturated,
    /// A motor was driven harder than it can be cooled.
    MotorHot,
    /// The laser does not follow its gate.
    LaserStuck,
    /// The host stopped saying that it is there.
    HostLost,
    /// What is believed of a joint's speed does not add up to what its encoder counted.
    EstimateDiverged,
    /// Something that should be a number is none.
    NotANumber,
}

impl Fault {
    /// Every fault.
    pub const ALL: [Fault; 14] = [
        Fault::EncoderJumped,
        Fault::EncoderDead,
        Fault::EncoderNoisy,
        Fault::EncoderSlipping,
        Fault::SetpointsStale,
        Fault::SetpointInvalid,
        Fault::LimitReached,
        Fault::HoldTimedOut,
        Fault::AmplifierSaturated,
        Fault::MotorHot,
        Fault::LaserStuck,
        Fault::HostLost,
        Fault::EstimateDiverged,
        Fault::NotANumber,
    ];

    /// Stable code for scripts and `explain`.
    pub const fn code(self) -> &'static str {
        match self {
            Fault::EncoderJumped => "encoder-jumped",
            Fault::EncoderDead => "encoder-dead",
            Fault::EncoderNoisy => "encoder-noisy",
            Fault::EncoderSlipping => "encoder-slipping",
            Fault::SetpointsStale => "setpoints-stale",
            Fault::SetpointInvalid => "setpoint-invalid",
            Fault::LimitReached => "limit-reached",
            Fault::HoldTimedOut => "hold-timed-out",
            Fault::AmplifierSaturated => "amplifier-saturated",
            Fault::MotorHot => "motor-hot",
            Fault::LaserStuck => "laser-stuck",
            Fault::HostLost => "host-lost",
            Fault::EstimateDiverged => "estimate-diverged",
            Fault::NotANumber => "not-a-number",
        }
    }

    /// Whether there is nothing left to control a motor by, so that it gets no volts.
    pub const fn leaves_motors_blind(self) -> bool {
        match self {
            Fault::EncoderJumped
            | Fault::EncoderDead
            | Fault::EncoderNoisy
            | Fault::EncoderSlipping
            | Fault::AmplifierSaturated
            | Fault::MotorHot
            | Fault::EstimateDiverged
            | Fault::NotANumber => true,
            Fault::SetpointsStale
            | Fault::SetpointInvalid
            | Fault::LimitReached
            | Fault::HoldTimedOut
            | Fault::LaserStuck
            | Fault::HostLost => false,
        }
    }

    /// Whether counts are not to be believed any more: the rig is unhomed from then on.
    pub const fn loses_counts(self) -> bool {
        matches!(
            self,
            Fault::EncoderJumped
                | Fault::EncoderDead
                | Fault::EncoderNoisy
                | Fault::EncoderSlipping
                | Fault::EstimateDiverged
                | Fault::NotANumber
        )
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
    /// An encoder has shown no edge where its joint should have passed several, or does not fit what its motor does, or a count
    /// was put back a moment ago: it may be dead or slip or lose counts, or somebody holds the head.
    Doubtful = 8,
    /// The rig was powered up, or lost counts, and was not told since where its joints stand: nobody knows where light would fall.
    Unhomed = 9,
    /// No host has said of late that it is there.
    HostSilent = 11,
}

impl Darkness {
    /// Every reason, in bit order.
    pub const ALL: [Darkness; 11] = [
        Darkness::Planned,
        Darkness::Disarmed,
        Darkness::FollowingError,
        Darkness::SpotError,
        Darkness::Holding,
        Darkness::OutOfBounds,
        Darkness::Stale,
        Darkness::Faulted,
        Darkness::Doubtful,
        Darkness::Unhomed,
        Darkness::HostSilent,
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
            Darkness::Doubtful => "doubtful",
            Darkness::Unhomed => "unhomed",
            Darkness::HostSilent => "host-silent",
        }
    }
}

/// The reasons that hold at once; empty means the gate is open.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct DarknessSet(u16);

impl DarknessSet {
    /// Adds a reason when `holds` is true.
    pub fn insert_if(&mut self, holds: bool, reason: Darkness) {
        if holds {
            self.0 |= 1 << reason as u16;
        }
    }

    /// Whether a reason is in the set.
    pub const fn contains(self, reason: Darkness) -> bool {
        self.0 & (1 << reason as u16) != 0
    }

    /// Whether nothing speaks against light.
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// One bit a reason: the one whose place is the reason's number.
    pub const fn bits(self) -> u16 {
        self.0
    }
}
