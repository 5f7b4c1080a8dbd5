//! Amplification and phase over frequency, and margins.

mod view;

use tracelight_chart::Theme;
use tracelight_linear::{FrequencyResponse, Margins, Stability};
use tracelight_task::{Failure, Task};

use crate::finding::Experiment;
use crate::frequencies::Frequencies;
use crate::systems::Named;

/// Systems over frequencies.
#[derive(Clone, Debug)]
pub struct Request(pub Frequencies);

/// What each of them answers.
pub struct Finding {
    theme: Theme,
    entries: Vec<Entry>,
}

/// A system and all that is known of it.
struct Entry {
    named: Named,
    response: FrequencyResponse,
    margins: Margins,
    /// What its closed loop does; none where that is not defined.
    closed: Option<Stability>,
}

impl Experiment for Request {
    type Finding = Finding;

    fn run(self, _: Task<'_>) -> Result<Finding, Failure> {
        let (systems, rad_s) = self.0.read()?;
        let entry = |named: Named| Entry {
            response: named.system.frequency_response(rad_s.clone()),
            margins: named.system.margins(),
            closed: named.system.closed().ok().map(|closed| closed.stability()),
            named,
        };
        let entries = systems.into_iter().map(entry).collect();
        Ok(Finding { theme: self.0.systems.theme, entries })
    }
}
