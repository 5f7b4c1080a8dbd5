//! Work that goes on while the page is looked at: how far it is, what it remarked, how it ended.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Instant;

use serde_json::{Value, json};
use tracelight_task::{Failure, Progress, Stop, meaning};

/// A piece of work.
#[derive(Debug)]
pub(crate) struct Work {
    /// Its number.
    pub(crate) id: u64,
    /// Ends it early.
    pub(crate) stop: Stop,
    began: Instant,
    state: Mutex<State>,
}

#[derive(Debug, Default)]
struct State {
    stage: &'static str,
    done: u64,
    of: u64,
    remarks: Vec<String>,
    ended: Option<Ended>,
}

/// Ends a piece of work that ends in no other way.
pub(crate) struct AtLast(pub(crate) Arc<Work>);

impl Drop for AtLast {
    fn drop(&mut self) {
        if !self.0.is_over() {
            self.0.end(Ended { answer: Value::Null, failure: Some(broken()) });
        }
    }
}

/// Somebody who waits for a piece of work: without him it ends.
pub(crate) struct Wanting(pub(crate) Arc<Work>);

impl Drop for Wanting {
    fn drop(&mut self) {
        self.0.stop.want();
    }
}

/// What is told of work that panicked.
pub(crate) fn broken() -> Failure {
    Failure::failed("internal", "the work ended in a way that it must not: please tell us")
}

/// How it ended.
#[derive(Clone, Debug)]
pub(crate) struct Ended {
    /// What it answers.
    pub(crate) answer: Value,
    /// What went wrong.
    pub(crate) failure: Option<Failure>,
}

impl Work {
    pub(crate) fn new(id: u64) -> Arc<Self> {
        Arc::new(Self { id, stop: Stop::default(), began: Instant::now(), state: Mutex::default() })
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub(crate) fn end(&self, ended: Ended) {
        self.state().ended = Some(ended);
    }

    pub(crate) fn is_over(&self) -> bool {
        self.state().ended.is_some()
    }

    /// Remarks until now.
    pub(crate) fn remarks(&self) -> Vec<String> {
        self.state().remarks.clone()
    }

    /// For the page.
    pub(crate) fn json(&self) -> Value {
        let state = self.state();
        let ended = state.ended.as_ref();
        json!({
            "id": self.id, "stage": state.stage, "done": state.done, "of": state.of, "remarks": state.remarks,
            "over": ended.is_some(), "answer": ended.map(|ended| &ended.answer),
            "failure": ended.and_then(|ended| ended.failure.as_ref()).map(failure_json),
        })
    }
}

/// What went wrong, with what to do.
pub(crate) fn failure_json(failure: &Failure) -> Value {
    failure.object(&meaning(failure.code).unwrap_or_default())
}

impl Progress for Work {
    fn stage(&self, name: &'static str, steps: u64) {
        let mut state = self.state();
        (state.stage, state.done, state.of) = (name, 0, steps);
    }

    fn at(&self, step: u64) {
        self.state().done = step;
    }

    fn say(&self, message: &str) {
        const MOST: usize = 100;
        let mut state = self.state();
        if state.remarks.len() < MOST {
            state.remarks.push(message.strip_prefix("note: ").unwrap_or(message).to_owned());
        }
    }

    fn clock_s(&self) -> f64 {
        self.began.elapsed().as_secs_f64()
    }
}
