//! Motion along one line or arc of the target from rest to rest, with any profile.

mod fit;

use tracelight_aim::{AimError, JointPath};
use tracelight_rig::{Joint, PanTilt, TICK_F64_S};
use tracelight_stroke::{Piece, Point};

use crate::compress::compress;
use crate::error::PlanError;
use crate::leg::{LENGTH_TOLERANCE_M, Leg};
use crate::machine::Machine;
use crate::motion::JointMotion;
use crate::move_point::MovePoint;
use crate::plan::{Plan, PlanPoint, check_duration};
use crate::planner::{FINAL_REST_S, assess, dark, last_tick, light_up, linger, rest};
use crate::profile::limits::{MoveLimits, Peaks};
use crate::profile::{Profile, Ramps, Shape};
use crate::request::{DarkMove, PlanRequest};
use crate::retime::along::Along;
use crate::retime::{AlongLimits, PathSample, Retimed, TimeLaw, chain};
use crate::travel::travel;

/// Why a course cannot be followed.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum CourseError {
    /// The path has no length.
    #[error("the path has no length: it begins where it ends")]
    NoLength,
    /// Part of it cannot be lit from where the head stands.
    #[error("{:.1} mm along it the path leaves the head's reach: {source}", 1e3 * at_m)]
    Reach {
        /// How far along, m.
        at_m: f64,
        /// Where and why.
        source: AimError,
    },
    /// The motors cannot follow it, or not soon enough.
    #[error(transparent)]
    Plan(#[from] PlanError),
}

/// A line, an arc or a cubic on the target, in front of a head.
#[derive(Clone, Debug)]
pub struct Course<'m> {
    machine: &'m Machine,
    leg: Leg,
    /// Its places, [`GRID_M`] apart or nearer.
    samples: Vec<PathSample>,
}

/// How a course is run over time, from rest to rest.
#[derive(Clone, Debug)]
pub struct Pace {
    way: Way,
    peaks: Peaks,
}

#[derive(Clone, Debug)]
enum Way {
    Shaped(Profile),
    Optimal(TimeLaw),
}

/// Where everything is at one time of a course.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoursePoint {
    /// Since its start, s.
    pub t_s: f64,
    /// Arc length, speed and acceleration along it: m, m/s, m/s².
    pub along: MovePoint,
    /// The spot on the target, m.
    pub spot: Point,
    /// Both joints.
    pub joints: PanTilt<JointMotion>,
    /// Required torque of both motors, N m, with friction for the present or intended direction of motion.
    pub torque_nm: PanTilt<f64>,
}

impl Pace {
    fn shaped(profile: Profile) -> Self {
        Self { peaks: profile.peaks(), way: Way::Shaped(profile) }
    }

    fn optimal(retimed: &Retimed) -> Self {
        let most = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, f64::max);
        let accelerations = || retimed.accelerations().iter().flatten().copied();
        let peaks = Peaks {
            speed: most(&mut retimed.speeds().iter().copied()),
            acceleration: most(&mut accelerations()),
            deceleration: most(&mut accelerations().map(|u| -u)),
            jerk: None,
            speed_jump: 0.0,
        };
        Self { way: Way::Optimal(retimed.law(0.0)), peaks }
    }

    /// How long it takes, s.
    pub const fn duration_s(&self) -> f64 {
        match &self.way {
            Way::Shaped(profile) => profile.duration_s(),
            Way::Optimal(law) => law.duration_s(),
        }
    }

    /// The most of its derivatives along the course: m/s, m/s², m/s³.
    pub const fn peaks(&self) -> &Peaks {
        &self.peaks
    }

    /// Arc length, speed and acceleration at a time: m, m/s, m/s².
    pub fn at(&self, t_s: f64) -> MovePoint {
        match &self.way {
            Way::Shaped(profile) => profile.at(t_s),
            Way::Optimal(law) => {
                let Along { s, v, a } = law.at(t_s);
                MovePoint { position: s, velocity: v, acceleration: a }
            }
        }
    }

    /// `count` times evenly from just after its start to just before its end, and both sides of every jump of the
    /// acceleration, s.
    fn times_s(&self, count: usize) -> impl Iterator<Item = f64> + '_ {
        let duration_s = self.duration_s();
        let aside = 1e-9 * duration_s;
        let even = (0..=count).map(move |i| i as f64 / count as f64 * duration_s);
        let breaks = match &self.way {
            Way::Shaped(profile) => profile.breaks_s().to_vec(),
            Way::Optimal(_) => Vec::new(),
        };
        let sides = breaks.into_iter().flat_map(move |t| [t - aside, t + aside]);
        even.chain(sides).map(move |t| t.clamp(aside, duration_s - aside))
    }
}

impl<'m> Course<'m> {
    /// In front of a head.
    ///
    /// # Errors
    /// [`CourseError::NoLength`], or [`CourseError::Reach`] where the head cannot light part of it.
    pub fn new(machine: &'m Machine, piece: Piece) -> Result<Self, CourseError> {
        let length_m = piece.length(LENGTH_TOLERANCE_M);
        // asked this way round, a number that is none has no length
        let leg = Leg::joined(&[(piece, length_m)], &[]).pop().filter(|leg| leg.length_m() > SHORTEST_M);
        let leg = leg.ok_or(CourseError::NoLength)?;
        let reach = |source| CourseError::Reach { at_m: first_out_of_reach(machine, &leg), source };
        let samples = leg.samples(machine, f64::INFINITY, (GRID_M, FEWEST)).map_err(reach)?;
        Ok(Self { machine, leg, samples })
    }

    /// Arc length, m.
    pub fn length_m(&self) -> f64 {
        self.leg.length_m()
    }

    /// Runs the course with the fastest profile of a shape within limits (m/s, m/s²), regardless of the motors.
    pub fn shaped(&self, shape: Shape, limits: &MoveLimits) -> Pace {
        Pace::shaped(Profile::new(shape, self.length_m(), limits))
    }

    /// As fast as limits and motors allow, place by place: no shape.
    ///
    /// # Errors
    /// [`PlanError::TooWeak`] where a motor cannot even hold or start its joint.
    pub fn optimal(&self, limits: &MoveLimits) -> Result<Pace, CourseError> {
        let capped = self.samples.iter().map(|&sample| PathSample { cap: limits.speed, ..sample });
        let along = AlongLimits { acceleration: limits.acceleration, deceleration: limits.deceleration };
        let retimed = Retimed::within(self.machine, capped.collect(), [0.0, 0.0], Some(&along))?;
        Ok(Pace::optimal(&retimed))
    }

    /// Where everything is at a time.
    ///
    /// # Errors
    /// None within reach, which [`Course::new`] has looked at.
    pub fn at(&self, pace: &Pace, t_s: f64) -> Result<CoursePoint, CourseError> {
        let along = pace.at(t_s);
        let (spot, path) = self.joints_at(along.position)?;
        let joints = chain(&path, &Along { s: along.position, v: along.velocity, a: along.acceleration });
        Ok(CoursePoint { t_s, along, spot, joints, torque_nm: self.torque(&path, &joints) })
    }

    /// Tick by tick; the last is the first at rest at its end.
    ///
    /// # Errors
    /// [`PlanError::TooLong`].
    pub fn ticks(&self, pace: &Pace) -> Result<Vec<CoursePoint>, CourseError> {
        check_duration(pace.duration_s())?;
        let ticks = (pace.duration_s() / TICK_F64_S - 1e-9).ceil().max(1.0) as usize;
        (0..=ticks).map(|tick| self.at(pace, tick as f64 * TICK_F64_S)).collect()
    }

    /// The largest torque asked of either motor, N m.
    ///
    /// # Errors
    /// None within reach.
    pub fn torque_peaks_nm(&self, pace: &Pace) -> Result<PanTilt<f64>, CourseError> {
        let mut most = PanTilt::new(0.0, 0.0);
        for t_s in pace.times_s(DENSE.max(self.samples.len())) {
            let torque = self.at(pace, t_s)?.torque_nm;
            most = PanTilt::from_fn(|j| f64::max(most[j], torque[j].abs()));
        }
        Ok(most)
    }

    /// A job that follows the course lit, from straight ahead: in the dark to its start, a rest, the course, a rest.
    ///
    /// # Errors
    /// [`PlanError::TooLong`], or [`PlanError::TooWeak`] on the way to its start.
    pub fn plan(&self, pace: &Pace, request: &PlanRequest) -> Result<Plan, CourseError> {
        let machine = self.machine;
        let ticks = self.ticks(pace)?;
        let (home, start) = (PanTilt::new(0.0, 0.0), ticks[0].joints.map(|j| j.position_rad));
        let shape = match request.travel {
            DarkMove::Shaped(shape) => shape,
            DarkMove::Optimal => Shape::Ramped(Ramps::REPORT),
        };
        let mut points = vec![rest(machine, home)];
        points.extend(travel(machine, shape, home, start)?.into_iter().map(|joints| dark(machine, joints)));
        light_up(&mut points, request.lift_s(machine), ticks[0].spot, 0);
        let start_tick = last_tick(&points);
        let lit = |p: &CoursePoint| PlanPoint {
            lit: true,
            stroke: Some(0),
            ..assess(machine, p.spot, p.joints, p.along.velocity / pace.peaks.speed)
        };
        points.extend(ticks[1..].iter().map(lit));
        let leg_end = self.leg.rest_at_end(start_tick, last_tick(&points));
        linger(&mut points, FINAL_REST_S);
        Ok(Plan {
            segments: compress(&points, machine, request.tolerance_m),
            points,
            leg_ends: vec![leg_end],
            set_speed_m_s: pace.peaks.speed,
            tightest: None,
        })
    }

    fn joints_at(&self, s_m: f64) -> Result<(Point, JointPath), CourseError> {
        let reach = |source| CourseError::Reach { at_m: s_m, source };
        self.leg.joints_at(self.machine, s_m).map_err(reach)
    }

    /// Torque at a place; friction is that of the way the joints go along the course, also where they start or stop.
    fn torque(&self, path: &JointPath, joints: &PanTilt<JointMotion>) -> PanTilt<f64> {
        const BARELY: f64 = 1e-12;
        let rates = PanTilt::from_fn(|j: Joint| {
            let rate = joints[j].velocity_rad_s;
            if rate == 0.0 { BARELY * path.first[j] } else { rate }
        });
        self.machine.torque(joints.map(|j| j.position_rad), rates, joints.map(|j| j.acceleration_rad_s2))
    }
}

/// A shorter course is none, m.
const SHORTEST_M: f64 = 1e-6;

/// Distance of the places along a course, m, and their least number.
const GRID_M: f64 = 2e-4;
const FEWEST: f64 = 500.0;

/// Times at which a motion's torque is looked at at least, once it stands.
const DENSE: usize = 2000;

/// How far along a leg the head can follow, m.
fn first_out_of_reach(machine: &Machine, leg: &Leg) -> f64 {
    let places = (leg.length_m() / GRID_M).clamp(FEWEST, 1e5).ceil() as u32;
    let at = |i: u32| f64::from(i) / f64::from(places) * leg.length_m();
    (0..=places).map(at).find(|&s| leg.joints_at(machine, s).is_err()).unwrap_or(leg.length_m())
}
