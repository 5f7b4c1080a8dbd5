//! Lit strokes tick by tick.

use tracelight_rig::{PanTilt, TICK_F64_S};
use tracelight_stroke::Point;

use crate::leg::Leg;
use crate::plan::JointMotion;
use crate::retime::{Along, Grid, TimeLaw, chain};
use crate::{Machine, PlanError};

/// One tick on a stroke.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MarkPoint {
    pub(crate) spot: Point,
    pub(crate) joints: PanTilt<JointMotion>,
    s_m: f64,
    speed_m_s: f64,
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

/// A leg from rest to rest, the start left out, the end included.
///
/// After rounding, every tick's torque is checked against the motors; where it is too much the leg is slowed down
/// and timed again, and if that does not end, all of it is run slower.
pub(crate) fn mark(machine: &Machine, leg: &Leg, request: &MarkRequest) -> Result<Vec<MarkPoint>, PlanError> {
    let mut grid = Grid::new(machine, leg, request.speed_m_s, request.stroke)?;
    let allowed = machine.torque_share + BORROW;
    let mut reach_m = 2.0 * grid.step_m();
    for _ in 0..16 {
        let points = sample(machine, leg, &grid, request)?;
        if slow_where_too_much(&mut grid, &points, allowed, reach_m) {
            return Ok(points);
        }
        reach_m *= 1.3;
    }
    let slower = MarkRequest { speed_m_s: 0.7 * request.speed_m_s, ..*request };
    mark(machine, leg, &slower)
}

/// Slows the grid down around every tick that asks too much; true if there was none.
fn slow_where_too_much(grid: &mut Grid, points: &[MarkPoint], allowed: f64, reach_m: f64) -> bool {
    let mut fine = true;
    for point in points.iter().filter(|p| p.fraction > allowed) {
        // torque beyond friction and gravity goes with the square of the speed; the overshoot is taken off at least
        let share = (1.0 - 1.5 * (point.fraction - allowed)).clamp(0.5, 0.95);
        grid.cap(point.s_m, reach_m, share * point.speed_m_s * point.speed_m_s);
        fine = false;
    }
    fine
}

fn sample(
    machine: &Machine,
    leg: &Leg,
    grid: &Grid,
    request: &MarkRequest,
) -> Result<Vec<MarkPoint>, PlanError> {
    let law = TimeLaw::new(&grid.fastest(), grid.step_m(), request.ramp_s);
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
