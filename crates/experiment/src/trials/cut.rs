//! A run that goes on and on, cut into trials: where the drive changes and then holds, where the joint stood, or else into equal parts.

use tracelight_lab::Sample;

/// Share of the largest voltage by which volts differ that are held: what is measured is never quite the same.
const HELD: f64 = 0.02;
/// A voltage counts as held that lasts so long, s.
const HOLD_S: f64 = 0.5;
/// A joint stands that does not move for so long, s.
const STANDS_S: f64 = 0.3;
/// A trial is no shorter, s.
const SHORTEST_S: f64 = 0.3;
/// A drive that never holds is cut into so many parts, none of them longer or shorter than that, s.
const PARTS: f64 = 8.0;
const PART_S: (f64, f64) = (0.4, 4.0);

/// The largest size of some numbers.
pub(super) fn largest(numbers: impl Iterator<Item = f64>) -> f64 {
    numbers.fold(0.0, |most, number| most.max(number.abs()))
}

/// Trials of a run; a joint that moves by less than `still` counts stands.
pub(super) fn cut(run: &[Sample], still: f64) -> Vec<Vec<Sample>> {
    let holds = holds(run);
    let length = |(from, to): &(usize, usize)| run[*to].time_s - run[*from].time_s;
    let all_s = run[run.len() - 1].time_s - run[0].time_s;
    let held_s: f64 = holds.iter().map(length).filter(|s| *s >= HOLD_S).sum();
    let mut ends: Vec<usize> = if 2.0 * held_s >= all_s {
        holds.iter().filter(|hold| length(hold) >= HOLD_S).map(|hold| hold.0).collect()
    } else {
        parts(run, still)
    };
    ends.retain(|&end| run[end].time_s - run[0].time_s >= SHORTEST_S);
    ends.push(run.len() - 1);
    let mut trials = Vec::new();
    let mut from = 0;
    for end in ends {
        if end > from && run[end].time_s - run[from].time_s >= SHORTEST_S || end == run.len() - 1 {
            // the sample at a cut ends one trial and begins the next
            trials.push(run[from..=end].to_vec());
            from = end;
        }
    }
    trials.retain(|trial| trial.len() > 1);
    trials
}

/// A trial in equal parts, as many as there may be up to so many: few trials tell nothing of how sure they are.
pub(super) fn divided(samples: &[Sample], most: usize) -> Vec<Vec<Sample>> {
    let (first, last) = (samples[0].time_s, samples[samples.len() - 1].time_s);
    let count = (((last - first) / PART_S.0) as usize).clamp(1, most);
    let at = |part: usize| {
        let time_s = first + (last - first) * part as f64 / count as f64;
        samples.partition_point(|sample| sample.time_s < time_s - 1e-9).min(samples.len() - 1)
    };
    let parts = (0..count).map(|part| samples[at(part)..=at(part + 1)].to_vec());
    parts.filter(|part| part.len() > 1).collect()
}

/// First and last sample of each stretch of one voltage.
fn holds(run: &[Sample]) -> Vec<(usize, usize)> {
    let alike = HELD * largest(run.iter().map(|sample| sample.volts));
    let mut found = vec![(0, 0)];
    for (k, sample) in run.iter().enumerate() {
        let from = found.last().map_or(0, |hold| hold.0);
        if (sample.volts - run[from].volts).abs() > alike {
            found.push((k, k));
        }
        // a voltage holds until the sample at which another begins
        if let Some(hold) = found.last_mut() {
            hold.1 = (k + 1).min(run.len() - 1);
        }
    }
    found
}

/// Ends of standstills, and between them of equal parts.
fn parts(run: &[Sample], still: f64) -> Vec<usize> {
    let (first, last) = (run[0].time_s, run[run.len() - 1].time_s);
    let mut moved = 0;
    let mut ends = Vec::new();
    for k in 1..run.len() {
        if (run[k].count - run[moved].count).abs() > still {
            if run[k].time_s - run[moved].time_s >= STANDS_S {
                ends.push(k - 1);
            }
            moved = k;
        }
    }
    let part_s = ((last - first) / PARTS).clamp(PART_S.0, PART_S.1);
    let (mut all, mut from_s, mut ends) = (Vec::new(), first, ends.into_iter().peekable());
    for (k, sample) in run.iter().enumerate() {
        if ends.next_if_eq(&k).is_some() || sample.time_s - from_s >= part_s {
            all.push(k);
            from_s = sample.time_s;
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use tracelight_maths::sin;

    use super::*;

    /// A row each 10 ms.
    fn run(volts: impl Fn(f64) -> f64, count: impl Fn(f64) -> f64) -> Vec<Sample> {
        (0..1000)
            .map(|k| 0.01 * f64::from(k))
            .map(|time_s| Sample { time_s, volts: volts(time_s), count: count(time_s).round() })
            .collect()
    }

    fn starts(trials: &[Vec<Sample>]) -> Vec<f64> {
        trials.iter().map(|trial| (10.0 * trial[0].time_s).round() / 10.0).collect()
    }

    #[test]
    fn steps_are_cut_where_the_drive_changes() {
        // noisy, as it is measured; what lasts for a tenth of a second is no trial
        let volts = |t: f64| match t {
            t if t < 2.0 => 0.0,
            t if t < 5.0 => 4.0 + 0.01 * sin(90.0 * t),
            t if t < 5.1 => 9.0,
            _ => 6.0,
        };
        let trials = cut(&run(volts, |t| 100.0 * t), 1.0);
        assert_eq!(starts(&trials), [0.0, 2.0, 5.1]);
        assert_eq!(trials.iter().map(Vec::len).sum::<usize>(), 1002, "a sample at a cut is in both");
    }

    #[test]
    fn few_trials_are_divided_into_equal_parts() {
        let run = run(|_| 3.0, |t| 100.0 * t);
        let parts = divided(&run, 4);
        assert_eq!(starts(&parts), [0.0, 2.5, 5.0, 7.5]);
        assert_eq!(divided(&run[..50], 4).len(), 1, "half a second is one part");
    }

    #[test]
    fn a_drive_that_never_holds_is_cut_into_parts_and_at_standstills() {
        let swings = |t: f64| 5.0 * sin(3.0 * t);
        let parts = cut(&run(swings, |t| 100.0 * t), 1.0);
        assert_eq!(parts.len(), 8);
        let stands = |t: f64| {
            200.0
                * if t < 3.0 {
                    t
                } else if t < 3.7 {
                    3.0
                } else {
                    t - 0.7
                }
        };
        let at = starts(&cut(&run(swings, stands), 1.0));
        assert!(at.contains(&3.7), "{at:?}");
    }
}
