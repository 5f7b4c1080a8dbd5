//! A plan in words, as JSON and as a table.

use std::fmt::Write;

use tracelight_pipeline::{Placed, Schedule, SheetFigures, Standing};
use tracelight_rig::TICK_F64_S;
use tracelight_stroke::Path;
use tracelight_task::counted;
use tracelight_trajectory::Plan;

use crate::sequence::sequence;
use crate::summary::{PlanFigures, StrokeFigures};

/// Outlines for display stay this close to their areas, m.
const OUTLINE_M: f64 = 1e-3;

/// A plan in words: two lines. `shortest` where the shortest way was looked for.
#[must_use]
pub fn plan_words(schedule: &Schedule, shortest: bool) -> String {
    let (ordered, plan) = (&schedule.ordered, &schedule.plan);
    // where ends are passed at speed the shortest way is not what is looked for
    let gap = match ordered.gap_percent() {
        Some(gap) if shortest => format!(", at most {gap:.1} % over the shortest"),
        _ => String::new(),
    };
    format!(
        "{}, {:.3} m lit, {:.3} m travel{gap}\n{:.3} s: {:.3} s lit, up to {:.3} m/s, torque up to {:.0} %",
        counted(ordered.drawing.strokes.len(), "stroke"),
        ordered.drawing.length(1e-6),
        ordered.travel,
        plan.duration_s(),
        plan.lit_s(),
        plan.top_speed_m_s(),
        100.0 * plan.torque_peak_fraction(),
    )
}

/// A plan as `plan --json` has it, with the time that its stages took.
#[must_use]
pub fn plan_json(
    (placed, sheet): (&Placed, Option<&SheetFigures>),
    standing: &Standing,
    schedule: &Schedule,
    timing: &serde_json::Value,
) -> String {
    let (ordered, plan) = (&schedule.ordered, &schedule.plan);
    let limits: serde_json::Map<_, _> =
        plan.limit_shares().into_iter().map(|(limit, share)| (key(&limit), share.into())).collect();
    serde_json::json!({
        "target": {
            "width_m": placed.size_m.0, "height_m": placed.size_m.1,
            "corners_m": placed.corners_m().map(|corner| [corner.x, corner.y]),
        },
        "head": standing,
        "align": placed.align,
        "sheet": sheet,
        "no_go": no_go_json(placed),
        "strokes": StrokeFigures::of(&ordered.drawing, plan),
        "plan": PlanFigures::of(plan),
        "order": {
            "travel_m": ordered.travel,
            "travel_s": plan.travel_s(),
            "lower_bound_m": ordered.lower_bound,
            "gap_percent": ordered.gap_percent(),
        },
        "limits": limits,
        "sequence": sequence(&ordered.drawing, plan),
        "timing_ms": timing,
    })
    .to_string()
}

/// What is kept dark, and what is left out for that; null where nothing is.
fn no_go_json(placed: &Placed) -> serde_json::Value {
    let outline =
        |path: &Path| -> Vec<[f64; 2]> { path.flatten(OUTLINE_M).iter().map(|p| [p.x, p.y]).collect() };
    let mut json = serde_json::json!(placed.left_out);
    if let Some(told) = json.as_object_mut() {
        let outlines: Vec<Vec<[f64; 2]>> = placed.kept_dark.iter().map(outline).collect();
        told.insert("outlines_m".to_owned(), outlines.into());
    }
    json
}

/// A limit's name as a key.
fn key(limit: &impl ToString) -> String {
    limit.to_string().replace(' ', "_")
}

/// A plan as a table: one row a tick.
#[must_use]
pub fn plan_csv(plan: &Plan) -> String {
    let mut text = String::from("t_s,lit,pan_rad,tilt_rad,pan_rad_s,tilt_rad_s,x_m,y_m,limit\n");
    for (tick, p) in plan.points.iter().enumerate() {
        let (pan, tilt) = (&p.joints.pan, &p.joints.tilt);
        // writing to a String cannot fail
        let _ = writeln!(
            text,
            "{:.3},{},{:.9},{:.9},{:.9},{:.9},{:.9},{:.9},{}",
            tick as f64 * TICK_F64_S,
            u8::from(p.lit),
            pan.position_rad,
            tilt.position_rad,
            pan.velocity_rad_s,
            tilt.velocity_rad_s,
            p.spot.x,
            p.spot.y,
            p.limit.map_or_else(String::new, |limit| limit.to_string())
        );
    }
    text
}
