//! The program behind the page.

use serde_json::Value;
use tracelight_task::{Failure, Progress, Stop};

/// Does what command lines say: whatever the page asks for is one, and nothing else.
pub trait Program: Send + Sync + 'static {
    /// Names of the heads that a page may choose: simulated ones, that no file and no port has to be read for.
    fn rigs(&self) -> Vec<String>;

    /// The head that a page's jobs are drawn with unless it chooses one of those; the program's own default where there is none.
    fn head(&self) -> Option<&Head> {
        None
    }

    /// Cameras that are plugged in, or that were named when the studio was opened.
    fn cameras(&self) -> Vec<Camera> {
        Vec::new()
    }

    /// Looks through the camera of a command line of `calibrate look`, and shows one image after the other, as JPEG and by what is in it, until `each` wants no more.
    ///
    /// # Errors
    /// What is wrong with it, or what the camera fails with.
    fn look(
        &self,
        arguments: &[String],
        stop: &Stop,
        each: &mut dyn FnMut(Vec<u8>, Value) -> bool,
    ) -> Result<(), Failure>;

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

/// A head that the studio was opened for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Head {
    /// The value of `--rig` by which it draws.
    pub draws_as: String,
    /// The value of `--rig` by which it is planned for and simulated.
    pub planned_as: String,
    /// Its board is at a port, and keeps time by itself.
    pub is_at_port: bool,
    /// Its board says that it moves a real head, or what it says is not known.
    pub is_real: bool,
}

/// A camera that pages may look through.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Camera {
    /// What pages call it: letters and digits.
    pub id: String,
    /// What people call it.
    pub name: String,
    /// The value of `--camera`.
    pub source: String,
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
    /// What it prints for people, where it was asked for that.
    pub text: String,
    /// The command did its work, and what it worked on failed.
    pub failure: Option<Failure>,
}
