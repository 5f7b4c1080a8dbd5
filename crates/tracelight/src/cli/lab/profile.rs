use std::fmt::Write;

use clap::Args;
use tracelight_chart::{Curve, Figure, Key, Panel, Pen, Scale, Theme};
use tracelight_rig::TICK_F64_S;
use tracelight_task::Failure;
use tracelight_trajectory::{MoveLimits, MovePoint, Peaks, Profile, Ramps};
use tracelight_units::{
    ANGLES, ANGULAR_ACCELERATIONS, ANGULAR_SPEEDS, Angle, AngularAcceleration, AngularSpeed,
};

use super::{OutFile, colour, out_file, within, write_all};
use crate::cli::shapes::{ProfileName, ramps};
use crate::cli::{Answer, Voice};

/// Move one joint from rest to rest, motors left out: durations and peaks of every profile, and plots
#[derive(Args, Debug)]
#[command(
    after_help = "Example: tracelight lab profile --distance 180deg --profile trapezoid,s-curve -o profiles.svg\n\n\
                  The defaults are the 2006 report's: half a turn at 24 rad/s and 100 rad/s², with its S-curve."
)]
pub(crate) struct ProfileArgs {
    /// How far
    #[arg(long, value_name = "ANGLE", default_value = "180deg", allow_hyphen_values = true, value_parser = distance)]
    distance: Angle,
    /// Highest speed
    #[arg(long, value_name = "SPEED", default_value = "24rad/s", allow_hyphen_values = true, value_parser = speed)]
    vmax: AngularSpeed,
    /// Highest acceleration
    #[arg(long, value_name = "ACCELERATION", default_value = "100rad/s2", allow_hyphen_values = true, value_parser = acceleration)]
    amax: AngularAcceleration,
    /// Highest deceleration [default: as --amax]
    #[arg(long, value_name = "ACCELERATION", allow_hyphen_values = true, value_parser = acceleration)]
    dmax: Option<AngularAcceleration>,
    /// The S-curve's ramps: shares of the acceleration phase over which acceleration builds up and fades, then the same of
    /// the deceleration phase
    #[arg(long, value_name = "PA1,PA2,PB1,PB2", default_value = "0.2,0.2,0.15,0.15", allow_hyphen_values = true, value_parser = ramps)]
    ramps: Ramps,
    /// Which to plot, the first of them in the CSV and first in --json
    #[arg(long, value_enum, value_delimiter = ',', default_value = "trapezoid,s-curve")]
    profile: Vec<ProfileName>,
    /// Plot angle, speed and acceleration into an SVG or PNG, or write them, a row a millisecond, to a CSV; may be given again
    #[arg(short, long, value_name = "FILE.svg|FILE.png|FILE.csv", value_parser = out_file)]
    out: Vec<OutFile>,
    #[command(flatten)]
    pub(super) voice: Voice,
}

fn distance(text: &str) -> Result<Angle, String> {
    let angle: Angle = text.parse().map_err(|e| format!("{e}"))?;
    within(text, angle, angle.0, ANGLES)
}

fn speed(text: &str) -> Result<AngularSpeed, String> {
    let speed: AngularSpeed = text.parse().map_err(|e| format!("{e}"))?;
    within(text, speed, speed.0, ANGULAR_SPEEDS)
}

fn acceleration(text: &str) -> Result<AngularAcceleration, String> {
    let acceleration: AngularAcceleration = text.parse().map_err(|e| format!("{e}"))?;
    within(text, acceleration, acceleration.0, ANGULAR_ACCELERATIONS)
}

pub(crate) fn run(args: &ProfileArgs) -> Result<Answer, Failure> {
    let limits = args.limits();
    let made =
        |name: ProfileName| Some((name, Profile::new(name.shape(args.ramps)?, args.distance.0, &limits)));
    let all: Vec<_> = ProfileName::ALL.into_iter().filter_map(made).collect();
    let chosen: Vec<_> = args.profile.iter().filter_map(|&name| made(name)).collect();
    let [(first, profile), ..] = chosen[..] else {
        return Err(no_optimum());
    };
    if chosen.len() < args.profile.len() {
        return Err(no_optimum());
    }
    write_all(&args.out, || figure(args, &chosen), || csv(&profile))?;
    Ok(Answer::new(table(args, &all), json(first, &profile, &all)))
}

/// Without motors there is nothing to be optimal about.
fn no_optimum() -> Failure {
    let message = "--profile optimal is as fast as the motors can, and this command knows none: under limits of speed and \
                   acceleration alone the trapezoid is the fastest. `tracelight lab move` has both";
    Failure::usage("usage", message)
}

impl ProfileArgs {
    fn limits(&self) -> MoveLimits {
        MoveLimits {
            speed: self.vmax.0,
            acceleration: self.amax.0,
            deceleration: self.dmax.unwrap_or(self.amax).0,
        }
    }
}

fn table(args: &ProfileArgs, all: &[(ProfileName, Profile)]) -> String {
    let limits = args.limits();
    let mut text = format!(
        "{:.6} rad from rest to rest, at most {} rad/s, {} rad/s² speeding up, {} rad/s² braking\n\n\
         profile     duration, s  peak, rad/s  peak, rad/s²  peak, rad/s³",
        args.distance.0, limits.speed, limits.acceleration, limits.deceleration
    );
    for (name, profile) in all {
        let peaks = profile.peaks();
        let jerk = peaks.jerk.map_or_else(|| "–".to_owned(), |jerk| format!("{jerk:.5}"));
        // writing to a String cannot fail
        let _ = write!(
            text,
            "\n{:10} {:12.6} {:12.4} {:13.4} {:>13}",
            name.name(),
            profile.duration_s(),
            peaks.speed,
            peaks.acceleration.max(peaks.deceleration),
            trimmed(&jerk),
        );
        if peaks.speed_jump > 0.0 {
            let _ = write!(text, "  starts and stops with a jump of {:.3} rad/s", peaks.speed_jump);
        }
    }
    text + "\n\n–: the acceleration jumps, so the jerk has no bound."
}

/// To a tenth, as far as columns go.
fn trimmed(number: &str) -> String {
    number
        .split_once('.')
        .map_or_else(|| number.to_owned(), |(whole, part)| format!("{whole}.{}", &part[..1]))
}

fn json(first: ProfileName, profile: &Profile, all: &[(ProfileName, Profile)]) -> String {
    let mut flat = figures(first, profile);
    flat["profiles"] = all.iter().map(|(name, profile)| figures(*name, profile)).collect();
    flat.to_string()
}

fn figures(name: ProfileName, profile: &Profile) -> serde_json::Value {
    let Peaks { speed, acceleration, deceleration, jerk, speed_jump } = profile.peaks();
    serde_json::json!({
        "profile": name.name(),
        "duration_s": profile.duration_s(),
        "peak_rad_s": speed,
        "peak_rad_s2": acceleration.max(deceleration),
        "peak_rad_s3": jerk,
        "jump_rad_s": speed_jump,
    })
}

/// Longest move whose rows are written, s.
const LONGEST_S: f64 = 1800.0;

fn csv(profile: &Profile) -> Result<String, Failure> {
    if profile.duration_s() > LONGEST_S {
        let message = format!(
            "the move takes {:.0} s, and at most {LONGEST_S:.0} s of it are written row by row; give it a higher --vmax or --amax",
            profile.duration_s()
        );
        return Err(Failure::failed("too-long", message));
    }
    let mut text = String::from("t_s,x_rad,v_rad_s,a_rad_s2\n");
    let ticks = (profile.duration_s() / TICK_F64_S).ceil() as usize;
    for tick in 0..=ticks {
        let t_s = tick as f64 * TICK_F64_S;
        let MovePoint { position, velocity, acceleration } = profile.at(t_s);
        let _ = writeln!(text, "{t_s:.3},{position:.9},{velocity:.9},{acceleration:.9}");
    }
    Ok(text)
}

/// Points of a plotted curve: every phase is smooth, so this many are enough.
const PLOTTED: u32 = 1000;

fn figure(args: &ProfileArgs, chosen: &[(ProfileName, Profile)]) -> Result<String, Failure> {
    let panel = |y_title: &str, value: &dyn Fn(&MovePoint) -> f64| Panel {
        x_title: "time, s".into(),
        y_title: y_title.into(),
        curves: chosen.iter().map(|(name, profile)| curve(*name, profile, value)).collect(),
        levels: Vec::new(),
        scale: Scale::Free,
        ..Panel::default()
    };
    let key = |(name, profile): &(ProfileName, Profile)| Key {
        colour: colour(*name),
        name: format!("{}, {:.4} s", name.name(), profile.duration_s()),
    };
    let limits = args.limits();
    let figure = Figure {
        title: format!(
            "{:.4} rad at {} rad/s, {} and {} rad/s²",
            args.distance.0, limits.speed, limits.acceleration, limits.deceleration
        ),
        legend: chosen.iter().map(key).collect(),
        panels: vec![
            panel("angle, rad", &|p| p.position),
            panel("speed, rad/s", &|p| p.velocity),
            panel("acceleration, rad/s²", &|p| p.acceleration),
        ],
        columns: 1,
        panel: (680, 230),
        theme: Theme::Light,
    };
    figure.svg().map_err(|e| Failure::failed("internal", e))
}

fn curve(name: ProfileName, profile: &Profile, value: &dyn Fn(&MovePoint) -> f64) -> Curve {
    // just inside both ends, so that what jumps there is seen
    let inside = 1e-9 * profile.duration_s();
    let time = |i: u32| f64::from(i) / f64::from(PLOTTED) * (profile.duration_s() - 2.0 * inside) + inside;
    let points = (0..=PLOTTED).map(|i| (time(i), value(&profile.at(time(i)))));
    let ends = [0.0, profile.duration_s()].map(|t| (t, value(&profile.at(t))));
    let points = std::iter::once(ends[0]).chain(points).chain(std::iter::once(ends[1]));
    Curve { colour: colour(name), pen: Pen::Solid, points: points.collect() }
}
