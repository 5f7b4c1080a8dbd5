use tracelight_maths::{log10, powf};
use tracelight_stroke::{Point, Vec2};
use tracelight_task::counted;

use super::layout::{Layout, WIDTH};
use super::lettering::{Align, Pen, fitted};
use super::plane::Plane;
use crate::finished::Finished;
use crate::origin::badge;

/// Height of a capital, px.
const LARGE: f64 = 13.0;
const SMALL: f64 = 10.5;
/// Above the trace and its corner marks, in the margin: no exposure of a wall was taken.
const ABOVE: f64 = 32.0;
const CHALK: Pen = Pen { radius: 0.8, strength: 0.9 };
const FAINT: Pen = Pen { radius: 0.7, strength: 0.55 };

/// Everything written on the wall: names, sizes, marks and the scale; a share of chalk for each pixel.
pub(super) fn captions(job: &Finished<'_>, layout: &Layout) -> Plane {
    let mut chalk = Plane::dark(WIDTH as usize, layout.height as usize);
    corner_marks(&mut chalk, layout);
    under_the_sheet(&mut chalk, job, layout);
    size_label(&mut chalk, job, layout);
    scale_bar(&mut chalk, layout);
    CHALK.text(&mut chalk, badge(job.origin).0, SMALL, layout.wall.0 - Vec2::new(0.0, ABOVE), Align::Left);
    chalk
}

/// First line of captions, px.
fn baseline(layout: &Layout) -> f64 {
    (layout.wall.1.y + 52.0).min(f64::from(layout.height) - 40.0)
}

fn corner_marks(chalk: &mut Plane, layout: &Layout) {
    const AWAY: f64 = 10.0;
    const LENGTH: f64 = 16.0;
    let (low, high) = (layout.wall.0, layout.wall.1);
    for (x, sx) in [(low.x, -1.0), (high.x, 1.0)] {
        for (y, sy) in [(low.y, -1.0), (high.y, 1.0)] {
            let corner = Point::new(x + sx * AWAY, y + sy * AWAY);
            FAINT.stroke(chalk, corner, corner - Vec2::new(sx * LENGTH, 0.0));
            FAINT.stroke(chalk, corner, corner - Vec2::new(0.0, sy * LENGTH));
        }
    }
}

fn under_the_sheet(chalk: &mut Plane, job: &Finished<'_>, layout: &Layout) {
    let middle = layout.sheet_middle.x;
    let lowest = layout.sheet_middle.y
        + layout.sheet_size.y / 2.0
        + 0.11 * layout.sheet_size.x.max(layout.sheet_size.y);
    let y = (lowest + 50.0).min(f64::from(layout.height) - 40.0);
    let name = fitted(&job.title(), LARGE, layout.sheet_size.x.max(200.0));
    CHALK.text(chalk, &name, LARGE, Point::new(middle, y), Align::Middle);
    let size = job.picture.map(|p| format!("{} × {} px", p.raster.width(), p.raster.height()));
    let size = size.unwrap_or_else(|| counted(job.drawing.strokes.len(), "stroke"));
    let scale = if layout.sheet_to_scale { "on A4" } else { "not to scale" };
    FAINT.text(chalk, &format!("{size}, {scale}"), SMALL, Point::new(middle, y + 24.0), Align::Middle);
}

fn size_label(chalk: &mut Plane, job: &Finished<'_>, layout: &Layout) {
    let (w, h) = (job.target.width_m, job.target.height_m);
    let at = Point::new(layout.wall.0.x, baseline(layout));
    let metric = if w.max(h) >= 2.0 {
        format!("{} × {} m", short(w), short(h))
    } else {
        format!("{} × {} cm", short(w * 100.0), short(h * 100.0))
    };
    CHALK.text(chalk, &metric, LARGE, at, Align::Left);
    // nobody counts ten feet in inches
    let (unit_m, unit) = if w.max(h) >= 10.0 * FOOT_M { (FOOT_M, "ft") } else { (INCH_M, "in") };
    let inches = format!("{} × {} {unit}", short(w / unit_m), short(h / unit_m));
    FAINT.text(chalk, &inches, SMALL, at + Vec2::new(0.0, 24.0), Align::Left);
}

const INCH_M: f64 = 0.0254;
const FOOT_M: f64 = 12.0 * INCH_M;

/// Centimetres above the line, inches below it, both from its left end.
fn scale_bar(chalk: &mut Plane, layout: &Layout) {
    let width_m = (layout.wall.1.x - layout.wall.0.x) / layout.px_per_m;
    let metric = round_length(width_m * 0.28, &[5.0, 2.0, 1.0]);
    // 4 in beside 10 cm is 1.6 % longer, and the neighbour people expect; beside metres it is feet
    let (foot_or_inch_m, foot_or_inch) = if metric >= 1.0 { (FOOT_M, "ft") } else { (INCH_M, "in") };
    let imperial = round_length(metric / foot_or_inch_m * 1.02, &[8.0, 6.0, 4.0, 2.0, 1.0]) * foot_or_inch_m;
    let longest = metric.max(imperial) * layout.px_per_m;
    // a narrow trace has no room beside its size label
    let beside = layout.wall.1.x - layout.wall.0.x > 420.0;
    let left = if beside { layout.wall.1.x - longest } else { layout.wall.1.x + 40.0 };
    let y = baseline(layout) + 3.0;
    CHALK.stroke(chalk, Point::new(left, y), Point::new(left + longest, y));
    let unit = if metric >= 1.0 { (1.0, "m") } else { (0.01, "cm") };
    let label = format!("{} {}", short(metric / unit.0), unit.1);
    tick_marks(chalk, Point::new(left, y), metric * layout.px_per_m, -1.0, &label);
    let label = format!("{} {foot_or_inch}", short(imperial / foot_or_inch_m));
    tick_marks(chalk, Point::new(left, y), imperial * layout.px_per_m, 1.0, &label);
}

/// Marks at both ends and the middle of a scale, `side` −1 above it and 1 below, and its label.
fn tick_marks(chalk: &mut Plane, left: Point, length: f64, side: f64, label: &str) {
    for (share, height) in [(0.0, 8.0), (0.5, 5.0), (1.0, 8.0)] {
        let foot = left + Vec2::new(length * share, 0.0);
        CHALK.stroke(chalk, foot, foot + Vec2::new(0.0, side * height));
    }
    let drop = if side < 0.0 { -13.0 } else { 13.0 + SMALL };
    FAINT.text(chalk, label, SMALL, left + Vec2::new(length / 2.0, drop), Align::Middle);
}

/// The largest of `steps`, falling from below 10 to 1, times 10ⁿ that is not above `length`.
fn round_length(length: f64, steps: &[f64]) -> f64 {
    let power = powf(10.0, log10(length.max(1e-9)).floor());
    let step = steps.iter().find(|&s| s * power <= length * (1.0 + 1e-9));
    step.copied().unwrap_or(1.0) * power
}

/// Three digits at most, no idle zeros.
fn short(value: f64) -> String {
    let decimals =
        if value >= 99.95 { 0 } else { usize::from(value >= 9.995) ^ 1 } + usize::from(value < 99.95);
    let text = format!("{value:.decimals$}");
    let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    text.to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_read_as_people_write_them() {
        for (value, wanted) in [
            (60.96, "61"),
            (45.72, "45.7"),
            (24.0, "24"),
            (20.0, "20"),
            (5.0, "5"),
            (120.4, "120"),
            (1.25, "1.25"),
        ] {
            assert_eq!(short(value), wanted);
        }
    }

    #[test]
    fn a_scale_has_a_round_length() {
        for (length, wanted) in [(0.17, 0.1), (0.2, 0.2), (0.49, 0.2), (0.6, 0.5), (3.0, 2.0), (1.0, 1.0)] {
            assert!((round_length(length, &[5.0, 2.0, 1.0]) - wanted).abs() < 1e-9, "{length}");
        }
    }
}
