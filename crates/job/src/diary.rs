//! What somebody at the wall did.

use tracelight_session::{Event, Snapshot, State, seconds};

/// What somebody at the wall did, as sentences for the report.
#[derive(Default)]
pub(crate) struct Diary {
    pub(crate) notes: Vec<String>,
    /// When the job came to rest, s, and how.
    rests: Option<(f64, String)>,
    speed: Option<f32>,
}

impl Diary {
    /// Writes down another speed than the last one.
    pub(crate) fn watch(&mut self, now: &Snapshot) {
        let before = self.speed.replace(now.speed).unwrap_or(1.0);
        if before != now.speed {
            let percent = 100.0 * now.speed;
            self.notes
                .push(format!("from {:.1} s on at {percent:.0} % of the planned speed", seconds(now.tick)));
        }
    }

    pub(crate) fn write(&mut self, event: &Event, now: &Snapshot) {
        let &Event::State { tick, to, .. } = event else { return };
        let how = match to {
            State::Paused => "paused",
            State::Stopped => "stopped",
            _ => "",
        };
        let at_s = seconds(tick);
        if !how.is_empty() && self.rests.is_none() {
            let stroke = now.stroke.map_or(now.strokes, |stroke| stroke + 1);
            self.rests =
                Some((at_s, format!("{how} after {at_s:.1} s at stroke {stroke} of {}", now.strokes)));
        } else if to == State::Tracing
            && let Some((since_s, how)) = self.rests.take()
        {
            self.notes.push(format!("{how}, for {:.1} s", at_s - since_s));
        }
    }

    /// Writes down that it never went on.
    pub(crate) fn end(&mut self, now: &Snapshot) {
        if let Some((since_s, how)) = self.rests.take() {
            let lasted_s = seconds(now.tick) - since_s;
            self.notes.push(format!("{how}, for {lasted_s:.1} s; it did not go on"));
        }
    }
}
