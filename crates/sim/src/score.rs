use tracelight_rig::{Phase, TICK_F64_S};
use tracelight_stroke::{Point, Vec2};
use tracelight_trajectory::{LegEnd, Plan, PlanPoint};

use crate::{Run, Tick};

/// How well the light followed the plan; lengths on the target.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tracking {
    /// Spot against the plan's point of the same tick, lit ticks, root mean square, mm.
    pub rms_mm: f64,
    /// Largest such distance, mm.
    pub max_mm: f64,
    /// Lit spot to the nearest point of the stroke, root mean square, mm.
    pub off_stroke_rms_mm: f64,
    /// Largest such distance, mm.
    pub off_stroke_max_mm: f64,
    /// Furthest excursion past a stroke end or corner along the incoming tangent, % of that leg (legs ≥ 20 mm).
    pub overshoot_percent: f64,
    /// Mean distance from the last planned point over the last 0.2 s at rest, mm.
    pub final_error_mm: f64,
    /// Mean speed of the lit spot, m/s.
    pub lit_speed_m_s: f64,
    /// Share of the lit time within ±2 % of the set speed.
    pub at_speed_share: f64,
}

/// Legs shorter than this do not count for overshoot, m.
const SHORTEST_LEG_M: f64 = 0.02;
/// How long after an end its overshoot is looked for, ticks.
const AFTER_END_TICKS: usize = 200;
/// How far along the plan the nearest point of a stroke is looked for, ticks either way.
const NEAR_TICKS: usize = 150;
/// The rest over which the final error is averaged, ticks.
const REST_TICKS: usize = 200;
/// Time over which the spot's speed is measured, ticks.
const SPEED_TICKS: usize = 5;
/// "At speed" means this close to it.
const AT_SPEED: f64 = 0.02;
const MM: f64 = 1e3;

/// Scores a run against its plan, with the truth about where the light was.
pub fn score(plan: &Plan, run: &Run, set_speed_m_s: f64) -> Tracking {
    let lit: Vec<&Tick> = run.ticks.iter().filter(|t| t.light).collect();
    let (rms_mm, max_mm) = rms_and_max(lit.iter().filter_map(|t| Some(t.spot?.distance(t.asked?))));
    let strokes = Strokes::of(plan);
    let (off_stroke_rms_mm, off_stroke_max_mm) =
        rms_and_max(lit.iter().filter_map(|t| strokes.off_stroke(t.spot?, t.telemetry.plan_tick as usize)));
    let speeds = lit_speeds(run);
    let at_speed = speeds.iter().filter(|&&v| (v / set_speed_m_s - 1.0).abs() <= AT_SPEED).count();
    Tracking {
        rms_mm,
        max_mm,
        off_stroke_rms_mm,
        off_stroke_max_mm,
        overshoot_percent: overshoot_percent(plan, run),
        final_error_mm: final_error_mm(plan, run),
        lit_speed_m_s: mean(&speeds),
        at_speed_share: at_speed as f64 / (speeds.len() as f64).max(1.0),
    }
}

/// Of lengths in m, in mm.
fn rms_and_max(errors_m: impl Iterator<Item = f64>) -> (f64, f64) {
    let (count, sum, max) =
        errors_m.fold((0.0, 0.0, 0.0f64), |(n, sum, max), e| (n + 1.0, sum + e * e, max.max(e)));
    ((sum / f64::max(count, 1.0)).sqrt() * MM, max * MM)
}

fn mean(values: &[f64]) -> f64 {
    // the sum of nothing is −0
    (values.iter().sum::<f64>() + 0.0) / (values.len() as f64).max(1.0)
}

/// A plan's points with the way to each of them, from the first.
struct Strokes<'a> {
    points: &'a [PlanPoint],
    way_m: Vec<f64>,
}

impl<'a> Strokes<'a> {
    fn of(plan: &'a Plan) -> Self {
        let steps = plan.points.windows(2).map(|pair| pair[0].spot.distance(pair[1].spot));
        let way_m = std::iter::once(0.0).chain(steps.scan(0.0, |way, step| {
            *way += step;
            Some(*way)
        }));
        Self { points: &plan.points, way_m: way_m.collect() }
    }

    /// Distance of a spot that is lit in that tick of the plan from the stroke it is on, m.
    fn off_stroke(&self, spot: Point, plan_tick: usize) -> Option<f64> {
        let last = self.points.len().checked_sub(1)?;
        let at = plan_tick.min(last);
        // light on the way between strokes is off whichever stroke is nearest
        let stroke = self.points[at].stroke;
        let far_m = |i: usize| {
            let (from, to) = (&self.points[i], &self.points[i + 1]);
            let on_one = from.stroke.is_some() && from.stroke == to.stroke;
            (on_one && (stroke.is_none() || stroke == from.stroke))
                .then(|| to_segment(spot, from.spot, to.spot))
        };
        // Outwards from where it should be, either way. What is so far from one step of the plan is no nearer to those that
        // end within the difference to the nearest: they are passed over.
        let mut nearest = f64::INFINITY;
        let mut passed = f64::NEG_INFINITY;
        for i in at..last.min(at + NEAR_TICKS - 1) {
            if self.way_m[i + 1] > passed
                && let Some(far) = far_m(i)
            {
                nearest = nearest.min(far);
                passed = self.way_m[i + 1] + (far - nearest);
            }
        }
        passed = f64::INFINITY;
        for i in (at.saturating_sub(NEAR_TICKS)..at).rev() {
            if self.way_m[i] < passed
                && let Some(far) = far_m(i)
            {
                nearest = nearest.min(far);
                passed = self.way_m[i] - (far - nearest);
            }
        }
        nearest.is_finite().then_some(nearest)
    }
}

fn to_segment(p: Point, a: Point, b: Point) -> f64 {
    let along: Vec2 = b - a;
    let share = ((p - a).dot(along) / along.hypot2().max(1e-300)).clamp(0.0, 1.0);
    p.distance(a + along * share)
}

/// Speeds of the true spot while lit, m/s, each over [`SPEED_TICKS`]: over a single tick a few micrometres of
/// trembling would count as speed.
fn lit_speeds(run: &Run) -> Vec<f64> {
    let stretches = run.ticks.windows(SPEED_TICKS + 1).filter(|w| w.iter().all(|t| t.light));
    let speed =
        |w: &[Tick]| Some(w[SPEED_TICKS].spot?.distance(w[0].spot?) / (SPEED_TICKS as f64 * TICK_F64_S));
    stretches.filter_map(speed).collect()
}

fn overshoot_percent(plan: &Plan, run: &Run) -> f64 {
    let long = plan.leg_ends.iter().filter(|e| e.length_m >= SHORTEST_LEG_M);
    long.map(|end| beyond(end, run) / end.length_m * 100.0).fold(0.0, f64::max)
}

/// How far the spot goes past the end of a leg along its last direction, beyond where the plan itself goes that
/// way afterwards, m. A head that holds, or makes its test move, is dark, and not on its way past anything.
fn beyond(end: &LegEnd, run: &Run) -> f64 {
    let first = run.ticks.partition_point(|t| t.telemetry.plan_tick < end.start_tick);
    let last = run.ticks.partition_point(|t| t.telemetry.plan_tick <= end.tick) + AFTER_END_TICKS;
    let ahead = |p: Point| (p - end.point).dot(end.tangent).max(0.0);
    let window = &run.ticks[first..last.min(run.ticks.len())];
    let moves = window.iter().filter(|t| !matches!(t.telemetry.phase, Phase::Holding | Phase::Testing));
    let over = moves.filter_map(|t| Some(ahead(t.spot?) - ahead(t.asked?)));
    over.fold(0.0, f64::max)
}

fn final_error_mm(plan: &Plan, run: &Run) -> f64 {
    let Some(last) = plan.points.last() else { return 0.0 };
    let rest = run.ticks.iter().rev().take(REST_TICKS).filter_map(|t| t.spot);
    mean(&rest.map(|s| s.distance(last.spot) * MM).collect::<Vec<_>>())
}

#[cfg(test)]
mod tests {
    use tracelight_rig::{PanTilt, Telemetry};

    use super::*;

    /// A stroke that turns back on itself with a rest, a dark way, and another stroke.
    fn plan() -> Plan {
        let points = (0..900).map(|tick| {
            let t = f64::from(tick);
            let (x, y) =
                (300.0 - (t.min(500.0) - 300.0).abs() + 0.2 * (t - 600.0).max(0.0), 30.0 * (0.02 * t).sin());
            let stroke = if (0..550).contains(&tick) { Some(0) } else { (tick > 650).then_some(1) };
            PlanPoint {
                spot: Point::new(1e-3 * x, 1e-3 * y),
                joints: PanTilt::default(),
                torque_fraction: PanTilt::default(),
                limit: None,
                lit: stroke.is_some(),
                stroke,
            }
        });
        Plan { points: points.collect(), ..Plan::default() }
    }

    #[test]
    fn passing_over_what_cannot_be_nearest_finds_the_nearest() {
        let plan = plan();
        let strokes = Strokes::of(&plan);
        for tick in 0..1000_usize {
            let at = tick.min(899);
            let aside = Vec2::new(1e-3 * (tick as f64).sin(), 3e-3 * (0.3 * tick as f64).cos());
            let spot = plan.points[at].spot + aside;
            let stroke = plan.points[at].stroke;
            let near = (at.saturating_sub(NEAR_TICKS)..899.min(at + NEAR_TICKS - 1)).filter(|&i| {
                let (from, to) = (plan.points[i].stroke, plan.points[i + 1].stroke);
                from.is_some() && from == to && (stroke.is_none() || stroke == from)
            });
            let each = near.map(|i| to_segment(spot, plan.points[i].spot, plan.points[i + 1].spot));
            let nearest = each.fold(f64::INFINITY, f64::min);
            assert_eq!(strokes.off_stroke(spot, tick).unwrap_or(f64::INFINITY), nearest, "{tick}");
        }
    }

    #[test]
    fn a_test_move_in_the_dark_is_no_overshoot() {
        let end = LegEnd {
            tick: 10,
            start_tick: 0,
            point: Point::ORIGIN,
            tangent: Vec2::new(1.0, 0.0),
            length_m: 0.1,
        };
        let tick = |plan_tick: u32, x: f64, phase: Phase| Tick {
            telemetry: Telemetry { plan_tick, phase, ..Telemetry::default() },
            angle_rad: PanTilt::default(),
            rate_rad_s: PanTilt::default(),
            spot: Some(Point::new(x, 0.0)),
            asked: Some(Point::new(-0.001, 0.0)),
            light: false,
        };
        let mut run = Run { ticks: vec![tick(3, 0.0, Phase::Tracing), tick(3, 0.002, Phase::Testing)] };
        run.ticks.push(tick(3, 0.001, Phase::Holding));
        assert_eq!(beyond(&end, &run), 0.0);
        run.ticks.push(tick(4, 0.0005, Phase::Tracing));
        assert_eq!(beyond(&end, &run), 0.0005);
    }
}
