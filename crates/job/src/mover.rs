//! A head that stays where it is between programs, moved by hand: parked, homed where it rests, jogged in the dark; a dot let out to see where one is that is not homed.

use tracelight_eye::refused;
use tracelight_pipeline::Driving;
use tracelight_rig::{Darkness, Fault, Joint, PanTilt, TICK_F64_S};
use tracelight_session::{Job, Request, Session, State};
use tracelight_sim::{Observed, Tick, observed_tick};
use tracelight_stroke::{Point, Vec2};
use tracelight_task::{Failure, Task};

use crate::course::{Wall, gone};

mod stops;

/// Fastest and most sudden that a joint is jogged.
const GENTLE_RAD_S: f64 = 1.0;
const GENTLE_RAD_S2: f64 = 4.0;
/// For how long a head rests that has come to rest, and how long that and parking may take, ticks. One whose motors have just taken hold of it is not known to move
/// yet.
const SETTLED_TICKS: u32 = 300;
const REST_TICKS: u32 = 5000;
const PARK_TICKS: u32 = 30_000;
/// How long a rig may take to say that it is homed, ticks.
const HOME_TICKS: u32 = 500;
/// Furthest that a joint is jogged at once of which nobody knows where it is, rad.
const BLIND_RAD: f64 = std::f64::consts::FRAC_PI_6;
/// Ticks after a dot in which a relay opens.
const DOT_ENDS_TICKS: u32 = 300;

/// Where a head rests.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Angles of the joints by its encoders, rad; from where it was powered up if it is not homed.
    pub angle_rad: PanTilt<f64>,
    /// Where its beam meets the target by them, m; `None` where it misses that, or is not homed.
    pub spot: Option<Point>,
    /// Whether it knows where it points.
    pub homed: bool,
}

impl Place {
    /// For people.
    #[must_use]
    pub fn words(&self) -> String {
        // nobody reads a sign of nothing
        let rounded = |value: f64, digit: f64| (value / digit).round() * digit + 0.0;
        let PanTilt { pan, tilt } = self.angle_rad.map(|angle| rounded(angle.to_degrees(), 0.01));
        let angles = format!("pan {pan:.2}°, tilt {tilt:.2}°");
        match (self.homed, self.spot) {
            (false, _) => format!("the head is not homed; it is at {angles} from where it was powered up"),
            (true, Some(spot)) => {
                let [x, y] = [spot.x, spot.y].map(|m| rounded(1e3 * m, 0.1));
                format!(
                    "the head is at {angles}: by what it tells its beam meets the target at {x:.1}, {y:.1} mm"
                )
            }
            (true, None) => format!("the head is at {angles}: by what it tells its beam misses the target"),
        }
    }
}

/// Where a head is to be jogged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Jog {
    /// By these angles, rad: pan positive to the left as seen from the head, tilt positive down.
    Angles(PanTilt<f64>),
    /// By that far on the target, m: right and up.
    By(Vec2),
    /// To that place on the target, m.
    To(Point),
}

/// A head in the hands of somebody who moves it.
pub struct Mover<'a> {
    wall: Wall<'a>,
    driving: &'a Driving,
    task: Task<'a>,
    last: Tick,
    /// A fault by which counts may have been lost while a stop was looked for.
    lost: Option<Fault>,
}

impl<'a> Mover<'a> {
    /// Takes over a head, disarmed, and waits until it rests.
    ///
    /// # Errors
    /// Its fault; `rig-gone`; `interrupted`.
    pub fn new(
        rig: &'a mut (dyn Observed + 'a),
        driving: &'a Driving,
        task: Task<'a>,
    ) -> Result<Self, Failure> {
        let mut wall = Session::new(rig);
        let Some(last) = observed_tick(&mut wall) else { return Err(gone()) };
        let mut mover = Self { wall, driving, task, last, lost: None };
        mover.settle()?;
        Ok(mover)
    }

    /// Where it rests.
    #[must_use]
    pub fn place(&self) -> Place {
        let homed = self.last.telemetry.homed;
        let angle_rad = self.last.telemetry.position_rad.map(f64::from);
        Place { angle_rad, spot: self.last.spot.filter(|_| homed), homed }
    }

    /// Returns to where both joints are at zero, in the dark; of a head that is not homed that is where it was powered up.
    ///
    /// # Errors
    /// As of [`new`](Self::new); `unfinished`: it does not come there.
    pub fn park(&mut self) -> Result<Place, Failure> {
        self.ask(Request::Park)?;
        self.wait(PARK_TICKS, |wall| wall.state() != State::Parking)?;
        self.settle()?;
        Ok(self.place())
    }

    /// Takes the place where it rests to be at these angles, rad.
    ///
    /// # Errors
    /// As of [`new`](Self::new); `unreachable`: its joints cannot be there; `session`: they move.
    pub fn home(&mut self, at_rad: PanTilt<f64>) -> Result<Place, Failure> {
        self.check_range(at_rad, "would be")?;
        let count_rad = self.driving.rig.model.encoder.count_rad();
        self.home_at(at_rad.map(|angle| (angle / count_rad).round() as i32))
    }

    /// Homes it by what its encoders are to read.
    fn home_at(&mut self, counts: PanTilt<i32>) -> Result<Place, Failure> {
        let count_rad = self.driving.rig.model.encoder.count_rad();
        self.ask(Request::Home(counts))?;
        let off_rad = |wall: &Wall<'_>| {
            let at = wall.told().position_rad;
            let off = |j: Joint| (f64::from(at[j]) - f64::from(counts[j]) * count_rad).abs();
            Joint::BOTH.into_iter().map(off).fold(0.0, f64::max)
        };
        self.wait(HOME_TICKS, |wall| wall.told().homed && off_rad(wall) < 0.5 * count_rad + 1e-3)?;
        // a board keeps the zero of a head that rests
        self.settle()?;
        Ok(self.place())
    }

    /// Turns it in the dark.
    ///
    /// # Errors
    /// As of [`new`](Self::new); `unhomed`, `unreachable`, `usage`: it cannot be turned there; `unfinished`: it does not come there.
    pub fn jog(&mut self, jog: Jog) -> Result<Place, Failure> {
        let from = self.place().angle_rad;
        let to = self.target_rad(jog)?;
        if from == to {
            return Ok(self.place());
        }
        let turn = self.driving.machine.turn(from, to, (GENTLE_RAD_S, GENTLE_RAD_S2));
        self.ask(Request::Jog(Job { segments: vec![turn], ..Job::default() }))?;
        self.wait(2 * u32::from(turn.ticks) + REST_TICKS, |wall| wall.state() != State::Jogging)?;
        self.settle()?;
        Ok(self.place())
    }

    /// Which angles a jog asks for, rad.
    fn target_rad(&self, jog: Jog) -> Result<PanTilt<f64>, Failure> {
        let Place { angle_rad, spot, homed } = self.place();
        if homed {
            self.check_range(angle_rad, "is").map_err(|out| {
                let message = format!("{}: `tracelight park` takes it back to straight ahead", out.message);
                Failure::failed(out.code, message)
            })?;
        }
        let on_target = |at: Point| {
            self.driving.machine.angles(at).map_err(|e| Failure::failed("unreachable", e.to_string()))
        };
        match jog {
            Jog::Angles(by_rad) if homed => {
                let to_rad = PanTilt::from_fn(|j| angle_rad[j] + by_rad[j]);
                self.check_range(to_rad, "would be")?;
                Ok(to_rad)
            }
            Jog::Angles(by_rad) => {
                let most = by_rad.pan.abs().max(by_rad.tilt.abs());
                if most > BLIND_RAD {
                    let message = format!(
                        "{:.1} degrees at once are too many for a head that is not homed, and may be near a stop: at most {:.0}",
                        most.to_degrees(),
                        BLIND_RAD.to_degrees()
                    );
                    return Err(Failure::usage("usage", message));
                }
                Ok(PanTilt::from_fn(|j| angle_rad[j] + by_rad[j]))
            }
            Jog::By(_) | Jog::To(_) if !homed => {
                let message = "the head is not homed, and nobody knows where on the target it points: jog it by angles, such as 5deg,0deg, until it points straight ahead, \
                               then `tracelight home`";
                Err(Failure::failed("unhomed", message))
            }
            Jog::To(at) => on_target(at),
            Jog::By(by) => match spot {
                Some(spot) => on_target(spot + by),
                None => {
                    let message = "the head does not point at the target now: jog it by angles, such as 5deg,0deg, or to a place (--to)";
                    Err(Failure::failed("unreachable", message))
                }
            },
        }
    }

    /// Refuses angles out of the joints' ranges.
    fn check_range(&self, to_rad: PanTilt<f64>, is: &str) -> Result<(), Failure> {
        let range_rad = self.driving.machine.geometry.range_rad;
        let beyond = |j: &Joint| !(range_rad[*j].0..=range_rad[*j].1).contains(&to_rad[*j]);
        match Joint::BOTH.into_iter().find(beyond) {
            Some(j) => {
                let (lower, upper) = range_rad[j];
                let message = format!(
                    "{j} {is} at {:.1} degrees, out of its range of {:.1} to {:.1}",
                    to_rad[j].to_degrees(),
                    lower.to_degrees(),
                    upper.to_degrees()
                );
                Err(Failure::failed("unreachable", message))
            }
            None => Ok(()),
        }
    }

    /// Stays where it is until somebody has decided something.
    ///
    /// # Errors
    /// As of [`new`](Self::new).
    pub fn hold<T>(&mut self, mut decided: impl FnMut() -> Option<T>) -> Result<T, Failure> {
        loop {
            self.step()?;
            if let Some(decision) = decided() {
                return Ok(decision);
            }
        }
    }

    /// Lets a dot of light out where it rests of a head that is not homed, to see where that is, for that long at most, s; who calls for it has armed it. For how
    /// long its gate was open, s: the light's budget may make it shorter.
    ///
    /// # Errors
    /// As of [`new`](Self::new); `no-light`: no light was let out, and why; `usage` of a head that is homed.
    pub fn dot(&mut self, lasts_s: f64) -> Result<f64, Failure> {
        self.check_dot()?;
        let ticks = (lasts_s / TICK_F64_S).clamp(1.0, u16::MAX.into()) as u16;
        self.ask(Request::Arm)?;
        self.ask(Request::Seek)?;
        self.ask(Request::Mark(ticks))?;
        let (mut lit, mut why) = (0, self.last.telemetry.darkness);
        for _ in 0..u32::from(ticks) + DOT_ENDS_TICKS {
            self.step()?;
            if self.last.telemetry.actuation.lights() {
                lit += 1;
            } else if lit == 0 {
                why = self.last.telemetry.darkness;
            }
        }
        self.ask(Request::Stop)?;
        self.step()?;
        if lit == 0 {
            let holds = |reason: &Darkness| why.contains(*reason);
            let why: Vec<&str> = Darkness::ALL.into_iter().filter(holds).map(Darkness::code).collect();
            let message = format!("no light was let out: {}", why.join(", "));
            return Err(Failure::failed("no-light", message));
        }
        Ok(f64::from(lit) * TICK_F64_S)
    }

    /// Refuses a dot of a head whose place is known: marks of places are drawn.
    ///
    /// # Errors
    /// `usage`.
    pub fn check_dot(&self) -> Result<(), Failure> {
        match self.place() {
            Place { homed: false, .. } => Ok(()),
            Place { spot, .. } => {
                let at = spot.map_or_else(
                    || "X,Y".to_owned(),
                    |at| format!("{:.1}mm,{:.1}mm", 1e3 * at.x, 1e3 * at.y),
                );
                let message = format!(
                    "--dot shows where a head is that is not homed, and this one is: `tracelight point {at}` marks a place on the target"
                );
                Err(Failure::usage("usage", message))
            }
        }
    }

    /// Waits until the joints have rested for a while.
    fn settle(&mut self) -> Result<(), Failure> {
        self.stay(SETTLED_TICKS, |mover| mover.wall.rests())
    }

    /// Waits until so many ticks in a row were as they should be of a head that rests.
    fn stay(&mut self, ticks: u32, mut rests: impl FnMut(&Self) -> bool) -> Result<(), Failure> {
        let mut rested = 0;
        for _ in 0..REST_TICKS {
            self.step()?;
            rested = if rests(self) { rested + 1 } else { 0 };
            if rested >= ticks {
                return Ok(());
            }
        }
        Err(Failure::failed("unfinished", "the head does not come to rest: does something move it?"))
    }

    fn wait(&mut self, ticks: u32, is_over: impl Fn(&Wall<'_>) -> bool) -> Result<(), Failure> {
        for _ in 0..ticks {
            self.step()?;
            if is_over(&self.wall) {
                return Ok(());
            }
        }
        let _ = self.wall.request(Request::Stop);
        self.step()?;
        Err(Failure::failed(
            "unfinished",
            "the head does not come where it is sent: is something in its way?",
        ))
    }

    fn ask(&mut self, request: Request) -> Result<(), Failure> {
        self.wall.request(request).map_err(refused)
    }

    /// One tick, of a head without a fault.
    fn step(&mut self) -> Result<(), Failure> {
        self.observe()?;
        self.last.telemetry.latched.map_or(Ok(()), |record| Err(Failure::fault(record)))
    }

    /// One tick, whatever is wrong with the head; who is stopped darkens it first.
    fn observe(&mut self) -> Result<(), Failure> {
        if self.task.stop.is_wanted() {
            let _ = self.wall.request(Request::Stop);
            observed_tick(&mut self.wall);
            return Err(Failure::interrupted());
        }
        self.last = observed_tick(&mut self.wall).ok_or_else(gone)?;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hands::Nobody;
    use crate::keep::KeepNothing;
    use crate::lap::run_lap;
    use tracelight_aim::HeadPose;
    use tracelight_pipeline::{Asked, request_of};
    use tracelight_sim::{RigConfig, SimulatedRig, score};
    use tracelight_stroke::{Drawing, Path, Stroke};
    use tracelight_task::{NoProgress, Stop};
    use tracelight_trajectory::plan;

    const POSE: HeadPose = HeadPose::square_on(0.9144);

    fn driving() -> Driving {
        let rig = RigConfig::report();
        let request = request_of(&rig);
        Driving::new(rig, POSE, request, Asked::default())
    }

    /// Where a homed head truly points after it was moved.
    fn moved(what: impl Fn(&mut Mover<'_>) -> Result<Place, Failure>) -> (Place, Tick, SimulatedRig) {
        let (driving, stop) = (driving(), Stop::default());
        let task = Task { progress: &NoProgress, stop: &stop };
        let mut rig = SimulatedRig::new(&driving.rig, POSE, 1);
        let place = what(&mut Mover::new(&mut rig, &driving, task).unwrap()).unwrap();
        let truth = rig.observe().unwrap();
        (place, truth, rig)
    }

    #[test]
    fn a_jog_ends_where_it_should_in_the_dark() {
        let (place, truth, _) = moved(|mover| mover.jog(Jog::To(Point::new(0.2, 0.1))));
        let (told, spot) = (place.spot.unwrap(), truth.spot.unwrap());
        assert!(place.homed && !truth.light, "{place:?}");
        assert!(
            told.distance(spot) < 1e-3 && spot.distance(Point::new(0.2, 0.1)) < 1e-3,
            "{told:?} {spot:?}"
        );
        let (place, truth, _) = moved(|mover| {
            mover.jog(Jog::Angles(PanTilt::new(-0.2, 0.1)))?;
            mover.jog(Jog::By(Vec2::new(-0.05, 0.0)))?;
            mover.jog(Jog::Angles(PanTilt::default()))
        });
        let start = driving().machine.geometry.spot(&POSE, PanTilt::new(-0.2, 0.1)).unwrap();
        let spot = truth.spot.unwrap();
        assert!((spot.x - start.x + 0.05).abs() < 2e-3 && (spot.y - start.y).abs() < 2e-3, "{place:?}");
        let (place, truth, _) = moved(|mover| {
            mover.jog(Jog::Angles(PanTilt::new(0.4, -0.3)))?;
            mover.park()
        });
        assert!(place.angle_rad.pan.abs() < 2e-3 && truth.angle_rad.tilt.abs() < 3e-3, "{place:?}");
    }

    #[test]
    fn what_cannot_be_reached_is_refused_and_nothing_moves() {
        let (place, ..) = moved(|mover| {
            for (jog, why) in [
                (Jog::Angles(PanTilt::new(4.0, 0.0)), "out of its range"),
                (Jog::To(Point::new(40.0, 0.0)), "streak"),
                (Jog::By(Vec2::new(f64::NAN, 0.0)), ""),
            ] {
                let refused = mover.jog(jog).unwrap_err();
                assert!(
                    refused.code == "unreachable" && refused.message.contains(why),
                    "{}",
                    refused.message
                );
            }
            assert!(mover.dot(1.0).unwrap_err().message.contains("tracelight point "));
            Ok(mover.place())
        });
        assert!(place.angle_rad.pan.abs() < 2e-3 && place.angle_rad.tilt.abs() < 2e-3, "{place:?}");
    }

    #[test]
    fn a_job_of_a_head_that_rests_elsewhere_begins_where_it_should() {
        let (_, _, mut rig) = moved(|mover| mover.jog(Jog::Angles(PanTilt::new(0.3, -0.2))));
        let (driving, stop) = (driving(), Stop::default());
        let mut path = Path::new(Point::new(-0.1, 0.0));
        path.line_to(Point::new(0.1, 0.05));
        let drawing = Drawing { strokes: vec![Stroke::new(path)] };
        let plan = plan(&drawing, &driving.machine, &driving.request).unwrap();
        let task = Task { progress: &NoProgress, stop: &stop };
        for dry in [true, false] {
            let drawn = (&plan, None);
            let lap = run_lap(&mut rig, drawn, (dry, 0.0), (&mut KeepNothing, &mut Nobody), task).unwrap();
            assert!(lap.failure.is_none() && lap.run.is_done(), "dry {dry}: {:?}", lap.failure);
            let lit: Vec<&Tick> = lap.run.ticks.iter().filter(|tick| tick.light).collect();
            assert_eq!(lit.is_empty(), dry);
            let off = |tick: &&Tick| tick.spot.unwrap().distance(tick.asked.unwrap());
            assert!(lit.iter().map(off).all(|off| off < 1e-3));
            // the way there is in no figure
            let figures = score(&plan, &lap.run, plan.set_speed_m_s);
            assert!(dry || figures.max_mm < 0.3 && figures.overshoot_percent < 0.5, "{figures:?}");
            assert!(lap.run.ticks.len() < plan.points.len() + 1000, "{}", lap.run.ticks.len());
        }
    }
}
