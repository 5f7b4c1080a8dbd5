//! Where the spot rests and where it passes: the choice at every end of every leg.
//!
//! Each leg may be run in four ways, from rest or under way to rest or under way. What that takes, and what the dark move
//! from one way to another takes, is estimated for all of them; the fastest sequence is found by dynamic programming; and
//! what it consists of is then timed tick by tick within the motors' torque. Where that takes longer than estimated the
//! choice is made again, until all of the fastest sequence is exact. What was timed is what is laid.

mod link;

use tracelight_rig::{PanTilt, TICK_F64_S};
use tracelight_stroke::Drawing;

use crate::corner::Corners;
use crate::leg::Leg;
use crate::mark::{End, MarkRequest, Marked, mark};
use crate::plan::JointMotion;
use crate::planner::check_duration;
use crate::retime::{Along, PathSample, Retimed, chain};
use crate::travel::touches;
use crate::{Machine, PlanError, PlanRequest};
use link::{Excess, Link};

/// How a leg is run: by how it starts and how it ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Run {
    pub(crate) start: End,
    pub(crate) end: End,
}

impl Run {
    const COUNT: usize = 4;
    const ALL: [Run; Run::COUNT] = [
        Run { start: End::Rest, end: End::Rest },
        Run { start: End::Rest, end: End::Moving },
        Run { start: End::Moving, end: End::Rest },
        Run { start: End::Moving, end: End::Moving },
    ];

    const fn index(self) -> usize {
        2 * self.start as usize + self.end as usize
    }

    const fn ends(self) -> [End; 2] {
        [self.start, self.end]
    }
}

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

/// A leg of the tour.
pub(crate) struct TourLeg {
    pub(crate) leg: Leg,
    /// Number of its stroke, from 0.
    pub(crate) stroke: usize,
    /// It begins where the one before ends: resting there the light may stay on.
    pub(crate) joined: bool,
    /// Seconds it takes, run in each way; infinite where it cannot be.
    drawn_s: [f64; Run::COUNT],
    /// The same tick by tick, of those that were looked at.
    marked: [Option<Marked>; Run::COUNT],
    /// About where the joints are at first and last, by how it starts and ends; `None` where that is out of reach.
    starts: [Option<PanTilt<JointMotion>>; 2],
    ends: [Option<PanTilt<JointMotion>>; 2],
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
        drawing: &Drawing,
        machine: &'a Machine,
        request: &'a PlanRequest,
        home: PanTilt<f64>,
    ) -> Result<Self, PlanError> {
        let mut legs: Vec<TourLeg> = Vec::new();
        let mut at = home.map(JointMotion::at_rest);
        for (stroke, drawn) in drawing.strokes.iter().enumerate() {
            for leg in Leg::split(&drawn.path, &Corners::of(machine, request)) {
                let leg = TourLeg::new(leg, stroke, machine, request, at, legs.is_empty())?;
                at = leg.ends[End::Rest as usize].unwrap_or(at);
                legs.push(leg);
            }
        }
        let links = Vec::with_capacity(legs.len() + 1);
        let mut tour = Self { machine, request, home, links, legs, excess: Excess::default(), refused: None };
        for i in 0..=tour.legs.len() {
            let link = tour.estimated(i);
            tour.links.push(link);
        }
        Ok(tour)
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
                self.correct();
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
        self.legs[leg].marked[run.index()].as_ref()
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
            is_exact &= self.look_closer(i, before, after);
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

impl TourLeg {
    fn new(
        leg: Leg,
        stroke: usize,
        machine: &Machine,
        request: &PlanRequest,
        before: PanTilt<JointMotion>,
        is_first: bool,
    ) -> Result<Self, PlanError> {
        let samples = leg
            .places(machine, request.speed_m_s)
            .map_err(|source| PlanError::Aim { stroke: stroke + 1, source })?;
        let mut drawn_s = [f64::INFINITY; Run::COUNT];
        let mut passing = [0.0; 2];
        let allowed = request.lit_speed.ends();
        for run in Run::ALL.into_iter().filter(|run| run.ends().iter().all(|end| allowed.contains(end))) {
            (drawn_s[run.index()], passing) = timed(machine, &samples, request, run.ends())?;
        }
        let at = |s_m: f64, v: f64| {
            let (_, joints) = leg.joints_at(machine, s_m).ok()?;
            Some(chain(&joints, &Along { s: s_m, v, a: 0.0 }))
        };
        let length = leg.length_m();
        // a relay that lets go more slowly than it takes hold cannot make light as short as it likes
        let least_ticks = f64::from(machine.relay_off_ticks) - f64::from(machine.relay_on_ticks) + 1.0;
        let passes = length >= least_ticks * TICK_F64_S * passing[0].max(passing[1]);
        let passed = |s_m: f64, v: f64| if passes { at(s_m, v) } else { None };
        let starts = [at(0.0, 0.0), passed(-passing[0] * request.run_up_s(machine), passing[0])];
        let ends = [at(length, 0.0), passed(length + 0.5 * passing[1] * request.ramp_s, passing[1])];
        let joined = !is_first
            && starts[0]
                .is_some_and(|start| touches(before.map(|j| j.position_rad), start.map(|j| j.position_rad)));
        Ok(Self { leg, stroke, joined, drawn_s, marked: Default::default(), starts, ends })
    }

    /// Runs it tick by tick; whether that takes what it was taken for.
    fn look_closer(&mut self, machine: &Machine, request: &PlanRequest, run: Run) -> Result<bool, PlanError> {
        let (marked, drawn_s) = (&mut self.marked[run.index()], &mut self.drawn_s[run.index()]);
        if marked.is_some() {
            return Ok(true);
        }
        let request = MarkRequest {
            speed_m_s: request.speed_m_s,
            ramp_s: request.ramp_s,
            run_up_s: request.run_up_s(machine),
            ends: run.ends(),
            stroke: self.stroke + 1,
        };
        let known_s = *drawn_s;
        *drawn_s = match mark(machine, &self.leg, &request) {
            // the leg itself is in reach: its run-up or run-out is not
            Err(PlanError::Aim { .. }) if run.ends() != [End::Rest; 2] => f64::INFINITY,
            Err(error) => {
                *drawn_s = f64::INFINITY;
                return Err(error);
            }
            Ok(ticks) => marked.insert(ticks).points.len() as f64 * TICK_F64_S,
        };
        Ok(is_near(*drawn_s, known_s))
    }
}

/// Whether an estimate was as good as a tick allows.
fn is_near(exact_s: f64, estimate_s: f64) -> bool {
    (exact_s - estimate_s).abs() <= TICK_F64_S
}

/// How long a leg takes with its run-up and run-out, and how fast it is passed at both ends.
fn timed(
    machine: &Machine,
    samples: &[PathSample],
    request: &PlanRequest,
    ends: [End; 2],
) -> Result<(f64, [f64; 2]), PlanError> {
    let speeds = ends.map(|end| if end == End::Moving { request.speed_m_s } else { 0.0 });
    let motion = Retimed::new(machine, samples.to_vec(), speeds)?;
    let run_up_s =
        if ends[0] == End::Moving { request.run_up_s(machine) - 0.5 * request.ramp_s } else { 0.0 };
    let speeds = motion.speeds();
    let passing = [speeds.first(), speeds.last()].map(|v| v.copied().unwrap_or(0.0));
    // to whole ticks, up
    let time_s = motion.duration_s() + request.ramp_s + run_up_s + 0.5 * TICK_F64_S;
    Ok((time_s, passing))
}
