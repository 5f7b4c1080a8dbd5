//! Controller settings of a rig, and the laws that follow from them.

use tracelight_control::{Feedback, Feedforward, LawConfig, LeadLag, Pid, StateFeedback};
use tracelight_rig::{Joint, PanTilt};

use crate::laws::{Compensator, HandTuned, LawName, ObserverName};
use crate::lead_lag::{Format, LeadLagDesign};

/// Of the pair of closed-loop poles: a step of the load overshoots by 1.5 %.
const DAMPING: f32 = 0.8;

/// Settings of the controller.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ControlSettings {
    /// From error to torque.
    pub law: LawName,
    /// From counts to position and velocity; none is the one the law is meant for.
    pub observer: Option<ObserverName>,
    /// Time over which those observers look that have one, s; the others' corner is its reciprocal.
    pub observer_interval_s: f64,
    /// What law [`LawName::HandTuned`] is.
    pub hand_tuned: PanTilt<HandTuned>,
    /// Whether a joint hops where its plan is slower than friction lets go; only law [`LawName::State`] with observer
    /// [`ObserverName::Kalman`] can.
    pub hops: bool,
    /// Bandwidth of each loop, rad/s: how far its closed-loop poles lie from the origin. The 2006 report's laws have
    /// their own.
    pub bandwidth_rad_s: PanTilt<f64>,
    /// Distance on the target beyond which the laser is darkened, m.
    pub tolerance_m: f64,
    /// How long the head may need to come back to its stroke, s.
    pub hold_limit_s: f64,
    /// How long a host may be silent before it is dark and the plan's clock stands, s.
    pub host_silence_s: f64,
    /// How long it may be silent before that is a fault, s; no less than that.
    pub host_lost_s: f64,
    /// By how much what an encoder shows of a motion may differ from what its motor must have made, as a share.
    pub scale_tolerance: f64,
    /// Share of its amplifier's limit that a motor stands for ever.
    pub motor_continuous: f64,
    /// Time constant of a motor's temperature, s.
    pub motor_heating_s: f64,
}

impl ControlSettings {
    /// The observer that is chosen, or the one the law is meant for.
    pub fn observer_in_use(&self) -> ObserverName {
        self.observer.unwrap_or(self.law.observer())
    }

    /// The law of one joint that has that inertia, kg m².
    pub fn law_config(&self, joint: Joint, inertia_kg_m2: f64) -> LawConfig {
        let bandwidth_rad_s = self.law.bandwidth_share() * self.bandwidth_rad_s[joint];
        let (bandwidth, inertia) = (bandwidth_rad_s as f32, inertia_kg_m2 as f32);
        let pid = Feedback::Pid(Pid::triple_pole(bandwidth, inertia));
        let (feedback, feedforward) = match self.law {
            LawName::State => (
                Feedback::State(StateFeedback { bandwidth_rad_s: bandwidth, damping: DAMPING }),
                Feedforward::Learned,
            ),
            LawName::PidFeedforward => (pid, Feedforward::Model),
            LawName::Pid => (pid, Feedforward::Gravity),
            LawName::HandTuned => {
                let by_hand = &self.hand_tuned[joint];
                (Feedback::Pid(by_hand.pid()), by_hand.feedforward)
            }
            LawName::LeadLag => (
                Feedback::LeadLag(LeadLagDesign::for_inertia(bandwidth_rad_s, inertia_kg_m2).discretize()),
                Feedforward::Gravity,
            ),
            LawName::ReportZpk => (Feedback::LeadLag(report(joint, Format::Zpk)), Feedforward::None),
            LawName::ReportTimeConstants => {
                (Feedback::LeadLag(report(joint, Format::TimeConstants)), Feedforward::None)
            }
            LawName::ReportPd => (Feedback::Pid(report_pd(joint)), Feedforward::None),
        };
        LawConfig { feedback, feedforward }
    }
}

fn report(joint: Joint, format: Format) -> LeadLag {
    let Compensator { gain, zeros, poles } = Compensator::of_the_report(joint);
    LeadLagDesign::report(gain, zeros, poles, format).discretize()
}

/// "PD gains tried: pan kp 2, kd 10; tilt kp 2, kd 5", their units taken to be N m/rad and N m s/rad.
fn report_pd(joint: Joint) -> Pid {
    let kd = match joint {
        Joint::Pan => 10.0,
        Joint::Tilt => 5.0,
    };
    Pid { kd, ..Pid::proportional(2.0) }
}
