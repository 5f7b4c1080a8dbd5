//! Finds where a plan's light would stand too long, before anything is lit.

use tracelight_control::{Config, LightBudget};
use tracelight_maths::{cos, hypot};
use tracelight_rig::{PanTilt, SPEED_RANGE, Segment, TICK_F64_S};
use tracelight_session::ATTENDED_TICKS;
use tracelight_stroke::Point;
use tracelight_trajectory::{Plan, PlanPoint};

use crate::config::RigConfig;

/// Share of the budget that a plan may use: a head that follows it comes back to where it was pushed off, and starts slowly there.
const PLANNED_SHARE: f64 = 0.9;
/// Share of the budget that a plan may use that somebody slows: at its own speed it uses less.
const SLOWED_SHARE: f64 = 0.95;
/// What is told of as one place: the diagonal of the budget's squares, in radii, as far as light may be from some of it that is charged with it.
const ABOUT_RADII: f64 = 5.8;

/// Light that would stand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Standing {
    /// Where on the target, m.
    pub spot: Point,
    /// Number of the stroke, from 0; `None` between strokes, through the relay's delay.
    pub stroke: Option<u32>,
    /// Total time of light in this place, s.
    pub stands_s: f64,
    /// Radius of the place as the head sees it, rad.
    pub about_rad: f64,
    /// Time allowed, s.
    pub most_s: f64,
}

/// Finds the first place of a plan where light would stand too long, starting from an unspent budget.
pub fn first_standing(rig: &RigConfig, plan: &Plan) -> Option<Standing> {
    let most_s = planned_s(rig);
    let config = planned_config(rig);
    let tick = Watch::new(&config).pass(moments(&plan.segments))?;
    let point = plan.points.get(tick).or(plan.points.last())?;
    let about_rad = ABOUT_RADII * f64::from(config.standing_radius_rad);
    let is_near = |other: &&PlanPoint| {
        let off = PanTilt::from_fn(|j| other.joints[j].position_rad - point.joints[j].position_rad);
        hypot(off.pan * cos(point.joints.tilt.position_rad), off.tilt) <= about_rad
    };
    let lit = plan.points.iter().filter(|other| other.lit).filter(is_near).count();
    Some(Standing {
        spot: point.spot,
        stroke: point.stroke,
        stands_s: lit as f64 * TICK_F64_S,
        about_rad,
        most_s,
    })
}

/// The lowest speed of a plan's clock, as a share of the plan's own, at which its light stands nowhere: slower it is longer in each place. 0 where every speed that may
/// be asked is fast enough.
pub fn slowest_speed(rig: &RigConfig, plan: &Plan) -> f32 {
    /// Steps of a whole by which it is found.
    const STEPS: f32 = 20.0;
    let standing_ticks = (SLOWED_SHARE * rig.light.standing_s / TICK_F64_S) as u32;
    let config = Config { standing_ticks, ..rig.control_config() };
    let stands = |speed: f32| Watch::new(&config).pass(slowed(&plan.segments, speed)).is_some();
    if !stands(SPEED_RANGE.0) {
        return 0.0;
    }
    let (mut least, mut most) = ((SPEED_RANGE.0 * STEPS) as u32, STEPS as u32);
    while most - least > 1 {
        let middle = u32::midpoint(least, most);
        if stands(middle as f32 / STEPS) {
            least = middle;
        } else {
            most = middle;
        }
    }
    most as f32 / STEPS
}

/// How long it must be dark between a way that is gone again and again, ticks, so that its light stands nowhere; `None` where no wait of up to
/// 30 s is long enough.
pub(crate) fn wait_between(rig: &RigConfig, segments: &[Segment]) -> Option<u32> {
    /// How long it is gone again and again while a wait is looked for, ticks.
    const SHORT_RUN: u32 = 120_000;
    /// As long as it may go on at all, and some more: what is found must last for that.
    const LONG_RUN: u32 = ATTENDED_TICKS + 60_000;
    const MOST: u32 = 30_000;
    const STEP: u32 = 50;
    let config = planned_config(rig);
    let lap = segments.last().map_or(0, Segment::end_tick).max(1);
    let end = segments.last().map(|s| s.sample(f32::from(s.ticks)).map(|at| at.position_rad));
    let way: Vec<_> = moments(segments).collect();
    let is_enough = |wait: u32, run: u32| {
        let laps = run.div_ceil(lap + wait).max(2);
        let mut watch = Watch::new(&config);
        (0..laps).all(|_| {
            let is_lit = watch.pass(way.iter().copied()).is_none();
            watch.wait(wait, end);
            is_lit
        })
    };
    let (mut least, mut most) = (0, MOST / STEP);
    if is_enough(0, LONG_RUN) {
        return Some(0);
    }
    if !is_enough(MOST, SHORT_RUN) {
        return None;
    }
    while most - least > 1 {
        let middle = least.midpoint(most);
        if is_enough(middle * STEP, SHORT_RUN) {
            most = middle;
        } else {
            least = middle;
        }
    }
    let mut wait = most * STEP;
    while !is_enough(wait, LONG_RUN) {
        wait += wait / 10 + STEP;
        if wait > MOST {
            return None;
        }
    }
    Some(wait)
}

/// How long light may stand by plan, s.
fn planned_s(rig: &RigConfig) -> f64 {
    PLANNED_SHARE * rig.light.standing_s
}

/// A controller that allows a plan less than it would.
fn planned_config(rig: &RigConfig) -> Config {
    Config { standing_ticks: (planned_s(rig) / TICK_F64_S) as u32, ..rig.control_config() }
}

/// A tick of a way: where the head is to be, how fast, and whether it is lit.
#[derive(Clone, Copy)]
struct Moment {
    angle_rad: PanTilt<f32>,
    rate_rad_s: PanTilt<f32>,
    gate: bool,
}

/// A head's light, looked after along a plan that is still in the making.
#[derive(Clone, Debug)]
pub struct LightAhead {
    config: Config,
    budget: LightBudget,
}

impl LightAhead {
    /// Of a head that lit nothing yet, with that share of what a plan may use.
    #[must_use]
    pub fn new(rig: &RigConfig, share: f64) -> Self {
        let config = planned_config(rig);
        let standing_ticks = (share * f64::from(config.standing_ticks)) as u32;
        Self { config: Config { standing_ticks, ..config }, budget: LightBudget::new() }
    }

    /// Goes along ticks of a plan; the first at which the light would stand, where it stays.
    pub fn pass(&mut self, points: &[PlanPoint]) -> Option<usize> {
        points.iter().position(|point| {
            let angle_rad = point.joints.map(|joint| joint.position_rad as f32);
            let rate_rad_s = point.joints.map(|joint| joint.velocity_rad_s as f32);
            self.budget.tick(&self.config, Some(angle_rad), point.lit, None);
            point.lit && self.budget.is_spent(&self.config, Some((angle_rad, rate_rad_s)))
        })
    }

    /// Lets dark ticks pass.
    pub fn wait(&mut self, ticks: u32) {
        for _ in 0..ticks {
            self.budget.tick(&self.config, Some(PanTilt::default()), false, None);
        }
    }
}

/// The ticks of segments that follow each other without a gap.
fn moments(segments: &[Segment]) -> impl Iterator<Item = Moment> {
    let of = |segment: &Segment, n: u16| {
        let at = segment.sample(f32::from(n));
        Moment {
            angle_rad: at.map(|setpoint| setpoint.position_rad),
            rate_rad_s: at.map(|setpoint| setpoint.velocity_rad_s),
            gate: segment.gate,
        }
    };
    segments.iter().flat_map(move |segment| (0..segment.ticks).map(move |n| of(segment, n)))
}

/// The ticks of segments whose plan's clock goes slower.
fn slowed(segments: &[Segment], speed: f32) -> impl Iterator<Item = Moment> {
    let of = move |segment: &Segment, n: u32| {
        let at = segment.sample((n as f32 * speed).min(f32::from(segment.ticks)));
        Moment {
            angle_rad: at.map(|setpoint| setpoint.position_rad),
            rate_rad_s: at.map(|setpoint| speed * setpoint.velocity_rad_s),
            gate: segment.gate,
        }
    };
    segments.iter().flat_map(move |segment| {
        let ticks = (f32::from(segment.ticks) / speed).ceil() as u32;
        (0..ticks).map(move |n| of(segment, n))
    })
}

/// A light budget, looked after along segments.
struct Watch<'a> {
    config: &'a Config,
    budget: LightBudget,
    gate: bool,
}

impl<'a> Watch<'a> {
    const fn new(config: &'a Config) -> Self {
        Self { config, budget: LightBudget::new(), gate: false }
    }

    /// The first tick of a way in which a controller so configured would be dark by its light budget.
    fn pass(&mut self, way: impl IntoIterator<Item = Moment>) -> Option<usize> {
        for (tick, moment) in way.into_iter().enumerate() {
            self.budget.tick(self.config, Some(moment.angle_rad), self.gate, None);
            self.gate = moment.gate;
            let place = (moment.angle_rad, moment.rate_rad_s);
            if self.gate && self.budget.is_spent(self.config, Some(place)) {
                return Some(tick);
            }
        }
        None
    }

    /// Lets dark ticks pass at these angles, rad.
    fn wait(&mut self, ticks: u32, angle_rad: Option<PanTilt<f32>>) {
        for _ in 0..ticks {
            self.budget.tick(self.config, angle_rad, self.gate, None);
            self.gate = false;
        }
    }
}
