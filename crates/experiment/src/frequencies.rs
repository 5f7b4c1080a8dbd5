//! Frequencies over which systems are asked.

use tracelight_linear::logspace;
use tracelight_task::Failure;

use crate::named::Named;
use crate::systems::{Systems, bounded};

/// Systems over frequencies.
#[derive(Clone, Debug)]
pub struct Frequencies {
    /// The systems.
    pub systems: Systems,
    /// From this one, rad/s; if not given, a decade below the slowest pole or zero, and well below every crossover.
    pub from_rad_s: Option<f64>,
    /// To this one, rad/s; if not given, a decade above the fastest, and well above every crossover.
    pub to_rad_s: Option<f64>,
    /// How many, evenly on a logarithmic scale.
    pub points: u32,
}

impl Frequencies {
    /// All systems, and frequencies for them together, rad/s.
    pub(crate) fn read(&self) -> Result<(Vec<Named>, Vec<f64>), Failure> {
        let systems = self.systems.with_data()?;
        bounded(self.points, systems.len())?;
        let rad_s = self.over(&systems.iter().collect::<Vec<_>>())?;
        Ok((systems, rad_s))
    }

    /// Frequencies for some systems together, rad/s.
    pub(crate) fn over(&self, systems: &[&Named]) -> Result<Vec<f64>, Failure> {
        let own = systems
            .iter()
            .map(|named| band(named))
            .reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
            .unwrap_or((0.1, 10.0));
        // beyond what was measured nothing is known
        let known = systems.iter().filter(|named| named.data.is_some()).map(|named| named.band());
        let (low, high) = known.fold(own, |a, b| (a.0.max(b.0), a.1.min(b.1)));
        // a bound that is typed moves the other, if that is not typed
        let (from, to) = match (self.from_rad_s, self.to_rad_s) {
            (Some(from), Some(to)) => (from, to),
            (Some(from), None) => {
                let end =
                    systems.iter().map(|n| n.system.time().nyquist_rad_s()).fold(f64::INFINITY, f64::min);
                (from, high.max(100.0 * from).min(end))
            }
            (None, Some(to)) => (low.min(to / 100.0), to),
            (None, None) => (low, high),
        };
        if from >= to {
            return Err(Failure::usage("usage", format!("--from {from} rad/s is not below --to {to} rad/s")));
        }
        Ok(logspace((from, to), self.points as usize))
    }
}

/// What a plot of a system has to show, rad/s: its poles and zeros, and every frequency that is told of it.
fn band(named: &Named) -> (f64, f64) {
    /// Half a decade and more beyond a crossover its slope is seen.
    const BEYOND: f64 = 5.0;
    let (low, high) = named.band();
    if named.data.is_some() {
        return (low, high);
    }
    let end = named.system.time().nyquist_rad_s();
    let margins = named.margins();
    // a dead time crosses again and again
    let gain: Vec<f64> = match &named.late {
        Some(_) => margins.least_gain().map(|m| m.rad_s).into_iter().collect(),
        None => margins.gain.iter().map(|m| m.rad_s).collect(),
    };
    let crossovers = margins.phase.iter().map(|m| m.rad_s).chain(gain);
    let own = named.bandwidth().into_iter().chain(named.resonance().map(|peak| peak.rad_s));
    let all = crossovers.chain(own).filter(|w| *w > 0.0 && *w <= end && w.is_finite());
    let wide = |(low, high): (f64, f64), w: f64| (low.min(w / BEYOND), high.max((w * BEYOND).min(end)));
    all.fold((low, high), wide)
}

#[cfg(test)]
mod tests {
    use tracelight_chart::Colour;
    use tracelight_linear::{Time, TransferFunction};

    use super::*;

    #[test]
    fn a_plot_holds_every_crossover() {
        for (text, period_s) in [
            ("13.16/(s(s+0.1316))", None),
            ("1e6/(s+1)", None),
            ("1e-6/s", None),
            ("1e9/s^2", None),
            ("100(s+1)^2/s^3", None),
            ("1/(s^2+0.001s+1)", None),
            ("7", None),
            ("0.001/(z-1)", Some(0.1)),
            ("3/(z-0.5)", Some(0.1)),
        ] {
            let time = period_s.map_or(Time::Continuous, Time::Sampled);
            let system = TransferFunction::parse(text, time).unwrap();
            let named = Named::rational(text.into(), system.clone(), Colour::Black);
            let (low, high) = band(&named);
            let margins = system.margins();
            let phase = margins.phase.iter().map(|m| m.rad_s);
            let gain = margins.gain.iter().map(|m| m.rad_s).filter(|w| *w > 0.0);
            for w in phase.chain(gain).chain(system.bandwidth()) {
                assert!(low <= w && w <= high * (1.0 + 1e-12), "{text}: {w} is not in {low} … {high}");
            }
        }
    }
}
