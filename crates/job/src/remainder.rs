//! What is left of a job when it is begun anew.

use tracelight_rig::Segment;
use tracelight_stroke::{Drawing, Stroke};
use tracelight_trajectory::{LegEnd, Plan};

/// What a plan has not drawn at a tick of its own, and the number of the stroke that begins with; `None` if nothing is left.
pub(crate) fn left(plan: &Plan, drawing: &Drawing, tick: u32) -> Option<(u32, Drawing)> {
    const TOLERANCE_M: f64 = 1e-6;
    /// Less of a stroke is not worth a way there.
    const LEAST_M: f64 = 5e-4;
    let points = &plan.points;
    let tick = (tick as usize).min(points.len().checked_sub(1)?);
    let stroke = points[tick..].iter().find_map(|point| point.stroke)?;
    let drawn = points[..=tick]
        .windows(2)
        .filter(|pair| pair.iter().all(|point| point.lit && point.stroke == Some(stroke)));
    let drawn_m: f64 = drawn.map(|pair| pair[0].spot.distance(pair[1].spot)).sum();
    let begun = drawing.strokes.get(stroke as usize)?;
    let is_left = begun.path.length(TOLERANCE_M) > drawn_m + LEAST_M;
    let rest = if is_left && drawn_m > 0.0 {
        begun.path.after(drawn_m, TOLERANCE_M).map(|path| begun.along(path))
    } else {
        is_left.then(|| begun.clone())
    };
    let first = if rest.is_some() { stroke } else { stroke + 1 };
    let strokes: Vec<Stroke> =
        rest.into_iter().chain(drawing.strokes.iter().skip(stroke as usize + 1).cloned()).collect();
    (!strokes.is_empty()).then_some((first, Drawing { strokes }))
}

/// Appends a plan to what was followed of those before, up to a tick of it; the tick at which it begins. `first` is the number of its first
/// stroke among all.
pub(crate) fn join(all: &mut Plan, cut: u32, next: &Plan, first: u32) -> u32 {
    all.points.truncate(cut as usize + 1);
    all.segments.retain(|segment| segment.end_tick() <= cut);
    all.leg_ends.retain(|end| end.tick <= cut);
    let base = all.points.len() as u32;
    all.points.extend(next.points.iter().map(|point| {
        let mut point = *point;
        point.stroke = point.stroke.map(|stroke| stroke + first);
        point
    }));
    all.segments.extend(next.segments.iter().map(|s| Segment { start_tick: s.start_tick + base, ..*s }));
    let later = |end: &LegEnd| LegEnd { tick: end.tick + base, start_tick: end.start_tick + base, ..*end };
    all.leg_ends.extend(next.leg_ends.iter().map(later));
    base
}

#[cfg(test)]
mod tests {
    use super::*;
    use tracelight_aim::HeadPose;
    use tracelight_pipeline::request_of;
    use tracelight_sim::RigConfig;
    use tracelight_stroke::{Path, Point};
    use tracelight_trajectory::plan;

    fn planned(drawing: &Drawing) -> Plan {
        let rig = RigConfig::report();
        plan(drawing, &rig.machine(HeadPose::square_on(0.9144)), &request_of(&rig)).unwrap()
    }

    fn drawing() -> Drawing {
        let line = |y: f64| {
            let points = [Point::new(-0.1, y), Point::new(0.1, y), Point::new(0.1, y + 0.05)];
            Stroke::new(Path::polyline(&points, false).unwrap())
        };
        Drawing { strokes: vec![line(-0.1), line(0.0), line(0.1)] }
    }

    #[test]
    fn what_is_left_and_what_was_drawn_are_the_whole() {
        let drawing = drawing();
        let whole = planned(&drawing);
        let lit_m = |plan: &Plan, until: usize| -> f64 {
            let lit = plan.points[..=until].windows(2).filter(|pair| pair.iter().all(|p| p.lit));
            lit.map(|pair| pair[0].spot.distance(pair[1].spot)).sum()
        };
        for tick in (0..whole.points.len()).step_by(50) {
            let Some((first, rest)) = left(&whole, &drawing, tick as u32) else {
                let all_m = lit_m(&whole, whole.points.len() - 1);
                assert!(all_m - lit_m(&whole, tick) < 1e-3, "{tick}");
                continue;
            };
            assert_eq!(rest.strokes.len() + first as usize, 3, "{tick}");
            let all_m = lit_m(&whole, tick) + rest.length(1e-6);
            assert!((all_m - drawing.length(1e-6)).abs() < 2e-3, "{tick}: {all_m}");
            let end = |d: &Drawing| d.strokes.last().unwrap().path.end();
            assert!(end(&rest).distance(end(&drawing)) < 1e-9);
        }
    }

    #[test]
    fn joined_plans_follow_each_other_tick_by_tick() {
        let drawing = drawing();
        let mut all = planned(&drawing);
        let cut = (all.points.len() / 2) as u32;
        let (first, rest) = left(&all, &drawing, cut).unwrap();
        let next = planned(&rest);
        let base = join(&mut all, cut, &next, first);
        assert_eq!(all.points.len(), cut as usize + 1 + next.points.len());
        assert_eq!(all.points[base as usize].spot, next.points[0].spot);
        assert_eq!(all.points.iter().filter_map(|p| p.stroke).max(), Some(2));
        assert!(all.segments.windows(2).all(|pair| pair[0].end_tick() <= pair[1].start_tick));
        assert!(all.leg_ends.windows(2).all(|pair| pair[0].tick <= pair[1].tick));
    }
}
