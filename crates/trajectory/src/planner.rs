use tracelight_rig::{PanTilt, TICK_F64_S};
use tracelight_stroke::{Drawing, Point, Stroke};

use crate::compress::compress;
use crate::leg::Leg;
use crate::mark::{MarkRequest, mark};
use crate::plan::{JointMotion, LegEnd, Plan, PlanPoint};
use crate::travel::travel;
use crate::{Machine, PlanError, Shape};

/// Rest after the last stroke, s: the error at rest is measured over its last 0.2 s.
const FINAL_REST_S: f64 = 0.4;

/// Longest job, s: its ticks are kept in memory, planned and run, at about 350 bytes each.
const LONGEST_S: f64 = 1800.0;

/// How a drawing is to be run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanRequest {
    /// Speed of the lit spot on the target, m/s; slower where the motors need it.
    pub speed_m_s: f64,
    /// Shape of the dark moves.
    pub travel: Shape,
    /// Time over which the acceleration along a stroke builds up, s.
    pub ramp_s: f64,
    /// Rest before a stroke is lit, s.
    pub settle_s: f64,
    /// Distance from the stroke at which the laser is to be darkened, m.
    pub tolerance_m: f64,
}

impl PlanRequest {
    /// Rest before a stroke that does not begin where the last one ends, s: to settle, and for the relay to have let go
    /// before it is to hold again.
    pub fn lift_s(&self, machine: &Machine) -> f64 {
        let relay_ticks = machine.relay_on_ticks + machine.relay_off_ticks + 1;
        self.settle_s.max(f64::from(relay_ticks) * TICK_F64_S)
    }
}

/// Times a drawing, strokes in the order given, starting from rest straight ahead.
///
/// Every stroke is reached by a dark move and a short rest, unless it begins where the one before ends; lit, run from
/// rest to rest between its corners, and darkened. The result is what is executed, tick by tick.
pub fn plan(drawing: &Drawing, machine: &Machine, request: &PlanRequest) -> Result<Plan, PlanError> {
    check_length(drawing, request)?;
    let mut plan = Plan { points: vec![rest(machine, PanTilt::new(0.0, 0.0))], ..Plan::default() };
    for (index, stroke) in drawing.strokes.iter().enumerate() {
        approach(&mut plan.points, machine, request, stroke, index)?;
        draw(&mut plan, machine, request, stroke, index)?;
    }
    linger(&mut plan.points, FINAL_REST_S);
    plan.segments = compress(&plan.points, machine, request.tolerance_m);
    Ok(plan)
}

fn check_length(drawing: &Drawing, request: &PlanRequest) -> Result<(), PlanError> {
    if drawing.strokes.is_empty() {
        return Err(PlanError::Empty);
    }
    check_duration(drawing.length(1e-4) / request.speed_m_s)
}

pub(crate) fn check_duration(needed_s: f64) -> Result<(), PlanError> {
    if needed_s <= LONGEST_S { Ok(()) } else { Err(PlanError::TooLong { needed_s, most_s: LONGEST_S }) }
}

/// Appends the dark way to a stroke, if there is one, and the rest before it up to the first lit tick.
fn approach(
    points: &mut Vec<PlanPoint>,
    machine: &Machine,
    request: &PlanRequest,
    stroke: &Stroke,
    index: usize,
) -> Result<(), PlanError> {
    let start = stroke.path.start();
    let to = machine.angles(start).map_err(|source| PlanError::Aim { stroke: index + 1, source })?;
    let from = points.last().map_or(PanTilt::default(), |p| p.joints.map(|j| j.position_rad));
    let way = travel(machine, request.travel, from, to)?;
    if way.is_empty() && points.last().is_some_and(|p| p.lit) {
        // it begins where the one before ends: the laser stays on, as at a corner
        return Ok(());
    }
    points.extend(way.into_iter().map(|joints| dark(machine, joints)));
    linger(points, request.lift_s(machine));
    if let Some(last) = points.last_mut() {
        *last = PlanPoint { spot: start, lit: true, stroke: Some(index as u32), ..*last };
    }
    Ok(())
}

/// Appends the lit ticks of one stroke.
fn draw(
    plan: &mut Plan,
    machine: &Machine,
    request: &PlanRequest,
    stroke: &Stroke,
    index: usize,
) -> Result<(), PlanError> {
    let id = Some(index as u32);
    let set_m_s = request.speed_m_s;
    let request = MarkRequest { speed_m_s: set_m_s, ramp_s: request.ramp_s, stroke: index + 1 };
    for leg in Leg::split(&stroke.path) {
        let start_tick = last_tick(plan);
        let marks = mark(machine, &leg, &request)?;
        plan.points.extend(marks.into_iter().map(|m| PlanPoint {
            lit: true,
            stroke: id,
            ..assess(machine, m.spot, m.joints, m.speed_m_s / set_m_s)
        }));
        let end = leg.at(leg.length_m());
        plan.leg_ends.push(LegEnd {
            tick: last_tick(plan),
            start_tick,
            point: end.point,
            tangent: end.tangent,
            length_m: leg.length_m(),
        });
        check_duration(plan.points.len() as f64 * TICK_F64_S)?;
    }
    Ok(())
}

fn last_tick(plan: &Plan) -> u32 {
    plan.points.len().saturating_sub(1) as u32
}

/// Stays where the last point is, dark and on no stroke.
fn linger(points: &mut Vec<PlanPoint>, time_s: f64) {
    let Some(&last) = points.last() else { return };
    let ticks = (time_s / TICK_F64_S).round() as usize;
    let still = last.joints.map(|j| JointMotion { position_rad: j.position_rad, ..JointMotion::default() });
    let resting = PlanPoint { lit: false, stroke: None, limit: None, joints: still, ..last };
    points.extend(std::iter::repeat_n(resting, ticks));
}

fn rest(machine: &Machine, angle_rad: PanTilt<f64>) -> PlanPoint {
    dark(machine, angle_rad.map(|position_rad| JointMotion { position_rad, ..JointMotion::default() }))
}

/// A point on the way: its spot is wherever the beam points, the target's origin where it points away from it.
fn dark(machine: &Machine, joints: PanTilt<JointMotion>) -> PlanPoint {
    let spot = machine.geometry.spot(&machine.pose, joints.map(|j| j.position_rad));
    assess(machine, spot.unwrap_or(Point::ORIGIN), joints, 0.0)
}

/// A dark point with its torques and the limit it is at, `speed_share` of the set speed.
fn assess(machine: &Machine, spot: Point, joints: PanTilt<JointMotion>, speed_share: f64) -> PlanPoint {
    let torque = machine.torque(
        joints.map(|j| j.position_rad),
        joints.map(|j| j.velocity_rad_s),
        joints.map(|j| j.acceleration_rad_s2),
    );
    let fraction = machine.fraction(torque);
    PlanPoint {
        spot,
        joints,
        torque_fraction: fraction.map(|f| f as f32),
        limit: machine.binding(&joints, fraction, speed_share),
        lit: false,
        stroke: None,
    }
}
