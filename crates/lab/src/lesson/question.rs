//! What a lesson asks, and how an answer is graded.

use tracelight_sim::RigConfig;

use super::check::Check;
use super::experiment::{Experiment, Quantity};

/// A lesson.
#[derive(Clone, Copy, Debug)]
pub struct Lesson {
    /// From 1.
    pub number: usize,
    /// In a few words.
    pub title: &'static str,
    /// What an answer consists of, in the order of its values.
    pub asks: &'static [Ask],
    /// Answers that show something, with their names.
    pub examples: &'static [(&'static str, &'static [f64])],
    /// What the plot shows: of which experiment which quantity.
    pub panels: &'static [(usize, Quantity)],
    /// The head, where it is not the preset `report`.
    pub rig: Option<fn() -> RigConfig>,
    pub(super) run: fn(&[f64]) -> Vec<Experiment>,
    pub(super) check: fn(&[f64], &[Experiment]) -> Vec<Check>,
}

/// A number that an answer has to have.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ask {
    /// As in `--answer`.
    pub name: &'static str,
    /// Its unit; the number is bare.
    pub unit: &'static str,
    /// Lowest and highest.
    pub bounds: (f64, f64),
    /// What it is.
    pub meaning: &'static str,
}

/// An answer, simulated.
#[derive(Clone, Debug)]
pub struct Graded {
    /// What was simulated.
    pub experiments: Vec<Experiment>,
    /// What it must be like.
    pub checks: Vec<Check>,
}

impl Graded {
    /// Whether the answer is right.
    pub fn is_right(&self) -> bool {
        self.checks.iter().all(Check::is_met)
    }
}

impl Lesson {
    /// Simulates an answer: a value for each of [`Lesson::asks`], within its bounds.
    pub fn grade(&self, values: &[f64]) -> Graded {
        let experiments = (self.run)(values);
        let checks = (self.check)(values, &experiments);
        Graded { experiments, checks }
    }

    /// What is tried in the lesson's experiments with those values.
    pub fn experiments(&self, values: &[f64]) -> Vec<Experiment> {
        (self.run)(values)
    }
}
