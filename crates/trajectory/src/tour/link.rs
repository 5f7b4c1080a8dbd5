//! The dark moves between legs: estimated for every choice, timed tick by tick for those that are made.

use tracelight_rig::{PanTilt, TICK_F64_S};

use super::{Run, Tour, is_near};
use crate::mark::End;
use crate::plan::JointMotion;
use crate::swing::Swing;
use crate::travel::{travel, travel_estimate_s};
use crate::{DarkMove, Machine, PlanError, PlanRequest};

/// Both joints at every tick of a dark move, its start left out.
type Way = Vec<PanTilt<JointMotion>>;

/// What leads from one leg to the next.
pub(super) struct Link {
    /// By how the leg before is run and how the next; infinite where there is no way.
    seconds: [[f64; Run::COUNT]; Run::COUNT],
    /// The ways that were looked at.
    ways: Vec<(usize, usize, Way)>,
}

impl Link {
    /// From one run's index to another's.
    pub(super) fn seconds(&self, from: usize, to: usize) -> f64 {
        self.seconds[from][to]
    }

    /// Its ticks, if it was looked at.
    pub(super) fn way(&self, from: Option<Run>, to: Option<Run>) -> &[PanTilt<JointMotion>] {
        let [from, to] = [from, to].map(index);
        let found = self.ways.iter().find(|way| (way.0, way.1) == (from, to));
        found.map_or(&[], |(_, _, way)| way)
    }
}

fn is_known(ways: &[(usize, usize, Way)], from: usize, to: usize) -> bool {
    ways.iter().any(|way| (way.0, way.1) == (from, to))
}

/// By how much links turned out slower than estimated, by how the leg before ends and how the next begins: sums, s, and
/// counts.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Excess([[(f64, f64); 2]; 2]);

impl Excess {
    fn count(&mut self, [before, after]: [End; 2], excess_s: f64) {
        let (sum, count) = &mut self.0[before as usize][after as usize];
        *sum += excess_s;
        *count += 1.0;
    }

    fn mean_s(&self, [before, after]: [End; 2]) -> f64 {
        let (sum, count) = self.0[before as usize][after as usize];
        if count > 0.0 { sum / count } else { 0.0 }
    }
}

/// How much of what links of a kind were slower than estimated is laid upon the others of that kind. Less than all: a link
/// that is taken for slower than it is is never looked at. Measured on 5000 hatched lines: none takes twice the rounds for
/// 0.05 %.
const LAID_UPON: f64 = 0.7;

/// Before the first leg and after the last the head is at rest.
fn index(run: Option<Run>) -> usize {
    run.map_or(0, Run::index)
}

impl Tour<'_> {
    /// What a link about takes.
    pub(super) fn estimated(&self, i: usize) -> Link {
        let by_ends = End::BOTH.map(|before| End::BOTH.map(|after| self.estimate_s(i, [before, after])));
        let seconds = Run::ALL.map(|from| Run::ALL.map(|to| by_ends[from.end as usize][to.start as usize]));
        Link { seconds, ways: Vec::new() }
    }

    /// Makes estimates of links that were not looked at what they turn out to be on the whole.
    pub(super) fn correct(&mut self) {
        let later_s = |from: Run, to: Run| LAID_UPON * self.excess.mean_s([from.end, to.start]);
        for link in &mut self.links {
            for (from, to) in Run::ALL.into_iter().flat_map(|from| Run::ALL.map(|to| (from, to))) {
                let known_s = &mut link.seconds[from.index()][to.index()];
                // where the light stays on nothing was estimated
                if *known_s > 0.0 && !is_known(&link.ways, from.index(), to.index()) {
                    *known_s += later_s(from, to);
                }
            }
        }
    }

    fn estimate_s(&self, i: usize, [before, after]: [End; 2]) -> f64 {
        let (machine, request) = (self.machine, self.request);
        let last = i.checked_sub(1).and_then(|last| self.legs.get(last));
        let leg = self.legs.get(i);
        let allowed = request.lit_speed.ends();
        let from = match last {
            None => (before == End::Rest).then(|| self.home.map(JointMotion::at_rest)),
            Some(last) => last.ends[before as usize].filter(|_| allowed.contains(&before)),
        };
        let Some(from) = from else { return f64::INFINITY };
        let to = match leg {
            None => (after == End::Rest).then(|| stopped(machine, &from, request.ramp_s)),
            Some(leg) => leg.starts[after as usize].filter(|_| allowed.contains(&after)),
        };
        let Some(to) = to else { return f64::INFINITY };
        let swing_s =
            || Swing::new(machine, from, to, request.swing_rise_s()).estimate_s().unwrap_or(f64::INFINITY);
        let lift_s = if after == End::Rest && leg.is_some() { request.lift_s(machine) } else { 0.0 };
        match ([before, after], request.travel) {
            ([End::Rest, End::Rest], _) if leg.is_none_or(|leg| leg.joined) => 0.0,
            ([End::Rest, End::Rest], DarkMove::Shaped(shape)) => {
                let [from, to] = [from, to].map(|end| end.map(|j| j.position_rad));
                travel_estimate_s(machine, shape, from, to) + lift_s
            }
            _ => swing_s() + lift_s,
        }
    }

    /// Times a link between legs that are timed; whether it takes what it was taken for.
    pub(super) fn look_closer(&mut self, i: usize, before: Option<Run>, after: Option<Run>) -> bool {
        let [from, to] = [before, after].map(index);
        let known_s = self.links[i].seconds[from][to];
        if is_known(&self.links[i].ways, from, to) || known_s.is_infinite() {
            return true;
        }
        let Some(motions) = self.around(i, before, after) else { return false };
        let ends = [before.map_or(End::Rest, |run| run.end), after.map_or(End::Rest, |run| run.start)];
        let stays_lit = ends == [End::Rest; 2] && self.legs.get(i).is_none_or(|leg| leg.joined);
        let way = match stays_lit {
            true => Some(Way::new()),
            false => dark_way(self.machine, self.request, motions, ends).unwrap_or_else(|error| {
                self.refused = Some(error);
                None
            }),
        };
        let settles = ends[1] == End::Rest && after.is_some() && !stays_lit;
        let lift_s = if settles { self.request.lift_s(self.machine) } else { 0.0 };
        let link = &mut self.links[i];
        link.seconds[from][to] = match way {
            None => f64::INFINITY,
            Some(way) => {
                let time_s = way.len() as f64 * TICK_F64_S + lift_s;
                if !stays_lit {
                    self.excess.count(ends, time_s - known_s);
                }
                link.ways.push((from, to, way));
                time_s
            }
        };
        is_near(link.seconds[from][to], known_s)
    }

    /// How the joints move before a link and after it, if the legs there are timed.
    fn around(&self, i: usize, before: Option<Run>, after: Option<Run>) -> Option<[PanTilt<JointMotion>; 2]> {
        let left = match before {
            None => self.home.map(JointMotion::at_rest),
            Some(run) => self.marked(i.checked_sub(1)?, run)?.points.last()?.joints,
        };
        let come = match after {
            None => stopped(self.machine, &left, self.request.ramp_s),
            Some(run) => self.marked(i, run)?.start,
        };
        Some([left, come])
    }
}

/// The dark move from one motion to another; none where the motors or the joints' range allow none.
fn dark_way(
    machine: &Machine,
    request: &PlanRequest,
    [from, to]: [PanTilt<JointMotion>; 2],
    ends: [End; 2],
) -> Result<Option<Way>, PlanError> {
    match request.travel {
        DarkMove::Shaped(shape) if ends == [End::Rest; 2] => {
            let [from, to] = [from, to].map(|joints| joints.map(|j| j.position_rad));
            travel(machine, shape, from, to).map(Some)
        }
        _ => Ok(Swing::new(machine, from, to, request.swing_rise_s()).ticks(machine)),
    }
}

/// Where joints that are under way may come to rest without haste.
fn stopped(machine: &Machine, from: &PanTilt<JointMotion>, ramp_s: f64) -> PanTilt<JointMotion> {
    PanTilt::from_fn(|j| {
        let motion = from[j];
        let torque = machine.usable_nm(j);
        let most = torque / machine.own_inertia(j, from.tilt.position_rad);
        let time_s = motion.velocity_rad_s.abs() / most + ramp_s;
        JointMotion::at_rest(motion.position_rad + 0.5 * motion.velocity_rad_s * time_s)
    })
}
