//! What the colours of a preview say, and how long a piece of it is.

use std::fmt::Write;

use tracelight_chart::{Rgb, STEPS, Theme};
use tracelight_maths::{log10, powf};
use tracelight_rig::Joint;
use tracelight_trajectory::Plan;

use super::frame::{Frame, MARGIN};
use crate::limit;

/// Room for an entry, across and down.
pub(super) const ENTRY: (f64, f64) = (330.0, 30.0);

/// How long a round number of millimetres is, at the right below the drawing.
pub(super) fn scale_bar(svg: &mut String, frame: &Frame, (to, y): (f64, f64)) {
    const LONGEST: f64 = 180.0;
    let most_mm = 1e3 * LONGEST / frame.scale;
    let decade = powf(10.0, log10(most_mm).floor());
    let length_mm = [5.0, 2.0, 1.0].map(|n| n * decade).into_iter().find(|&l| l <= most_mm).unwrap_or(decade);
    let from = to - 1e-3 * length_mm * frame.scale;
    let _ = writeln!(
        svg,
        r##"<path d="M{from:.1} {:.1}v8H{to:.1}v-8" fill="none" stroke="{}" stroke-width="2"/><text x="{to:.1}" y="{:.1}" text-anchor="end">{length_mm} mm</text>"##,
        y - 8.0,
        Theme::Light.ink(),
        y - 16.0
    );
}

pub(super) fn ramp(svg: &mut String, top: f64, colour: &dyn Fn(usize) -> Rgb, ends: [&str; 2], title: &str) {
    let _ = writeln!(svg, r#"<text x="{MARGIN}" y="{:.1}" font-weight="600">{title}</text>"#, top + 12.0);
    for step in 0..STEPS {
        let x = MARGIN + 50.0 * step as f64;
        let colour = colour(step);
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

pub(super) fn limits(svg: &mut String, top: f64, columns: usize, plan: &Plan) {
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
        let is_broken = limit.and_then(limit::joint) == Some(Joint::Tilt);
        let dashes = if is_broken { r#" stroke-dasharray="7 5""# } else { "" };
        let (x, y) = (MARGIN + ENTRY.0 * (i % columns) as f64, top + 44.0 + ENTRY.1 * (i / columns) as f64);
        let _ = writeln!(
            svg,
            r#"<path d="M{x:.1} {:.1}h28" stroke="{}" stroke-width="6"{dashes}/><text x="{:.1}" y="{y:.1}">{name}, {:.1} %</text>"#,
            y - 6.0,
            limit::rgb(limit),
            x + 38.0,
            100.0 * share
        );
    }
}
