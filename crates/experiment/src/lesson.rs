//! Lessons on control: a text, a question, an answer that the simulator grades.

mod plot;
mod text;
mod view;

use tracelight_lab::{Graded, Lesson};
use tracelight_sim::RigConfig;
use tracelight_task::{Failure, Task};

use crate::finding::Experiment;

/// A lesson, and perhaps an answer to its question.
#[derive(Clone, Debug)]
pub struct Request {
    /// The lesson.
    pub lesson: Lesson,
    /// The answer's values, in the order in which the lesson asks for them.
    pub answer: Option<Vec<f64>>,
}

/// The lesson, or what its answer came to.
pub struct Finding {
    lesson: Lesson,
    graded: Option<Graded>,
}

/// All lessons.
pub struct List;

impl Experiment for Request {
    type Finding = Finding;

    fn run(self, _: Task<'_>) -> Result<Finding, Failure> {
        let graded = self.answer.as_deref().map(|values| self.lesson.grade(values));
        Ok(Finding { lesson: self.lesson, graded })
    }
}

impl Finding {
    /// Whether there is an answer.
    #[must_use]
    pub const fn is_answered(&self) -> bool {
        self.graded.is_some()
    }

    /// What is said of an answer that is not right yet.
    #[must_use]
    pub fn not_yet(&self) -> Option<Failure> {
        let checks = &self.graded.as_ref()?.checks;
        let unmet = checks.iter().filter(|check| !check.is_met()).count();
        let message = format!("{unmet} of {} figures not met yet", checks.len());
        (unmet > 0).then(|| Failure::failed("not-yet", message))
    }

    /// The rig that the lesson is on, where it is not the preset `report`.
    #[must_use]
    pub fn rig(&self) -> Option<RigConfig> {
        self.lesson.rig.map(|rig| rig())
    }
}
