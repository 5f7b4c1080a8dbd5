//! Singular values over frequency, norms, zeros and hidden states of a system with any number of inputs and outputs; disk margins.

mod disk;
mod figure;
mod view;

use tracelight_linear::{
    Complex, DistinctRoot, Hidden, LinearError, Mode, Peak, StateSpace, decibels, logspace,
};
use tracelight_task::{Failure, Task};

use crate::finding::Experiment;
use crate::sigma::disk::Disk;
use crate::systems::{OneSystem, bounded};

/// A system and the frequencies over which it is looked at.
#[derive(Clone, Debug)]
pub struct Request {
    /// A formula, a file, or a product of files such as `P*K`.
    pub system: OneSystem,
    /// From this one, rad/s; if not given, a decade below all that stands out.
    pub from_rad_s: Option<f64>,
    /// To this one, rad/s; if not given, a decade above.
    pub to_rad_s: Option<f64>,
    /// How many, evenly on a logarithmic scale; peaks come on top.
    pub points: u32,
}

/// What is known of the system.
pub struct Finding {
    request: Request,
    name: String,
    /// What rational figures of it are worth, if it has a dead time.
    note: String,
    system: StateSpace,
    poles: Vec<DistinctRoot>,
    /// Transmission zeros: those of the minimal part.
    zeros: Vec<Complex>,
    /// States of the minimal part.
    minimal: usize,
    unmoved: Hidden,
    unseen: Hidden,
    /// None of what is not stable.
    peak: Option<Peak>,
    /// None of what is not stable, or lets an impulse straight through.
    h2: Option<f64>,
    disk: Disk,
    /// Frequencies, rad/s, and the singular values at each, dB, the largest first; no numbers at a pole.
    rad_s: Vec<f64>,
    values_db: Vec<Vec<f64>>,
}

/// How finely the norm is found.
const TOLERANCE: f64 = 1e-9;

impl Experiment for Request {
    type Finding = Finding;

    fn run(self, _: Task<'_>) -> Result<Finding, Failure> {
        let states = self.system.states()?;
        let name = states.name.clone();
        let channels = states.system.d().nrows().min(states.system.d().ncols());
        bounded(self.points, channels)?;
        let failed = |e: LinearError| Failure::failed("no-such-system", format!("{name}: {e}"));
        let mut finding = Finding::of(self, states.name, states.note, states.system).map_err(failed)?;
        let band = finding.shown()?;
        finding.rad_s = finding.frequencies(band);
        let system = &finding.system;
        let at = |w: &f64| match system.singular_values(&[*w]) {
            Ok(values) => values.into_iter().flatten().map(decibels).collect(),
            // on a pole
            Err(_) => vec![f64::NAN; channels],
        };
        finding.values_db = finding.rad_s.iter().map(at).collect();
        Ok(finding)
    }
}

impl Finding {
    /// All but the curves.
    fn of(request: Request, name: String, note: String, system: StateSpace) -> Result<Self, LinearError> {
        let minimal = system.minimal()?.system;
        Ok(Self {
            poles: system.distinct_poles()?,
            zeros: minimal.zeros()?,
            minimal: minimal.order(),
            unmoved: system.unmoved()?,
            unseen: system.unseen()?,
            peak: system.h_infinity_norm(TOLERANCE)?,
            h2: system.h2_norm()?,
            disk: Disk::of(&system)?,
            rad_s: Vec::new(),
            values_db: Vec::new(),
            request,
            name,
            note,
            system,
        })
    }

    /// Frequencies that stand out, rad/s: of poles and zeros, of the norm, of the margins.
    fn marked(&self) -> impl Iterator<Item = f64> + '_ {
        let time = self.system.time();
        let roots = self.poles.iter().map(|pole| pole.value).chain(self.zeros.iter().copied());
        let natural = roots.map(move |root| Mode::of(root, time).natural_rad_s);
        natural.chain(self.peak.map(|peak| peak.rad_s)).chain(self.disk.rad_s())
    }

    /// From where to where it is shown, rad/s.
    fn shown(&self) -> Result<(f64, f64), Failure> {
        /// Less, beside the largest, is a zero that was rounded.
        const NOTHING: f64 = 1e-9;
        let end = self.system.time().nyquist_rad_s();
        let all: Vec<f64> = self.marked().filter(|w| *w > 0.0 && w.is_finite()).collect();
        let most = all.iter().copied().fold(0.0, f64::max);
        let least = all.into_iter().filter(|w| *w > NOTHING * most).fold(f64::INFINITY, f64::min);
        let (least, most) = match most > 0.0 {
            true => (least, most),
            // nothing stands out: half the sampling frequency, or one
            false => (end.min(1.0), end.min(1.0)),
        };
        let (low, high) = ((0.1 * least).min(0.1 * end), (10.0 * most).min(end));
        let (from, to) = match (self.request.from_rad_s, self.request.to_rad_s) {
            (Some(from), Some(to)) => (from, to),
            (Some(from), None) => (from, high.max(100.0 * from).min(end)),
            (None, Some(to)) => (low.min(to / 100.0), to),
            (None, None) => (low, high),
        };
        if from < to {
            return Ok((from, to));
        }
        Err(Failure::usage("usage", format!("--from {from} rad/s is not below --to {to} rad/s")))
    }

    /// Frequencies in a band, those that stand out among them: a narrow peak is drawn as high as it is.
    fn frequencies(&self, (from, to): (f64, f64)) -> Vec<f64> {
        let mut all = logspace((from, to), self.request.points as usize);
        let time = self.system.time();
        let turns = self.poles.iter().map(|pole| time.continuous(pole.value).im.abs());
        all.extend(self.marked().chain(turns).filter(|w| *w > from && *w < to));
        all.sort_by(f64::total_cmp);
        all.dedup();
        all
    }
}
