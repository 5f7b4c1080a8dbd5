//! The open loop's values over all frequencies in the complex plane, and on Nichols's chart.

mod figure;
mod nichols;
mod view;

use tracelight_chart::Theme;
use tracelight_linear::{Complex, Margins, RealCrossing};
use tracelight_task::{Failure, Task};

use crate::finding::Experiment;
use crate::frequencies::Frequencies;
use crate::named::Named;

/// Open loops over frequencies.
#[derive(Clone, Debug)]
pub struct Request {
    /// The loops and the frequencies.
    pub over: Frequencies,
    /// On which chart they are plotted.
    pub chart: Chart,
    /// How far from zero Nyquist's plot goes; if not given, as far as everything that is finite.
    pub reach: Option<f64>,
}

/// A chart of open loops.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Chart {
    /// The complex plane.
    Nyquist,
    /// Amplification over phase.
    Nichols,
}

/// What each loop is like.
pub struct Finding {
    theme: Theme,
    chart: Chart,
    reach: Option<f64>,
    /// The frequencies that were asked for, rad/s: from and to; all of them where a bound is not given.
    asked_rad_s: (f64, f64),
    entries: Vec<Entry>,
}

/// A loop and what is known of it.
struct Entry {
    /// What is plotted.
    named: Named,
    /// The margins, of the open loop: of one that was closed, what it was before.
    margins: Margins,
    rad_s: Vec<f64>,
    values: Vec<Complex>,
    phases_deg: Vec<f64>,
    /// Where it is real, and finite.
    crossings: Vec<RealCrossing>,
    /// Poles of the open loop that grow, and of the closed one.
    open_unstable: usize,
    closed_unstable: Option<usize>,
}

impl Entry {
    /// The loop whose margins are told: before it was closed, if it was.
    fn open(&self) -> &Named {
        self.named.opened.as_deref().unwrap_or(&self.named)
    }

    /// Whether what is plotted is a closed loop.
    const fn is_closed(&self) -> bool {
        self.named.opened.is_some()
    }

    fn of(named: Named, rad_s: &[f64]) -> Self {
        let open = named.opened.as_deref().unwrap_or(&named);
        let (margins, closed_unstable) = (open.margins(), open.closed_growing());
        let open_unstable = open.unstable.filter(|_| open.data.is_some());
        let open_unstable = open_unstable.unwrap_or_else(|| open.system.growing_poles());
        let response = named.frequency_response(rad_s.to_vec());
        Self {
            rad_s: response.rad_s.clone(),
            phases_deg: response.phases_deg().collect(),
            values: response.values,
            margins,
            crossings: named.real_crossings(),
            open_unstable,
            closed_unstable,
            named,
        }
    }
}

impl Experiment for Request {
    type Finding = Finding;

    fn run(self, _: Task<'_>) -> Result<Finding, Failure> {
        let (systems, rad_s) = self.over.read()?;
        let entries = systems.into_iter().map(|named| Entry::of(named, &rad_s)).collect();
        Ok(Finding {
            theme: self.over.systems.theme,
            chart: self.chart,
            reach: self.reach,
            asked_rad_s: (self.over.from_rad_s.unwrap_or(0.0), self.over.to_rad_s.unwrap_or(f64::INFINITY)),
            entries,
        })
    }
}
