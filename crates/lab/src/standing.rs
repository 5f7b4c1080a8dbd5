//! Where a speed stands at its highest whatever the volts: an amplifier at its limit, in a record that is never steady.

use std::ops::Range;

/// Share of the highest speed by which speeds differ that stand.
const ALIKE: f64 = 5e-3;
/// Share of all volts' spread by which volts differ meanwhile. A speed is within that share of its highest about the top of a slow
/// sine as well, but there the volts change by less.
const CHANGE: f64 = 0.25;

/// Ranges of at least so many rows in which the speed stands at its highest, either way, and the volts change. None if speeds are not
/// told apart finely enough: their least step is `step`.
pub fn standing(volts: &[f64], rates: &[f64], least: usize, step: f64) -> Vec<Range<usize>> {
    let spread = |range: Range<usize>| {
        let (low, high) =
            volts[range].iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(*v), h.max(*v)));
        high - low
    };
    let all = spread(0..volts.len());
    let mut found = Vec::new();
    for way in [1.0, -1.0] {
        let top = rates.iter().map(|rate| way * rate).fold(0.0, f64::max);
        if step > ALIKE * top || top == 0.0 {
            continue;
        }
        let mut from = 0;
        for run in rates.chunk_by(|a, b| stands(way * a, top) == stands(way * b, top)) {
            let range = from..from + run.len();
            from = range.end;
            if stands(way * run[0], top) && run.len() >= least && spread(range.clone()) >= CHANGE * all {
                found.push(range);
            }
        }
    }
    found
}

fn stands(rate: f64, top: f64) -> bool {
    top - rate <= ALIKE * top
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_limit_is_told_from_the_top_of_a_sine() {
        let volts: Vec<f64> = (0..2000).map(|k| 3.0 + 2.0 * (0.01 * f64::from(k)).sin()).collect();
        // the motor follows a little late
        let rate = |k: u32| 30.0 + 20.0 * (0.01 * f64::from(k) - 0.7).sin();
        let free: Vec<f64> = (0..2000).map(rate).collect();
        assert_eq!(standing(&volts, &free, 30, 0.0), []);
        let limited: Vec<f64> = free.iter().map(|rate| rate.min(42.0)).collect();
        let found = standing(&volts, &limited, 30, 0.0);
        assert_eq!(found.len(), 3, "{found:?}");
        assert!(found.iter().all(|range| limited[range.clone()].iter().all(|rate| *rate > 41.7)));
        assert_eq!(standing(&volts, &limited, 30, 1.0), [], "counted too coarsely");
        assert_eq!(standing(&[], &[], 30, 0.0), []);
    }
}
