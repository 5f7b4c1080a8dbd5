//! Where the spot rests and where it passes: the choice at every end of every leg.

use tracelight_rig::{PanTilt, TICK_F64_S};
use tracelight_stroke::Drawing;

use crate::corner::Corners;
use crate::leg::Leg;
use crate::mark::{End, MarkRequest};
use crate::plan::JointMotion;
use crate::retime::{Along, PathSample, Retimed, chain};
use crate::swing::Swing;
use crate::travel::{touches, travel_estimate_s};
use crate::{DarkMove, Machine, PlanError, PlanRequest};

/// The legs of a drawing in order, with what it takes to draw each and to get from one to the next.
pub(crate) struct Tour {
    pub(crate) legs: Vec<TourLeg>,
    /// Before each leg and after the last: seconds in the dark, by how the leg before ends and how the next begins.
    links: Vec<[[f64; 2]; 2]>,
}

/// A leg of the tour.
pub(crate) struct TourLeg {
    pub(crate) leg: Leg,
    /// Number of its stroke, from 0.
    pub(crate) stroke: usize,
    /// It begins where the one before ends: resting there the light may stay on.
    pub(crate) joined: bool,
    /// Seconds by start and end.
    drawn_s: [[f64; 2]; 2],
    /// Where the joints are at first and last, by how it starts and ends; `None` where the run-up is out of reach.
    starts: [Option<PanTilt<JointMotion>>; 2],
    ends: [Option<PanTilt<JointMotion>>; 2],
}

impl Tour {
    /// The tour from `home`, at rest, through all strokes to rest.
    pub(crate) fn new(
        drawing: &Drawing,
        machine: &Machine,
        request: &PlanRequest,
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
        let mut tour = Self { links: Vec::with_capacity(legs.len() + 1), legs };
        for i in 0..=tour.legs.len() {
            let link = End::BOTH
                .map(|before| End::BOTH.map(|after| tour.link_s(machine, request, home, i, [before, after])));
            tour.links.push(link);
        }
        Ok(tour)
    }

    /// Seconds from the end of the leg before to the start of the next; infinite where that cannot be.
    fn link_s(
        &self,
        machine: &Machine,
        request: &PlanRequest,
        home: PanTilt<f64>,
        next: usize,
        ends: [End; 2],
    ) -> f64 {
        let [before, after] = ends;
        let last = next.checked_sub(1).and_then(|i| self.legs.get(i));
        let leg = self.legs.get(next);
        let allowed = request.lit_speed.ends();
        // before all of them and after, the head is at rest
        let from = match last {
            None => (before == End::Rest).then(|| home.map(JointMotion::at_rest)),
            Some(last) => last.ends[before as usize].filter(|_| allowed.contains(&before)),
        };
        let Some(from) = from else { return f64::INFINITY };
        let to = match leg {
            None => (after == End::Rest).then(|| stopped(machine, &from, request.ramp_s)),
            Some(leg) => leg.starts[after as usize].filter(|_| allowed.contains(&after)),
        };
        let Some(to) = to else { return f64::INFINITY };
        if ends == [End::Rest; 2] {
            return match leg {
                None => 0.0,
                Some(leg) if leg.joined => 0.0,
                Some(_) => match request.travel {
                    DarkMove::Shaped(shape) => {
                        let [from, to] = [from, to].map(|end| end.map(|j| j.position_rad));
                        travel_estimate_s(machine, shape, from, to) + request.lift_s(machine)
                    }
                    DarkMove::Optimal => swing_s(machine, request, from, to) + request.lift_s(machine),
                },
            };
        }
        let settled_s = if after == End::Rest && leg.is_some() { request.lift_s(machine) } else { 0.0 };
        swing_s(machine, request, from, to) + settled_s
    }

    /// The ends of every leg that make the tour shortest; the number of the leg that cannot be reached if there are none.
    pub(crate) fn choose(&self) -> Result<Vec<[End; 2]>, usize> {
        // shortest time up to each leg's end, by how it ends, and how it and the one before came to that
        let mut times = [0.0, f64::INFINITY];
        let mut came: Vec<[(End, End); 2]> = Vec::with_capacity(self.legs.len());
        for (leg, link) in self.legs.iter().zip(&self.links) {
            let best = End::BOTH.map(|end| {
                let mut best = (f64::INFINITY, (End::Rest, End::Rest));
                for before in End::BOTH {
                    for start in End::BOTH {
                        let time = times[before as usize]
                            + link[before as usize][start as usize]
                            + leg.drawn_s[start as usize][end as usize];
                        if time < best.0 {
                            best = (time, (before, start));
                        }
                    }
                }
                best
            });
            times = best.map(|(time, _)| time);
            if times.iter().all(|time| time.is_infinite()) {
                return Err(self.out_of_reach(came.len()));
            }
            came.push(best.map(|(_, way)| way));
        }
        let last = self.links.last().map_or([0.0; 2], |link| link.map(|after| after[End::Rest as usize]));
        let total = [times[0] + last[0], times[1] + last[1]];
        if total.iter().all(|time| time.is_infinite()) {
            return Err(self.legs.len().saturating_sub(1));
        }
        let mut end = if total[1] < total[0] { End::Moving } else { End::Rest };
        let mut ends = Vec::with_capacity(came.len());
        for way in came.iter().rev() {
            let (before, start) = way[end as usize];
            ends.push([start, end]);
            end = before;
        }
        ends.reverse();
        Ok(ends)
    }

    /// Whether it is a leg that cannot be reached, or the one before that cannot be left.
    fn out_of_reach(&self, leg: usize) -> usize {
        let is_left = |last: usize| self.legs[last].ends[End::Moving as usize].is_some();
        leg.checked_sub(1).filter(|&last| !is_left(last)).unwrap_or(leg)
    }

    /// Takes a link out of the choice.
    pub(crate) fn forbid(&mut self, link: usize, [before, after]: [End; 2]) {
        self.links[link][before as usize][after as usize] = f64::INFINITY;
    }
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
        let mut drawn_s = [[f64::INFINITY; 2]; 2];
        let mut passing = [0.0; 2];
        for &start in request.lit_speed.ends() {
            for &end in request.lit_speed.ends() {
                let ends = [start, end];
                let (time, speeds) = timed(machine, &samples, request, ends)?;
                drawn_s[start as usize][end as usize] = time;
                passing = speeds;
            }
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
        Ok(Self { leg, stroke, joined, drawn_s, starts, ends })
    }

    /// How it is to be run.
    pub(crate) fn request(&self, machine: &Machine, request: &PlanRequest, ends: [End; 2]) -> MarkRequest {
        MarkRequest {
            speed_m_s: request.speed_m_s,
            ramp_s: request.ramp_s,
            run_up_s: request.run_up_s(machine),
            ends,
            stroke: self.stroke + 1,
        }
    }
}

/// About how long a dark move between joints under way takes, s; infinite where there is none.
fn swing_s(
    machine: &Machine,
    request: &PlanRequest,
    from: PanTilt<JointMotion>,
    to: PanTilt<JointMotion>,
) -> f64 {
    Swing::new(machine, from, to, request.swing_rise_s()).estimate_s().unwrap_or(f64::INFINITY)
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
    Ok((motion.duration_s() + request.ramp_s + run_up_s, passing))
}

/// Where joints that are under way may come to rest without haste.
pub(crate) fn stopped(machine: &Machine, from: &PanTilt<JointMotion>, ramp_s: f64) -> PanTilt<JointMotion> {
    PanTilt::from_fn(|j| {
        let motion = from[j];
        let torque = machine.torque_share * machine.motors[j].torque_limit_nm();
        let most = torque / machine.own_inertia(j, from.tilt.position_rad);
        let time_s = motion.velocity_rad_s.abs() / most + ramp_s;
        JointMotion::at_rest(motion.position_rad + 0.5 * motion.velocity_rad_s * time_s)
    })
}
