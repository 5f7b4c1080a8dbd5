//! Laws and observers by name.

use tracelight_control::{Feedforward, KalmanTuning, ObserverConfig, Pid};
use tracelight_rig::Joint;

/// A law that a rig can be driven by.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum LawName {
    /// State feedback with what disturbs estimated, and feedforward by what the head has shown to be.
    State,
    /// PID and feedforward of inertia, Coriolis, gravity and friction by the model.
    PidFeedforward,
    /// PID and gravity.
    Pid,
    /// PID with gains somebody set by hand: [`HandTuned`].
    HandTuned,
    /// A lead for the phase, a lag for the static error, and gravity.
    LeadLag,
    /// The 2006 report's K11 and K22, its figures read as poles and zeros, as they are typeset.
    ReportZpk,
    /// The report's K11 and K22, read as time constants, as its design tool displayed them.
    ReportTimeConstants,
    /// The report's PD gains.
    ReportPd,
}

impl LawName {
    /// Every law, the best first.
    pub const ALL: [Self; 8] = [
        Self::State,
        Self::PidFeedforward,
        Self::Pid,
        Self::HandTuned,
        Self::LeadLag,
        Self::ReportZpk,
        Self::ReportTimeConstants,
        Self::ReportPd,
    ];

    /// As on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::State => "state",
            Self::PidFeedforward => "pid-ff",
            Self::Pid => "pid",
            Self::HandTuned => "hand-tuned",
            Self::LeadLag => "lead-lag",
            Self::ReportZpk => "report-zpk",
            Self::ReportTimeConstants => "report-tc",
            Self::ReportPd => "report-pd",
        }
    }

    /// The law of that name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|law| law.name() == name)
    }

    /// The observer it is meant for.
    pub const fn observer(self) -> ObserverName {
        match self {
            Self::State => ObserverName::Kalman,
            Self::PidFeedforward => ObserverName::KalmanModel,
            Self::Pid | Self::HandTuned | Self::LeadLag => ObserverName::TrackingLoop,
            Self::ReportZpk | Self::ReportTimeConstants | Self::ReportPd => ObserverName::Counts,
        }
    }

    /// Shape of the setpoint in a step response.
    pub const fn reference(self) -> StepReference {
        if matches!(self, Self::State | Self::PidFeedforward) {
            StepReference::Move
        } else {
            StepReference::Jump
        }
    }

    /// Share of a rig's bandwidth that it is given: an observer that knows nothing of the head lags behind it, and leaves
    /// a sixth; an integrator takes half.
    pub(crate) const fn bandwidth_share(self) -> f64 {
        match self {
            Self::State => 1.0,
            Self::PidFeedforward => 0.5,
            Self::Pid | Self::LeadLag => 1.0 / 6.0,
            // these have their own
            Self::HandTuned | Self::ReportZpk | Self::ReportTimeConstants | Self::ReportPd => 1.0,
        }
    }
}

/// Shape of the setpoint in a step response.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StepReference {
    /// The setpoint is a step.
    Jump,
    /// The setpoint is a move within the rig's limits.
    Move,
}

/// A PID of one joint with manually set gains.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HandTuned {
    /// Proportional, N m/rad.
    pub kp: f64,
    /// Integral, N m/(rad·s).
    pub ki: f64,
    /// Derivative, N m·s/rad.
    pub kd: f64,
    /// Setpoint weight of the proportional part, 0 to 1.
    pub position_weight: f64,
    /// Setpoint weight of the derivative part.
    pub velocity_weight: f64,
    /// Whether the integrator rests while the amplifier is at its limit and the error would drive it further.
    pub anti_windup: bool,
    /// What the model adds.
    pub feedforward: Feedforward,
}

impl HandTuned {
    /// What to begin with: on the original rig it arrives within 2 mm; 40° overshoot by 7 % on pan and 13 % on tilt.
    pub const FIRST: Self = Self {
        kp: 40.0,
        ki: 0.0,
        kd: 5.0,
        position_weight: 1.0,
        velocity_weight: 1.0,
        anti_windup: true,
        feedforward: Feedforward::Gravity,
    };

    pub(crate) const fn pid(&self) -> Pid {
        Pid {
            ki: self.ki as f32,
            kd: self.kd as f32,
            position_weight: self.position_weight as f32,
            velocity_weight: self.velocity_weight as f32,
            anti_windup: self.anti_windup,
            ..Pid::proportional(self.kp as f32)
        }
    }
}

/// A compensator as the 2006 report prints it: gain (s + z₁)(s + z₂) / ((s + p₁)(s + p₂)).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Compensator {
    /// What stands before it.
    pub gain: f64,
    /// z₁ and z₂, rad/s.
    pub zeros: [f64; 2],
    /// p₁ and p₂, rad/s.
    pub poles: [f64; 2],
}

impl Compensator {
    /// K11 = 281 (s + 32.9)(s + 97.8) / ((s + 250)(s + 177)) of pan, K22 = 144 (s + 31.5)(s + 33.4) / ((s + 194)(s + 83.5)) of
    /// tilt, N m/rad.
    pub const fn of_the_report(joint: Joint) -> Self {
        match joint {
            Joint::Pan => Self { gain: 281.0, zeros: [32.9, 97.8], poles: [250.0, 177.0] },
            Joint::Tilt => Self { gain: 144.0, zeros: [31.5, 33.4], poles: [194.0, 83.5] },
        }
    }
}

/// How counts become position and velocity.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ObserverName {
    /// Kalman filter with sticking friction that learns what the head is.
    Kalman,
    /// Kalman filter with sticking friction and fixed parameters of the model.
    KalmanModel,
    /// Tracking loop (PLL).
    TrackingLoop,
    /// Time between edges (M/T).
    EdgeTimes,
    /// Differences over a fixed interval.
    Differences,
    /// Washout filter.
    Washout,
    /// Differences from tick to tick.
    Counts,
}

impl ObserverName {
    /// Every observer, the best first.
    pub const ALL: [Self; 7] = [
        Self::Kalman,
        Self::KalmanModel,
        Self::TrackingLoop,
        Self::EdgeTimes,
        Self::Differences,
        Self::Washout,
        Self::Counts,
    ];

    /// As in rig files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Kalman => "kalman",
            Self::KalmanModel => "kalman-model",
            Self::TrackingLoop => "tracking-loop",
            Self::EdgeTimes => "edge-times",
            Self::Differences => "differences",
            Self::Washout => "washout",
            Self::Counts => "counts",
        }
    }

    /// The observer of that name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|observer| observer.name() == name)
    }

    /// With the interval, ticks, that those take which have one; the others' corner is its reciprocal.
    pub fn config(self, interval_ticks: usize) -> ObserverConfig {
        let corner = 1.0 / (interval_ticks as f32 * tracelight_rig::TICK_S);
        match self {
            Self::Kalman => ObserverConfig::Kalman(KalmanTuning::LEARNING),
            Self::KalmanModel => ObserverConfig::Kalman(KalmanTuning::BELIEVING),
            Self::TrackingLoop => ObserverConfig::TrackingLoop(corner),
            Self::EdgeTimes => ObserverConfig::EdgeTimes(interval_ticks),
            Self::Differences => ObserverConfig::Differences(interval_ticks),
            Self::Washout => ObserverConfig::Washout(corner),
            Self::Counts => ObserverConfig::Differences(1),
        }
    }
}
