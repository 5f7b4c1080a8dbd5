//! A plan as a picture: its lit way in colours, its dark way dashed.

use std::fmt::Write;

use tracelight_maths::{hypot, log10, powf};
use tracelight_rig::Joint;
use tracelight_rig::TICK_F64_S;
use tracelight_stroke::{Point, Rect};
use tracelight_trajectory::{Binding, Plan, PlanPoint};

/// What the colours of a preview say.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ColourBy {
    /// How fast the spot is
    #[default]
    Speed,
    /// When a stroke is drawn
    Order,
    /// Which limit holds the spot back
    Limit,
}

/// Slow to fast: warm colours where the eye should look.
const SPEEDS: [&str; 8] =
    ["#a50026", "#d7301f", "#ef6548", "#e8a33d", "#8fb58c", "#5aa6c4", "#4575b4", "#313695"];
/// First to last.
const ORDER: [&str; 8] =
    ["#9bd0c4", "#6fbfb9", "#48aaae", "#2c93a3", "#237a96", "#225f86", "#264472", "#2a2a5c"];
const NO_LIMIT: &str = "#a3a3a3";
/// The longer side of the drawing in the picture's own units, and the room around it and for the legend below.
const SIDE: f64 = 1000.0;
const MARGIN: f64 = 40.0;
const LEGEND: f64 = 90.0;
/// Narrower drawings get room for the legend, as wide as its longest row; and what an entry of it takes.
const NARROWEST: f64 = 760.0;
const ENTRY: (f64, f64) = (330.0, 30.0);
/// Moves shorter than this many units are joined: a third of a pixel on a large screen.
const SHORTEST: f64 = 0.4;
/// More strokes than this go without a number beside their start.
const NUMBERED: usize = 40;

const fn limit_colour(limit: Option<Binding>) -> &'static str {
    match limit {
        None => NO_LIMIT,
        Some(Binding::SpeedCap) => "#4575b4",
        Some(Binding::Torque(Joint::Pan)) => "#d7301f",
        Some(Binding::Torque(Joint::Tilt)) => "#e8a33d",
        Some(Binding::Acceleration(Joint::Pan)) => "#238b57",
        Some(Binding::Acceleration(Joint::Tilt)) => "#7cc29a",
        Some(Binding::Jerk(Joint::Pan)) => "#b0136f",
        Some(Binding::Jerk(Joint::Tilt)) => "#e08ac0",
        Some(Binding::JointSpeed(Joint::Pan)) => "#6a3d9a",
        Some(Binding::JointSpeed(Joint::Tilt)) => "#b79ad6",
    }
}

/// An SVG of the plan, `set_m_s` the speed it was asked for.
#[must_use]
pub fn preview(plan: &Plan, by: ColourBy, set_m_s: f64) -> String {
    let frame = Frame::around(plan);
    let inner = frame.size.0.max(NARROWEST);
    let columns = (inner / ENTRY.0).floor().max(1.0) as usize;
    let rows = if by == ColourBy::Limit { plan.limit_shares().len() / columns } else { 0 };
    let (width, height) =
        (inner + 2.0 * MARGIN, frame.size.1 + 2.0 * MARGIN + LEGEND + ENTRY.1 * rows as f64);
    let last = plan.points.iter().rev().find_map(|p| p.stroke).unwrap_or(0);
    let mut svg = format!(
        r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:.0} {height:.0}" font-family="system-ui, sans-serif" font-size="20" fill="#333">
<rect width="100%" height="100%" fill="#fff"/>
"##
    );
    let _ = write!(
        svg,
        r##"<path d="{}" fill="none" stroke="#bbb" stroke-width="1.5" stroke-dasharray="2 6" stroke-linecap="round"/>"##,
        dark_way(plan, &frame)
    );
    svg.push_str(
        "\n<g fill=\"none\" stroke-width=\"4\" stroke-linecap=\"round\" stroke-linejoin=\"round\">\n",
    );
    lit_way(&mut svg, plan, &frame, &|p, speed_m_s| match by {
        ColourBy::Speed => of_ramp(&SPEEDS, speed_m_s / set_m_s),
        ColourBy::Order => of_ramp(&ORDER, f64::from(p.stroke.unwrap_or(0)) / f64::from(last + 1)),
        ColourBy::Limit => limit_colour(p.limit),
    });
    svg.push_str("</g>\n");
    numbers(&mut svg, plan, &frame);
    let top = frame.size.1 + 2.0 * MARGIN;
    match by {
        ColourBy::Speed => ramp(
            &mut svg,
            top,
            &SPEEDS,
            ["standing", &format!("{set_m_s:.3} m/s, the set speed")],
            "Speed of the spot",
        ),
        ColourBy::Order => ramp(&mut svg, top, &ORDER, ["first", "last"], "Order of the strokes"),
        ColourBy::Limit => limits(&mut svg, top, columns, plan),
    }
    scale_bar(&mut svg, &frame, (inner + MARGIN, top + 10.0));
    svg.push_str("</svg>\n");
    svg
}

/// How long a round number of millimetres is, at the right below the drawing.
fn scale_bar(svg: &mut String, frame: &Frame, (to, y): (f64, f64)) {
    const LONGEST: f64 = 180.0;
    let most_mm = 1e3 * LONGEST / frame.scale;
    let decade = powf(10.0, log10(most_mm).floor());
    let length_mm = [5.0, 2.0, 1.0].map(|n| n * decade).into_iter().find(|&l| l <= most_mm).unwrap_or(decade);
    let from = to - 1e-3 * length_mm * frame.scale;
    let _ = writeln!(
        svg,
        r##"<path d="M{from:.1} {:.1}v8H{to:.1}v-8" fill="none" stroke="#333" stroke-width="2"/><text x="{to:.1}" y="{:.1}" text-anchor="end">{length_mm} mm</text>"##,
        y - 8.0,
        y - 16.0
    );
}

fn of_ramp(ramp: &[&'static str; 8], share: f64) -> &'static str {
    ramp[((8.0 * share) as usize).min(7)]
}

/// From target metres to the picture, y down.
struct Frame {
    corner: Point,
    scale: f64,
    size: (f64, f64),
}

impl Frame {
    fn around(plan: &Plan) -> Self {
        let lit = plan.points.iter().filter(|p| p.lit).map(|p| p.spot);
        let all = lit.fold(None, |all: Option<Rect>, p| {
            Some(all.map_or(Rect::from_points(p, p), |all| all.union_pt(p)))
        });
        let all = all.unwrap_or(Rect::ZERO);
        let scale = SIDE / all.width().max(all.height()).max(1e-3);
        Self {
            corner: Point::new(all.x0, all.y1),
            scale,
            size: (scale * all.width(), (scale * all.height()).max(1.0)),
        }
    }

    fn at(&self, p: Point) -> (f64, f64) {
        (MARGIN + self.scale * (p.x - self.corner.x), MARGIN + self.scale * (self.corner.y - p.y))
    }
}

fn dark_way(plan: &Plan, frame: &Frame) -> String {
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
fn lit_way(svg: &mut String, plan: &Plan, frame: &Frame, colour: &dyn Fn(&PlanPoint, f64) -> &'static str) {
    let mut open: Option<(&'static str, (f64, f64))> = None;
    for pair in plan.points.windows(2) {
        if !(pair[0].lit && pair[1].lit) {
            if open.take().is_some() {
                svg.push_str("\"/>\n");
            }
            continue;
        }
        let (from, to) = (frame.at(pair[0].spot), frame.at(pair[1].spot));
        let speed_m_s = pair[0].spot.distance(pair[1].spot) / TICK_F64_S;
        let wanted = colour(&pair[1], speed_m_s);
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
                let _ = write!(
                    svg,
                    r#"<path stroke="{wanted}" d="M{:.1} {:.1}L{:.1} {:.1}"#,
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

/// Each stroke's number where it begins.
fn numbers(svg: &mut String, plan: &Plan, frame: &Frame) {
    // corners that are passed in the dark part a stroke: it has one number all the same
    let mut starts: Vec<&PlanPoint> = plan.points.iter().filter(|p| p.lit).collect();
    starts.dedup_by_key(|p| p.stroke);
    if starts.len() > NUMBERED {
        return;
    }
    for p in starts {
        let (x, y) = frame.at(p.spot);
        let number = p.stroke.map_or(0, |s| s + 1);
        let _ = writeln!(
            svg,
            r##"<circle cx="{x:.1}" cy="{y:.1}" r="4" fill="#333"/><text x="{:.1}" y="{:.1}" font-size="18" stroke="#fff" stroke-width="4" paint-order="stroke">{number}</text>"##,
            x + 7.0,
            y - 7.0
        );
    }
}

fn ramp(svg: &mut String, top: f64, colours: &[&str; 8], ends: [&str; 2], title: &str) {
    let _ = writeln!(svg, r#"<text x="{MARGIN}" y="{:.1}" font-weight="600">{title}</text>"#, top + 12.0);
    for (i, colour) in colours.iter().enumerate() {
        let x = MARGIN + 50.0 * i as f64;
        let _ = writeln!(
            svg,
            r#"<rect x="{x:.1}" y="{:.1}" width="50" height="16" fill="{colour}"/>"#,
            top + 28.0
        );
    }
    let y = top + 68.0;
    let _ = writeln!(svg, r#"<text x="{MARGIN}" y="{y:.1}">{}</text>"#, ends[0]);
    let _ =
        writeln!(svg, r#"<text x="{:.1}" y="{y:.1}" text-anchor="end">{}</text>"#, MARGIN + 400.0, ends[1]);
}

fn limits(svg: &mut String, top: f64, columns: usize, plan: &Plan) {
    let shares = plan.limit_shares();
    let soft = 1.0 - shares.iter().map(|(_, share)| share).sum::<f64>();
    let named = shares.into_iter().map(|(limit, share)| (limit.to_string(), Some(limit), share));
    let all = named.chain([("starts, stops, small breaks".to_owned(), None, soft)]);
    let _ = writeln!(
        svg,
        r#"<text x="{MARGIN}" y="{:.1}" font-weight="600">What holds the spot back, share of the lit time</text>"#,
        top + 12.0
    );
    for (i, (name, limit, share)) in all.enumerate() {
        let (x, y) = (MARGIN + ENTRY.0 * (i % columns) as f64, top + 44.0 + ENTRY.1 * (i / columns) as f64);
        let _ = writeln!(
            svg,
            r#"<rect x="{x:.1}" y="{:.1}" width="28" height="16" fill="{}"/><text x="{:.1}" y="{y:.1}">{name}, {:.1} %</text>"#,
            y - 14.0,
            limit_colour(limit),
            x + 38.0,
            100.0 * share
        );
    }
}
