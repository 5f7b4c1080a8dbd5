//! What a reader says of what it left out.

use std::collections::BTreeMap;

use usvg::roxmltree::{Document, Node};

use super::paint::Told;
use super::seen::{Reason, Seen};
use crate::number::length;

/// Lengths below this share of the page's diagonal are not worth a word.
const LEAST: f64 = 1e-3;

/// Elements of that name, in whatever namespace, that hold something.
fn count(xml: &Document, name: &str) -> usize {
    let holds = |n: &Node| n.descendants().any(|d| d.text().is_some_and(|t| !t.trim().is_empty()));
    xml.descendants().filter(|n| n.tag_name().name() == name && (name != "text" || holds(n))).count()
}

/// What is left out of a drawing that has strokes, of things that are no lines.
pub(super) fn things(xml: &Document, told: Told) -> Vec<String> {
    let said = |found: usize, what: &str| (found > 0).then(|| format!("{what} ({found} found)"));
    let image = said(count(xml, "image"), "not drawn: embedded pictures; trace their own files");
    let patterns = said(told.patterns, "not drawn: the lines of patterns, only the edges of what they fill");
    let filters = said(told.filters, "not applied: filters; shapes are drawn as they are without");
    let masks = said(told.masks, "not applied: masks of patterns or pictures; all that they mask is drawn");
    let dashes = said(told.undashed, "drawn as whole lines: dashed lines of too many dashes");
    let stops = said(told.stops, "not drawn: edges inside gradients whose colour changes at once");
    let linear =
        said(masks_by_linear_light(xml), "not applied: linearRGB in masks; their edges may lie elsewhere");
    let view = said(
        lengths_of_view(xml),
        "not applied: lengths in vw, vh, vmin or vmax, which have no meaning on a wall",
    );
    [image, patterns, filters, masks, dashes, stops, linear, view].into_iter().flatten().collect()
}

/// Masks that measure brightness by linear light.
fn masks_by_linear_light(xml: &Document) -> usize {
    let is_linear = |node: Node| {
        node.attribute("color-interpolation") == Some("linearRGB")
            || node
                .attribute("style")
                .is_some_and(|style| style.replace(' ', "").contains("color-interpolation:linearRGB"))
    };
    xml.descendants().filter(|n| n.tag_name().name() == "mask" && n.ancestors().any(is_linear)).count()
}

/// Elements with lengths that are shares of a window.
fn lengths_of_view(xml: &Document) -> usize {
    const PLACES: [&str; 14] =
        ["x", "y", "x1", "y1", "x2", "y2", "cx", "cy", "r", "rx", "ry", "width", "height", "stroke-width"];
    let is_one = |value: &str| {
        let number = ["vw", "vh", "vmin", "vmax"].iter().find_map(|unit| value.trim().strip_suffix(unit));
        number.is_some_and(|number| number.trim().parse::<f64>().is_ok())
    };
    let has_one = |n: &Node| n.attributes().any(|a| PLACES.contains(&a.name()) && is_one(a.value()));
    xml.descendants().filter(has_one).count()
}

/// What is left out of what is painted, a sentence for each reason, with its length.
pub(super) fn lines(
    seen: &Seen,
    hidden: &[(Reason, f64)],
    diagonal: f64,
    metres: Option<f64>,
) -> Vec<String> {
    let mut sums: BTreeMap<Reason, (usize, f64)> = BTreeMap::new();
    for &(reason, length) in hidden.iter().chain(&seen.unseen) {
        let sum = sums.entry(reason).or_default();
        *sum = (sum.0 + 1, sum.1 + length);
    }
    let told = sums.into_iter().filter(|(_, (_, sum))| *sum > LEAST * diagonal);
    let mut said: Vec<String> =
        told.map(|(reason, (count, sum))| sentence(reason, count, &length(sum, metres))).collect();
    if seen.on_black {
        said.push("all of it is as white as paper: drawn as it is seen on black".into());
    }
    if seen.unjudged > 0 {
        let lines = seen.unjudged;
        said.push(format!(
            "not looked at for what hides them: {lines} lines; too many lines cross in this drawing"
        ));
    }
    said
}

fn sentence(reason: Reason, count: usize, length: &str) -> String {
    let lines = if count == 1 { "line" } else { "lines" };
    let what = match reason {
        Reason::Paper => {
            return format!("not drawn: the paper, a white rectangle behind everything, {length}");
        }
        Reason::Invisible => "of opacity 0",
        Reason::NoArea => "round fills that have no area; --hidden keep draws them",
        Reason::OffPage => "off the page; --crop off draws them",
        Reason::Clipped => "outside clip paths; --crop off draws them",
        Reason::Masked => "hidden by masks; --crop off draws them",
        Reason::Covered => "covered by what is painted above them; --hidden keep draws them",
        Reason::OneColour => "in the colour of what lies around them; --hidden keep draws them",
        Reason::Again => "where shapes above them have an edge, which is drawn; --hidden keep draws both",
    };
    format!("not drawn: {count} {lines}, {length}, {what}")
}

/// Why a drawing has no strokes.
pub(super) fn hint(xml: &Document, hidden: &[(Reason, f64)]) -> &'static str {
    let is_cut = |reason: &Reason| matches!(reason, Reason::OffPage | Reason::Clipped | Reason::Masked);
    if count(xml, "image") > 0 {
        "the SVG holds an embedded picture, not paths: trace the picture's own file"
    } else if hidden.iter().any(|(reason, _)| is_cut(reason)) {
        "all paths of the SVG lie off its page, outside its clip paths or behind its masks: --crop off draws them"
    } else if hidden.iter().any(|(reason, _)| !matches!(reason, Reason::Invisible)) {
        "no path of the SVG can be seen: --hidden keep draws what is hidden"
    } else if count(xml, "text") > 0 {
        "the SVG holds text that shows no letter: give a font that has its letters (--font FILE)"
    } else {
        "the SVG has no visible path"
    }
}
