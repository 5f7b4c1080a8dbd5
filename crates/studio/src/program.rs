//! The program behind the page.

use tracelight_task::{Failure, Progress, Stop};

/// Does what command lines say: whatever the page asks for is one, and nothing else.
pub trait Program: Send + Sync + 'static {
    /// Names of the heads that a page may choose: simulated ones, that no file and no port has to be read for.
    fn rigs(&self) -> Vec<String>;

    /// Does what a command line says, without the program's name, in this process.
    ///
    /// # Errors
    /// What is wrong with it, or what failed before there was anything to answer.
    fn perform(
        &self,
        arguments: &[String],
        progress: &dyn Progress,
        stop: &Stop,
    ) -> Result<Performed, Failure>;
}

/// What a command line has done.
#[derive(Clone, Debug)]
pub struct Performed {
    /// What it prints with `--json`: one JSON object.
    pub json: String,
    /// The command did its work, and what it worked on failed.
    pub failure: Option<Failure>,
}
