use std::time::{Duration, Instant};

/// Work that is early by less is not held back: a sleep takes about as long.
const EARLY: Duration = Duration::from_millis(1);
/// A step that begins later than this after it was due is late.
const LATE: Duration = Duration::from_millis(1);

/// Holds steps back that are too fast, so that each takes its time by the clock, on average and for ever.
#[derive(Clone, Copy, Debug)]
pub struct Pace {
    step_s: f64,
    began: Option<Instant>,
    steps: u64,
    late: u64,
    latest: Duration,
}

impl Pace {
    /// Of steps that take so long each, s.
    #[must_use]
    pub const fn new(step_s: f64) -> Self {
        Self { step_s, began: None, steps: 0, late: 0, latest: Duration::ZERO }
    }

    /// Waits until the next step is due. The first one begins the count.
    pub fn wait(&mut self) {
        self.steps += 1;
        let due = Duration::from_secs_f64(self.steps as f64 * self.step_s);
        let began = *self.began.get_or_insert_with(Instant::now);
        let early = due.saturating_sub(began.elapsed());
        if early > EARLY {
            std::thread::sleep(early);
        }
        let late = began.elapsed().saturating_sub(due);
        self.late += u64::from(late > LATE);
        self.latest = self.latest.max(late);
    }

    /// How many steps began more than a millisecond after they were due, and how late the latest one was, s.
    #[must_use]
    pub const fn lateness(&self) -> (u64, f64) {
        (self.late, self.latest.as_secs_f64())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_that_is_held_up_is_late_and_the_next_ones_until_it_is_made_up_for() {
        let mut pace = Pace::new(1e-3);
        pace.wait();
        std::thread::sleep(Duration::from_millis(30));
        (0..40).for_each(|_| pace.wait());
        let (late, latest_s) = pace.lateness();
        // of 30 ms the first is over, and those within a millisecond of their time are not late
        assert!((20..=40).contains(&late), "{late}");
        assert!(latest_s >= 0.028, "{latest_s}");
    }
}
