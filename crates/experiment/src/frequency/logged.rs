//! What a log says of an excited joint: its rows on an even grid, with those that are missing filled in.

use tracelight_lab::{Excited, standing};
use tracelight_rig::{Joint, TICK_F64_S};
use tracelight_task::{Failure, counted};

use crate::columns::{self, Columns, Kind, Quantity};
use crate::record::MOST_V;
use crate::table::{self, Log, MOST_ROWS};

/// What somebody else's log has.
const KIND: Kind = Kind {
    code: "frequency-log",
    must: &[&[Quantity::Time], &[Quantity::Volt], &[Quantity::Count, Quantity::Angle, Quantity::Speed]],
    may: &[],
    own: "axis,time_s,volt,count",
};
/// This program's columns.
const OWN: [&str; 4] = ["axis", "time_s", "volt", "count"];
/// A row is in its place within that share of a tick.
const IN_PLACE: f64 = 0.1;
/// A gap of more ticks is not filled in: the period it lies in is left out.
const LONGEST_GAP: f64 = 8.0;
/// Most rows that are filled in, as a share.
const MOST_FILLED: f64 = 0.2;
/// Speeds are told over that time, s, and stand where they do so for that, s.
const OVER_S: f64 = 0.05;
const STANDS_S: f64 = 0.1;
/// Most ticks of a period: its sines are told one by one.
const LONGEST_TICKS: usize = 20_000;

/// An excited joint by a log.
pub(super) struct Logged {
    pub(super) seen: Excited,
    /// Speeds in place of angles.
    pub(super) speeds: bool,
    pub(super) tick_s: f64,
    pub(super) period_ticks: usize,
    /// What was taken for what, filled in and left out, a line each.
    pub(super) said: Vec<String>,
}

/// Which rows are read, and how.
pub(super) struct How<'a> {
    pub(super) joint: Joint,
    /// The joint of a log that says none.
    pub(super) axis: Option<Joint>,
    pub(super) columns: &'a Columns,
    pub(super) count_rad: f64,
    pub(super) period_s: f64,
}

/// A row.
struct Row {
    line: u64,
    time_s: f64,
    volts: f64,
    /// Angle, rad, or speed, rad/s.
    value: f64,
}

/// Reads a log.
pub(super) fn logged(log: &Log, how: &How<'_>) -> Result<Logged, Failure> {
    let own = how.columns.is_empty() && table::is_own(log, &OWN, |names| names.all(OWN).is_ok());
    let fails = |what: String| Failure::usage(KIND.code, format!("{}{what}", log.name));
    let (rows, speeds, mut said) =
        if own { (own_rows(log, how)?, false, Vec::new()) } else { told_rows(log, how)? };
    let tick_s = if own { TICK_F64_S } else { usual_step(&rows) };
    let period_ticks = if tick_s > 0.0 { (how.period_s / tick_s).round() as usize } else { 0 };
    if period_ticks > LONGEST_TICKS {
        let message = format!("a log's --period may have {} s at most", LONGEST_TICKS as f64 * tick_s);
        return Err(Failure::usage("usage", message));
    }
    let even = Even::of(&rows, tick_s, period_ticks).map_err(fails)?;
    said.extend(even.filled_in());
    let step = if speeds { 0.0 } else { how.count_rad };
    let (seen, left_out) = even.without_gaps_and_limits(tick_s, period_ticks, (speeds, step));
    said.extend(left_out);
    Ok(Logged { seen, speeds, tick_s, period_ticks, said })
}

/// Rows of this program's columns.
fn own_rows(log: &Log, how: &How<'_>) -> Result<Vec<Row>, Failure> {
    let mut rows = Vec::new();
    table::read(
        log,
        KIND.code,
        |names| names.all(OWN),
        |&[axis, time, volt, count], row| {
            let time_s = row.number(time)?;
            if row.joint(axis)? == how.joint {
                let volts = row.up_to(volt, MOST_V, "any amplifier takes, V")?;
                let value = f64::from(row.whole(count)?) * how.count_rad;
                rows.push(Row { line: row.line, time_s, volts, value });
            }
            Ok(())
        },
    )?;
    Ok(rows)
}

/// Rows of somebody else's columns, whether they are speeds, and what was taken for what.
fn told_rows(log: &Log, how: &How<'_>) -> Result<(Vec<Row>, bool, Vec<String>), Failure> {
    let found = columns::read(log, how.columns, how.axis, &KIND)?;
    let (value, unit) = match [Quantity::Count, Quantity::Angle].into_iter().find(|q| found.has(*q)) {
        Some(Quantity::Count) => (Quantity::Count, how.count_rad),
        Some(place) => (place, 1.0),
        None => (Quantity::Speed, 1.0),
    };
    let row = |reading: &columns::Reading| Row {
        line: reading.line,
        time_s: reading.get(Quantity::Time),
        volts: reading.get(Quantity::Volt),
        value: unit * reading.get(value),
    };
    let said = vec![format!("{}: {}", log.name, found.said)];
    Ok((found.of(how.joint).map(row).collect(), value == Quantity::Speed, said))
}

/// What rows are apart, half of them at most, s; 0 of less than two.
fn usual_step(rows: &[Row]) -> f64 {
    let mut steps: Vec<f64> = rows.windows(2).map(|pair| pair[1].time_s - pair[0].time_s).collect();
    steps.sort_by(f64::total_cmp);
    let step = steps.get(steps.len() / 2).copied().unwrap_or_default();
    // a nanosecond is nothing a log tells
    (step * 1e9).round() * 1e-9
}

/// Rows on an even grid.
struct Even {
    volts: Vec<f64>,
    values: Vec<f64>,
    /// No row was near enough to tell it.
    unknown: Vec<bool>,
    filled: usize,
}

impl Even {
    fn of(rows: &[Row], tick_s: f64, period_ticks: usize) -> Result<Self, String> {
        let mut even = Self { volts: Vec::new(), values: Vec::new(), unknown: Vec::new(), filled: 0 };
        let Some(first) = rows.first().map(|row| row.time_s) else { return Ok(even) };
        let mut told = Vec::new();
        let mut before = 0;
        while before < rows.len() {
            let at_s = first + tick_s * told.len() as f64;
            let row = &rows[before];
            if (row.time_s - at_s).abs() <= IN_PLACE * tick_s {
                even.put(row.volts, row.value, false);
                told.push(true);
                before += 1;
                continue;
            }
            if row.time_s < at_s {
                // it came before its place: what is there is told from it and the next
                if before + 1 < rows.len() && rows[before + 1].time_s < row.time_s {
                    return Err(format!(
                        ":{}: the time falls back: give one run, as one log",
                        rows[before + 1].line
                    ));
                }
                before += 1;
                continue;
            }
            if told.len() == MOST_ROWS {
                return Err(format!(
                    ":{}: {} s is too long after the first row",
                    row.line,
                    row.time_s - first
                ));
            }
            let wide = row.time_s - rows[before - 1].time_s > LONGEST_GAP * tick_s;
            even.put(rows[before - 1].volts, between(rows, before, at_s), wide);
            told.push(false);
        }
        even.repeat_volts(&told, period_ticks);
        even.filled = told.iter().filter(|told| !**told).count();
        if even.filled as f64 > MOST_FILLED * told.len() as f64 {
            return Err(too_many(rows, tick_s, (even.filled, told.len())));
        }
        Ok(even)
    }

    fn put(&mut self, volts: f64, value: f64, unknown: bool) {
        self.volts.push(volts);
        self.values.push(value);
        self.unknown.push(unknown);
    }

    /// Volts that nobody wrote down are those of the same tick in other periods.
    fn repeat_volts(&mut self, told: &[bool], period_ticks: usize) {
        if period_ticks == 0 {
            return;
        }
        for k in (0..told.len()).filter(|&k| !told[k]) {
            let same = (k % period_ticks..told.len()).step_by(period_ticks).filter(|&other| told[other]);
            let (count, sum) =
                same.fold((0.0, 0.0), |(count, sum), other| (count + 1.0, sum + self.volts[other]));
            if count > 0.0 {
                self.volts[k] = sum / count;
            }
        }
    }

    fn filled_in(&self) -> Option<String> {
        (self.filled > 0).then(|| {
            let all = self.values.len();
            format!(
                "{} of {all} that are missing, or came at another time, are told from those beside them",
                counted(self.filled, "row")
            )
        })
    }

    /// What was seen, less whole periods with a long gap or with a speed that stands whatever the volts, and what was left out.
    fn without_gaps_and_limits(
        self,
        tick_s: f64,
        period_ticks: usize,
        (speeds, step): (bool, f64),
    ) -> (Excited, Vec<String>) {
        let over = ((OVER_S / tick_s.max(1e-9)).round() as usize).max(1);
        let rates: Vec<f64> = if speeds {
            self.values.clone()
        } else {
            self.values
                .windows(over + 1)
                .map(|span| (span[over] - span[0]) / (over as f64 * tick_s))
                .collect()
        };
        let least = ((STANDS_S / tick_s.max(1e-9)).round() as usize).max(2);
        let limits = standing(&self.volts[..rates.len()], &rates, least, step / (over as f64 * tick_s));
        let touched = |from: usize| {
            let to = from + period_ticks;
            let gap = self.unknown[from..to].iter().any(|unknown| *unknown);
            (gap, limits.iter().any(|range| range.start < to && from < range.end))
        };
        let whole = self.values.len().checked_div(period_ticks).unwrap_or_default();
        let periods: Vec<(bool, bool)> = (0..whole).map(|number| touched(number * period_ticks)).collect();
        let gaps = periods.iter().filter(|(gap, _)| *gap).count();
        let limited = periods.iter().filter(|(gap, limit)| *limit && !gap).count();
        let mut left_out = Vec::new();
        let mut say = |count: usize, why: &str| {
            if count > 0 {
                left_out.push(format!("{count} of {} left out: {why}", counted(whole, "period")));
            }
        };
        say(gaps, "more rows are missing there than can be filled in");
        say(limited, "its speed stands at the same value there whatever the volts, the amplifier's limit");
        let kept = |number: usize| periods.get(number).is_none_or(|(gap, limit)| !gap && !limit);
        let of = |all: &[f64]| -> Vec<f64> {
            if gaps + limited == 0 {
                return all.to_vec();
            }
            all.chunks(period_ticks)
                .enumerate()
                .filter(|(k, _)| kept(*k))
                .flat_map(|(_, part)| part)
                .copied()
                .collect()
        };
        let (volts, angles_rad) = (of(&self.volts), of(&self.values));
        let bias_v = volts.iter().sum::<f64>();
        // over a twentieth of a second, as the simulated head is watched
        let one_way = if speeds {
            angles_rad.chunks(over).all(|part| part.iter().sum::<f64>() * bias_v > 0.0)
        } else {
            let length = if gaps + limited == 0 { angles_rad.len().max(1) } else { period_ticks };
            let parts = angles_rad.chunks(length);
            parts
                .flat_map(|part| part.windows(over + 1).step_by(over))
                .all(|span| (span[over] - span[0]) * bias_v > 0.0)
        };
        (Excited { angles_rad, volts, one_way }, left_out)
    }
}

/// Says that too many rows are missing, by the longest gap.
fn too_many(rows: &[Row], tick_s: f64, (filled, all): (usize, usize)) -> String {
    let apart = |pair: &[Row]| pair[1].time_s - pair[0].time_s;
    let Some(pair) = rows.windows(2).max_by(|a, b| apart(a).total_cmp(&apart(b))) else {
        return String::new();
    };
    format!(
        ":{}: {} s comes {:.4} ms after the row before; rows must be {} ms apart, and {filled} of {all} are missing or at other times",
        pair[1].line,
        pair[1].time_s,
        1e3 * apart(pair),
        1e3 * tick_s
    )
}

/// A value between rows by the cubic through two on either side (Lagrange), or a line where there are none.
fn between(rows: &[Row], after: usize, at_s: f64) -> f64 {
    let (from, to) = (after.saturating_sub(2), (after + 2).min(rows.len()));
    let near = if to - from == 4 { &rows[from..to] } else { &rows[after - 1..=after] };
    let share = |k: usize| {
        let others = near.iter().enumerate().filter(|(other, _)| *other != k);
        others.map(|(_, row)| (at_s - row.time_s) / (near[k].time_s - row.time_s)).product::<f64>()
    };
    (0..near.len()).map(|k| near[k].value * share(k)).sum()
}
