//! The report's controller in every reading of its unexplained numbers, and what of the report's figures 14 to 17 each reading shows.
//!
//! The report prints kp = 2, kd = 10 for pan and kp = 2, kd = 5 for tilt without units, `Kmtr = 0.01447`, `p = 50` and a torque limit of 500, and
//! says of its figures 14 to 17 that both axes overshoot in the beginning and keep a constant error. A reading is judged by that alone: by
//! what can be seen on the axes of the report's own figures, where a line is about a hundredth of the height.

use std::path::Path;

use crate::chapter::{Done, Joined, Run};
use crate::table::{Cell, Kind, Table, digits};

/// Kmtr of the start files.
const KMTR: f64 = 0.01447;
/// Motor turns per joint turn.
const RATIO: f64 = 6.3 * 2.8435;
/// Joint torque per volt, as the report has it, N m/V.
const NM_PER_V: f64 = 0.077_389;

/// What kp times an angle may be: a factor to N m at the joint.
const UNITS: [(&str, f64); 4] =
    [("N m", 1.0), ("Kmtr, at the motor", KMTR * RATIO), ("volts", NM_PER_V), ("Kmtr, at the joint", KMTR)];
/// What p may be: a filter of the derivative that keeps its gain or divides it by p, or nothing that matters here.
const DERIVATIVES: [(&str, &str); 3] =
    [("50 s/(s + 50)", "s/(1 + s/50)"), ("s/(s + 50)", "s/(s + 50)"), ("s, p not in it", "s/(1 + s/1000)")];
/// Of the start files, or what the rig's amplifiers give.
const CAPS: [(&str, Option<&str>); 2] = [("500 N m", Some("500Nm")), ("the rig's", None)];
const SETS: [&str; 2] = ["B", "A"];
/// Arrays of figures 14 and 15, and 16 and 17.
const ARRAYS: [&str; 2] = ["trapezoid.csv", "circle.csv"];

/// A figure of the report: its axes, and what is drawn on them.
struct Axes {
    number: u32,
    /// Columns of the angle as it was, and as it should be, in the table of `lab simulate`.
    columns: (usize, usize),
    /// Lowest and highest of the axis; where the report's has no end that is known, one step of its ticks further.
    y_rad: (f64, f64),
    /// What can be seen: a hundredth of the height between the outermost ticks.
    seen_rad: f64,
    /// First and last of the time axis, s.
    t_s: (f64, f64),
    /// Whether the joint comes to rest on it.
    rests: bool,
}

const FIGURES: [Axes; 4] = [
    Axes { number: 14, columns: (3, 1), y_rad: (-0.5, 3.5), seen_rad: 0.04, t_s: (0.0, 7.0), rests: true },
    Axes { number: 15, columns: (4, 2), y_rad: (0.0, 1.8), seen_rad: 0.018, t_s: (0.0, 7.0), rests: true },
    Axes { number: 16, columns: (3, 1), y_rad: (-0.2, 1.2), seen_rad: 0.01, t_s: (0.1, 0.8), rests: false },
    Axes { number: 17, columns: (4, 2), y_rad: (-1.5, 1.5), seen_rad: 0.02, t_s: (0.05, 0.55), rests: false },
];

/// What a figure shows of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Seen {
    /// Whether the curve stays on the axes.
    inside: bool,
    /// Beyond the furthest of the desired, rad.
    over_rad: f64,
    /// Mean distance from the desired at rest, signed; root mean square where nothing rests, rad.
    off_rad: f64,
    /// From end to end of what trembles, rad.
    rattle_rad: f64,
}

/// The commands, and the table of what they show.
pub(crate) fn joined(book: &Path) -> Joined {
    let readings = all();
    let mut runs = Vec::new();
    for (number, reading) in readings.iter().enumerate() {
        for array in ARRAYS {
            runs.push(reading.run(book, number, array));
        }
    }
    Joined {
        caption: "Figures 14 to 17 in every reading of the report's controller: overshoot and error in mrad, by what can be seen",
        runs,
        show: Box::new(move |done| table(&readings, done)),
    }
}

/// A reading, by its numbers in the lists above.
#[derive(Clone, Copy, Debug)]
struct Reading {
    set: &'static str,
    unit: (&'static str, f64),
    derivative: (&'static str, &'static str),
    cap: (&'static str, Option<&'static str>),
}

fn all() -> Vec<Reading> {
    let mut all = Vec::new();
    for set in SETS {
        for unit in UNITS {
            for derivative in DERIVATIVES {
                all.extend(CAPS.map(|cap| Reading { set, unit, derivative, cap }));
            }
        }
    }
    all
}

/// PD with this gain of the derivative, as a formula.
pub(crate) fn controller(factor: f64, kd: f64, derivative: &str) -> String {
    let pd = format!("2 + {kd} {derivative}");
    if factor == 1.0 { pd } else { format!("{factor:.5} ({pd})") }
}

impl Reading {
    fn run(&self, book: &Path, number: usize, array: &str) -> Run {
        let file = book.join("readings").join(format!("{}-{array}", number + 1));
        let by = |kd: f64| controller(self.unit.1, kd, self.derivative.1);
        let array = book.join("arrays").join(array).display().to_string();
        let mut arguments: Vec<String> =
            ["lab", "simulate", &array, "--controller", &by(10.0), &by(5.0), "--set", self.set]
                .map(str::to_owned)
                .to_vec();
        if let Some(cap) = self.cap.1 {
            arguments.extend(["--cap".to_owned(), cap.to_owned()]);
        }
        arguments.extend(["-o".to_owned(), file.display().to_string()]);
        Run { arguments, figure: Some(file), passing: true, ..Run::default() }
    }

    fn name(&self) -> String {
        format!("set {}, {}, {}, {}", self.set, self.unit.0, self.derivative.0, self.cap.0)
    }
}

fn table(readings: &[Reading], done: &[Done]) -> Table {
    let heads =
        ["set", "kp, kd in", "derivative", "limit", "14, pan", "15, tilt", "16, pan", "17, tilt", "fits"];
    let mut rows = Vec::new();
    let mut fits = Vec::new();
    for (reading, runs) in readings.iter().zip(done.chunks(ARRAYS.len())) {
        let tables: Vec<Vec<Vec<f64>>> =
            runs.iter().map(|(_, csv)| numbers(csv.as_deref().unwrap_or(""))).collect();
        let of = |(k, axes)| (axes, Seen::of(axes, tables.get(k / 2).map_or(&[][..], Vec::as_slice)));
        let all: Vec<(&Axes, Seen)> = FIGURES.iter().enumerate().map(of).collect();
        let each: Vec<bool> = all.iter().map(|(axes, seen)| seen.fits(axes)).collect();
        let mut row: Vec<Cell> =
            [reading.set, reading.unit.0, reading.derivative.0, reading.cap.0].map(Cell::words).to_vec();
        row.extend(all.iter().map(|(axes, seen)| seen.cell(axes)));
        row.push(Cell::words(format!("{} of 4", each.iter().filter(|&&fits| fits).count())));
        rows.push(row);
        fits.push(each);
    }
    Table { heads: heads.map(str::to_owned).to_vec(), rows, finding: finding(readings, &fits) }
}

/// What follows, or that it is open.
fn finding(readings: &[Reading], fits: &[Vec<bool>]) -> String {
    let count = |each: &Vec<bool>| each.iter().filter(|&&fits| fits).count();
    let best = fits.iter().map(count).max().unwrap_or(0);
    let of_figure = |k: usize| fits.iter().filter(|each| each.get(k) == Some(&true)).count();
    let each: Vec<String> = FIGURES
        .iter()
        .enumerate()
        .map(|(k, axes)| format!("figure {} by {}", axes.number, of_figure(k)))
        .collect();
    let names: Vec<String> = readings
        .iter()
        .zip(fits)
        .filter(|(_, each)| count(each) == best)
        .map(|(reading, _)| reading.name())
        .collect();
    let verdict = if best == FIGURES.len() {
        format!("All four are shown by {}.", names.join("; "))
    } else if best == 0 {
        "No reading shows any of the four as the report describes them: what its numbers mean is open."
            .to_owned()
    } else {
        format!(
            "No reading shows all four as the report describes them: what its numbers mean is open. The most, {best} of 4, are shown by {}.",
            names.join("; ")
        )
    };
    format!(
        "Of {} readings, {} show at least one figure as it is described: {}. {verdict}",
        readings.len(),
        of_any(fits),
        each.join(", ")
    )
}

/// How many fit a figure at least.
fn of_any(fits: &[Vec<bool>]) -> usize {
    fits.iter().filter(|each| each.contains(&true)).count()
}

fn numbers(csv: &str) -> Vec<Vec<f64>> {
    let row = |line: &str| line.split(',').map(|cell| cell.parse().unwrap_or(f64::NAN)).collect();
    csv.lines().skip(1).map(row).collect()
}

impl Seen {
    /// Of rows of `lab simulate`; nothing fits where there are none.
    fn of(axes: &Axes, rows: &[Vec<f64>]) -> Self {
        let (from_s, to_s) = axes.t_s;
        // a row is a millisecond; half of one for rounding
        let within = |row: &&Vec<f64>, from_s: f64| {
            row.first().is_some_and(|t| (from_s - 5e-4..=to_s + 5e-4).contains(t))
        };
        let of = |from_s: f64, column: usize| -> Vec<f64> {
            rows.iter().filter(|row| within(row, from_s)).filter_map(|row| row.get(column).copied()).collect()
        };
        let (is, should) = (of(from_s, axes.columns.0), of(from_s, axes.columns.1));
        if is.is_empty() {
            return Self::default();
        }
        let ((lowest, highest), (least, most)) = (ends(&is), ends(&should));
        // the last second of a figure that ends at rest
        let start_s = if axes.rests { to_s - 1.0 } else { from_s };
        let (late, wanted) = (of(start_s, axes.columns.0), of(start_s, axes.columns.1));
        let errors = || wanted.iter().zip(&late).map(|(set, is)| set - is);
        let count = late.len() as f64;
        let mean = errors().sum::<f64>() / count;
        let rms = (errors().map(|e| e * e).sum::<f64>() / count).sqrt();
        // a move from 0 overshoots at its end only; a circle at either
        let over_rad = if axes.rests { highest - most } else { (highest - most).max(least - lowest) };
        Self {
            inside: lowest >= axes.y_rad.0 - axes.seen_rad && highest <= axes.y_rad.1,
            over_rad,
            off_rad: if axes.rests { mean } else { rms },
            rattle_rad: if axes.rests { ends(&late).1 - ends(&late).0 } else { trembling(&late) },
        }
    }

    fn fits(&self, axes: &Axes) -> bool {
        let seen = |value_rad: f64| value_rad.abs() >= axes.seen_rad;
        self.inside && self.over_rad >= axes.seen_rad && seen(self.off_rad) && !seen(self.rattle_rad)
    }

    fn cell(&self, axes: &Axes) -> Cell {
        let mrad = |value_rad: f64| digits((1e3 * value_rad).round());
        let over = mrad(self.over_rad.max(0.0));
        let mut text = format!("over {over}, off {}", mrad(self.off_rad));
        if self.rattle_rad >= axes.seen_rad {
            text += &format!(", rattles {}", mrad(self.rattle_rad));
        }
        if !self.inside {
            text += ", leaves the axes";
        }
        Cell { text, kind: if self.fits(axes) { Kind::Fits } else { Kind::Misses } }
    }
}

fn ends(values: &[f64]) -> (f64, f64) {
    values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &v| (low.min(v), high.max(v)))
}

/// From end to end of what is left of a curve once its mean over 21 ms is taken away: what shakes, not what moves.
fn trembling(values: &[f64]) -> f64 {
    const AROUND: usize = 10;
    let width = 2 * AROUND + 1;
    if values.len() < width {
        return 0.0;
    }
    let rest: Vec<f64> = values
        .windows(width)
        .map(|window| window[AROUND] - window.iter().sum::<f64>() / width as f64)
        .collect();
    let (low, high) = ends(&rest);
    high - low
}

#[cfg(test)]
mod tests {
    use tracelight_maths::sin;

    use super::*;

    /// A run of figure 14 and 15 whose pan is this.
    fn rows(pan: impl Fn(f64) -> f64) -> Vec<Vec<f64>> {
        let row = |k: u32| {
            let t = 1e-3 * f64::from(k);
            vec![t, if t < 0.35 { 9.0 * t } else { 3.15 }, 0.0, pan(t), 0.0]
        };
        (0..=7000).map(row).collect()
    }

    #[test]
    fn what_the_report_describes_fits_and_what_it_would_have_seen_does_not() {
        let axes = &FIGURES[0];
        let set = |t: f64| if t < 0.35 { 9.0 * t } else { 3.15 };
        let overshoots = |t: f64| if (0.35..1.0).contains(&t) { set(t) + 0.2 } else { set(t) - 0.1 };
        let seen = Seen::of(axes, &rows(overshoots));
        assert!(seen.fits(axes), "{seen:?}");
        assert!((seen.over_rad - 0.2).abs() < 1e-9 && (seen.off_rad - 0.1).abs() < 1e-9, "{seen:?}");
        for (what, seen) in [
            ("no overshoot", Seen::of(axes, &rows(|t| set(t) - 0.1))),
            ("no error", Seen::of(axes, &rows(|t| if t < 1.0 { overshoots(t) } else { set(t) }))),
            ("rattles", Seen::of(axes, &rows(|t| overshoots(t) + 0.1 * sin(600.0 * t)))),
            (
                "off the axes",
                Seen::of(axes, &rows(|t| overshoots(t) + if t > 0.5 && t < 0.6 { 2.0 } else { 0.0 })),
            ),
            ("nothing", Seen::of(axes, &[])),
        ] {
            assert!(!seen.fits(axes), "{what}: {seen:?}");
        }
    }

    #[test]
    fn a_circle_at_its_own_pace_does_not_tremble() {
        let angle = |k: u32| sin(std::f64::consts::TAU * f64::from(k) / 500.0);
        let circle: Vec<f64> = (0..=500).map(angle).collect();
        assert!(trembling(&circle) < 0.01, "{}", trembling(&circle));
        let shaken: Vec<f64> = (0..=500).map(|k| angle(k) + 0.03 * sin(0.6 * f64::from(k))).collect();
        assert!(trembling(&shaken) > 0.05, "{}", trembling(&shaken));
    }

    #[test]
    fn every_reading_is_there_once() {
        let names: std::collections::BTreeSet<String> = all().iter().map(Reading::name).collect();
        assert_eq!(names.len(), SETS.len() * UNITS.len() * DERIVATIVES.len() * CAPS.len());
        assert_eq!(controller(KMTR, 10.0, "s/(1 + s/50)"), "0.01447 (2 + 10 s/(1 + s/50))");
    }
}
