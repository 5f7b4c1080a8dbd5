use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use tracelight_rigfile::set_law;
use tracelight_sim::{LawName, ObserverName, RigConfig};
use tracelight_task::Failure;

/// By what the head is held to its plan.
#[derive(Args, Clone, Copy, Debug)]
pub struct LawArgs {
    /// Control law [default: the rig's]
    #[arg(long, value_name = "LAW", value_parser = law())]
    pub law: Option<LawName>,
    /// How counts become position and speed [default: the observer the law was designed with]
    #[arg(long, value_name = "OBSERVER", value_parser = observer())]
    pub observer: Option<ObserverName>,
}

impl LawArgs {
    /// Sets what was asked for.
    pub fn apply(self, rig: &mut RigConfig) -> Result<(), Failure> {
        set_law(rig, self.law, self.observer)
    }
}

/// Names of laws on the command line.
pub fn law() -> impl TypedValueParser<Value = LawName> {
    PossibleValuesParser::new(LawName::ALL.map(|law| PossibleValue::new(law.name()).help(about(law))))
        .map(|name| LawName::named(&name).unwrap_or(LawName::State))
}

/// A law in one line of help.
const fn about(law: LawName) -> &'static str {
    match law {
        LawName::State => "State feedback with disturbance estimation; feedforward from the identified head",
        LawName::PidFeedforward => {
            "PID with model feedforward of inertia, Coriolis torque, gravity and friction"
        }
        LawName::Pid => "PID with gravity compensation",
        LawName::HandTuned => "PID with gains set by hand in the rig file",
        LawName::LeadLag => "Lead-lag compensator with gravity compensation",
        LawName::ReportZpk => "The 2006 report's compensators, their numbers read as poles and zeros",
        LawName::ReportTimeConstants => "The same compensators, their numbers read as time constants",
        LawName::ReportPd => "The 2006 report's PD gains",
    }
}

/// Names of observers on the command line.
pub fn observer() -> impl TypedValueParser<Value = ObserverName> {
    PossibleValuesParser::new(ObserverName::ALL.map(ObserverName::name))
        .map(|name| ObserverName::named(&name).unwrap_or(ObserverName::Kalman))
}
