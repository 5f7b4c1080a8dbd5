//! Plans lit strokes tick by tick, with their dark run-ups and run-outs.

use tracelight_aim::AimError;
use tracelight_rig::{PanTilt, TICK_F64_S};
use tracelight_stroke::Point;

use crate::error::PlanError;
use crate::leg::Leg;
use crate::machine::Machine;
use crate::motion::JointMotion;
use crate::plan::check_duration;
use crate::request::{End, MarkRequest};
use crate::retime::along::Along;
use crate::retime::{PathSample, Retimed, chain};
use crate::travel;

/// One tick on a stroke.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MarkPoint {
    pub(crate) spot: Point,
    pub(crate) joints: PanTilt<JointMotion>,
    s_m: f64,
    pub(crate) speed_m_s: f64,
    /// On the leg, not on the way up to it or out of it.
    pub(crate) lit: bool,
    /// Largest share of a motor's torque.
    fraction: f64,
}

/// A leg in time.
#[derive(Clone, Debug)]
pub(crate) struct Marked {
    /// Where the joints are at first: at rest at the leg's start, or where the run-up begins.
    pub(crate) start: PanTilt<JointMotion>,
    /// Every tick after that.
    pub(crate) points: Vec<MarkPoint>,
}

/// How much of the motors' torque beyond the planned share the S-curve may borrow before the leg is slowed down
/// there: rounding moves a little speed into curves.
pub(crate) const BORROW: f64 = 0.05;

/// Distance of the places at which a leg is looked at, m, and their least number.
const GRID_M: f64 = 5e-4;
const FEWEST: f64 = 16.0;

/// Slower than this, m/s, a leg that still asks too much is given up.
const SLOWEST_M_S: f64 = 1e-3;

impl Leg {
    /// The places at which a leg is looked at, nowhere faster than `speed_m_s`.
    pub(crate) fn places(&self, machine: &Machine, speed_m_s: f64) -> Result<Vec<PathSample>, AimError> {
        self.samples(machine, speed_m_s, (GRID_M, FEWEST))
    }
}

/// A leg tick by tick.
///
/// After rounding, every tick's torque and jerk are checked; where they are too much the leg is slowed down and timed again. If
/// that does not end it is rounded more widely, where jerk is bounded, and then run slower as a whole.
pub(crate) fn mark(machine: &Machine, leg: &Leg, request: &MarkRequest) -> Result<Marked, PlanError> {
    if let Some(marked) = settled(machine, leg, request)? {
        return Ok(marked);
    }
    // from all there is one way to all there is the other, with something left for what the leg's own bends ask
    let widest_s = WIDEN * machine.least_ramp_s();
    if widest_s > request.ramp_s {
        let run_up_s = request.run_up_s.max(0.5 * widest_s);
        return mark(machine, leg, &MarkRequest { ramp_s: widest_s, run_up_s, ..*request });
    }
    if request.speed_m_s < SLOWEST_M_S {
        return Err(too_weak(machine, leg, request.stroke));
    }
    mark(machine, leg, &MarkRequest { speed_m_s: 0.7 * request.speed_m_s, ..*request })
}

/// The widest window that rounds, in the least that jerk asks for.
const WIDEN: f64 = 2.4;

/// Slowed down wherever it asks too much; none if there is no end to that.
fn settled(machine: &Machine, leg: &Leg, request: &MarkRequest) -> Result<Option<Marked>, PlanError> {
    let aim = |source| PlanError::Aim { stroke: request.stroke, source };
    let mut samples = leg.places(machine, request.speed_m_s).map_err(aim)?;
    let allowed = machine.torque_share + BORROW;
    let mut reach_m = 2.0 * GRID_M.min(leg.length_m() / FEWEST);
    let can_widen = WIDEN * machine.least_ramp_s() > request.ramp_s;
    let mut longest = usize::MAX;
    for _ in 0..16 {
        let marked = match in_time(machine, leg, &samples, request) {
            // it was slowed down to nearly nothing
            Err(PlanError::TooLong { .. }) if longest < usize::MAX => return Ok(None),
            marked => marked?,
        };
        // jerk where it is slow anyway is no less where it is slower still
        if can_widen && marked.points.len() > longest {
            return Ok(None);
        }
        longest = longest.min(2 * marked.points.len());
        if slow_where_too_much(&mut samples, &marked.points, allowed, reach_m) {
            return Ok(Some(marked));
        }
        reach_m *= 1.3;
    }
    Ok(None)
}

/// The motor that holds its joint worst at the leg's end.
fn too_weak(machine: &Machine, leg: &Leg, stroke: usize) -> PlanError {
    match leg.joints_at(machine, leg.length_m()) {
        Ok((_, joints)) => travel::too_weak(machine, joints.angle_rad),
        Err(source) => PlanError::Aim { stroke, source },
    }
}

/// Slows the leg down around every tick that asks too much; true if there was none.
fn slow_where_too_much(samples: &mut [PathSample], points: &[MarkPoint], allowed: f64, reach_m: f64) -> bool {
    let mut fine = true;
    let [start, end] = [samples.first(), samples.last()].map(|place| place.map_or(0.0, |place| place.s));
    // asked this way round, a number that is none is too much
    for point in points.iter().filter(|p| !within(p.fraction, allowed)) {
        // torque beyond friction and gravity goes with the square of the speed; the overshoot is taken off at least
        let share = (1.0 - 1.5 * (point.fraction - allowed)).clamp(0.5, 0.95);
        let at = point.s_m.clamp(start, end);
        let first = samples.partition_point(|sample| sample.s < at - reach_m);
        let near = samples[first..].iter_mut().take_while(|sample| sample.s <= at + reach_m);
        near.for_each(|sample| sample.cap = sample.cap.min(share.sqrt() * point.speed_m_s));
        fine = false;
    }
    fine
}

fn within(fraction: f64, allowed: f64) -> bool {
    fraction <= allowed
}

fn in_time(
    machine: &Machine,
    leg: &Leg,
    samples: &[PathSample],
    request: &MarkRequest,
) -> Result<Marked, PlanError> {
    let speeds = request.ends.map(|end| if end == End::Moving { request.speed_m_s } else { 0.0 });
    let law = Retimed::new(machine, samples.to_vec(), speeds)?.law(request.ramp_s);
    check_duration(law.duration_s())?;
    // a run-up's ticks are laid so that one of them falls on the leg's start
    let first_s = match request.ends[0] {
        End::Rest => 0.0,
        End::Moving => law.start_s() - (request.run_up_s / TICK_F64_S).ceil() * TICK_F64_S,
    };
    let ticks = ((law.duration_s() - first_s) / TICK_F64_S).ceil().max(1.0) as usize;
    let length = leg.length_m();
    let at = |tick: usize| {
        let along = if tick == ticks && request.ends[1] == End::Rest {
            Along { s: length, v: 0.0, a: 0.0 }
        } else {
            law.at(first_s + tick as f64 * TICK_F64_S)
        };
        point(machine, leg, &along, request)
    };
    let start = at(0)?.joints;
    let points: Result<Vec<MarkPoint>, PlanError> = (1..=ticks).map(at).collect();
    let mut points = points?;
    count_jerk(machine, &start, &mut points);
    Ok(Marked { start, points })
}

/// Counts too high a jerk like as much too high a torque.
fn count_jerk(machine: &Machine, start: &PanTilt<JointMotion>, points: &mut [MarkPoint]) {
    let mut before = *start;
    for point in points {
        let jerk = machine.jerk_share(&before, &point.joints);
        let most = (machine.torque_share + BORROW) * jerk.pan.max(jerk.tilt);
        point.fraction = point.fraction.max(most);
        before = point.joints;
    }
}

/// A spot that passes lights the way to where it is a tick later: it is lit up to the tick nearest to the leg's end.
fn is_lit(along: &Along, length_m: f64, ends: [End; 2]) -> bool {
    let tick_m = along.v * TICK_F64_S;
    let begun = ends[0] == End::Rest || along.s > -1e-3 * tick_m;
    let nearly_over = along.s + 0.5 * tick_m > length_m && along.s > 0.5 * tick_m;
    begun && (ends[1] == End::Rest || !nearly_over)
}

fn point(machine: &Machine, leg: &Leg, along: &Along, request: &MarkRequest) -> Result<MarkPoint, PlanError> {
    let (spot, joints) = leg
        .joints_at(machine, along.s)
        .map_err(|source| PlanError::Aim { stroke: request.stroke, source })?;
    let motion = chain(&joints, along);
    let fraction = machine.fraction_of(&motion).map(f64::abs);
    Ok(MarkPoint {
        spot,
        joints: motion,
        s_m: along.s,
        speed_m_s: along.v,
        lit: is_lit(along, leg.length_m(), request.ends),
        fraction: fraction.pan.max(fraction.tilt),
    })
}
