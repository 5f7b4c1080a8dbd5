//! The lit and the dark way of a plan as paths, and which way they go.

use std::fmt::Write;

use tracelight_chart::{Rgb, Theme};
use tracelight_maths::hypot;
use tracelight_rig::TICK_F64_S;
use tracelight_trajectory::{Plan, PlanPoint};

use super::frame::Frame;

/// Moves shorter than this many units are joined: a third of a pixel on a large screen.
const SHORTEST: f64 = 0.4;
/// From arrow to arrow along a stroke, and what a stroke must have to get one.
const BETWEEN_ARROWS: f64 = 340.0;
const LEAST_FOR_ARROW: f64 = 34.0;

/// How a piece of the lit way is drawn.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct Ink {
    pub(super) colour: Rgb,
    /// Broken, for what two of a colour are told apart by.
    pub(super) is_broken: bool,
}

pub(super) fn dark_way(plan: &Plan, frame: &Frame) -> String {
    let mut data = String::new();
    for run in plan.points.chunk_by(|a, b| a.lit == b.lit).filter(|run| !run[0].lit) {
        let mut last = None;
        for (i, p) in run.iter().enumerate() {
            let (x, y) = frame.at(p.spot);
            let is_near = last.is_some_and(|(u, v): (f64, f64)| hypot(x - u, y - v) < 4.0 * SHORTEST);
            if is_near && i + 1 < run.len() {
                continue;
            }
            // writing to a String cannot fail
            let _ = write!(data, "{}{x:.1} {y:.1}", if last.is_none() { 'M' } else { 'L' });
            last = Some((x, y));
        }
    }
    data
}

/// Lit stretches of one colour, each a path.
pub(super) fn lit_way(svg: &mut String, plan: &Plan, frame: &Frame, ink: &dyn Fn(&PlanPoint, f64) -> Ink) {
    let mut open: Option<(Ink, (f64, f64))> = None;
    for pair in plan.points.windows(2) {
        if !(pair[0].lit && pair[1].lit) {
            if open.take().is_some() {
                svg.push_str("\"/>\n");
            }
            continue;
        }
        let (from, to) = (frame.at(pair[0].spot), frame.at(pair[1].spot));
        let speed_m_s = pair[0].spot.distance(pair[1].spot) / TICK_F64_S;
        let wanted = ink(&pair[1], speed_m_s);
        match open {
            Some((now, last)) if now == wanted => {
                if hypot(to.0 - last.0, to.1 - last.1) >= SHORTEST {
                    let _ = write!(svg, "L{:.1} {:.1}", to.0, to.1);
                    open = Some((now, to));
                }
            }
            _ => {
                if open.is_some() {
                    let _ = writeln!(svg, "L{:.1} {:.1}\"/>", from.0, from.1);
                }
                let (colour, dashes) =
                    (wanted.colour, if wanted.is_broken { r#" stroke-dasharray="7 5""# } else { "" });
                let _ = write!(
                    svg,
                    r#"<path stroke="{colour}"{dashes} d="M{:.1} {:.1}L{:.1} {:.1}"#,
                    from.0, from.1, to.0, to.1
                );
                open = Some((wanted, to));
            }
        }
    }
    if open.is_some() {
        svg.push_str("\"/>\n");
    }
}

/// A place of a stroke, and the direction in which it is passed, of length one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Passed {
    pub(super) at: (f64, f64),
    pub(super) towards: (f64, f64),
}

/// Where arrows stand: along each stroke, evenly, one at least if it is not too short.
pub(super) fn arrows(plan: &Plan, frame: &Frame) -> Vec<Passed> {
    let lit = plan.points.chunk_by(|a, b| a.stroke == b.stroke && a.lit == b.lit).filter(|run| run[0].lit);
    lit.flat_map(|run| along(&run.iter().map(|p| frame.at(p.spot)).collect::<Vec<_>>())).collect()
}

fn along(points: &[(f64, f64)]) -> Vec<Passed> {
    let step = |w: &[(f64, f64)]| hypot(w[1].0 - w[0].0, w[1].1 - w[0].1);
    let length: f64 = points.windows(2).map(step).sum();
    if length < LEAST_FOR_ARROW {
        return Vec::new();
    }
    let count = (length / BETWEEN_ARROWS).round().max(1.0);
    let mut found = Vec::new();
    let (mut gone, mut next) = (0.0, 0.42);
    for pair in points.windows(2) {
        let long = step(pair);
        gone += long;
        if long > 0.0 && gone >= next / count * length {
            let towards = ((pair[1].0 - pair[0].0) / long, (pair[1].1 - pair[0].1) / long);
            found.push(Passed { at: pair[1], towards });
            next += 1.0;
        }
    }
    found
}

/// A head of an arrow.
pub(super) fn arrow(svg: &mut String, passed: &Passed) {
    const LONG: f64 = 7.5;
    const WIDE: f64 = 5.0;
    let ((x, y), (u, v)) = (passed.at, passed.towards);
    let point = |ahead: f64, aside: f64| (x + ahead * u - aside * v, y + ahead * v + aside * u);
    let [tip, left, right] = [point(LONG, 0.0), point(-LONG, WIDE), point(-LONG, -WIDE)];
    // writing to a String cannot fail
    let _ = writeln!(
        svg,
        r#"<path d="M{:.1} {:.1}L{:.1} {:.1}L{:.1} {:.1}Z" stroke="{}" stroke-width="2" paint-order="stroke"/>"#,
        tip.0,
        tip.1,
        left.0,
        left.1,
        right.0,
        right.1,
        Theme::Light.ground()
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arrows_stand_evenly_and_point_along() {
        let line: Vec<(f64, f64)> = (0..=700).map(|i| (f64::from(i), 5.0)).collect();
        let found = along(&line);
        assert_eq!(found.iter().map(|p| p.at.0).collect::<Vec<_>>(), [147.0, 497.0]);
        assert!(found.iter().all(|p| p.towards == (1.0, 0.0)));
        assert_eq!(along(&line[..60]).len(), 1);
        assert!(along(&line[..20]).is_empty() && along(&[]).is_empty());
    }
}
