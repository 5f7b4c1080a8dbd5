//! The gang of four: what a loop of plant and controller makes of setpoints, disturbances and noise, over frequency.

mod figure;
mod view;

use tracelight_chart::{Colour, Theme};
use tracelight_linear::{DataPeak, FrequencyResponse, LoopMember, Norm, Peak};
use tracelight_maths::complex;
use tracelight_task::{Failure, Task};

use crate::closing::Around;
use crate::finding::Experiment;
use crate::frequencies::Frequencies;
use crate::named::Named;
use crate::systems::bounded;

/// Plants, and controllers each of which is put into a loop with each plant.
#[derive(Clone, Debug)]
pub struct Request {
    /// The plants, and over which frequencies.
    pub plants: Frequencies,
    /// The controllers, each a formula as the plants are; sampled by Tustin's rule where plants are sampled.
    pub controllers: Vec<String>,
}

/// What each loop does.
pub struct Finding {
    theme: Theme,
    loops: Vec<Entry>,
}

/// A loop and what is known of it.
struct Entry {
    name: String,
    colour: Colour,
    /// What is plant and what controller, for people.
    parts: [String; 2],
    /// The open loop: its margins are the loop's.
    open: Named,
    /// S, T, PS and CS.
    members: Vec<Member>,
}

/// One of the four.
struct Member {
    which: LoopMember,
    response: FrequencyResponse,
    peak: Highest,
}

/// The largest gain of a transfer function.
#[derive(Clone, Copy)]
enum Highest {
    /// Of a loop whose poles are known: the norm, or why there is none.
    Norm(Norm),
    /// Inside measured data.
    Data(DataPeak),
    /// Of measured data of a loop that is not stable there is no norm.
    Unstable,
}

impl Highest {
    const fn peak(self) -> Option<Peak> {
        match self {
            Self::Norm(norm) => norm.peak(),
            Self::Data(data) => Some(data.peak),
            Self::Unstable => None,
        }
    }
}

impl Experiment for Request {
    type Finding = Finding;

    fn run(self, task: Task<'_>) -> Result<Finding, Failure> {
        let loops = self.loops()?;
        bounded(self.plants.points, LoopMember::ALL.len() * loops.len())?;
        let shown: Vec<&Named> = loops.iter().flat_map(|of| [&of.open, &of.plant]).collect();
        let rad_s = self.plants.over(&shown)?;
        let mut entries = Vec::new();
        for (of, colour) in loops.into_iter().zip(Colour::in_turn()) {
            task.check()?;
            entries.push(Entry::of(of, &rad_s, colour)?);
        }
        Ok(Finding { theme: self.plants.systems.theme, loops: entries })
    }
}

impl Request {
    fn loops(&self) -> Result<Vec<Around>, Failure> {
        let systems = &self.plants.systems;
        let mut loops = Vec::new();
        for formula in &self.controllers {
            let controllers = systems.controllers(std::slice::from_ref(formula))?;
            let plants = systems.beside(controllers.iter())?;
            let Some(controller) = controllers.into_iter().next() else { continue };
            for plant in plants {
                let name = format!("{} with {}", plant.name, formula.trim());
                loops.push(Around::new(plant, controller.clone(), name, systems.positive)?);
            }
        }
        Ok(loops)
    }
}

impl Entry {
    fn of(of: Around, rad_s: &[f64], colour: Colour) -> Result<Self, Failure> {
        let members = LoopMember::ALL.map(|which| Member::of(&of, which, rad_s));
        let parts = [&of.plant, &of.controller].map(Named::text);
        let members = members.into_iter().collect::<Result<_, Failure>>()?;
        Ok(Self { name: of.open.name.clone(), colour, parts, open: of.open, members })
    }
}

impl Member {
    fn of(of: &Around, which: LoopMember, rad_s: &[f64]) -> Result<Self, Failure> {
        let named = of.member(which, of.open.name.clone())?;
        let peak = match (of.function(which), &of.open.data) {
            (None, Some(data)) => match of.open.counted() {
                Some(Ok(1..)) => Highest::Unstable,
                _ => Highest::Data(data.highest(|w, open| complex::norm(of.value(which, w, open)))),
            },
            (Some(function), _) => Highest::Norm(function.h_infinity()),
            (None, None) => Highest::Unstable,
        };
        Ok(Self { which, response: named.frequency_response(rad_s.to_vec()), peak })
    }
}
