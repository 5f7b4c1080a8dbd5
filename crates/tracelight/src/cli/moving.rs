//! A head at a port that is moved by hand: homed where it rests, jogged, parked.

use std::f64::consts::TAU;

use clap::Args;
use serde_json::json;
use tracelight_aim::HeadPose;
use tracelight_eye::corners::angles;
use tracelight_job::{Jog, Mover, Place};
use tracelight_operator::{Bar, asked};
use tracelight_pipeline::{Asked, DEFAULT_DISTANCE_M, Driving, request_of};
use tracelight_port::{At, head};
use tracelight_rig::PanTilt;
use tracelight_rigfile::homing_section;
use tracelight_sim::Observed as _;
use tracelight_stroke::{Point, Vec2};
use tracelight_task::{Failure, Stop, Task};
use tracelight_units::{Length, Offset, TIMES, parse};

use crate::cli::answer::{Answer, Voice};
use crate::cli::driving::stand_by;
use crate::named;
use tracelight_flags::positive_length;

/// The head at a port, and where it stands.
#[derive(Args, Clone, Debug)]
pub(crate) struct HeadArgs {
    /// Port of its board, and its rig: PORT or PORT:RIG, such as /dev/ttyACM0:my-head.toml; grbl:PORT or grbl:tcp:HOST of a Grbl board
    #[arg(long, value_name = "PORT")]
    rig: String,
    /// Distance from the head to the target [default: 3ft]
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true, value_parser = positive_length, conflicts_with = "stands")]
    distance: Option<Length>,
    /// Where the head stands, as `calibrate corners` or `calibrate head` has found it
    #[arg(id = "stands", long = "head", value_name = "FILE.toml")]
    stands: Option<String>,
    #[command(flatten)]
    pub(crate) voice: Voice,
}

/// Tell a head that it points straight ahead now, or where it points
///
/// A head whose encoders count from where they are powered up does not know where it points. Jog it until it points straight ahead, with a dot to see it
/// by, then this makes that its zero; or let it find its end stops, where it has some. It is known until the board loses power, also to programs that come later.
#[derive(Args, Debug)]
#[command(
    after_help = "Example: tracelight jog 3deg,0deg --dot 2s --rig /dev/ttyACM0:my-head.toml\n         \
                  tracelight home --rig /dev/ttyACM0:my-head.toml\n         \
                  tracelight home --by-stops --rig /dev/ttyACM0:my-head.toml"
)]
pub(crate) struct HomeArgs {
    /// Where it points instead: pan to the left and tilt down, such as 10deg,-5deg [default: straight ahead]
    #[arg(long, value_name = "PAN,TILT", allow_hyphen_values = true, value_parser = within_a_turn)]
    at: Option<PanTilt<f64>>,
    /// Home it by its end stops, which the rig file's [homing] tells: each joint comes up against them gently, in the dark
    #[arg(long, conflicts_with = "at")]
    by_stops: bool,
    /// Find where the end stops of a head are that is homed, and print them for its rig file
    #[arg(long, conflicts_with_all = ["at", "by_stops"])]
    find_stops: bool,
    #[command(flatten)]
    pub(crate) head: HeadArgs,
}

/// Turn a head in the dark: by angles, or by a way on the target
#[derive(Args, Debug)]
#[command(after_help = "Examples: tracelight jog 5deg,0deg --rig /dev/ttyACM0\n          \
                  tracelight jog 10cm,-2cm --rig /dev/ttyACM0:my-head.toml --distance 2m\n          \
                  tracelight jog --to 30cm,20cm --rig /dev/ttyACM0\n          \
                  tracelight jog 2deg,0deg --dot 1s --rig /dev/ttyACM0\n\n\
                  A head that is not homed is turned by angles alone, from where it is, no more than 30 degrees at once.")]
pub(crate) struct JogArgs {
    /// By angles, pan to the left and tilt down, such as 5deg,-2deg; or right and up on the target, such as 10cm,5cm
    #[arg(
        value_name = "BY",
        allow_hyphen_values = true,
        value_parser = way,
        required_unless_present = "to",
        conflicts_with = "to"
    )]
    by: Option<Jog>,
    /// To a place on the target, right and up of its middle, such as 30cm,20cm
    #[arg(long, value_name = "X,Y", allow_hyphen_values = true)]
    to: Option<Offset>,
    /// Then let out a dot of light for this long, such as 2s, to see where a head is that is not homed; at a real head a key allows it
    #[arg(long, value_name = "TIME", allow_hyphen_values = true, value_parser = dot)]
    dot: Option<f64>,
    #[command(flatten)]
    pub(crate) head: HeadArgs,
}

/// Return a head to straight ahead, in the dark
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight park --rig /dev/ttyACM0")]
pub(crate) struct ParkArgs {
    #[command(flatten)]
    pub(crate) head: HeadArgs,
}

/// Furthest way on a target, m.
const MOST_M: f64 = 1000.0;

/// Two angles of a turn at most: pan to the left, tilt down.
fn within_a_turn(text: &str) -> Result<PanTilt<f64>, String> {
    let at = angles(text)?;
    let is_within = at.pan.abs().max(at.tilt.abs()) <= TAU;
    is_within.then_some(at).ok_or_else(|| format!("{text} is more than a turn of 360 degrees"))
}

/// A way to go: by two angles, or by two lengths.
fn way(text: &str) -> Result<Jog, String> {
    if angles(text).is_ok() {
        return within_a_turn(text).map(Jog::Angles);
    }
    let Offset(x, y) = text.parse().map_err(|_| {
        format!("{text} is no way to go; give two angles such as 5deg,-2deg, or two lengths such as 10cm,5cm")
    })?;
    let by = Vec2::new(x.0, y.0);
    let is_near = by.hypot() <= MOST_M;
    is_near
        .then_some(Jog::By(by))
        .ok_or_else(|| format!("{text} is further than {MOST_M} m, and off every wall"))
}

/// How long a dot lasts, s.
fn dot(text: &str) -> Result<f64, String> {
    const RANGE: std::ops::RangeInclusive<f64> = 0.05..=60.0;
    let time_s = parse(text, TIMES).map_err(|e| e.to_string())?;
    let wrong = || format!("{text} is not between {} s and {} s", RANGE.start(), RANGE.end());
    RANGE.contains(&time_s).then_some(time_s).ok_or_else(wrong)
}

pub(crate) fn home(args: &HomeArgs, stop: &Stop) -> Result<Answer, Failure> {
    let at = args.at.unwrap_or_default();
    args.head.moved(stop, |mover, _| match (args.by_stops, args.find_stops) {
        (true, _) => Ok(Moved::to(mover.home_by_stops()?)),
        (_, true) => {
            let stops_rad = mover.find_stops()?;
            Ok(Moved { stops_rad: Some(stops_rad), ..Moved::to(mover.place()) })
        }
        _ => Ok(Moved::to(mover.home(at)?)),
    })
}

/// What was done with a head.
struct Moved {
    place: Place,
    /// For how long its gate was open, s.
    dot_s: Option<f64>,
    stops_rad: Option<PanTilt<(f64, f64)>>,
}

impl Moved {
    const fn to(place: Place) -> Self {
        Self { place, dot_s: None, stops_rad: None }
    }

    /// What there is to say besides where it is.
    fn words(&self) -> String {
        let lit = self.dot_s.map_or_else(String::new, |s| format!("; its gate was open for {s:.2} s"));
        lit + &self.stops_rad.map_or_else(String::new, |stops| {
            format!("; its end stops:\n\n{}", homing_section(stops.pan, stops.tilt))
        })
    }
}

pub(crate) fn park(args: &ParkArgs, stop: &Stop) -> Result<Answer, Failure> {
    args.head.moved(stop, |mover, _| Ok(Moved::to(mover.park()?)))
}

pub(crate) fn jog(args: &JogArgs, stop: &Stop) -> Result<Answer, Failure> {
    let to = args.to.map(|Offset(x, y)| Jog::To(Point::new(x.0, y.0)));
    args.head.moved(stop, |mover, (arms, may_light, task)| {
        if args.dot.is_some() {
            may_light?;
            mover.check_dot()?;
        }
        let place = match to.or(args.by) {
            Some(jog) => mover.jog(jog)?,
            None => mover.place(),
        };
        let Some(lasts_s) = args.dot else { return Ok(Moved::to(place)) };
        if arms {
            asked(
                &format!("{}; A lets a dot out there for {lasts_s} s, any other key none", place.words()),
                task,
                |wait| mover.hold(wait),
            )?;
        }
        Ok(Moved { dot_s: Some(mover.dot(lasts_s)?), ..Moved::to(place) })
    })
}

impl HeadArgs {
    /// Does something with the head, and tells where it rests then.
    fn moved(
        &self,
        stop: &Stop,
        what: impl FnOnce(&mut Mover<'_>, (bool, Result<(), Failure>, Task<'_>)) -> Result<Moved, Failure>,
    ) -> Result<Answer, Failure> {
        let bar = Bar::new(self.voice.quiet);
        let task = Task { progress: &bar, stop };
        let (driving, at) = self.driving(task)?;
        let _kept = stop.keep();
        let mut device = head(&at, &driving.rig, driving.pose, stop)?;
        let (origin, arms) = (device.origin(), device.rig().wants_a_person());
        let may_light = if origin.simulated { Ok(()) } else { named::fit(&driving.rig) };
        let moved = Mover::new(&mut device, &driving, task)
            .and_then(|mut mover| what(&mut mover, (arms, may_light, task)));
        // it knows why it is gone
        let moved = moved.map_err(|why| device.rig().failure().unwrap_or(why))?;
        let Moved { place, dot_s, stops_rad } = &moved;
        let spot_mm = place.spot.map(|spot| [1e3 * spot.x, 1e3 * spot.y]);
        let json = json!({
            "homed": place.homed, "pan_deg": place.angle_rad.pan.to_degrees(), "tilt_deg": place.angle_rad.tilt.to_degrees(),
            "spot_mm": spot_mm, "light_from": origin.light_from.name(), "simulated": origin.simulated, "gate_open_s": dot_s,
            "stops_deg": stops_rad.map(|stops| {
                let degrees = |(lower, upper): (f64, f64)| [lower.to_degrees(), upper.to_degrees()];
                json!({ "pan": degrees(stops.pan), "tilt": degrees(stops.tilt) })
            }),
        });
        Ok(Answer::new(place.words() + &moved.words(), json.to_string()))
    }

    fn driving(&self, task: Task<'_>) -> Result<(Driving, At), Failure> {
        let (rig, at) = named::rig_or_port(&self.rig)?;
        let Some(at) = at else {
            let message = format!(
                "--rig {}: a simulated head ends with the program that has it; give the port of a board, such as /dev/ttyACM0, or that of an emulated one, which stays \
                 (tracelight rig serve --pty out/head)",
                self.rig
            );
            return Err(Failure::usage("usage", message));
        };
        let (rig, _) = at.fitted(rig, task.stop)?;
        let pose = HeadPose::square_on(self.distance.map_or(DEFAULT_DISTANCE_M, |d| d.0));
        let request = request_of(&rig);
        let mut driving = Driving::new(rig, pose, request, Asked::default());
        let known = self.stands.as_deref().map(|path| named::head(path, &driving.rig)).transpose()?;
        known.iter().for_each(|known| stand_by(&mut driving, known));
        Ok((driving, at))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ways_are_angles_or_lengths() {
        assert_eq!(way("10cm,-5mm"), Ok(Jog::By(Vec2::new(0.1, -0.005))));
        let Ok(Jog::Angles(by)) = way("-10deg, 20deg") else { unreachable!() };
        assert!((by.pan.to_degrees() + 10.0).abs() < 1e-9 && (by.tilt.to_degrees() - 20.0).abs() < 1e-9);
        for text in ["10cm", "10cm,5deg", "5,5", "", "1cm,2cm,3cm", "nan,nan"] {
            assert!(way(text).unwrap_err().contains("two angles such as"), "{text}");
        }
        assert!(way("400deg,0deg").unwrap_err().contains("more than a turn"));
        assert!(way("1e300m,0cm").unwrap_err().contains("off every wall"));
        assert!(dot("0s").is_err() && dot("61s").is_err() && dot("2s") == Ok(2.0));
    }
}
