use tracelight_rig::{Joint, TICK_F64_S};
use tracelight_stroke::Point;
use tracelight_trajectory::{Binding, PlanPoint};

use super::axis::Axis;
use super::curve::{Band, Curve, band, bands, curve, strip};
use super::html::number;
use super::plot::Plot;
use crate::finished::Finished;
use crate::limit;
use crate::origin::words;
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

    fn curve(&self, y: &Axis, value: impl Fn(&Sample<'_>) -> Option<f64>) -> Curve {
        curve(self.samples.iter().map(|s| (s.t_s, value(s))), &self.time, y)
    }

    fn band(&self, y: &Axis, value: impl Fn(&Sample<'_>) -> Option<f64>) -> Band {
        band(self.samples.iter().map(|s| (s.t_s, value(s))), &self.time, y)
    }

    /// The largest of something that errs while light falls.
    fn largest_lit(&self, size: impl Fn(&Sample<'_>) -> f64) -> f64 {
        let sizes = self.samples.iter().filter(|s| s.tick.light).map(size);
        sizes.filter(|size| size.is_finite()).fold(0.0, f64::max)
    }

    /// Says what of the dark is above a diagram that ends at `top`; nothing where nothing is.
    fn dark_note(&self, top: f64, unit: &str, size: impl Fn(&Sample<'_>) -> f64) -> String {
        let dark = self.samples.iter().filter(|s| !s.tick.light).map(|s| (s.t_s, size(s)));
        let Some((at_s, most)) = dark.filter(|d| d.1.is_finite()).max_by(|a, b| a.1.total_cmp(&b.1)) else {
            return String::new();
        };
        if most <= top {
            return String::new();
        }
        let first_light_s = self.samples.iter().find(|s| s.tick.light).map_or(f64::INFINITY, |s| s.t_s);
        let when = if at_s < first_light_s { "Dark start" } else { "While dark up to" };
        format!("{when} {} {unit}, not shown.", number(most, 3))
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
    let size = |s: &Sample<'_>| s.error_mm().unwrap_or(f64::NAN);
    let largest = over.largest_lit(size);
    // the limit is shown where the curve would still be readable beside it
    let in_view = largest > limit / 6.0;
    let top = if in_view { largest.max(limit) * 1.08 } else { (largest * 1.25).max(1e-3) };
    let y = Axis::around([0.0, top].into_iter(), 4);
    let dark_error = |s: &Sample<'_>| s.error_mm().filter(|&e| !s.tick.light && e <= y.high());
    let dark = over.dark_note(y.high(), "mm", size);
    let plot = over
        .plot(
            &format!("Tracking error{}", words(over.job.origin.light_from).by),
            "spot to its planned place, mm",
            y,
        )
        .line("dark", &over.curve(&y, dark_error), Some("while dark"))
        .band("error", &over.band(&y, lit_error), Some("while lit: mean, and lowest to highest"));
    let name = format!("limit {} mm", number(limit, 2));
    if in_view {
        plot.level("limit", limit, Some(&name)).note(&dark)
    } else {
        let above = format!("The laser darkens at {} mm, above this diagram.", number(limit, 2));
        plot.note(format!("{above} {dark}").trim_end())
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
    // what light shows decides; a job that is never lit is shown whole
    let lit = over.largest_lit(largest);
    let all = over.samples.iter().map(largest).fold(0.0, f64::max);
    let reach = if lit > 0.0 { lit * 1.15 } else { all }.max(1e-3);
    let y = Axis::around([-reach, reach].into_iter(), 4);
    let curve = |joint: Joint| over.curve(&y, |s| Some(error(s, joint)).filter(|e| e.abs() <= y.high()));
    over.plot("Following error of the joints", "desired − actual, mrad", y)
        .line("pan", &curve(Joint::Pan), Some("pan"))
        .line("tilt", &curve(Joint::Tilt), Some("tilt"))
        .note(&over.dark_note(y.high(), "mrad", largest))
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
    let plot = over.plot(title, "share of the limit, %", y).line(
        "planned",
        &over.curve(&y, |s| Some(planned(s))),
        Some("planned"),
    );
    // steppers and servos are told where to be, not what torque to give
    let plot = match over.samples.iter().any(|s| used(s) != 0.0) {
        true => plot.band(
            &joint.to_string(),
            &over.band(&y, |s| Some(used(s))),
            Some("commanded: mean, and lowest to highest"),
        ),
        false => plot,
    };
    plot.level("limit", 100.0, Some(&limit)).level("limit", -100.0, None)
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
    // what is faster ends below the strips
    let shown = |value: &f64| y.share(*value) <= 1.0 - BELOW_STRIPS / 1000.0;
    let speeds = |points: &mut dyn Iterator<Item = (f64, Option<f64>)>| {
        curve(points.map(|(t, speed)| (t, speed.filter(shown))), &time, &y)
    };
    let plot = Plot::new("Time plan and speed", "speed of the spot, m/s", time, y)
        .over("time of the plan, s")
        .shifted(begun_s(job))
        .height(13.0)
        .area("lit", &lit, None)
        .area("stroke-odd", &strokes(false), Some("strokes, by number"))
        .area("stroke-even", &strokes(true), None);
    let plot = limits(job, &time)
        .into_iter()
        .fold(plot, |plot, (class, data, name)| plot.area(&class, &data, Some(&name)))
        .line("wanted speed", &speeds(&mut planned_speed(job)), Some("planned"))
        .line("speed", &speeds(&mut actual_speed(job)), Some("actual"))
        .level("set", job.set_speed_m_s, Some(&format!("set speed {} m/s", number(job.set_speed_m_s, 4))));
    let wide = job.plan.duration_s() * 0.045;
    let plot = numbers(job)
        .into_iter()
        .fold(plot, |plot, (span, number)| plot.label(span, span.1 - span.0 < wide, &number));
    plot.note(&cut_note(job, &y)).html()
}

/// Heights of the strip of strokes and of the one of limits below it, of 1000 from the top; what is pan's alone lies in the upper half of
/// the latter, what is tilt's in its lower half.
const STRIP: [f64; 2] = [0.0, 95.0];
const LIMIT_STRIP: [f64; 2] = [105.0, 149.0];
/// Where the curves begin.
const BELOW_STRIPS: f64 = 160.0;

const fn lane(limit: Binding) -> [f64; 2] {
    let [top, bottom] = LIMIT_STRIP;
    let middle = 0.5 * (top + bottom);
    match limit::joint(limit) {
        None => LIMIT_STRIP,
        Some(Joint::Pan) => [top, middle],
        Some(Joint::Tilt) => [middle, bottom],
    }
}

/// What holds the motion back, over time: for each limit that does its class, its spans and its name.
fn limits(job: &Finished<'_>, time: &Axis) -> Vec<(String, String, String)> {
    let points = || job.plan.points.iter().enumerate().map(|(i, p)| (i as f64 * TICK_F64_S, p.limit));
    let spans = |limit: Binding| strip(points().map(|(t, l)| (t, l == Some(limit))), time, lane(limit));
    let named = |limit: Binding| match limit::joint(limit) {
        None => limit.to_string(),
        Some(Joint::Pan) => format!("{limit} (above)"),
        Some(Joint::Tilt) => format!("{limit} (below)"),
    };
    let all = Binding::ALL.into_iter().map(|limit| (limit::class(limit), spans(limit), named(limit)));
    all.filter(|(_, data, _)| !data.is_empty()).collect()
}

/// Half of the ticks a speed is taken over.
const REACH: usize = 4;

fn speed_between(from: Option<Point>, to: Option<Point>, ticks: u32) -> Option<f64> {
    (ticks > 0).then_some(from?.distance(to?) / (f64::from(ticks) * TICK_F64_S))
}

fn planned_speed<'a>(job: &'a Finished<'_>) -> impl Iterator<Item = (f64, Option<f64>)> + 'a {
    let points = &job.plan.points;
    let joins: Vec<usize> = (1..points.len()).filter(|&i| are_joined(points, i)).collect();
    (0..points.len()).map(move |i| {
        let (from, to) = (i.saturating_sub(REACH), (i + REACH).min(points.len() - 1));
        let is_one = joins.get(joins.partition_point(|&join| join <= from)).is_none_or(|&join| join > to);
        let speed = || speed_between(Some(points[from].spot), Some(points[to].spot), (to - from) as u32);
        (i as f64 * TICK_F64_S, is_one.then(speed).flatten())
    })
}

/// Whether one plan ends before a tick and another one begins there, elsewhere: how the head came there is in neither. No motor makes a step so much
/// longer than the ones before and after it.
fn are_joined(points: &[PlanPoint], at: usize) -> bool {
    const LONGER: f64 = 10.0;
    const LEAST_M: f64 = 1e-3;
    let step = |to: usize| {
        let ends = to.checked_sub(1).and_then(|from| Some((points.get(from)?, points.get(to)?)));
        ends.map_or(0.0, |(from, to)| from.spot.distance(to.spot))
    };
    step(at) > LONGER * step(at - 1).max(step(at + 1)) + LEAST_M
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
    Axis::new(0.0, top / (1.0 - BELOW_STRIPS / 1000.0) * 1.001, 4)
}

fn fastest(job: &Finished<'_>) -> f64 {
    planned_speed(job).filter_map(|p| p.1).fold(0.0, f64::max)
}

fn cut_note(job: &Finished<'_>, y: &Axis) -> String {
    let fastest = fastest(job);
    if y.share(fastest) <= 1.0 - BELOW_STRIPS / 1000.0 {
        return String::new();
    }
    format!("Travel reaches {} m/s, above this diagram.", number(fastest, 3))
}

/// When the run began with the plan, s.
fn begun_s(job: &Finished<'_>) -> f64 {
    let mut all = samples(job.plan, job.run);
    let first = all.find(Sample::is_tracing);
    first.map_or(0.0, |s| s.t_s - f64::from(s.tick.telemetry.plan_tick) * TICK_F64_S)
}

/// Each stroke's span of the plan and its number, from one.
fn numbers(job: &Finished<'_>) -> Vec<((f64, f64), String)> {
    let mut found = Vec::new();
    let mut start = 0;
    for span in job.plan.points.chunk_by(|a, b| a.stroke == b.stroke) {
        let (from, to) = (start as f64 * TICK_F64_S, (start + span.len()) as f64 * TICK_F64_S);
        if let Some(stroke) = span[0].stroke {
            found.push(((from, to), (u64::from(stroke) + 1).to_string()));
        }
        start += span.len();
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;

    #[test]
    fn no_speed_is_told_of_where_one_plan_ends_and_another_one_begins() {
        let mut fixture = fixture::star();
        let once = fastest(&fixture.job());
        let points = &fixture.plan.points;
        assert!((1..points.len()).all(|at| !are_joined(points, at)));
        // stopped half-way, and begun anew from zero
        let half = points.len() / 2;
        let again: Vec<PlanPoint> = points[..half].to_vec();
        fixture.plan.points.truncate(half);
        fixture.plan.points.extend(again);
        assert!(are_joined(&fixture.plan.points, half));
        let speeds = planned_speed(&fixture.job()).filter(|(_, speed)| speed.is_none()).count();
        assert!(fastest(&fixture.job()) <= once && speeds >= 2 * REACH, "{once}, {speeds}");
    }
}
