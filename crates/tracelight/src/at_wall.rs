//! Somebody at the wall: keys and the clock to a job, what happens to a terminal or a script.

use std::time::{Duration, Instant};

use serde_json::{Value, json};
use tracelight_job::Hands;
use tracelight_rig::TICK_F64_S;
use tracelight_session::{Event, Refused, Request, Snapshot, State, When, seconds};
use tracelight_task::{Stop, Task};

use crate::cli::by_hand::ByHandArgs;
use crate::keys::{Key, Keys};

/// What the keys do.
const HELP: &str = "keys: Space pauses after this stroke, and goes on; P pauses at once; Esc stops; A arms, Enter goes on after that; + and − change the speed, \
                    = sets 100 %; C clears a fault; Q ends; ? shows this";
/// Speeds that + and − go through, as multiples of the plan's.
const SPEEDS: [f32; 9] = [0.1, 0.25, 0.5, 0.75, 1.0, 1.25, 1.5, 1.75, 2.0];
/// How often progress is told, ticks of the rig.
const PROGRESS_TICKS: u32 = 250;
/// A rig that is late by less is not waited for: a sleep takes about as long.
const EARLY: Duration = Duration::from_millis(1);

/// Keys, clock and events of one job.
pub(crate) struct AtWall<'a> {
    task: Task<'a>,
    stop: &'a Stop,
    clock: Option<Clock>,
    keys: Option<Keys>,
    events: bool,
}

/// When a tick is due.
struct Clock {
    factor: f64,
    began: Option<Instant>,
    ticks: u64,
}

impl<'a> AtWall<'a> {
    /// Whoever stands there, if the job runs by hand at all.
    pub(crate) fn of(args: &ByHandArgs, task: Task<'a>, stop: &'a Stop) -> Option<Self> {
        if args.real_time.is_none() && !args.events {
            return None;
        }
        let keys = args.real_time.and_then(|_| Keys::listen());
        if keys.is_some() {
            task.say(HELP);
        }
        let clock = args.real_time.map(|factor| Clock { factor, began: None, ticks: 0 });
        Some(Self { task, stop, clock, keys, events: args.events })
    }

    /// What a key asks for here.
    fn meaning(&self, key: Key, now: &Snapshot) -> Option<Request> {
        let is_on = matches!(now.state, State::Tracing | State::Returning | State::Pausing);
        match key {
            Key::Space if is_on => Some(Request::Pause(When::AfterStroke)),
            Key::Space | Key::Enter => Some(Request::Resume),
            Key::Escape => Some(Request::Stop),
            // the first darkens, the second ends
            Key::Interrupt if is_on => Some(Request::Pause(When::AtOnce)),
            Key::Interrupt | Key::Char('q') => {
                self.stop.want();
                Some(Request::Stop)
            }
            Key::Char('p') => Some(Request::Pause(When::AtOnce)),
            Key::Char('a') => Some(Request::Arm),
            Key::Char('c') => Some(Request::Clear),
            Key::Char('+') => Some(Request::Speed(faster(now.speed))),
            Key::Char('-') => Some(Request::Speed(slower(now.speed))),
            Key::Char('=') => Some(Request::Speed(1.0)),
            Key::Char('?') => {
                self.task.say(HELP);
                None
            }
            Key::Char(_) => None,
        }
    }

    #[expect(clippy::print_stdout, reason = "events are what was asked for")]
    fn print(&self, event: &Value) {
        if self.events {
            println!("{event}");
        }
    }
}

fn faster(speed: f32) -> f32 {
    SPEEDS.into_iter().find(|&next| next > speed + 1e-3).unwrap_or(SPEEDS[SPEEDS.len() - 1])
}

fn slower(speed: f32) -> f32 {
    SPEEDS.into_iter().rev().find(|&next| next < speed - 1e-3).unwrap_or(SPEEDS[0])
}

impl Hands for AtWall<'_> {
    fn tick(&mut self, now: &Snapshot) -> Option<Request> {
        if let Some(clock) = &mut self.clock {
            clock.wait();
        }
        if now.tick.is_multiple_of(PROGRESS_TICKS) {
            self.print(&json!({
                "event": "progress", "t_s": seconds(now.tick), "state": now.state.name(), "plan_s": seconds(now.plan_tick),
                "of_s": seconds(now.plan_ticks), "stroke": now.stroke.map(|stroke| stroke + 1), "strokes": now.strokes,
                "speed": now.speed, "gate": now.gate,
            }));
        }
        let key = self.keys.as_ref()?.next()?;
        let request = self.meaning(key, now)?;
        if let Request::Speed(speed) = request {
            self.task.say(&format!("speed {:.0} %", 100.0 * speed));
        }
        Some(request)
    }

    fn event(&mut self, event: &Event) {
        let (line, words) = match *event {
            Event::State { tick, from, to } => (
                json!({"event": "state", "t_s": seconds(tick), "from": from.name(), "to": to.name()}),
                words(to).map(str::to_owned),
            ),
            Event::Stroke { tick, stroke, of } => {
                (json!({"event": "stroke", "t_s": seconds(tick), "stroke": stroke + 1, "strokes": of}), None)
            }
            Event::Fault { tick, fault } => (
                json!({"event": "fault", "t_s": seconds(tick), "code": fault.code(), "message": fault.row().what}),
                Some(format!("fault {}: {} (C clears it)", fault.code(), fault.row().what)),
            ),
        };
        self.print(&line);
        if let Some(words) = words.filter(|_| self.keys.is_some()) {
            self.task.say(&words);
        }
    }

    fn refused(&mut self, why: &Refused) {
        self.print(&json!({"event": "refused", "message": why.to_string()}));
        if self.keys.is_some() {
            self.task.say(&why.to_string());
        }
    }

    fn is_there(&self) -> bool {
        self.keys.is_some()
    }
}

/// What a terminal says of a state.
const fn words(state: State) -> Option<&'static str> {
    match state {
        State::Pausing => Some("pauses after this stroke"),
        State::Paused => Some("paused, dark: Space goes on"),
        State::Stopped => Some("stopped, dark: A arms, then Enter goes on; Q ends"),
        State::Returning => Some("dark, on its way back to the stroke"),
        State::Armed => Some("armed for 10 s: Enter goes on"),
        _ => None,
    }
}

impl Clock {
    /// Waits until the next tick is due.
    fn wait(&mut self) {
        self.ticks += 1;
        let due = Duration::from_secs_f64(self.ticks as f64 * TICK_F64_S / self.factor);
        let began = *self.began.get_or_insert_with(Instant::now);
        let early = due.saturating_sub(began.elapsed());
        if early > EARLY {
            std::thread::sleep(early);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn speeds_go_up_and_down_and_end() {
        assert_eq!([faster(1.0), faster(0.3), faster(2.0)], [1.25, 0.5, 2.0]);
        assert_eq!([slower(1.0), slower(0.3), slower(0.1)], [0.75, 0.25, 0.1]);
    }
}
