//! A leg of the tour with all its possible runs.

use tracelight_rig::{PanTilt, TICK_F64_S};

use super::run::Run;
use crate::error::PlanError;
use crate::leg::Leg;
use crate::machine::Machine;
use crate::mark::{Marked, mark};
use crate::motion::JointMotion;
use crate::request::{End, MarkRequest, PlanRequest};
use crate::retime::along::Along;
use crate::retime::{PathSample, Retimed, chain};
use crate::travel::touches;

/// A leg of the tour.
pub(crate) struct TourLeg {
    pub(crate) leg: Leg,
    /// Number of its stroke, from 0.
    pub(crate) stroke: usize,
    /// Whether the leg begins where the previous one ends. At rest there, the light may stay on.
    pub(crate) joined: bool,
    /// The dark rest before it that is asked for, s.
    pub(crate) wait_s: f64,
    /// Duration of the leg for each run, s; infinite if infeasible.
    pub(super) drawn_s: [f64; Run::COUNT],
    /// Ticks of the runs that were planned so far.
    marked: [Option<Marked>; Run::COUNT],
    /// About where the joints are at first and last, by how it starts and ends; `None` where that is out of reach.
    pub(super) starts: [Option<PanTilt<JointMotion>>; 2],
    pub(super) ends: [Option<PanTilt<JointMotion>>; 2],
}

impl TourLeg {
    pub(super) fn new(
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
        Ok(Self { leg, stroke, joined, wait_s: 0.0, drawn_s, marked: Default::default(), starts, ends })
    }

    /// Asks for a dark rest before it, s: it begins from rest, also where the one before ends.
    pub(super) fn wait(&mut self, time_s: f64) {
        self.wait_s = time_s;
        self.joined = false;
        self.starts[End::Moving as usize] = None;
        for run in Run::ALL.into_iter().filter(|run| run.start == End::Moving) {
            self.drawn_s[run.index()] = f64::INFINITY;
        }
    }

    /// Returns the planned ticks of a run, if there are any.
    pub(super) fn marked(&self, run: Run) -> Option<&Marked> {
        self.marked[run.index()].as_ref()
    }

    /// Runs it tick by tick; whether that takes what it was taken for.
    pub(super) fn look_closer(
        &mut self,
        machine: &Machine,
        request: &PlanRequest,
        run: Run,
    ) -> Result<bool, PlanError> {
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
pub(super) fn is_near(exact_s: f64, estimate_s: f64) -> bool {
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
