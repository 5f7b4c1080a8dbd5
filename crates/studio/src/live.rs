//! A job that people attend from pages: one of them operates it, the others look on, and anybody stops it.
//!
//! ```text
//! page ─ wish, "here" ─► Live ─► the job, tick by tick        job ─ events, progress ─► Live ─► every page
//! ```
//!
//! The operator's page says all the time that it is there. One that is silent for [`PAUSED`] pauses the job at its stroke's end, after [`DARK`] it is stopped: whoever operates it is lost. What is
//! stopped is armed anew before there is light, by whomever.

use std::collections::VecDeque;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use serde_json::{Value, json};
use tokio::sync::broadcast;

use crate::program::Seat;

/// How long the operator's page may be silent before the job pauses, and before it is stopped.
const PAUSED: Duration = Duration::from_millis(1200);
const DARK: Duration = Duration::from_millis(1800);
/// How long an operator has to refuse another one.
const ASKED: Duration = Duration::from_secs(5);
/// Events that a page may be behind; one that reads no more loses the oldest.
const MOST_BEHIND: usize = 512;
/// Wishes that wait for a tick.
const MOST_WISHES: usize = 64;
/// Kinds of events of which a page is told the last one that comes later.
const KEPT: [&str; 7] = ["head", "preflight", "frame", "point", "fault", "looks", "seen"];
/// What stops a job, whoever says it.
const STOP: &str = "stop";

/// What pages and a job say to each other.
#[derive(Debug)]
pub(crate) struct Live {
    told: broadcast::Sender<String>,
    state: Mutex<State>,
}

#[derive(Debug, Default)]
struct State {
    wishes: VecDeque<String>,
    /// How strokes are drawn: all, one at a time, or points.
    mode: &'static str,
    /// Who operates the job: as long as one goes on there is one.
    operator: Option<Operator>,
    /// Another page that wants to operate it, and since when.
    wants: Option<(String, Instant)>,
    /// What a page is told first that comes in the middle: the last event of each kind that says how things stand.
    earlier: Vec<(String, String)>,
    progress: Option<String>,
}

impl State {
    /// Whether a job may be asked anything.
    const fn is_on(&self) -> bool {
        self.operator.is_some()
    }

    /// Stops the job: whatever else was asked is not wanted any more.
    fn stop(&mut self) {
        self.wishes.clear();
        self.wishes.push_back(STOP.to_owned());
    }

    /// The operator, if a page is that.
    fn operated_by(&mut self, page: &str) -> Option<&mut Operator> {
        self.operator.as_mut().filter(|operator| operator.page == page)
    }
}

#[derive(Debug)]
struct Operator {
    page: String,
    heard: Instant,
    /// What its silence has brought about already.
    lost: Lost,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd)]
enum Lost {
    There,
    Paused,
    Dark,
}

impl Operator {
    /// A page that operates from now on.
    fn new(page: &str) -> Self {
        Self { page: page.to_owned(), heard: Instant::now(), lost: Lost::There }
    }
}

impl Live {
    pub(crate) fn new() -> Self {
        Self { told: broadcast::channel(MOST_BEHIND).0, state: Mutex::default() }
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn say(&self, event: &Value) {
        // nobody may be there
        let _ = self.told.send(event.to_string());
    }

    /// A job begins, which that page operates.
    pub(crate) fn begin(&self, page: &str, mode: &'static str) {
        *self.state() = State { operator: Some(Operator::new(page)), mode, ..State::default() };
        self.say(&json!({ "event": "begun", "operator": page, "mode": mode }));
    }

    /// The job is over: nothing is asked of it any more.
    pub(crate) fn end(&self) {
        *self.state() = State::default();
        self.say(&json!({ "event": "over" }));
    }

    pub(crate) fn is_on(&self) -> bool {
        self.state().is_on()
    }

    /// Whether the job has told how far it is: before, nothing of what is asked is heard.
    pub(crate) fn has_begun(&self) -> bool {
        self.state().progress.is_some()
    }

    /// Stops the job, before whatever else was asked; whether there was one.
    pub(crate) fn stop(&self) -> bool {
        let mut state = self.state();
        if state.is_on() {
            state.stop();
        }
        state.is_on()
    }

    /// A page's line: what it is told first, and then whatever happens.
    pub(crate) fn join(&self) -> (Vec<String>, broadcast::Receiver<String>) {
        let state = self.state();
        let operator = state.operator.as_ref().map(|operator| &operator.page);
        let first = json!({ "event": "live", "on": state.is_on(), "operator": operator, "mode": state.mode });
        let first = first.to_string();
        let all = std::iter::once(first)
            .chain(state.earlier.iter().map(|(_, text)| text.clone()))
            .chain(state.progress.clone());
        (all.collect(), self.told.subscribe())
    }

    /// What a page asks. Whoever does not operate the job may stop it, and ask to operate it.
    ///
    /// # Errors
    /// Why that is refused, for who asked.
    pub(crate) fn ask(&self, page: &str, wish: &str) -> Result<(), String> {
        if wish == STOP {
            return if self.stop() { Ok(()) } else { Err("nothing is traced".to_owned()) };
        }
        let mut state = self.state();
        if !state.is_on() {
            return Err("nothing is traced".to_owned());
        }
        match (wish, state.operated_by(page).is_some()) {
            ("take", true) => {
                drop(state);
                self.say(&json!({ "event": "operator", "page": page }));
            }
            ("take", false) => {
                state.wants = Some((page.to_owned(), Instant::now()));
                drop(state);
                self.say(&json!({ "event": "asks", "page": page }));
            }
            ("refuse", true) => {
                let refused = state.wants.take();
                drop(state);
                if let Some((page, _)) = refused {
                    self.say(&json!({ "event": "refuses", "page": page }));
                }
            }
            (_, false) => return Err("another page operates it: take it over first".to_owned()),
            _ if state.wishes.len() >= MOST_WISHES => return Err("too much is asked at once".to_owned()),
            _ => state.wishes.push_back(wish.to_owned()),
        }
        Ok(())
    }

    /// Whether a page may end the job.
    pub(crate) fn may_end(&self, page: &str) -> bool {
        self.state().operated_by(page).is_some()
    }

    /// A page is there.
    pub(crate) fn hear(&self, page: &str) {
        if let Some(operator) = self.state().operated_by(page) {
            (operator.heard, operator.lost) = (Instant::now(), Lost::There);
        }
    }

    /// Looks whether the operator is still there, and whether another one becomes it.
    pub(crate) fn look(&self) {
        let mut state = self.state();
        let State { operator, wants, wishes, .. } = &mut *state;
        let Some(operator) = operator else { return };
        let silent = operator.heard.elapsed();
        let mut stops = false;
        if silent >= DARK && operator.lost < Lost::Dark {
            operator.lost = Lost::Dark;
            // in any state
            stops = true;
            self.say(&json!({ "event": "lost", "dark": true }));
        } else if silent >= PAUSED && operator.lost < Lost::Paused {
            operator.lost = Lost::Paused;
            wishes.push_back("pause".to_owned());
            self.say(&json!({ "event": "lost", "dark": false }));
        }
        let is_granted = |since: &Instant| since.elapsed() >= ASKED || operator.lost > Lost::There;
        if let Some((page, _)) = wants.take_if(|(_, since)| is_granted(since)) {
            // it passes dark, and what its former operator asked is not wanted any more: who has it now arms it
            stops = true;
            *operator = Operator::new(&page);
            self.say(&json!({ "event": "operator", "page": page }));
        }
        if stops {
            state.stop();
        }
    }
}

impl Seat for Live {
    fn wish(&self) -> Option<String> {
        self.state().wishes.pop_front()
    }

    fn tell(&self, event: &Value) {
        let text = event.to_string();
        let mut state = self.state();
        let kind = event["event"].as_str().unwrap_or_default();
        if kind == "progress" {
            state.progress = Some(text.clone());
        } else if KEPT.contains(&kind) {
            state.earlier.retain(|(known, _)| known != kind);
            state.earlier.push((kind.to_owned(), text.clone()));
        }
        drop(state);
        let _ = self.told.send(text);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wishes(live: &Live) -> Vec<String> {
        std::iter::from_fn(|| live.wish()).collect()
    }

    #[test]
    fn one_page_operates_and_anybody_stops() {
        let live = Live::new();
        assert!(live.ask("a", "arm").is_err() && live.ask("a", "stop").is_err() && !live.stop());
        live.begin("a", "trace");
        assert!(live.ask("a", "arm").is_ok());
        assert!(live.ask("b", "go-on").unwrap_err().contains("another page operates it"));
        assert!(live.ask("b", "stop").is_ok());
        // what was asked before is not wanted any more
        assert_eq!(wishes(&live), ["stop"]);
        live.end();
        assert!(live.ask("a", "arm").is_err());
    }

    #[test]
    fn an_operator_that_is_silent_pauses_and_then_darkens_once() {
        let live = Live::new();
        live.begin("a", "trace");
        live.look();
        assert!(wishes(&live).is_empty());
        let silent = |for_how_long: Duration| {
            live.state().operator.as_mut().unwrap().heard = Instant::now() - for_how_long;
            live.look();
            wishes(&live)
        };
        assert_eq!(silent(PAUSED), ["pause"]);
        assert!(silent(PAUSED).is_empty());
        // whatever was asked before
        live.ask("a", "go-on").unwrap();
        assert_eq!(silent(DARK), ["stop"]);
        assert!(silent(3 * DARK).is_empty());
        live.hear("b");
        assert!(silent(3 * DARK).is_empty(), "another page is not the operator");
        live.hear("a");
        live.look();
        assert_eq!(silent(DARK), ["stop"]);
    }

    #[test]
    fn who_takes_it_over_waits_unless_the_operator_is_lost_and_gets_it_dark() {
        let live = Live::new();
        live.begin("a", "trace");
        live.ask("b", "take").unwrap();
        live.look();
        assert!(live.ask("b", "arm").is_err());
        live.ask("a", "refuse").unwrap();
        let waited = live.state().wants.take().map(|(page, _)| (page, Instant::now() - ASKED));
        live.state().wants = waited;
        live.look();
        assert!(wishes(&live).is_empty() && live.ask("b", "arm").is_err(), "it was refused");
        live.ask("b", "take").unwrap();
        live.ask("a", "arm").unwrap();
        let waited = live.state().wants.take().map(|(page, _)| (page, Instant::now() - ASKED));
        live.state().wants = waited;
        live.look();
        assert_eq!(wishes(&live), ["stop"]);
        assert!(live.ask("b", "arm").is_ok() && live.ask("a", "arm").is_err());
    }

    #[test]
    fn a_page_that_comes_later_is_told_what_was_said_before() {
        let live = Live::new();
        live.begin("a", "trace");
        live.tell(&json!({ "event": "preflight" }));
        for n in 0..100 {
            live.tell(&json!({ "event": "point", "point": n }));
            live.tell(&json!({ "event": "stroke", "stroke": n }));
        }
        for n in 0..3 {
            live.tell(&json!({ "event": "progress", "n": n }));
        }
        let (first, _) = live.join();
        assert_eq!(first.len(), 4);
        assert!(first[0].contains("\"operator\":\"a\"") && first[3].contains("\"n\":2"), "{first:?}");
        assert!(first[1].contains("preflight") && first[2].contains("\"point\":99"), "{first:?}");
    }
}
