//! Speeds that stand at the same value whatever the volts: those of an amplifier at its limit.

use super::Trial;

/// Volts above which a speed, or a current, rises no more.
#[derive(Clone, Debug, PartialEq)]
pub struct Plateau {
    /// The points on it, by their numbers.
    pub points: Vec<usize>,
    /// The value at which they stand: their mean.
    pub value: f64,
    /// Volts of the lowest of them, V.
    pub from_v: f64,
}

/// Fewest points that stand at one value.
const LEAST: usize = 3;
/// Shares of the largest by which values on a plateau differ at most, and by which their volts do at least.
const ALIKE: f64 = 5e-3;
const APART: f64 = 0.04;
/// By so many times what they differ they would have risen, at the rate of those below.
const RISEN: f64 = 4.0;
/// The end of a trial that its speed is taken over, s at most, and as a share of the trial.
const END_S: f64 = 0.5;
const END: f64 = 0.25;

/// The plateaus of points (volts, value), one each way at most: the highest volts whose values are alike although those below them rise.
/// `step` is the least by which values are told apart.
pub fn plateau(points: &[(f64, f64)], step: f64) -> Vec<Plateau> {
    [1.0, -1.0].into_iter().filter_map(|way| one_way(points, step, way)).collect()
}

fn one_way(points: &[(f64, f64)], step: f64, way: f64) -> Option<Plateau> {
    let mut order: Vec<usize> =
        (0..points.len()).filter(|&k| way * points[k].0 > 0.0 && way * points[k].1 > 0.0).collect();
    order.sort_by(|&a, &b| (way * points[b].0).total_cmp(&(way * points[a].0)));
    let at = |k: usize| (way * points[order[k]].0, way * points[order[k]].1);
    let (most_v, top) =
        (at_first(&order, points, way)?.0, order.iter().map(|&k| way * points[k].1).fold(0.0, f64::max));
    let alike = (ALIKE * top).max(step);
    let count = (0..order.len()).take_while(|&k| top - at(k).1 <= alike).count();
    if count < LEAST || count == order.len() {
        return None;
    }
    let (from_v, below) = (at(count - 1).0, at(count));
    // those below rise from what would be at rest
    let start = at(order.len() - 1);
    let rise = if start.0 < below.0 { (below.1 - start.1) / (below.0 - start.0) } else { below.1 / below.0 };
    let stands = most_v - from_v >= APART * most_v && rise * (most_v - from_v) > RISEN * alike;
    let points_on = order[..count].to_vec();
    let value = points_on.iter().map(|&k| points[k].1).sum::<f64>() / count as f64;
    stands.then_some(Plateau { points: points_on, value, from_v: way * from_v })
}

fn at_first(order: &[usize], points: &[(f64, f64)], way: f64) -> Option<(f64, f64)> {
    order.first().map(|&k| (way * points[k].0, way * points[k].1))
}

/// The plateaus of trials of one joint, by the volts and the speeds at their ends; of places known to `step_rad`.
pub fn saturated(trials: &[Trial], count_rad: f64, step_rad: f64) -> Vec<Plateau> {
    let ends: Vec<(f64, f64)> =
        trials.iter().map(|trial| end(trial, count_rad).unwrap_or_default()).collect();
    plateau(&ends, step_rad / END_S)
}

/// Volts and speed at a trial's end, where its voltage holds and its speed no longer changes.
fn end(trial: &Trial, count_rad: f64) -> Option<(f64, f64)> {
    let samples = &trial.samples;
    let last = samples.last()?;
    let span_s = END_S.min(END * trial.length_s());
    let at = |time_s: f64| samples.partition_point(|sample| sample.time_s < time_s - 1e-9);
    let (from, middle, to) = (at(last.time_s - span_s), at(last.time_s - 0.5 * span_s), samples.len() - 1);
    let rate = |a: usize, b: usize| {
        let lasts_s = samples[b].time_s - samples[a].time_s;
        (lasts_s > 0.0).then(|| (samples[b].count - samples[a].count) * count_rad / lasts_s)
    };
    let (before, after) = (rate(from, middle)?, rate(middle, to)?);
    let volts = samples[from].volts;
    // the last sample's voltage is that of what follows
    let holds = samples[from..to].iter().all(|sample| (sample.volts - volts).abs() <= ALIKE * volts.abs());
    let steady = (after - before).abs() <= 2.0 * ALIKE * after.abs();
    (holds && steady).then_some((volts, rate(from, to)?))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An amplifier that gives 8 V at most, and a motor of 10 rad/s a volt beyond 1 V.
    fn line(limit_v: f64) -> Vec<(f64, f64)> {
        let speed = |v: f64| v.signum() * 10.0 * (v.abs().min(limit_v) - 1.0).max(0.0);
        (-12..=12).map(|k| (f64::from(k), speed(f64::from(k)) + 0.05 * f64::from(k % 3))).collect()
    }

    #[test]
    fn speeds_that_rise_no_more_are_found_each_way() {
        let found = plateau(&line(8.0), 0.0);
        assert_eq!(found.len(), 2);
        for (one, way) in found.iter().zip([1.0, -1.0]) {
            assert_eq!(one.points.len(), 5, "{one:?}");
            assert_eq!(one.from_v, 8.0 * way);
            assert!((one.value - 70.0 * way).abs() < 0.1, "{one:?}");
        }
    }

    #[test]
    fn speeds_that_rise_are_no_plateau() {
        assert_eq!(plateau(&line(100.0), 0.0), []);
        // two at the top may be alike by chance, and one speed at one voltage is no limit
        assert_eq!(plateau(&line(11.0), 0.0), []);
        assert_eq!(plateau(&[(5.0, 40.0); 9], 0.0), []);
        assert_eq!(plateau(&[], 0.0), []);
    }
}
