//! A line or an arc of the target followed from rest to rest by every profile: as asked, and as the motors can.
//!
//! It is what the 2006 report did in LabVIEW.

mod figure;
mod view;

use std::ops::ControlFlow;

use tracelight_aim::HeadPose;
use tracelight_pipeline::request_of;
use tracelight_rig::PanTilt;
use tracelight_sim::{RigConfig, Run, SimulatedRig, Tracking, score};
use tracelight_stroke::{Element, Piece, Point};
use tracelight_task::{Failure, Task};
use tracelight_trajectory::{Course, CourseError, Machine, MoveLimits, Pace, PlanError, Ramps};
use tracelight_units::Rate;

use crate::finding::Experiment;
use crate::profile_name::ProfileName;

/// What is followed, by what, and how.
#[derive(Clone, Debug)]
pub struct Request {
    /// The rig.
    pub rig: RigConfig,
    /// Where it stands before the target.
    pub pose: HeadPose,
    /// What is followed.
    pub way: Way,
    /// Highest speed.
    pub speed: Rate,
    /// Highest acceleration.
    pub acceleration: Rate,
    /// Highest deceleration.
    pub deceleration: Rate,
    /// The S-curve's ramps.
    pub ramps: Ramps,
    /// Which are plotted; the first of them is the one of the table.
    pub profiles: Vec<ProfileName>,
    /// Takes the limits as they are, whatever that asks of the motors, and runs nothing.
    pub as_asked: bool,
    /// Of what differs from head to head.
    pub seed: u64,
}

/// A way on the target; its points are m right and up of the centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Way {
    /// A straight line. Rates in rad are the beam's as it is straight ahead.
    Line {
        /// Where it begins.
        from: Point,
        /// Where it ends.
        to: Point,
    },
    /// Part of a circle. Rates in rad are about its centre.
    Arc {
        /// Where it begins.
        from: Point,
        /// The circle's centre.
        centre: Point,
        /// How far round, anticlockwise, rad.
        sweep_rad: f64,
    },
}

/// A way by every profile.
pub struct Finding {
    wish: Wish,
    rig: RigConfig,
    machine: Machine,
    length_m: f64,
    profiles: Vec<ProfileName>,
    as_asked: bool,
    entries: Vec<Entry>,
}

/// What is to be followed.
struct Wish {
    /// In words.
    title: String,
    piece: Piece,
    limits: MoveLimits,
}

/// One profile's moves.
struct Entry {
    name: ProfileName,
    /// By the limits as they were asked for, and the torque that takes; none for the optimum, which is the motors'.
    asked: Option<(Pace, PanTilt<f64>)>,
    /// What the motors can do of it, and how the simulated rig follows that.
    on_rig: Option<OnRig>,
}

struct OnRig {
    pace: Pace,
    run: Run,
    tracking: Tracking,
    /// The tick of the plan at which the move begins.
    start_tick: u32,
    /// The rig left the course and held, or did not get to the end.
    held: bool,
}

impl Experiment for Request {
    type Finding = Finding;

    fn run(self, task: Task<'_>) -> Result<Finding, Failure> {
        let machine = self.rig.machine(self.pose);
        let wish = self.wish()?;
        let course = Course::new(&machine, wish.piece).map_err(failure)?;
        if self.as_asked && self.profiles.contains(&ProfileName::Optimal) {
            let message = "--profile optimal is as fast as the motors can, and --as-asked leaves them out; leave one away";
            return Err(Failure::usage("usage", message));
        }
        let mut entries = Vec::new();
        for name in ProfileName::ALL {
            task.check()?;
            let asked = asked(name, &course, (&wish.limits, self.ramps)).map_err(failure)?;
            entries.push(Entry { name, asked, on_rig: None });
        }
        if !self.as_asked {
            self.run_all(&mut entries, &course, &wish.limits, task)?;
        }
        let Self { rig, profiles, as_asked, .. } = self;
        Ok(Finding { length_m: course.length_m(), wish, rig, machine, profiles, as_asked, entries })
    }
}

impl Request {
    fn wish(&self) -> Result<Wish, Failure> {
        let (piece, metres_per_rad, title) = self.way.course(&self.pose)?;
        let limits = MoveLimits {
            speed: self.speed.linear(metres_per_rad),
            acceleration: self.acceleration.linear(metres_per_rad),
            deceleration: self.deceleration.linear(metres_per_rad),
        };
        Ok(Wish { title, piece, limits })
    }

    /// Fits every profile to the motors, and if none takes too long runs them all.
    fn run_all(
        &self,
        entries: &mut [Entry],
        course: &Course<'_>,
        limits: &MoveLimits,
        task: Task<'_>,
    ) -> Result<(), Failure> {
        let mut paces = Vec::new();
        for entry in entries.iter() {
            let pace = match entry.name.shape(self.ramps) {
                None => course.optimal(limits),
                Some(shape) => course.shaped_for_motors(shape, limits),
            };
            let pace = pace.map_err(failure)?;
            if pace.duration_s() > LONGEST_S {
                let too_long = PlanError::TooLong { needed_s: pace.duration_s(), most_s: LONGEST_S };
                return Err(failure(too_long.into()));
            }
            paces.push(pace);
        }
        for (entry, pace) in entries.iter_mut().zip(paces) {
            entry.on_rig = Some(self.run_one(pace, course, task).map_err(failure)?);
            task.check()?;
        }
        Ok(())
    }

    fn run_one(&self, pace: Pace, course: &Course<'_>, task: Task<'_>) -> Result<OnRig, CourseError> {
        let plan = course.plan(&pace, &request_of(&self.rig))?;
        let mut simulated = SimulatedRig::new(&self.rig.trusting(), self.pose, self.seed);
        let run = tracelight_sim::run(&mut simulated, &plan, false, |_, _| {
            if task.stop.is_wanted() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        let tracking = score(&plan, &run, plan.set_speed_m_s);
        // a rig that holds takes longer than its plan
        let held = !run.is_done() || run.ticks.len() > plan.points.len() + 50;
        let start_tick = plan.leg_ends.first().map_or(0, |end| end.start_tick);
        Ok(OnRig { pace, run, tracking, start_tick, held })
    }
}

impl Way {
    /// The way itself, how long a radian is of it, m, and what it is in words.
    fn course(self, pose: &HeadPose) -> Result<(Piece, f64, String), Failure> {
        match self {
            Self::Line { from, to } => {
                let length_mm = 1e3 * from.distance(to);
                let title = format!("line of {length_mm:.1} mm from {} to {} mm", in_mm(from), in_mm(to));
                Ok((Piece { from, element: Element::Line { to } }, pose.distance_m, title))
            }
            Self::Arc { from, centre, sweep_rad } => {
                let radius_m = from.distance(centre);
                if radius_m < 1e-6 {
                    let message = "--start is at --centre: such an arc has no radius; move one of them";
                    return Err(Failure::usage("usage", message));
                }
                let title = format!(
                    "arc of {:.4}° about {} from {} mm, radius {:.1} mm",
                    sweep_rad.to_degrees(),
                    in_mm(centre),
                    in_mm(from),
                    1e3 * radius_m
                );
                let element = Element::Arc { centre, sweep: sweep_rad };
                Ok((Piece { from, element }, radius_m, title))
            }
        }
    }
}

impl Finding {
    /// The course itself.
    fn course(&self) -> Result<Course<'_>, Failure> {
        Course::new(&self.machine, self.wish.piece).map_err(failure)
    }

    /// The moves to be plotted, in the order they were named.
    fn chosen(&self) -> impl Iterator<Item = &Entry> {
        self.profiles.iter().filter_map(|&name| self.entries.iter().find(|entry| entry.name == name))
    }

    /// What an ideal encoder would count, from straight ahead.
    fn counts(&self, angle_rad: PanTilt<f64>) -> PanTilt<i64> {
        angle_rad.map(|angle| (angle / self.rig.model.encoder.count_rad()).round() as i64)
    }
}

impl Entry {
    /// The move that is wanted: on the rig, or as asked.
    fn pace(&self) -> Option<&Pace> {
        let asked = self.asked.as_ref().map(|(pace, _)| pace);
        self.on_rig.as_ref().map(|on_rig| &on_rig.pace).or(asked)
    }
}

fn in_mm(at: Point) -> String {
    format!("({:.1}, {:.1})", 1e3 * at.x, 1e3 * at.y)
}

/// A profile by the limits as they were asked for, and the torque that takes.
fn asked(
    name: ProfileName,
    course: &Course<'_>,
    (limits, ramps): (&MoveLimits, Ramps),
) -> Result<Option<(Pace, PanTilt<f64>)>, CourseError> {
    let Some(shape) = name.shape(ramps) else { return Ok(None) };
    let pace = course.shaped(shape, limits);
    let torque_nm = course.torque_peaks_nm(&pace)?;
    Ok(Some((pace, torque_nm)))
}

/// Longest move that is run, s: all seven are kept, tick by tick.
const LONGEST_S: f64 = 60.0;

fn failure(error: CourseError) -> Failure {
    match error {
        CourseError::NoLength => Failure::usage("usage", error),
        CourseError::Reach { .. } => {
            let message = format!("{error}; move it nearer to the centre, or step back (--distance)");
            Failure::failed("unreachable", message)
        }
        CourseError::Plan(PlanError::TooLong { needed_s, most_s }) => {
            let message = format!(
                "the move would take {needed_s:.0} s, and at most {most_s:.0} s are run; give it a higher --vmax or --amax"
            );
            Failure::failed("too-long", message)
        }
        CourseError::Plan(error) => Failure::failed("motor-too-weak", error),
    }
}
