use tracelight_rig::{Joint, PanTilt, TICK_F64_S};
use tracelight_stroke::{Drawing, Point};

use crate::compress::compress;
use crate::corner::Corners;
use crate::leg::Leg;
use crate::mark::{End, Marked};
use crate::plan::{JointMotion, Plan, PlanPoint, Tightest};
use crate::retime::{Binding, steady_speed};
use crate::tour::{NoTour, Run, Tour, TourLeg};
use crate::{Machine, PlanError, Shape};

/// Rest after the last stroke, s: the error at rest is measured over its last 0.2 s.
pub(crate) const FINAL_REST_S: f64 = 0.4;

/// Longest job, s: its ticks are kept in memory, planned and run, at about 350 bytes each.
const LONGEST_S: f64 = 1800.0;

/// How lit strokes are run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LitSpeed {
    /// As fast as the set speed and the motors allow: from rest to rest at corners and stroke ends, or past them at
    /// speed, whichever is quicker.
    #[default]
    Fastest,
    /// From rest to rest at every corner and stroke end.
    Stops,
    /// At one speed throughout: what the tightest curve permits of the set speed. Every corner and stroke end is passed at
    /// that speed, with dark ways up to it and out of it.
    Exact,
}

impl LitSpeed {
    /// How legs may start and end.
    pub(crate) const fn ends(self) -> &'static [End] {
        match self {
            LitSpeed::Fastest => &End::BOTH,
            LitSpeed::Stops => &[End::Rest],
            LitSpeed::Exact => &[End::Moving],
        }
    }
}

/// How a dark move goes from rest to rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DarkMove {
    /// Both joints by one profile of that shape, each over its own distance.
    Shaped(Shape),
    /// As fast as each joint can, limited in jerk, both arriving together ([`crate::steer`]).
    Optimal,
}

/// How a drawing is to be run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanRequest {
    /// Speed of the lit spot on the target, m/s; slower where the motors need it.
    pub speed_m_s: f64,
    /// Whether that is to be kept.
    pub lit_speed: LitSpeed,
    /// The dark moves from rest to rest.
    pub travel: DarkMove,
    /// Time over which the acceleration along a stroke builds up, s.
    pub ramp_s: f64,
    /// Rest before a stroke that begins at rest is lit, s.
    pub settle_s: f64,
    /// Distance from the stroke at which the laser is to be darkened, m.
    pub tolerance_m: f64,
    /// How far corners may be rounded off, m: by so much the line may lie inside of them where that is quicker than to stop
    /// there; at one speed, where they need no slowing down then. Zero keeps all of them sharp, and where a closed stroke
    /// begins it stays sharp anyway.
    pub corner_m: f64,
}

impl PlanRequest {
    /// Rest before a stroke that does not begin where the last one ends, s: to settle, and for the relay to have let go
    /// before it is to hold again.
    pub fn lift_s(&self, machine: &Machine) -> f64 {
        self.settle_s.max(f64::from(relay_ticks(machine)) * TICK_F64_S)
    }

    /// The same with time enough for the acceleration to build up within the highest jerk.
    pub(crate) fn within_jerk(&self, machine: &Machine) -> Self {
        Self { ramp_s: self.ramp_s.max(machine.least_ramp_s()), ..*self }
    }

    /// How long the spot runs up to a stroke, s: past the end of the S-curve, and for the relay to have let go before it
    /// is to hold again.
    pub(crate) fn run_up_s(&self, machine: &Machine) -> f64 {
        RUN_UP_S.max(0.5 * self.ramp_s).max(f64::from(relay_ticks(machine)) * TICK_F64_S)
    }

    /// Time over which the acceleration of dark moves under way builds up, s.
    pub(crate) fn swing_rise_s(&self) -> f64 {
        0.5 * self.ramp_s
    }
}

/// From one light to the next at least, ticks.
const fn relay_ticks(machine: &Machine) -> u32 {
    machine.relay_on_ticks + machine.relay_off_ticks + 1
}

/// Shortest run-up, s: on the simulated 2006 rig the error at a stroke's start is no smaller after a longer one.
const RUN_UP_S: f64 = 0.015;

/// Times a drawing, strokes in the order given, starting from rest straight ahead.
///
/// Every stroke is reached in the dark. Its corners and ends are drawn from rest to rest, or passed at speed, with a dark
/// way up and out: whichever makes the whole drawing faster, unless [`LitSpeed::Exact`] asks for the latter. A stroke that
/// begins where the one before ends may stay lit between. The result is what is executed, tick by tick.
pub fn plan(drawing: &Drawing, machine: &Machine, request: &PlanRequest) -> Result<Plan, PlanError> {
    check_length(drawing, request)?;
    let request = &request.within_jerk(machine);
    let (mut request, mut tightest) = at_one_speed(drawing, machine, request)?;
    loop {
        let mut plan = at_speed(drawing, machine, &request)?;
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
fn at_speed(drawing: &Drawing, machine: &Machine, request: &PlanRequest) -> Result<Plan, PlanError> {
    let home = PanTilt::new(0.0, 0.0);
    let mut tour = Tour::new(drawing, machine, request, home)?;
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
        for leg in Leg::split(&drawn.path, &Corners::of(machine, &unhurried)) {
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

pub(crate) fn check_duration(needed_s: f64) -> Result<(), PlanError> {
    if needed_s <= LONGEST_S { Ok(()) } else { Err(PlanError::TooLong { needed_s, most_s: LONGEST_S }) }
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
            light_up(&mut self.plan.points, self.request.lift_s(self.machine), spot, leg.stroke);
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
