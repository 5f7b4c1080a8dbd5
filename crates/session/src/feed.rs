//! A job's segments on their way to the rig.

use tracelight_rig::{Command, Rig, Segment};

/// Segments that are sent in a tick at most: a board has other things to do in one, and no plan has so many.
const MOST_A_TICK: u32 = 4;

/// Moves segments on their way to the rig, by what is known only while the job runs: a camera's trim.
pub trait Trim {
    /// How far ahead of the plan's clock segments are sent, ticks: what is sent is not moved any more.
    fn ahead_ticks(&self) -> u32;

    /// Returns what is sent in place of a segment. It is asked once for each of them, in order.
    fn trimmed(&mut self, segment: &Segment) -> Segment;
}

/// Sends segments as they are, as early as the rig takes them.
#[derive(Clone, Copy, Debug, Default)]
pub struct Untrimmed;

impl Trim for Untrimmed {
    fn ahead_ticks(&self) -> u32 {
        u32::MAX
    }

    fn trimmed(&mut self, segment: &Segment) -> Segment {
        *segment
    }
}

/// Feeds a plan's segments to a rig as it takes them.
#[derive(Clone, Debug)]
pub struct Feeder<S> {
    segments: S,
    dark: bool,
    next: usize,
    /// One that was trimmed, and that the rig did not take yet.
    waiting: Option<Segment>,
    finished: bool,
}

impl<S: AsRef<[Segment]>> Feeder<S> {
    /// `dark` shuts every segment's gate: a dry run.
    pub const fn new(segments: S, dark: bool) -> Self {
        Self { segments, dark, next: 0, waiting: None, finished: false }
    }

    /// Sends as many segments as the rig takes now, some a tick at most, then the end of the job.
    pub fn feed(&mut self, rig: &mut impl Rig) {
        self.feed_trimmed(rig, 0, &mut Untrimmed);
    }

    /// Does the same with what is soon due at a tick of the plan, trimmed.
    pub fn feed_trimmed(&mut self, rig: &mut impl Rig, plan_tick: u32, trim: &mut impl Trim) {
        let mut left = MOST_A_TICK;
        while let Some(segment) = self.segments.as_ref().get(self.next) {
            if left == 0 || segment.start_tick > plan_tick.saturating_add(trim.ahead_ticks()) {
                return;
            }
            let sent = *self.waiting.get_or_insert_with(|| trim.trimmed(segment));
            let sent = Segment { gate: sent.gate && !self.dark, ..sent };
            if rig.send(Command::Append(sent)).is_err() {
                return;
            }
            self.waiting = None;
            self.next += 1;
            left -= 1;
        }
        if !self.finished {
            self.finished = rig.send(Command::Finish).is_ok();
        }
    }
}
