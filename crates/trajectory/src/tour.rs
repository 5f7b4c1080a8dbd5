//! Decides at both ends of every leg whether the spot rests or passes.
//!
//! Each leg may be run in four ways, from rest or under way to rest or under way. What that takes, and what the dark move
//! from one way to another takes, is estimated for all of them; the fastest sequence is found by dynamic programming; and
//! what it consists of is then timed tick by tick within the motors' torque. Where that takes longer than estimated the
//! choice is made again, until all of the fastest sequence is exact. What was timed is what is laid.

pub(crate) mod leg;
mod link;
pub(crate) mod run;

use tracelight_rig::PanTilt;
use tracelight_stroke::Drawing;

use crate::corner::Corners;
use crate::error::PlanError;
use crate::machine::Machine;
use crate::mark::Marked;
use crate::motion::JointMotion;
use crate::plan::check_duration;
use crate::request::{End, PlanRequest, Wait};
use leg::TourLeg;
use link::{Excess, Link, Sides};
use run::Run;

/// The tour from `home`, at rest, through all strokes to rest.
pub(crate) struct Tour<'a> {
    machine: &'a Machine,
    request: &'a PlanRequest,
    home: PanTilt<f64>,
    pub(crate) legs: Vec<TourLeg>,
    /// Before each leg, and after the last.
    links: Vec<Link>,
    excess: Excess,
    /// Why something that was looked at cannot be.
    refused: Option<PlanError>,
}

/// Why there is no tour.
pub(crate) enum NoTour {
    /// The leg that cannot be reached at speed, or left.
    NoWay(usize),
    Plan(PlanError),
}

impl<'a> Tour<'a> {
    /// With estimates of all there is to choose from.
    pub(crate) fn new(
        (drawing, waits): (&Drawing, &[Wait]),
        machine: &'a Machine,
        request: &'a PlanRequest,
        home: PanTilt<f64>,
    ) -> Result<Self, PlanError> {
        let mut legs: Vec<TourLeg> = Vec::new();
        let mut at = home.map(JointMotion::at_rest);
        for (stroke, drawn) in drawing.strokes.iter().enumerate() {
            for leg in Corners::of(machine, request).legs(&drawn.path) {
                let mut leg = TourLeg::new(leg, stroke, machine, request, at, legs.is_empty())?;
                let is_first = legs.last().is_none_or(|before| before.stroke != stroke);
                waits
                    .iter()
                    .filter(|wait| is_first && wait.stroke == stroke)
                    .for_each(|wait| leg.wait(wait.time_s));
                at = leg.ends[End::Rest as usize].unwrap_or(at);
                legs.push(leg);
            }
        }
        let sides = |i: usize| Sides::of(i, &legs, home, machine, request);
        let links = (0..=legs.len()).map(|i| sides(i).estimated()).collect();
        Ok(Self { machine, request, home, links, legs, excess: Excess::default(), refused: None })
    }

    /// How to run every leg for the shortest tour, to a two-thousandth. All of it has been timed tick by tick.
    pub(crate) fn settle(&mut self) -> Result<Vec<Run>, NoTour> {
        const ENOUGH: f64 = 5e-4;
        let mut is_first = true;
        loop {
            // what was not looked at yet may turn out slower, hardly faster: there is no more to be hoped for than that
            let no_tour = |leg| self.refused.map_or(NoTour::NoWay(leg), NoTour::Plan);
            let (runs, hoped_s) = self.choose().map_err(no_tour)?;
            check_duration(hoped_s).map_err(NoTour::Plan)?;
            let is_exact = self.is_exact(&runs).map_err(NoTour::Plan)?;
            if is_exact || self.total_s(&runs) <= (1.0 + ENOUGH) * hoped_s {
                return Ok(runs);
            }
            if std::mem::take(&mut is_first) {
                self.links.iter_mut().for_each(|link| link.correct(&self.excess));
            }
        }
    }

    /// How long a choice takes, s.
    pub(crate) fn total_s(&self, runs: &[Run]) -> f64 {
        let rest = Run::ALL[0];
        let mut before = rest;
        let mut sum = 0.0;
        for ((leg, link), &run) in self.legs.iter().zip(&self.links).zip(runs) {
            sum += link.seconds(before.index(), run.index()) + leg.drawn_s[run.index()];
            before = run;
        }
        sum + self.links.last().map_or(0.0, |link| link.seconds(before.index(), rest.index()))
    }

    /// The dark move before a leg, if it was chosen: its ticks, none where it is joined.
    pub(crate) fn way(&self, link: usize, from: Option<Run>, to: Option<Run>) -> &[PanTilt<JointMotion>] {
        self.links[link].way(from, to)
    }

    /// A leg tick by tick, if it was chosen.
    pub(crate) fn marked(&self, leg: usize, run: Run) -> Option<&Marked> {
        self.legs[leg].marked(run)
    }

    /// Times legs and links of a choice tick by tick; whether all of them are what they were taken for.
    fn is_exact(&mut self, runs: &[Run]) -> Result<bool, PlanError> {
        let mut is_exact = true;
        let mut drawn_s = 0.0;
        for (leg, &run) in self.legs.iter_mut().zip(runs) {
            is_exact &= leg.look_closer(self.machine, self.request, run).unwrap_or_else(|error| {
                self.refused = Some(error);
                false
            });
            let exact_s = leg.drawn_s[run.index()];
            drawn_s += if exact_s.is_finite() { exact_s } else { 0.0 };
            // before all memory is full of it
            check_duration(drawn_s)?;
        }
        let befores = std::iter::once(None).chain(runs.iter().copied().map(Some));
        let afters = runs.iter().copied().map(Some).chain(std::iter::once(None));
        for (i, (before, after)) in befores.zip(afters).enumerate() {
            let sides = Sides::of(i, &self.legs, self.home, self.machine, self.request);
            let looked = self.links[i].look_closer(&sides, [before, after], &mut self.excess);
            is_exact &= looked.unwrap_or_else(|error| {
                self.refused = Some(error);
                false
            });
        }
        Ok(is_exact)
    }

    /// The runs that make the tour shortest, and how long it takes, s; the number of the leg that cannot be reached if there are none.
    fn choose(&self) -> Result<(Vec<Run>, f64), usize> {
        let mut times = [0.0, f64::INFINITY, f64::INFINITY, f64::INFINITY];
        // for each leg's runs, the run of the leg before that it is best come from
        let mut came: Vec<[usize; Run::COUNT]> = Vec::with_capacity(self.legs.len());
        for (leg, link) in self.legs.iter().zip(&self.links) {
            let best = Run::ALL.map(|run| {
                let to = run.index();
                let by = |from: usize| times[from] + link.seconds(from, to) + leg.drawn_s[to];
                shortest(by)
            });
            times = best.map(|(_, time)| time);
            if times.iter().all(|time| time.is_infinite()) {
                return Err(self.out_of_reach(came.len()));
            }
            came.push(best.map(|(from, _)| from));
        }
        let rest = Run::ALL[0].index();
        let home_s =
            |from: usize| times[from] + self.links.last().map_or(0.0, |link| link.seconds(from, rest));
        let (mut run, total) = shortest(home_s);
        if total.is_infinite() {
            return Err(self.legs.len().saturating_sub(1));
        }
        let mut runs = Vec::with_capacity(came.len());
        for from in came.iter().rev() {
            runs.push(Run::ALL[run]);
            run = from[run];
        }
        runs.reverse();
        Ok((runs, total))
    }

    /// Whether it is a leg that cannot be reached, or the one before that cannot be left.
    fn out_of_reach(&self, leg: usize) -> usize {
        let is_left = |last: usize| self.legs[last].ends[End::Moving as usize].is_some();
        leg.checked_sub(1).filter(|&last| !is_left(last)).unwrap_or(leg)
    }
}

/// The run with the shortest time, the first of equals.
fn shortest(time: impl Fn(usize) -> f64) -> (usize, f64) {
    let all = (0..Run::COUNT).map(|run| (run, time(run)));
    all.fold((0, f64::INFINITY), |best, next| if next.1 < best.1 { next } else { best })
}
