//! Amplification and phase over frequency, and margins.

mod view;

use tracelight_chart::Theme;
use tracelight_linear::{Complex, FrequencyResponse, Margins, Peak, Stability};
use tracelight_task::{Failure, Task};

use crate::finding::Experiment;
use crate::frequencies::Frequencies;
use crate::named::Named;

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
    /// Frequencies, rad/s, and values of points that were measured and are not trusted, as far as they are shown.
    left_out: Vec<(f64, Complex)>,
    response: FrequencyResponse,
    /// Where it is 3 dB below what it is at rest, rad/s.
    bandwidth_rad_s: Option<f64>,
    resonance: Option<Peak>,
    kind: Kind,
}

/// What a system is.
enum Kind {
    /// An open loop.
    Open {
        margins: Margins,
        /// What its closed loop does; none where that is not defined.
        closed: Option<Stability>,
    },
    /// A loop that is closed already: it has no margins. What it does; none of measured data that do not tell.
    Closed(Option<Stability>),
}

impl Entry {
    /// Points that are not trusted are shown from one frequency, rad/s, to the other.
    fn of(named: Named, rad_s: &[f64], shown: (f64, f64), is_closed: bool) -> Self {
        let kind = match is_closed {
            true => Kind::Closed(match (&named.data, &named.opened) {
                (Some(_), open) => open.as_ref().and_then(|open| open.closed_stability()),
                (None, _) => Some(named.stability()),
            }),
            false => Kind::Open { margins: named.margins(), closed: named.closed_stability() },
        };
        let all = named.data.iter().flat_map(|data| data.left_out());
        Self {
            left_out: all.copied().filter(|point| shown.0 <= point.0 && point.0 <= shown.1).collect(),
            response: named.frequency_response(rad_s.to_vec()),
            bandwidth_rad_s: named.bandwidth(),
            resonance: named.resonance(),
            kind,
            named,
        }
    }
}

impl Experiment for Request {
    type Finding = Finding;

    fn run(self, _: Task<'_>) -> Result<Finding, Failure> {
        let (systems, rad_s) = self.0.read()?;
        let is_closed = self.0.systems.closed;
        let shown = (self.0.from_rad_s.unwrap_or(0.0), self.0.to_rad_s.unwrap_or(f64::INFINITY));
        let entries = systems.into_iter().map(|named| Entry::of(named, &rad_s, shown, is_closed)).collect();
        Ok(Finding { theme: self.0.systems.theme, entries })
    }
}
