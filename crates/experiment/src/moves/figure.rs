//! The moves of a course as plots: on the target, along the course, at the joints, as counts.

use tracelight_chart::{Colour, Curve, Figure, Key, Panel, Pen, Scale, Theme};
use tracelight_rig::{Joint, TICK_F64_S};
use tracelight_sim::Tick;
use tracelight_task::Failure;
use tracelight_trajectory::CoursePoint;

use super::{Entry, Finding, OnRig, failure};
use crate::panels::over_time;

/// Points of a plotted curve.
const PLOTTED: u32 = 400;
/// Dots along the path: so many even steps of time.
const DOTS: usize = 20;

/// What of a point is plotted.
type Value<'a> = dyn Fn(&CoursePoint) -> f64 + 'a;

/// A move, sampled.
struct Plotted<'a> {
    entry: &'a Entry,
    points: Vec<CoursePoint>,
}

pub(super) fn figure(finding: &Finding) -> Result<Figure, Failure> {
    let course = finding.course()?;
    let mut moves = Vec::new();
    for entry in finding.chosen() {
        let Some(pace) = entry.pace() else { continue };
        // just inside both ends, so that what jumps there is seen
        let inside = 1e-9 * pace.duration_s();
        let time = |i: u32| inside + f64::from(i) / f64::from(PLOTTED) * (pace.duration_s() - 2.0 * inside);
        let points: Result<Vec<_>, _> = (0..=PLOTTED).map(|i| course.at(pace, time(i))).collect();
        moves.push(Plotted { entry, points: points.map_err(failure)? });
    }
    let key = |m: &Plotted<'_>| Key {
        colour: m.colour(),
        name: format!("{}, {:.4} s", m.entry.name.name(), m.points.last().map_or(0.0, |p| p.t_s)),
    };
    let how = if finding.as_asked { "as asked" } else { "as the motors can" };
    Ok(Figure {
        title: format!("{}: {how}", capital(&finding.wish.title)).replace('-', "−"),
        legend: moves.iter().map(key).collect(),
        panels: panels(finding, &moves),
        columns: 3,
        panel: (400, 260),
        theme: Theme::Light,
    })
}

fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

fn panels(finding: &Finding, moves: &[Plotted<'_>]) -> Vec<Panel> {
    let time = |y_title: &str, curves: Vec<Curve>| over_time(y_title, Vec::new(), curves);
    let each = |values: &[(Pen, &Value<'_>)]| {
        moves.iter().flat_map(|m| values.iter().map(|&(pen, value)| m.curve(pen, value))).collect::<Vec<_>>()
    };
    let both = |value: &dyn Fn(&CoursePoint, Joint) -> f64| {
        each(&[(Pen::Solid, &|p| value(p, Joint::Pan)), (Pen::Dashed, &|p| value(p, Joint::Tilt))])
    };
    let count = |p: &CoursePoint, j: Joint| finding.counts(p.joints.map(|m| m.position_rad))[j] as f64;
    let torque = Panel {
        levels: vec![-100.0, 100.0],
        ..time(
            "torque, %: pan, tilt (dashed)",
            both(&|p, j| 100.0 * finding.machine.fraction(p.torque_nm)[j]),
        )
    };
    let last = if moves.iter().any(|m| m.entry.on_rig.is_some()) {
        let errors = moves.iter().filter_map(Plotted::error).collect();
        Panel { levels: vec![0.0], ..time("error of the spot on the rig, mm", errors) }
    } else {
        time("joint speed, °/s: pan, tilt (dashed)", both(&|p, j| p.joints[j].velocity_rad_s.to_degrees()))
    };
    vec![
        path(moves),
        time(
            "spot, mm: x, y (dashed)",
            each(&[(Pen::Solid, &|p| 1e3 * p.spot.x), (Pen::Dashed, &|p| 1e3 * p.spot.y)]),
        ),
        last,
        time("way, mm", each(&[(Pen::Solid, &|p| 1e3 * p.along.position)])),
        time("speed, m/s", each(&[(Pen::Solid, &|p| p.along.velocity)])),
        time("acceleration along it, m/s²", each(&[(Pen::Solid, &|p| p.along.acceleration)])),
        angles(moves, time("", both(&|p, j| p.joints[j].position_rad.to_degrees()))),
        time("counts: pan, tilt (dashed)", both(&count)),
        torque,
    ]
}

/// Joint angles, with dots where the rig's joints really were.
fn angles(moves: &[Plotted<'_>], desired: Panel) -> Panel {
    let actual = |m: &Plotted<'_>| {
        let ticks = m.ticks()?;
        let step = (ticks.len() / DOTS).max(1);
        let dots = |j: Joint| {
            ticks.iter().step_by(step).map(move |(t_s, tick)| (*t_s, tick.angle_rad[j].to_degrees()))
        };
        let points = Joint::BOTH.into_iter().flat_map(dots).collect();
        Some(Curve { colour: m.colour(), pen: Pen::Dots, points })
    };
    let dots: Vec<Curve> = moves.iter().filter_map(actual).collect();
    let title = if dots.is_empty() {
        "angle, °: pan, tilt (dashed)"
    } else {
        "angle, °: pan, tilt (dashed), actual (dots)"
    };
    Panel { y_title: title.into(), curves: desired.curves.into_iter().chain(dots).collect(), ..desired }
}

/// The course on the target, with dots at even steps of time.
fn path(moves: &[Plotted<'_>]) -> Panel {
    let spot = |p: &CoursePoint| (1e3 * p.spot.x, 1e3 * p.spot.y);
    let curve = |m: &Plotted<'_>, pen: Pen, step: usize| Curve {
        colour: m.colour(),
        pen,
        points: m.points.iter().step_by(step).map(spot).collect(),
    };
    let lines = moves.iter().map(|m| curve(m, Pen::Solid, 1));
    let dots = moves.iter().map(|m| curve(m, Pen::Dots, PLOTTED as usize / DOTS));
    Panel {
        x_title: "x on the target, mm".into(),
        y_title: "y, mm".into(),
        curves: lines.chain(dots).collect(),
        levels: Vec::new(),
        scale: Scale::Even,
        ..Panel::default()
    }
}

impl Plotted<'_> {
    const fn colour(&self) -> Colour {
        self.entry.name.colour()
    }

    fn curve(&self, pen: Pen, value: &Value<'_>) -> Curve {
        // a thousandth of a tick either way is nothing to a plot, and its axis begins at nought
        let points = self.points.iter().map(|p| ((1e6 * p.t_s).round() * 1e-6, value(p))).collect();
        Curve { colour: self.colour(), pen, points }
    }

    /// What the rig did during the move, and when.
    fn ticks(&self) -> Option<Vec<(f64, &Tick)>> {
        let OnRig { run, start_tick, pace, .. } = self.entry.on_rig.as_ref()?;
        let last_tick = start_tick + (pace.duration_s() / TICK_F64_S).ceil() as u32;
        let during = run.ticks.iter().filter(|t| (*start_tick..=last_tick).contains(&t.telemetry.plan_tick));
        let since = |t: &Tick| f64::from(t.telemetry.plan_tick - start_tick) * TICK_F64_S;
        Some(during.map(|t| (since(t), t)).collect())
    }

    /// How far the spot was from where it was to be, tick by tick of the run.
    fn error(&self) -> Option<Curve> {
        let points =
            self.ticks()?.into_iter().filter_map(|(t_s, t)| Some((t_s, 1e3 * t.spot?.distance(t.asked?))));
        Some(Curve { colour: self.colour(), pen: Pen::Solid, points: points.collect() })
    }
}
