//! When a board's ticks are, by the host's clock.

use std::collections::VecDeque;

/// Answers of which the quickest tells: what hurried most was held up least.
const KEPT: usize = 64;
/// Seconds over which the clocks' drift is fitted.
const DRIFT_S: usize = 60;
/// Length of a tick, µs.
const TICK_US: f64 = 1000.0;

/// A host's idea of its board's clock.
#[derive(Clone, Debug, Default)]
pub struct Clock {
    /// Of the last answers: host's time, µs, how much earlier the board's clock is, µs, and how long the way there and back took, µs.
    answers: VecDeque<(f64, f64, f64)>,
    /// The best of each second.
    best: VecDeque<(f64, f64, f64)>,
    /// Ticks of the last answer, through their wrap.
    tick: i64,
}

impl Clock {
    /// Takes an answer: sent and come by the host's clock, µs, and when the board had it: in which tick, and how far in it, µs. One that was sent later than it came, or
    /// long ago, is none.
    pub fn hear(&mut self, (sent_us, came_us): (u64, u64), tick: u32, tick_us: u16) {
        const LONGEST_US: u64 = 10_000_000;
        if sent_us > came_us || came_us - sent_us > LONGEST_US {
            return;
        }
        self.tick = if self.answers.is_empty() { tick.into() } else { self.unwrapped(tick) };
        let board_us = self.tick as f64 * TICK_US + f64::from(tick_us);
        let (sent, came) = (sent_us as f64, came_us as f64);
        let (there_and_back, middle) = (came - sent, 0.5 * (sent + came));
        let answer = (middle, middle - board_us, there_and_back);
        if self.answers.len() == KEPT {
            self.answers.pop_front();
        }
        self.answers.push_back(answer);
        let is_same_second = |&(at, ..): &(f64, f64, f64)| middle - at < 1e6;
        match self.best.back_mut() {
            Some(best) if is_same_second(best) => {
                if there_and_back < best.2 {
                    *best = (best.0, answer.1, there_and_back);
                }
            }
            _ => {
                if self.best.len() == DRIFT_S {
                    self.best.pop_front();
                }
                self.best.push_back(answer);
            }
        }
    }

    /// A tick through the wrap of its number: the one nearest to the last answer's.
    fn unwrapped(&self, tick: u32) -> i64 {
        self.tick + i64::from(tick.wrapping_sub(self.tick as u32).cast_signed())
    }

    /// When a tick began by the host's clock, µs, and how far off that may be, µs; `None` before the first answer.
    pub fn instant_of(&self, tick: u32) -> Option<(f64, f64)> {
        let &(at, offset, there_and_back) = self.answers.iter().min_by(|a, b| a.2.total_cmp(&b.2))?;
        let board_us = self.unwrapped(tick) as f64 * TICK_US;
        let drifted = self.drift().unwrap_or(0.0) * (board_us + offset - at);
        Some((board_us + offset + drifted, 0.5 * there_and_back))
    }

    /// How much faster the host's clock runs than the board's, as a share; `None` before it is known of ten seconds.
    pub fn drift(&self) -> Option<f64> {
        const LEAST: usize = 10;
        if self.best.len() < LEAST {
            return None;
        }
        let count = self.best.len() as f64;
        let mean = |of: fn(&(f64, f64, f64)) -> f64| self.best.iter().map(of).sum::<f64>() / count;
        let (at, offset) = (mean(|best| best.0), mean(|best| best.1));
        let (up, down) = self.best.iter().fold((0.0, 0.0), |(up, down), best| {
            (up + (best.0 - at) * (best.1 - offset), down + (best.0 - at) * (best.0 - at))
        });
        (down > 0.0).then(|| up / down)
    }

    /// How long the way there and back takes, µs: the middle and the longest of the last answers; `None` before the first.
    pub fn round_trip_us(&self) -> Option<(f64, f64)> {
        let mut ways: Vec<f64> = self.answers.iter().map(|answer| answer.2).collect();
        ways.sort_by(f64::total_cmp);
        Some((*ways.get(ways.len() / 2)?, *ways.last()?))
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

    use super::*;

    #[test]
    fn ticks_are_told_to_half_a_millisecond_through_jitter_and_drift() {
        let mut clock = Clock::default();
        let mut state = 7_u64;
        let mut roll = |below: u64| {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            state % below
        };
        // the board's clock is slow by 80 parts in a million, and began 12.3 s after the host's
        let board_of = |host_us: f64| (host_us - 12.3e6) * (1.0 - 80e-6);
        let (mut worst, mut sent) = (0.0_f64, 13_000_000_u64);
        for answer in 0..12_000 {
            sent += 10_000;
            let (there, back) = (150 + roll(400) + 8000 * u64::from(roll(20) == 0), 150 + roll(400));
            // ticks wrap in the middle of it
            let number = |board_us: f64| ((board_us / 1000.0) as u32).wrapping_sub(60_000);
            let board_us = board_of((sent + there) as f64);
            clock.hear((sent, sent + there + back), number(board_us), (board_us % 1000.0) as u16);
            if answer > 3000 {
                let tick = (board_of(sent as f64) / 1000.0) as u32;
                let truly = f64::from(tick) * 1000.0 / (1.0 - 80e-6) + 12.3e6;
                let (told, unsure) = clock.instant_of(number(board_of(sent as f64))).unwrap();
                worst = worst.max((told - truly).abs());
                assert!((told - truly).abs() <= unsure + 60.0, "{answer}: {} of {unsure}", told - truly);
            }
        }
        assert!(worst < 500.0, "{worst} us");
        assert!((clock.drift().unwrap() - 80e-6).abs() < 20e-6, "{:?}", clock.drift());
    }

    #[test]
    fn an_answer_from_the_future_or_of_long_ago_is_none() {
        let mut clock = Clock::default();
        clock.hear((5000, 4000), 1, 0);
        clock.hear((0, 20_000_000), 1, 0);
        assert_eq!(clock.instant_of(1), None);
    }

    #[test]
    fn before_an_answer_nothing_is_known() {
        assert_eq!(Clock::default().instant_of(5), None);
        assert_eq!(Clock::default().round_trip_us(), None);
    }
}
