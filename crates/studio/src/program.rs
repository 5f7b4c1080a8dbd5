//! The program behind the page.

use serde_json::Value;
use tracelight_task::{Failure, Progress, Stop};

/// Does what command lines say: whatever the page asks for is one, and nothing else.
pub trait Program: Send + Sync + 'static {
    /// Names of the heads that a page may choose: simulated ones, that no file and no port has to be read for.
    fn rigs(&self) -> Vec<String>;

    /// Whether somebody who attends a job may ask that of it.
    fn knows(&self, wish: &str) -> bool;

    /// Does what a command line says, without the program's name, in this process. Whoever has a seat attends the job that it is.
    ///
    /// # Errors
    /// What is wrong with it, or what failed before there was anything to answer.
    fn perform(
        &self,
        arguments: &[String],
        seat: Option<&dyn Seat>,
        task: (&dyn Progress, &Stop),
    ) -> Result<Performed, Failure>;
}

/// Where somebody sits who attends a job.
pub trait Seat: Sync {
    /// What is asked of the job next, by its word, if anything is. Never waits.
    fn wish(&self) -> Option<String>;

    /// Told what happens, as one JSON object. Never waits.
    fn tell(&self, event: &Value);
}

/// What a command line has done.
#[derive(Clone, Debug)]
pub struct Performed {
    /// What it prints with `--json`: one JSON object.
    pub json: String,
    /// The command did its work, and what it worked on failed.
    pub failure: Option<Failure>,
}
