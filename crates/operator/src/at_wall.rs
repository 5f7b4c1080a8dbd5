//! Somebody at the wall: keys and the clock to a job, what happens to a terminal or a script.

use std::io::Write as _;
use std::time::{Duration, Instant};

use serde_json::{Value, json};
use tracelight_job::{Ask, Hands, Look, Sighting, Step};
use tracelight_pipeline::{Check, point_json, point_words};
use tracelight_rig::TICK_F64_S;
use tracelight_session::{
    Event, Refused, Request, Snapshot, State, When, event_json, faster, slower, snapshot_json,
};
use tracelight_stroke::Place;
use tracelight_task::{Pace, Stop, Task};

use crate::keys::{Key, Keys};
use crate::seat::{Seat, Wish};

/// What the keys do.
const HELP: &str = "keys: Space pauses after this stroke, and goes on; P pauses at once; Esc stops; A arms, Enter goes on after that; + and − change the speed, \
                    = sets 100 %; C clears a fault; Q ends; ? shows this";
/// What they do where strokes are drawn one at a time.
const STEP_HELP: &str = "keys: Space, Enter, → or a pedal: this one is done, the next one; ← the one before; S skips this one; P pauses, Space goes on; Esc stops; A arms, Enter goes on \
                         after that; + and − change the speed; C clears a fault; Q ends; ? shows this";
/// What they do while the frame is drawn.
const FRAME_HELP: &str = "keys: the frame is drawn until Space, Enter or → begins the drawing; P pauses, Space goes on; Esc stops; A arms, Enter goes on after that; \
                          + and − change the speed; C clears a fault; Q ends; ? shows this";
/// How often progress is told, ticks of the rig.
const PROGRESS_TICKS: u32 = 250;
/// How often whoever has a seat is told it.
const SEAT_EACH: Duration = Duration::from_millis(40);

/// How somebody at the wall attends a job.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Attending {
    /// How many times as fast as real time a simulated rig runs; as fast as it can where there is none.
    pub real_time: Option<f64>,
    /// The rig keeps time by itself, as one behind a port does.
    pub keeps_time: bool,
    /// They arm before the first light; otherwise who starts the program has done that.
    pub arms: bool,
    /// How long to stay on one stroke or point before the next, s; until a key is pressed where there is none.
    pub each_s: Option<f64>,
    /// The frame of the drawing comes first.
    pub framing: bool,
    /// Strokes or points are drawn one at a time.
    pub steps: bool,
    /// Events are printed as JSON lines.
    pub events: bool,
}

/// Keys, clock and events of one job.
pub struct AtWall<'a> {
    how: Attending,
    task: Task<'a>,
    stop: &'a Stop,
    clock: Option<Pace>,
    keys: Option<Keys>,
    /// Who attends from elsewhere, and when he was last told how far it is.
    seat: Option<&'a dyn Seat>,
    seat_told: Option<Instant>,
    /// Strokes mark points.
    points: bool,
    /// The frame is drawn.
    framing: bool,
    /// How a camera looks into what is off, if it does.
    look: Option<Look>,
    /// A key has armed it once: before, the program arms for whoever started it.
    armed: bool,
    /// The last key paused it at once.
    at_once: bool,
    /// After so many ticks on one stroke or point the next one follows.
    each_ticks: Option<u32>,
    /// Tick since which it is on one.
    on_it_since: Option<u32>,
}

impl<'a> AtWall<'a> {
    /// Whoever stands there, or sits elsewhere, if the job runs by hand at all.
    #[must_use]
    pub fn of(how: Attending, seat: Option<&'a dyn Seat>, task: Task<'a>, stop: &'a Stop) -> Option<Self> {
        let Attending { real_time, keeps_time, each_s, framing, steps, events, .. } = how;
        let by_the_clock = real_time.is_some() || keeps_time;
        if !by_the_clock && !events && !steps && seat.is_none() {
            return None;
        }
        Some(Self {
            how,
            task,
            stop,
            clock: real_time.filter(|_| !keeps_time).map(|factor| Pace::new(TICK_F64_S / factor)),
            // a terminal from which somebody else is served is not his
            keys: (by_the_clock && seat.is_none()).then(Keys::listen).flatten(),
            seat,
            seat_told: None,
            points: false,
            framing,
            look: None,
            armed: false,
            at_once: false,
            each_ticks: each_s.map(|time_s| (time_s / TICK_F64_S) as u32),
            on_it_since: None,
        })
    }

    fn help(&self) {
        self.task.say(match (self.framing, self.how.steps) {
            (true, _) => FRAME_HELP,
            (false, true) => STEP_HELP,
            (false, false) => HELP,
        });
    }

    /// Tells what was looked at before any light.
    pub fn preflight(&self, checks: &[Check]) {
        self.print(&json!({"event": "preflight", "checks": checks}));
        if self.keys.is_some() {
            checks.iter().for_each(|check| self.task.say(&check.line()));
            self.help();
            if self.how.arms {
                self.task.say("dark until somebody arms it: A arms, then Enter begins within 10 s");
            }
        }
    }

    /// What a key asks for here.
    fn meaning(&self, key: Key, now: &Snapshot) -> Option<Request> {
        let is_on = now.state.is_on();
        match key {
            Key::Space if is_on => Some(Request::Pause(When::AfterStroke)),
            Key::Space | Key::Enter => Some(Request::Resume),
            Key::Escape => Some(Request::Stop),
            // the first darkens, the second ends
            Key::Interrupt if self.look == Some(Look::Begun) => Some(Request::Stop),
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
                self.help();
                None
            }
            Key::Forwards | Key::Backwards | Key::Char(_) => None,
        }
    }

    /// Which stroke a key asks for here, where strokes are drawn one at a time.
    fn step(&self, key: Key, now: &Snapshot) -> Option<Step> {
        let is_on = now.state.is_on() || now.state == State::Parking;
        match key {
            _ if !self.how.steps && !self.framing => None,
            Key::Backwards | Key::Char('s') if self.framing => None,
            Key::Space | Key::Enter if is_on => Some(Step::Next),
            Key::Forwards => Some(Step::Next),
            Key::Backwards => Some(Step::Previous),
            Key::Char('s') => Some(Step::Skip),
            _ => None,
        }
    }

    /// How far it is, and, where a clock is kept, how well.
    fn progress(&self, now: &Snapshot) -> Value {
        let mut told = snapshot_json(now);
        if let Some((late, latest_s)) = self.clock.map(|clock| clock.lateness()) {
            told["late_ticks"] = json!(late);
            told["latest_ms"] = json!(1e3 * latest_s);
        }
        told
    }

    /// Tells who has a seat how far it is, and hears what he asks.
    fn seated(&mut self, now: &Snapshot) -> Option<Ask> {
        let seat = self.seat?;
        if self.seat_told.is_none_or(|told| told.elapsed() >= SEAT_EACH) {
            self.seat_told = Some(Instant::now());
            seat.tell(&self.progress(now));
        }
        let wish = seat.wish()?;
        if wish == Wish::End {
            self.stop.want();
        }
        Some(wish.ask())
    }

    /// The next one, where it is time for it by itself. One that was paused has its whole time again.
    fn by_itself(&mut self, now: &Snapshot) -> Option<Ask> {
        let each = self.each_ticks?;
        if !matches!(now.state, State::Stepping | State::Pointing) {
            self.on_it_since = None;
            return None;
        }
        let since = *self.on_it_since.get_or_insert(now.tick);
        let is_time = now.laps > 0 && now.tick.saturating_sub(since) >= each;
        is_time.then_some(Ask::Step(Step::Next))
    }

    /// Prints an event. Where nobody reads them any more the job ends, and its results are kept.
    fn print(&self, event: &Value) {
        self.seat.iter().for_each(|seat| seat.tell(event));
        if self.how.events && writeln!(std::io::stdout(), "{event}").is_err() {
            self.stop.want();
        }
    }
}

impl Hands for AtWall<'_> {
    fn tick(&mut self, now: &Snapshot) -> Option<Ask> {
        if let Some(clock) = &mut self.clock {
            clock.wait();
        }
        if let Some(ask) = self.seated(now) {
            return Some(ask);
        }
        if self.seat.is_none() && now.tick.is_multiple_of(PROGRESS_TICKS) {
            self.print(&self.progress(now));
        }
        let Some(key) = self.keys.as_ref().and_then(Keys::next) else { return self.by_itself(now) };
        if let Some(step) = self.step(key, now) {
            return Some(Ask::Step(step));
        }
        let request = self.meaning(key, now)?;
        self.armed |= request == Request::Arm;
        self.at_once = request == Request::Pause(When::AtOnce);
        if let Request::Speed(speed) = request {
            self.task.say(&format!("speed {:.0} %", 100.0 * speed));
        }
        Some(Ask::Request(request))
    }

    fn left(&mut self, number: u32, done: bool) {
        let word = if self.points { "point" } else { "stroke" };
        self.print(&json!({"event": "left", word: number + 1, "done": done}));
    }

    fn frames(&mut self, on: bool) {
        self.framing = on;
        self.print(&json!({"event": "frame", "on": on}));
        if !on && self.keys.is_some() {
            self.help();
        }
    }

    fn looks(&mut self, look: Look) {
        self.look = Some(look).filter(|look| *look != Look::Over);
        self.print(&json!({"event": "looks", "state": look.name()}));
        if self.keys.is_some() && !self.stop.is_wanted() {
            self.task.say(match look {
                Look::Begun => {
                    "something is off: the camera looks into it, in the dark and by dots; Esc stops that"
                }
                Look::Stopped => "stopped, dark: A arms, then Enter lets the camera begin again; Q ends",
                Look::Over => "the camera is done with it",
            });
        }
    }

    fn sees(&mut self, sighting: &Sighting) {
        let Sighting { seen, asked, rms_m, images } = sighting;
        let mm = |m: f64| 1e3 * m;
        self.print(&json!({
            "event": "seen", "x_mm": mm(seen.x), "y_mm": mm(seen.y), "asked_x_mm": mm(asked.x), "asked_y_mm": mm(asked.y),
            "off_mm": mm(seen.distance(*asked)), "rms_mm": mm(*rms_m), "images": images,
        }));
    }

    fn goes_to(&mut self, point: &Place, number: u32, of: u32) {
        self.points = true;
        self.print(&point_json(point, (number, of)));
        self.task.say(&point_words(point, (number, of)));
    }

    fn event(&mut self, event: &Event) {
        let words = match *event {
            // who starts the program has armed it
            Event::State { tick: 0, .. } => None,
            // what the camera has the head do is nobody's to go on with, and who ends it knows
            Event::State { .. } | Event::Fault(_) if self.look.is_some() || self.stop.is_wanted() => None,
            Event::State { to: State::Armed, .. } if !self.armed => None,
            Event::State { to: State::Pausing, .. } if self.at_once => None,
            Event::State { from: State::Armed, to: State::Ready | State::Unhomed, .. } => {
                Some("no longer armed: A arms".to_owned())
            }
            Event::State { to, .. } => words(to).map(str::to_owned),
            Event::Stroke { stroke, of, .. } => {
                (self.how.steps && !self.points).then(|| format!("stroke {} of {of}", stroke + 1))
            }
            Event::NotBegun { why, .. } => Some(why.to_string()),
            Event::Fault(record) => Some(format!("fault {record} (C clears it)")),
        };
        self.armed &= !matches!(event, Event::State { to: State::Armed, .. });
        self.print(&event_json(event));
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

    fn arms(&self) -> bool {
        self.how.arms
    }

    fn is_there(&self) -> bool {
        self.keys.is_some() || self.seat.is_some()
    }
}

/// What a terminal says of a state.
const fn words(state: State) -> Option<&'static str> {
    match state {
        State::Pausing => Some("pauses after this stroke"),
        State::Paused => Some("paused, dark: Space goes on"),
        State::Stopped => Some("stopped, dark: A arms, then Enter goes on; Q ends"),
        State::Returning => Some("dark, on its way back to the stroke"),
        State::Armed => Some("armed for 10 s: Enter begins, or goes on"),
        State::Unhomed => Some("dark: the head does not know any more where it points; Q ends"),
        _ => None,
    }
}
