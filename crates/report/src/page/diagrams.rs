use tracelight_rig::{Joint, TICK_F64_S};
use tracelight_stroke::Point;
use tracelight_trajectory::Binding;

use super::axis::Axis;
use super::curve::{bands, curve, strip};
use super::html::number;
use super::plot::Plot;
use crate::finished::Finished;
use crate::sample::{Sample, samples};

/// Marks along the time axis; on a phone their labels still stand apart.
const TIME_MARKS: usize = 6;

/// All diagrams over time, as HTML.
pub(super) fn diagrams(job: &Finished<'_>) -> String {
    let samples: Vec<Sample<'_>> = samples(job.plan, job.run).collect();
    if samples.is_empty() {
        return r#"<p class="note">Nothing was run, so there is nothing to plot over time.</p>"#.to_owned();
    }
    let over = Over { job, time: time_axis(&samples), lit: lit_bands(&samples), samples };
    let mut plots = vec![error(&over)];
    plots.extend(Joint::BOTH.map(|joint| angle(&over, joint)));
    plots.extend(Joint::BOTH.map(|joint| torque(&over, joint)));
    plots.push(following_error(&over));
    plots.iter().map(Plot::html).collect()
}

/// What all diagrams share.
struct Over<'a> {
    job: &'a Finished<'a>,
    samples: Vec<Sample<'a>>,
    time: Axis,
    lit: String,
}

impl Over<'_> {
    /// An empty diagram with the lit spans shaded.
    fn plot(&self, title: &str, y_title: &str, y: Axis) -> Plot {
        Plot::new(title, y_title, self.time, y).area("lit", &self.lit, Some("light on"))
    }

    fn curve(&self, y: &Axis, value: impl Fn(&Sample<'_>) -> Option<f64>) -> String {
        curve(self.samples.iter().map(|s| (s.t_s, value(s))), &self.time, y)
    }

    fn axis(&self, value: impl Fn(&Sample<'_>) -> f64, marks: usize) -> Axis {
        Axis::around(self.samples.iter().map(value), marks)
    }
}

fn time_axis(samples: &[Sample<'_>]) -> Axis {
    let end = |s: Option<&Sample<'_>>| s.map_or(0.0, |s| s.t_s);
    Axis::new(end(samples.first()), end(samples.last()), TIME_MARKS)
}

fn lit_bands(samples: &[Sample<'_>]) -> String {
    bands(samples.iter().map(|s| (s.t_s, s.tick.light)), &time_axis(samples))
}

fn error(over: &Over<'_>) -> Plot {
    let limit = over.job.tolerance_mm;
    let lit_error = |s: &Sample<'_>| s.error_mm().filter(|_| s.tick.light);
    let largest = over.samples.iter().filter_map(lit_error).fold(0.0, f64::max);
    // the limit is shown where the curve would still be readable beside it
    let in_view = largest > limit / 6.0;
    let top = if in_view { largest.max(limit) * 1.08 } else { (largest * 1.25).max(1e-3) };
    let y = Axis::around([0.0, top].into_iter(), 4);
    let dark_error = |s: &Sample<'_>| s.error_mm().filter(|_| !s.tick.light);
    let plot = over
        .plot("Tracking error", "spot to its planned place, mm", y)
        .line("dark", &over.curve(&y, dark_error), Some("while dark"))
        .line("error", &over.curve(&y, lit_error), Some("while lit"));
    let name = format!("limit {} mm", number(limit, 2));
    if in_view {
        plot.level("limit", limit, Some(&name))
    } else {
        plot.note(&format!("The laser darkens at {} mm, above this diagram.", number(limit, 2)))
    }
}

fn angle(over: &Over<'_>, joint: Joint) -> Plot {
    let wanted = |s: &Sample<'_>| f64::from(s.tick.telemetry.setpoint[joint].position_rad).to_degrees();
    let actual = |s: &Sample<'_>| s.tick.angle_rad[joint].to_degrees();
    let y = over.axis(wanted, 6);
    let (title, positive) = match joint {
        Joint::Pan => ("Pan angle", "positive: left"),
        Joint::Tilt => ("Tilt angle", "positive: down"),
    };
    over.plot(title, &format!("angle, ° ({positive})"), y)
        .line(&format!("wanted {joint}"), &over.curve(&y, |s| Some(wanted(s))), Some("desired"))
        .line(&joint.to_string(), &over.curve(&y, |s| Some(actual(s))), Some("actual"))
}

fn following_error(over: &Over<'_>) -> Plot {
    let error = |s: &Sample<'_>, joint: Joint| {
        (f64::from(s.tick.telemetry.setpoint[joint].position_rad) - s.tick.angle_rad[joint]) * 1e3
    };
    let largest = |s: &Sample<'_>| error(s, Joint::Pan).abs().max(error(s, Joint::Tilt).abs());
    let reach = over.samples.iter().map(largest).fold(0.0, f64::max).max(1e-3);
    let y = Axis::around([-reach, reach].into_iter(), 4);
    let curve = |joint: Joint| over.curve(&y, |s| Some(error(s, joint)));
    over.plot("Following error of the joints", "desired − actual, mrad", y)
        .line("pan", &curve(Joint::Pan), Some("pan"))
        .line("tilt", &curve(Joint::Tilt), Some("tilt"))
}

fn torque(over: &Over<'_>, joint: Joint) -> Plot {
    let limit_v = over.job.command_limit_v[joint].abs().max(1e-9);
    let used = |s: &Sample<'_>| f64::from(s.tick.telemetry.actuation.command_v[joint]) / limit_v * 100.0;
    let planned = |s: &Sample<'_>| f64::from(s.planned.torque_fraction[joint]) * 100.0;
    let y = Axis::new(-115.0, 115.0, 5);
    let title = match joint {
        Joint::Pan => "Pan torque",
        Joint::Tilt => "Tilt torque",
    };
    let limit = format!("limit ±{} N m", number(over.job.torque_limit_nm[joint], 3));
    over.plot(title, "share of the limit, %", y)
        .line(&format!("wanted {joint}"), &over.curve(&y, |s| Some(planned(s))), Some("planned"))
        .line(&joint.to_string(), &over.curve(&y, |s| Some(used(s))), Some("commanded"))
        .level("limit", 100.0, Some(&limit))
        .level("limit", -100.0, None)
}

/// The plan in time: who is drawn when, and how fast.
pub(super) fn schedule(job: &Finished<'_>) -> String {
    if job.plan.points.len() < 2 {
        return r#"<p class="note">The plan is empty.</p>"#.to_owned();
    }
    let time = Axis::new(0.0, job.plan.duration_s(), TIME_MARKS);
    let y = speed_axis(job);
    let points = || job.plan.points.iter().enumerate().map(|(i, p)| (i as f64 * TICK_F64_S, p));
    let strokes = |odd: bool| {
        let belongs = move |stroke: Option<u32>| stroke.is_some_and(|n| (n % 2 == 1) == odd);
        strip(points().map(|(t, p)| (t, p.lit && belongs(p.stroke))), &time, STRIP)
    };
    let lit = bands(points().map(|(t, p)| (t, p.lit)), &time);
    let plot = Plot::new("Time plan and speed", "speed of the spot, m/s", time, y)
        .over("time of the plan, s")
        .height(13.0)
        .area("lit", &lit, None)
        .area("stroke-odd", &strokes(false), Some("strokes, by number"))
        .area("stroke-even", &strokes(true), None);
    let plot = limits(job, &time)
        .into_iter()
        .fold(plot, |plot, (class, data, name)| plot.area(class, &data, Some(&name)))
        .line("wanted speed", &curve(planned_speed(job), &time, &y), Some("planned"))
        .line("speed", &curve(actual_speed(job), &time, &y), Some("actual"))
        .level("set", job.set_speed_m_s, Some(&format!("set speed {} m/s", number(job.set_speed_m_s, 4))));
    let plot = numbers(job).into_iter().fold(plot, |plot, (at, number)| plot.label(at, &number));
    plot.note(&cut_note(job, &y)).html()
}

/// Heights of the strip of strokes and of the one of limits below it, of 1000 from the top.
const STRIP: [f64; 2] = [0.0, 95.0];
const LIMIT_STRIP: [f64; 2] = [103.0, 143.0];

/// What holds the motion back, over time: for each limit that does its class, its spans and its name.
fn limits(job: &Finished<'_>, time: &Axis) -> Vec<(&'static str, String, String)> {
    let points = || job.plan.points.iter().enumerate().map(|(i, p)| (i as f64 * TICK_F64_S, p.limit));
    let spans = |limit: Binding| strip(points().map(|(t, l)| (t, l == Some(limit))), time, LIMIT_STRIP);
    let all = Binding::ALL.into_iter().map(|limit| (limit_class(limit), spans(limit), limit.to_string()));
    all.filter(|(_, data, _)| !data.is_empty()).collect()
}

const fn limit_class(limit: Binding) -> &'static str {
    match limit {
        Binding::SpeedCap => "binds-cap",
        Binding::Torque(Joint::Pan) => "binds-torque-pan",
        Binding::Torque(Joint::Tilt) => "binds-torque-tilt",
        Binding::Acceleration(Joint::Pan) => "binds-acceleration-pan",
        Binding::Acceleration(Joint::Tilt) => "binds-acceleration-tilt",
        Binding::Jerk(Joint::Pan) => "binds-jerk-pan",
        Binding::Jerk(Joint::Tilt) => "binds-jerk-tilt",
        Binding::JointSpeed(Joint::Pan) => "binds-speed-pan",
        Binding::JointSpeed(Joint::Tilt) => "binds-speed-tilt",
    }
}

/// Half of the ticks a speed is taken over.
const REACH: usize = 4;

fn speed_between(from: Option<Point>, to: Option<Point>, ticks: u32) -> Option<f64> {
    (ticks > 0).then_some(from?.distance(to?) / (f64::from(ticks) * TICK_F64_S))
}

fn planned_speed<'a>(job: &'a Finished<'_>) -> impl Iterator<Item = (f64, Option<f64>)> + 'a {
    let points = &job.plan.points;
    (0..points.len()).map(move |i| {
        let (from, to) = (i.saturating_sub(REACH), (i + REACH).min(points.len() - 1));
        (
            i as f64 * TICK_F64_S,
            speed_between(Some(points[from].spot), Some(points[to].spot), (to - from) as u32),
        )
    })
}

/// Speed of the true spot while the plan's clock ran, over that clock.
fn actual_speed<'a>(job: &'a Finished<'_>) -> impl Iterator<Item = (f64, Option<f64>)> + 'a {
    let ticks = &job.run.ticks;
    (REACH..ticks.len().saturating_sub(REACH)).filter_map(move |i| {
        let sample = Sample::new(&ticks[i], job.plan.points.last()?);
        let speed = speed_between(ticks[i - REACH].spot, ticks[i + REACH].spot, 2 * REACH as u32);
        sample.is_tracing().then_some((f64::from(ticks[i].telemetry.plan_tick) * TICK_F64_S, speed))
    })
}

/// Travel is quick; the axis is for the strokes.
const MOST_SET_SPEEDS: f64 = 2.0;

fn speed_axis(job: &Finished<'_>) -> Axis {
    let fastest = fastest(job);
    let top = fastest.min(job.set_speed_m_s * MOST_SET_SPEEDS).max(job.set_speed_m_s * 1.1);
    Axis::new(0.0, top * 1.2, 4) // air for the strips of strokes and limits
}

fn fastest(job: &Finished<'_>) -> f64 {
    planned_speed(job).filter_map(|p| p.1).fold(0.0, f64::max)
}

fn cut_note(job: &Finished<'_>, y: &Axis) -> String {
    let fastest = fastest(job);
    if fastest <= y.high() {
        return String::new();
    }
    format!("Travel reaches {} m/s, above this diagram.", number(fastest, 3))
}

/// Strokes wide enough for their number: the middle of their span and the number, from one.
fn numbers(job: &Finished<'_>) -> Vec<(f64, String)> {
    let wide = job.plan.duration_s() * 0.045;
    let mut found = Vec::new();
    let mut start = 0;
    for span in job.plan.points.chunk_by(|a, b| a.stroke == b.stroke) {
        let (from, length) = (start as f64 * TICK_F64_S, span.len() as f64 * TICK_F64_S);
        if let (Some(stroke), true) = (span[0].stroke, length >= wide) {
            found.push((from + length / 2.0, (u64::from(stroke) + 1).to_string()));
        }
        start += span.len();
    }
    found
}
