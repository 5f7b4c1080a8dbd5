//! An encoder disc beside its axis, from the edges of a joint that turns evenly.

use std::f64::consts::TAU;

use tracelight_maths::{atan2, cos, hypot, sin};

use crate::regression::{Uncertain, regression};

/// Where an edge was crossed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Crossing {
    /// s.
    pub(crate) time_s: f64,
    /// Angle that the counter reads, rad.
    pub(crate) angle_rad: f64,
    /// Count there, with what is known of its kind of edge.
    pub(crate) counts: f64,
}

/// Fewest turns of even motion by which a disc is judged.
const LEAST_TURNS: f64 = 2.0;

/// Amplitude of what repeats once a turn, counts, and at which angle it is largest, rad. `None` if no run has two turns of even motion.
///
/// The mean of all runs is taken, whatever their lengths: friction that varies over a turn acts against the motion, so that it cancels
/// between runs of both directions.
pub(crate) fn eccentricity(runs: &[Vec<Crossing>]) -> Option<(Uncertain, f64)> {
    let found: Vec<[Uncertain; 2]> = runs.iter().filter_map(|run| of_run(even(run)?)).collect();
    if found.is_empty() {
        return None;
    }
    let count = found.len() as f64;
    let mean = |i: usize| found.iter().map(|pair| pair[i].value).sum::<f64>() / count;
    let (sine, cosine) = (mean(0), mean(1));
    let within = found.iter().map(|pair| hypot(pair[0].within, pair[1].within)).sum::<f64>() / count;
    Some((Uncertain { value: hypot(sine, cosine), within }, atan2(sine, cosine)))
}

/// The longest part of a run in which the joint turns evenly: starts, stops and pauses are left out.
fn even(run: &[Crossing]) -> Option<&[Crossing]> {
    /// Speed is taken over so many parts of a turn, and a part is even within that share of the median speed.
    const PARTS: f64 = 32.0;
    const EVEN: f64 = 0.25;
    /// At its ends the speed is that of a turn further inside, within that share, or within that many times what is usual of the run.
    const ENDS: f64 = 0.01;
    const USUAL: f64 = 3.0;
    let turns = (run.last()?.angle_rad - run.first()?.angle_rad).abs() / TAU;
    let a_turn = (run.len() as f64 / turns) as usize;
    let half = (a_turn as f64 / PARTS) as usize;
    if turns < LEAST_TURNS || half == 0 || run.len() <= 2 * half {
        return None;
    }
    let speed = |i: usize| {
        let (before, after) = (run[i - half], run[i + half]);
        (after.angle_rad - before.angle_rad).abs() / (after.time_s - before.time_s)
    };
    let speeds: Vec<f64> = (half..run.len() - half).map(speed).collect();
    let mut sorted = speeds.clone();
    sorted.sort_by(f64::total_cmp);
    let median = sorted[sorted.len() / 2];
    let is_even = |v: &f64| (v - median).abs() <= EVEN * median;
    let (mut start, mut end) = longest(&speeds, is_even);
    let change = |a: usize, b: usize| (speeds[a] - speeds[b]).abs() / speeds[b];
    let mut changes: Vec<f64> =
        (start..end.saturating_sub(a_turn)).step_by(half).map(|i| change(i, i + a_turn)).collect();
    changes.sort_by(f64::total_cmp);
    let most = ENDS.max(USUAL * changes.get(changes.len() / 2).copied().unwrap_or_default());
    let differs = |a: usize, b: usize| change(a, b) > most;
    while start + a_turn < end && differs(start, start + a_turn) {
        start += half;
    }
    while start + a_turn < end && differs(end - 1, end - 1 - a_turn) {
        end -= half;
    }
    // a speed there is that of what lies about it
    let part = run.get(start + 2 * half..end)?;
    let turns = (part.last()?.angle_rad - part.first()?.angle_rad).abs() / TAU;
    (turns >= LEAST_TURNS).then_some(part)
}

/// Begin and end of the longest stretch of values for which something holds.
fn longest(values: &[f64], holds: impl Fn(&f64) -> bool) -> (usize, usize) {
    let (mut best, mut start) = ((0, 0), 0);
    for end in 1..=values.len() {
        if !holds(&values[end - 1]) {
            start = end;
        } else if end - start > best.1 - best.0 {
            best = (start, end);
        }
    }
    best
}

/// Sine and cosine of what repeats with a turn, beside a smooth motion.
fn of_run(run: &[Crossing]) -> Option<[Uncertain; 2]> {
    /// Chebyshev's polynomials of the motion, which stay apart.
    const POWERS: usize = 6;
    /// Deviations within which 95 of 100 lie.
    const DEVIATIONS: f64 = 1.96;
    let (first, last) = (run.first()?, run.last()?);
    let middle_s = 0.5 * (first.time_s + last.time_s);
    let half_s = 0.5 * (last.time_s - first.time_s);
    let mut columns = vec![Vec::new(); POWERS + 2];
    for crossing in run {
        let x = (crossing.time_s - middle_s) / half_s;
        let (mut one, mut two) = (1.0, x);
        for column in &mut columns[..POWERS] {
            column.push(one);
            (one, two) = (two, 2.0 * x * two - one);
        }
        columns[POWERS].push(sin(crossing.angle_rad));
        columns[POWERS + 1].push(cos(crossing.angle_rad));
    }
    let wanted: Vec<f64> = run.iter().map(|crossing| crossing.counts - first.counts).collect();
    let found = regression(&columns, &wanted)?;
    let left = |row: usize| {
        let explained = columns.iter().zip(&found.factors).map(|(column, factor)| column[row] * factor.value);
        wanted[row] - explained.sum::<f64>()
    };
    let turns = (last.angle_rad - first.angle_rad).abs() / TAU;
    let slow = DEVIATIONS * slow_deviation(&(0..run.len()).map(left).collect::<Vec<_>>(), turns);
    let factor = |k: usize| Uncertain { within: found.factors[k].within.max(slow), ..found.factors[k] };
    Some([factor(POWERS), factor(POWERS + 1)])
}

/// Standard deviation of an amplitude over a turn by what is left, if that changes no sooner than within a quarter of a turn: edges
/// beside each other may all be off alike where a motion is not smooth.
fn slow_deviation(left: &[f64], turns: f64) -> f64 {
    const PARTS: f64 = 4.0;
    let size = (left.len() as f64 / (PARTS * turns)) as usize;
    let means = left.chunks_exact(size.max(1)).map(|part| part.iter().sum::<f64>() / part.len() as f64);
    let (count, squares) =
        means.fold((0.0, 0.0), |(count, squares), mean| (count + 1.0, squares + mean * mean));
    // half of a sine's square is its mean
    (2.0 * squares).sqrt() / f64::max(count, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    const COUNT_RAD: f64 = TAU / 4096.0;

    /// Edges of a joint that speeds up, turns at 3 rad/s, and slows down again: exact times, a disc beside its axis by `amount` counts.
    fn spun(acceleration: f64, held_s: f64, amount: f64) -> Vec<Crossing> {
        let rise_s = 3.0 / acceleration;
        let all_s = 2.0 * rise_s + held_s;
        let angle = |t: f64| {
            let ramp = |t: f64| 0.5 * acceleration * t * t;
            if t < rise_s {
                ramp(t)
            } else if t < all_s - rise_s {
                ramp(rise_s) + 3.0 * (t - rise_s)
            } else {
                2.0 * ramp(rise_s) + 3.0 * held_s - ramp(all_s - t)
            }
        };
        let read = |t: f64| angle(t) / COUNT_RAD + amount * angle(t).sin();
        let last = read(all_s).floor() as i32;
        let when = |edge: i32| {
            let (mut low, mut high) = (0.0, all_s);
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if read(middle) < f64::from(edge) { low = middle } else { high = middle }
            }
            low
        };
        (1..last)
            .map(|edge| Crossing {
                time_s: when(edge),
                angle_rad: f64::from(edge) * COUNT_RAD,
                counts: f64::from(edge),
            })
            .collect()
    }

    #[test]
    fn starts_and_stops_are_no_disc_beside_its_axis() {
        for (acceleration, held_s) in [(1.0, 20.0), (3.0, 20.0), (6.0, 10.0)] {
            for amount in [0.0, 2.0] {
                let (found, at_rad) = eccentricity(&[spun(acceleration, held_s, amount)]).unwrap();
                assert!((found.value - amount).abs() < 0.05, "{acceleration}: {found:?}");
                assert!((found.value - amount).abs() <= found.within, "{acceleration}: {found:?}");
                assert!(amount == 0.0 || (at_rad - 0.25 * TAU).abs() < 0.02, "{at_rad}");
            }
        }
    }

    #[test]
    fn what_never_turns_evenly_for_two_turns_tells_nothing() {
        assert!(eccentricity(&[spun(0.5, 1.0, 2.0)]).is_none());
        assert!(eccentricity(&[spun(3.0, 20.0, 2.0)[..4000].to_vec()]).is_none());
        assert!(eccentricity(&[Vec::new()]).is_none());
    }
}
