//! A plan as a picture: its lit way in colours, its dark way dashed.

mod frame;
mod labels;
mod legend;
mod ways;

use std::fmt::Write;

use tracelight_chart::{Ramp, Rgb, STEPS, Theme, dark_style, share_step};
use tracelight_rig::Joint;
use tracelight_task::counted;
use tracelight_trajectory::Plan;

use self::frame::{Frame, MARGIN};
use self::legend::{ENTRY, limits, ramp, scale_bar};
use self::ways::{Ink, arrow, arrows, dark_way, lit_way};
use crate::limit;

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

/// Room for the legend below the drawing.
const LEGEND: f64 = 90.0;
/// Narrower drawings get room for the legend, as wide as its longest row.
const NARROWEST: f64 = 760.0;

/// An SVG of the plan in true size, `set_m_s` the speed it was asked for.
#[must_use]
pub fn preview(plan: &Plan, by: ColourBy, set_m_s: f64) -> String {
    let frame = Frame::around(plan);
    let inner = frame.size.0.max(NARROWEST);
    let columns = (inner / ENTRY.0).floor().max(1.0) as usize;
    let rows = if by == ColourBy::Limit { plan.limit_shares().len() / columns } else { 0 };
    let (width, height) =
        (inner + 2.0 * MARGIN, frame.size.1 + 2.0 * MARGIN + LEGEND + ENTRY.1 * rows as f64);
    let mut svg = head(plan, by, &frame, (width, height));
    let _ = write!(
        svg,
        r#"<path d="{}" fill="none" stroke="{}" stroke-width="1.5" stroke-dasharray="2 6" stroke-linecap="round"/>"#,
        dark_way(plan, &frame),
        Theme::Light.dark_way()
    );
    svg.push_str("\n<g fill=\"none\" stroke-width=\"4\" stroke-linejoin=\"round\">\n");
    lit(&mut svg, plan, &frame, (by, set_m_s));
    svg.push_str("</g>\n");
    let arrows = arrows(plan, &frame);
    arrows.iter().for_each(|passed| arrow(&mut svg, passed));
    labels::numbers(&mut svg, plan, &frame, &arrows);
    let top = frame.size.1 + 2.0 * MARGIN;
    match by {
        ColourBy::Speed => ramp(
            &mut svg,
            top,
            &|step| amount(STEPS - 1 - step),
            ["standing", &format!("{set_m_s:.3} m/s, the set speed")],
            "Speed of the spot",
        ),
        ColourBy::Order => ramp(&mut svg, top, &amount, ["first", "last"], "Order of the strokes"),
        ColourBy::Limit => limits(&mut svg, top, columns, plan),
    }
    scale_bar(&mut svg, &frame, (inner + MARGIN, top + 10.0));
    svg.push_str("</svg>\n");
    let style = dark_style(&svg);
    svg.replacen("</desc>\n", &format!("</desc>\n{style}\n"), 1)
}

/// The root, as large as what is drawn is on the target, and what is on the picture in words.
fn head(plan: &Plan, by: ColourBy, frame: &Frame, (width, height): (f64, f64)) -> String {
    let mm = |units: f64| 1e3 * units / frame.scale;
    let strokes = plan.points.iter().filter_map(|p| p.stroke).max().map_or(0, |last| last + 1);
    let what = match by {
        ColourBy::Speed => "its speed",
        ColourBy::Order => "its order",
        ColourBy::Limit => "what holds it back",
    };
    format!(
        r##"<svg xmlns="http://www.w3.org/2000/svg" width="{:.2}mm" height="{:.2}mm" viewBox="0 0 {width:.0} {height:.0}" role="img" font-family="system-ui, sans-serif" font-size="20" fill="{}">
<title>Plan of {}, {:.2} s</title>
<desc>The lit way, {:.0} × {:.0} mm in true size, coloured by {what}; the dark way dashed; numbers where strokes begin, arrows the way they go.</desc>
<rect width="100%" height="100%" fill="{}"/>
"##,
        mm(width),
        mm(height),
        Theme::Light.ink(),
        counted(strokes as usize, "stroke"),
        plan.duration_s(),
        mm(frame.size.0),
        mm(frame.size.1),
        Theme::Light.ground(),
    )
}

fn lit(svg: &mut String, plan: &Plan, frame: &Frame, (by, set_m_s): (ColourBy, f64)) {
    let last = plan.points.iter().rev().find_map(|p| p.stroke).unwrap_or(0);
    let plain = |colour: Rgb| Ink { colour, is_broken: false };
    lit_way(svg, plan, frame, &|p, speed_m_s| match by {
        // slow stands out: that is where it burns
        ColourBy::Speed => plain(amount(STEPS - 1 - share_step(speed_m_s / set_m_s))),
        ColourBy::Order => plain(amount(share_step(f64::from(p.stroke.unwrap_or(0)) / f64::from(last + 1)))),
        ColourBy::Limit => {
            let is_broken = p.limit.and_then(limit::joint) == Some(Joint::Tilt);
            Ink { colour: limit::rgb(p.limit), is_broken }
        }
    });
}

fn amount(step: usize) -> Rgb {
    Ramp::Amount.rgb(step, Theme::Light)
}
