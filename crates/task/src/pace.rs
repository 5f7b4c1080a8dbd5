use std::time::{Duration, Instant};

/// Work that is early by less is not held back: a sleep takes about as long.
const EARLY: Duration = Duration::from_millis(1);

/// Holds steps back that are too fast, so that each takes its time by the clock, on average and for ever.
#[derive(Clone, Copy, Debug)]
pub struct Pace {
    step_s: f64,
    began: Option<Instant>,
    steps: u64,
}

impl Pace {
    /// Of steps that take so long each, s.
    #[must_use]
    pub const fn new(step_s: f64) -> Self {
        Self { step_s, began: None, steps: 0 }
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
    }
}
