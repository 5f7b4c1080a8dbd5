use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use tracelight_sim::{LawName, ObserverName, RigConfig};

/// By what the head is held to its plan.
#[derive(Args, Clone, Copy, Debug)]
pub(crate) struct LawArgs {
    /// Control law [default: the rig's]: state feedback with what disturbs estimated, PID with or without feedforward,
    /// lead-lag, or the 2006 report's: its compensators read as poles and zeros or as time constants, its PD gains
    #[arg(long, value_name = "LAW", value_parser = law())]
    pub(crate) law: Option<LawName>,
    /// How counts become position and speed [default: as the law is meant]
    #[arg(long, value_name = "OBSERVER", value_parser = observer())]
    pub(crate) observer: Option<ObserverName>,
}

impl LawArgs {
    /// Sets what was asked for.
    pub(crate) fn apply(self, rig: &mut RigConfig) {
        rig.set_law(self.law.unwrap_or(rig.control.law), self.observer);
    }
}

/// Names of laws on the command line.
pub(crate) fn law() -> impl TypedValueParser<Value = LawName> {
    PossibleValuesParser::new(LawName::ALL.map(LawName::name))
        .map(|name| LawName::named(&name).unwrap_or(LawName::State))
}

/// Names of observers on the command line.
pub(crate) fn observer() -> impl TypedValueParser<Value = ObserverName> {
    PossibleValuesParser::new(ObserverName::ALL.map(ObserverName::name))
        .map(|name| ObserverName::named(&name).unwrap_or(ObserverName::Kalman))
}
