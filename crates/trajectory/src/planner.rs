use tracelight_rig::{Joint, PanTilt, TICK_F64_S};
use tracelight_stroke::{Drawing, Point};

use crate::binding::Binding;
use crate::compress::compress;
use crate::corner::Corners;
use crate::error::PlanError;
use crate::machine::Machine;
use crate::mark::Marked;
use crate::motion::JointMotion;
use crate::plan::{Plan, PlanPoint, Tightest, check_duration};
use crate::request::{End, LitSpeed, PlanRequest, Wait};
use crate::retime::steady_speed;
use crate::tour::leg::TourLeg;
use crate::tour::run::Run;
use crate::tour::{NoTour, Tour};

/// Rest after the last stroke, s: the error at rest is measured over its last 0.2 s.
pub(crate) const FINAL_REST_S: f64 = 0.4;

/// Times a drawing, strokes in the order given, starting from rest straight ahead.
///
/// Every stroke is reached in the dark. Its corners and ends are drawn from rest to rest, or passed at speed, with a dark
/// way up and out: whichever makes the whole drawing faster, unless [`LitSpeed::Exact`] asks for the latter. A stroke that
/// begins where the one before ends may stay lit between. The result is what is executed, tick by tick.
///
/// # Errors
/// Why there is no such plan.
pub fn plan(drawing: &Drawing, machine: &Machine, request: &PlanRequest) -> Result<Plan, PlanError> {
    plan_from(drawing, machine, request, PanTilt::default())
}

/// Times a drawing like [`plan`], starting from rest at these joint angles, rad.
///
/// # Errors
/// As of [`plan`].
pub fn plan_from(
    drawing: &Drawing,
    machine: &Machine,
    request: &PlanRequest,
    home_rad: PanTilt<f64>,
) -> Result<Plan, PlanError> {
    timed((drawing, &[]), machine, request, home_rad)
}

/// Times a drawing like [`plan`], resting in the dark before some of its strokes: these begin from rest.
///
/// # Errors
/// As of [`plan`]; at one speed throughout, where no stroke begins from rest, there is no plan with such rests.
pub fn plan_waiting(
    drawing: &Drawing,
    waits: &[Wait],
    machine: &Machine,
    request: &PlanRequest,
) -> Result<Plan, PlanError> {
    timed((drawing, waits), machine, request, PanTilt::default())
}

fn timed(
    (drawing, waits): (&Drawing, &[Wait]),
    machine: &Machine,
    request: &PlanRequest,
    home_rad: PanTilt<f64>,
) -> Result<Plan, PlanError> {
    check_length(drawing, request)?;
    let request = &request.within_jerk(machine);
    let (mut request, mut tightest) = at_one_speed(drawing, machine, request)?;
    loop {
        let mut plan = at_speed((drawing, waits), machine, &request, home_rad)?;
        plan.set_speed_m_s = request.speed_m_s;
        let uneven = if request.lit_speed == LitSpeed::Exact { slowest_place(machine, &plan) } else { None };
        let Some(place) = uneven.filter(|_| request.speed_m_s > SLOWEST_M_S) else {
            plan.tightest = tightest.map(|bend| Tightest { speed_m_s: request.speed_m_s, ..bend });
            return Ok(plan);
        };
        // between places the motors had a little less than at them, and no place knows of jerk
        request.speed_m_s *= (place.speed_m_s / request.speed_m_s).clamp(0.7, 0.97);
        tightest = tightest.or(Some(place));
    }
}

/// Times a drawing at the speed asked for.
fn at_speed(
    (drawing, waits): (&Drawing, &[Wait]),
    machine: &Machine,
    request: &PlanRequest,
    home: PanTilt<f64>,
) -> Result<Plan, PlanError> {
    let mut tour = Tour::new((drawing, waits), machine, request, home)?;
    let runs = tour.settle().map_err(|why| match why {
        NoTour::Plan(error) => error,
        NoTour::NoWay(leg) => PlanError::NoWayAtSpeed {
            stroke: tour.legs.get(leg).map_or(0, |leg| leg.stroke + 1),
            speed_m_s: request.speed_m_s,
        },
    })?;
    let mut draft = Draft::new(machine, request, home);
    draft.lay(&tour, &runs)?;
    let mut plan = draft.plan;
    linger(&mut plan.points, FINAL_REST_S);
    name_jerk(&mut plan.points, machine);
    plan.segments = compress(&plan.points, machine, request.tolerance_m);
    Ok(plan)
}

/// Where lit strokes are slowest, if that is slower than the set speed.
fn slowest_place(machine: &Machine, plan: &Plan) -> Option<Tightest> {
    // by how fast the joints turn: where the line breaks a little, from tick to tick the spot takes a short cut
    let speed_m_s = |p: &PlanPoint| {
        let [a, b] = machine.geometry.jacobian(&machine.pose, p.joints.map(|j| j.position_rad))?;
        Some((a * p.joints.pan.velocity_rad_s + b * p.joints.tilt.velocity_rad_s).hypot())
    };
    let lit = plan.points.windows(2).filter(|pair| pair[0].lit && pair[1].lit);
    let places = lit.map(|pair| Tightest {
        stroke: pair[0].stroke.unwrap_or(0) as usize,
        point: pair[0].spot,
        radius_m: f64::INFINITY,
        speed_m_s: speed_m_s(&pair[0]).unwrap_or(f64::INFINITY),
    });
    let slowest = places.min_by(|a, b| a.speed_m_s.total_cmp(&b.speed_m_s))?;
    (slowest.speed_m_s < (1.0 - EVEN) * plan.set_speed_m_s).then_some(slowest)
}

/// A spot that is slower by less keeps its speed.
const EVEN: f64 = 1e-3;

/// The request with the speed that can be kept throughout, if one is asked for, and where the drawing bends most if that
/// is less than the set speed.
fn at_one_speed(
    drawing: &Drawing,
    machine: &Machine,
    request: &PlanRequest,
) -> Result<(PlanRequest, Option<Tightest>), PlanError> {
    let mut tightest: Option<Tightest> = None;
    if request.lit_speed != LitSpeed::Exact {
        return Ok((*request, None));
    }
    // breaks are judged when the speed is known
    let unhurried = PlanRequest { lit_speed: LitSpeed::Fastest, corner_m: 0.0, ..*request };
    for (stroke, drawn) in drawing.strokes.iter().enumerate() {
        for leg in Corners::of(machine, &unhurried).legs(&drawn.path) {
            let aim = |source| PlanError::Aim { stroke: stroke + 1, source };
            let mut samples = leg.places(machine, request.speed_m_s).map_err(aim)?;
            samples.iter_mut().for_each(|sample| sample.cap = request.speed_m_s);
            // what is run up to it and out of it must be passed as fast; what is out of reach is found when it is planned
            samples.extend(leg.around(
                machine,
                request.speed_m_s,
                [request.run_up_s(machine), request.ramp_s],
            ));
            let (speed, place) = steady_speed(machine, &samples);
            if speed < tightest.map_or(request.speed_m_s, |t| t.speed_m_s) {
                let at = leg.at(samples[place].s);
                let radius_m = 1.0 / at.curvature.hypot();
                tightest = Some(Tightest { stroke, point: at.point, radius_m, speed_m_s: speed });
            }
        }
    }
    match tightest {
        Some(Tightest { stroke, radius_m, speed_m_s, .. }) if speed_m_s < SLOWEST_M_S => {
            Err(PlanError::TooBent { stroke: stroke + 1, radius_m })
        }
        Some(found) => {
            // rounding must not make it a limit that is met nowhere
            let speed_m_s = (1.0 - 1e-6) * found.speed_m_s;
            Ok((PlanRequest { speed_m_s, ..*request }, Some(Tightest { speed_m_s, ..found })))
        }
        None => Ok((*request, None)),
    }
}

/// Slower than this, m/s, a drawing is not drawn at one speed.
const SLOWEST_M_S: f64 = 1e-3;

fn check_length(drawing: &Drawing, request: &PlanRequest) -> Result<(), PlanError> {
    if drawing.strokes.is_empty() {
        return Err(PlanError::Empty);
    }
    check_duration(drawing.length(1e-4) / request.speed_m_s)
}

/// A plan in the making.
struct Draft<'a> {
    plan: Plan,
    machine: &'a Machine,
    request: &'a PlanRequest,
}

impl<'a> Draft<'a> {
    fn new(machine: &'a Machine, request: &'a PlanRequest, home: PanTilt<f64>) -> Self {
        let plan = Plan { points: vec![rest(machine, home)], ..Plan::default() };
        Self { plan, machine, request }
    }

    /// All legs and what is between them.
    fn lay(&mut self, tour: &Tour<'_>, runs: &[Run]) -> Result<(), PlanError> {
        self.plan.points.reserve((tour.total_s(runs) / TICK_F64_S) as usize);
        let mut before = None;
        for (i, (leg, &run)) in tour.legs.iter().zip(runs).enumerate() {
            self.approach(
                leg,
                tour.way(i, before, Some(run)),
                [before.map_or(End::Rest, |run| run.end), run.start],
            );
            if let Some(marked) = tour.marked(i, run) {
                self.draw(leg, marked, run.end);
            }
            check_duration(self.plan.points.len() as f64 * TICK_F64_S)?;
            before = Some(run);
        }
        self.go(tour.way(tour.legs.len(), before, None));
        Ok(())
    }

    fn go(&mut self, way: &[PanTilt<JointMotion>]) {
        self.plan.points.extend(way.iter().map(|&joints| dark(self.machine, joints)));
    }

    /// The dark way to a leg, if there is one, and the rest before it up to the first lit tick.
    fn approach(&mut self, leg: &TourLeg, way: &[PanTilt<JointMotion>], ends: [End; 2]) {
        if ends == [End::Rest; 2] && leg.joined && self.plan.points.last().is_some_and(|p| p.lit) {
            // it begins where the one before ends: the laser stays on, as at a corner
            return;
        }
        self.go(way);
        if ends[1] == End::Rest {
            let spot = leg.leg.at(0.0).point;
            light_up(&mut self.plan.points, self.request.lift_s(self.machine) + leg.wait_s, spot, leg.stroke);
        }
    }

    /// The ticks of a leg, with its way up and out.
    fn draw(&mut self, leg: &TourLeg, marked: &Marked, end: End) {
        let start_tick = last_tick(&self.plan.points);
        let set_m_s = self.request.speed_m_s;
        self.plan.points.extend(marked.points.iter().map(|m| PlanPoint {
            lit: m.lit,
            stroke: m.lit.then_some(leg.stroke as u32),
            ..assess(self.machine, m.spot, m.joints, if m.lit { m.speed_m_s / set_m_s } else { 0.0 })
        }));
        if end == End::Rest {
            self.plan.leg_ends.push(leg.leg.rest_at_end(start_tick, last_tick(&self.plan.points)));
        }
    }
}

/// Names the jerk as the limit where nothing else is.
fn name_jerk(points: &mut [PlanPoint], machine: &Machine) {
    const BINDS: f64 = 0.9;
    for i in 1..points.len() {
        let share = machine.jerk_share(&points[i - 1].joints, &points[i].joints);
        let joint = if share.pan >= share.tilt { Joint::Pan } else { Joint::Tilt };
        if points[i].limit.is_none() && share[joint] >= BINDS {
            points[i].limit = Some(Binding::Jerk(joint));
        }
    }
}

pub(crate) fn last_tick(points: &[PlanPoint]) -> u32 {
    points.len().saturating_sub(1) as u32
}

/// Rests before a stroke that begins at rest; the last tick of it is lit.
pub(crate) fn light_up(points: &mut Vec<PlanPoint>, lift_s: f64, spot: Point, stroke: usize) {
    linger(points, lift_s);
    if let Some(last) = points.last_mut() {
        *last = PlanPoint { spot, lit: true, stroke: Some(stroke as u32), ..*last };
    }
}

/// Stays where the last point is, dark and on no stroke.
pub(crate) fn linger(points: &mut Vec<PlanPoint>, time_s: f64) {
    let Some(&last) = points.last() else { return };
    let ticks = (time_s / TICK_F64_S).round() as usize;
    let still = last.joints.map(|j| JointMotion::at_rest(j.position_rad));
    let resting = PlanPoint { lit: false, stroke: None, limit: None, joints: still, ..last };
    points.extend(std::iter::repeat_n(resting, ticks));
}

pub(crate) fn rest(machine: &Machine, angle_rad: PanTilt<f64>) -> PlanPoint {
    dark(machine, angle_rad.map(JointMotion::at_rest))
}

/// A point on the way: its spot is wherever the beam points, the target's origin where it points away from it.
pub(crate) fn dark(machine: &Machine, joints: PanTilt<JointMotion>) -> PlanPoint {
    let spot = machine.geometry.spot(&machine.pose, joints.map(|j| j.position_rad));
    assess(machine, spot.unwrap_or(Point::ORIGIN), joints, 0.0)
}

/// A dark point with its torques and the limit it is at, `speed_share` of the set speed.
pub(crate) fn assess(
    machine: &Machine,
    spot: Point,
    joints: PanTilt<JointMotion>,
    speed_share: f64,
) -> PlanPoint {
    let fraction = machine.fraction_of(&joints);
    PlanPoint {
        spot,
        joints,
        torque_fraction: fraction.map(|f| f as f32),
        limit: machine.binding(&joints, fraction, speed_share),
        lit: false,
        stroke: None,
    }
}
