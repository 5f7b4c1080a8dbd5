//! Eight lessons on a joint's loop: what is tried, what is asked, and how an answer is graded by simulating it.
//!
//! The order is that of K. J. Åström and R. M. Murray, *Feedback Systems* (2nd ed., 2021), ch. 11, and of the same authors' PID:
//! a spring, a damper, what takes away the rest, and then what is in the way on a real head.

mod counts;
mod feedforward;
mod friction;
mod overshoot;
mod pd;
mod proportional;
mod rigs;
mod two_degrees;
mod windup;

use tracelight_rig::{Joint, TICK_F64_S};
use tracelight_sim::{BenchTick, RigConfig};

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
    run: fn(&[f64]) -> Vec<Experiment>,
    check: fn(&[f64], &[Experiment]) -> Vec<Check>,
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

/// Something a joint did.
#[derive(Clone, Debug)]
pub struct Experiment {
    /// What was done.
    pub name: String,
    /// Which joint is looked at.
    pub joint: Joint,
    /// What happened.
    pub ticks: Vec<BenchTick>,
}

/// What a panel shows over time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// True angle, °.
    Angle,
    /// Setpoint less true angle, mm on a target 3 ft away.
    Error,
    /// V at the amplifier.
    Command,
    /// What the observer says, rad/s.
    Speed,
}

/// A figure of the simulation, and what it must be.
#[derive(Clone, Debug, PartialEq)]
pub struct Check {
    /// Which figure.
    pub what: String,
    /// Its unit.
    pub unit: &'static str,
    /// What it was; NaN where it never was anything.
    pub value: f64,
    /// The least it must be,
    pub least: f64,
    /// and the most.
    pub most: f64,
    /// What helps when it is too small,
    pub if_less: &'static str,
    /// and when it is too large, or never was anything.
    pub if_more: &'static str,
}

impl Check {
    fn at_most(
        what: impl Into<String>,
        value: f64,
        most: f64,
        unit: &'static str,
        hint: &'static str,
    ) -> Self {
        Self { what: what.into(), unit, value, least: f64::NEG_INFINITY, most, if_less: "", if_more: hint }
    }

    /// Whether it is.
    pub fn is_met(&self) -> bool {
        (self.least..=self.most).contains(&self.value)
    }

    /// What helps.
    pub fn hint(&self) -> &'static str {
        if self.value < self.least { self.if_less } else { self.if_more }
    }
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
    /// Every lesson.
    pub const ALL: [Self; 8] = [
        proportional::LESSON,
        overshoot::LESSON,
        pd::LESSON,
        windup::LESSON,
        counts::LESSON,
        friction::LESSON,
        feedforward::LESSON,
        two_degrees::LESSON,
    ];

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

impl Quantity {
    /// With its unit.
    pub const fn title(self) -> &'static str {
        match self {
            Self::Angle => "angle, °",
            Self::Error => "error, mm",
            Self::Command => "command, V",
            Self::Speed => "speed as seen, rad/s",
        }
    }

    /// In a tick.
    pub fn of(self, tick: &BenchTick, joint: Joint) -> f64 {
        match self {
            Self::Angle => tick.angle_rad[joint].to_degrees(),
            Self::Error => rigs::mm(f64::from(tick.setpoint[joint].position_rad) - tick.angle_rad[joint]),
            Self::Command => f64::from(tick.command_v[joint]),
            Self::Speed => f64::from(tick.estimates[joint].velocity_rad_s),
        }
    }
}

impl Experiment {
    /// True angles, rad, a tick each.
    fn angles_rad(&self) -> Vec<f64> {
        self.ticks.iter().map(|tick| tick.angle_rad[self.joint]).collect()
    }

    /// Of a step to `to_rad`.
    fn figures(&self, to_rad: f64) -> crate::StepFigures {
        crate::StepFigures::of(&self.angles_rad(), to_rad, TICK_F64_S)
    }
}
