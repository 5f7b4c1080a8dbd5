//! Lit strokes tick by tick.

use tracelight_rig::{PanTilt, TICK_F64_S};
use tracelight_stroke::Point;

use crate::leg::Leg;
use crate::plan::JointMotion;
use crate::planner::check_duration;
use crate::retime::{Along, PathSample, Retimed, chain};
use crate::{Machine, PlanError, travel};

/// One tick on a stroke.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MarkPoint {
    pub(crate) spot: Point,
    pub(crate) joints: PanTilt<JointMotion>,
    s_m: f64,
    pub(crate) speed_m_s: f64,
    /// Largest share of a motor's torque.
    fraction: f64,
}

/// How lit strokes are to be run.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MarkRequest {
    /// Set speed, m/s.
    pub(crate) speed_m_s: f64,
    /// Window of the S-curve, s.
    pub(crate) ramp_s: f64,
    /// Number of the stroke, for messages.
    pub(crate) stroke: usize,
}

/// How much of the motors' torque beyond the planned share the S-curve may borrow before the leg is slowed down
/// there: rounding moves a little speed into curves.
const BORROW: f64 = 0.05;

/// Distance of the places at which a leg is looked at, m, and their least number.
const GRID_M: f64 = 5e-4;
const FEWEST: f64 = 16.0;

/// Slower than this, m/s, a leg that still asks too much is given up.
const SLOWEST_M_S: f64 = 1e-3;

/// A leg from rest to rest, the start left out, the end included.
///
/// After rounding, every tick's torque is checked against the motors; where it is too much the leg is slowed down
/// and timed again, and if that does not end, all of it is run slower.
pub(crate) fn mark(machine: &Machine, leg: &Leg, request: &MarkRequest) -> Result<Vec<MarkPoint>, PlanError> {
    let aim = |source| PlanError::Aim { stroke: request.stroke, source };
    let mut samples = leg.samples(machine, request.speed_m_s, (GRID_M, FEWEST)).map_err(aim)?;
    let allowed = machine.torque_share + BORROW;
    let mut reach_m = 2.0 * GRID_M.min(leg.length_m() / FEWEST);
    for _ in 0..16 {
        let points = in_time(machine, leg, &samples, request)?;
        if slow_where_too_much(&mut samples, &points, allowed, reach_m) {
            return Ok(points);
        }
        reach_m *= 1.3;
    }
    if request.speed_m_s < SLOWEST_M_S {
        return Err(too_weak(machine, leg, request.stroke));
    }
    let slower = MarkRequest { speed_m_s: 0.7 * request.speed_m_s, ..*request };
    mark(machine, leg, &slower)
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
    // asked this way round, a number that is none is too much
    for point in points.iter().filter(|p| !within(p.fraction, allowed)) {
        // torque beyond friction and gravity goes with the square of the speed; the overshoot is taken off at least
        let share = (1.0 - 1.5 * (point.fraction - allowed)).clamp(0.5, 0.95);
        let first = samples.partition_point(|sample| sample.s < point.s_m - reach_m);
        let near = samples[first..].iter_mut().take_while(|sample| sample.s <= point.s_m + reach_m);
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
) -> Result<Vec<MarkPoint>, PlanError> {
    let law = Retimed::new(machine, samples.to_vec())?.law(request.ramp_s);
    check_duration(law.duration_s())?;
    let ticks = (law.duration_s() / TICK_F64_S).ceil() as usize;
    let length = leg.length_m();
    let at = |tick: usize| {
        let along = if tick == ticks {
            Along { s: length, v: 0.0, a: 0.0 }
        } else {
            law.at(tick as f64 * TICK_F64_S)
        };
        point(machine, leg, &along, request.stroke)
    };
    (1..=ticks).map(at).collect()
}

fn point(machine: &Machine, leg: &Leg, along: &Along, stroke: usize) -> Result<MarkPoint, PlanError> {
    let (spot, joints) =
        leg.joints_at(machine, along.s).map_err(|source| PlanError::Aim { stroke, source })?;
    let (rate, acceleration) = chain(&joints, along);
    let fraction = machine.fraction(machine.torque(joints.angle_rad, rate, acceleration)).map(f64::abs);
    let motion = PanTilt::from_fn(|j| JointMotion {
        position_rad: joints.angle_rad[j],
        velocity_rad_s: rate[j],
        acceleration_rad_s2: acceleration[j],
    });
    Ok(MarkPoint {
        spot,
        joints: motion,
        s_m: along.s,
        speed_m_s: along.v,
        fraction: fraction.pan.max(fraction.tilt),
    })
}
