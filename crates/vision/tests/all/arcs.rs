//! Lines and arcs that pass into each other, drawn with a pen, come back as the lines and arcs they were.

#![allow(clippy::print_stdout, reason = "the figures are worth seeing when a bound is missed")]

use drawn::Drawn::{self, Arc, Line};
use tracelight_image::Grey;
use tracelight_stroke::{Element, Path};
use tracelight_vision::{Options, trace};

use crate::drawn::{self, kinds, kinds_drawn, kink, path};
use crate::raster::Canvas;

/// The path drawn with a pen on 640 × 480 px, and traced.
fn traced(path: &Path, pen_px: f64) -> Vec<Path> {
    let mut canvas = Canvas::new(640, 480);
    canvas.pen(&path.flatten(0.01), pen_px);
    let levels = canvas.shares().map(|s| (245.0 - 225.0 * s) as u8).collect();
    let found = trace(&Grey::new(640, 480, levels).unwrap(), &Options::default()).unwrap();
    found.strokes.strokes.into_iter().map(|s| s.path).collect()
}

/// Radii in order.
fn radii(path: &Path) -> Vec<f64> {
    let radius = |p: tracelight_stroke::Piece| match p.element {
        Element::Arc { centre, .. } => Some(p.from.distance(centre)),
        _ => None,
    };
    path.pieces().filter_map(radius).collect()
}

/// The path begun at any element, either way round, so that its kinds are these in this order; where a pen's tip is off
/// its arc, a cubic leads there, which does not count.
fn turned(path: &Path, wanted: &str) -> Option<Path> {
    let starts = if path.is_closed() { path.elements().len() } else { 1 };
    let both = [path.clone(), path.reversed()];
    let all = both.iter().flat_map(|path| (0..starts).map(|k| path.started_at(k)));
    all.into_iter().find(|path| kinds(path).trim_matches('C') == wanted)
}

fn check(name: &str, start: (f64, f64), drawn: &[Drawn], closed: bool) {
    let wanted = kinds_drawn(drawn);
    for (pen_px, degrees) in [(3.0, 0.0_f64), (3.0, 17.0), (6.0, 0.0), (6.0, -23.0)] {
        let what = format!("{name}, pen {pen_px} px, turned by {degrees}°");
        let found = traced(&path(start.into(), degrees.to_radians(), drawn, closed), pen_px);
        assert_eq!(found.len(), 1, "{what}: strokes");
        println!("{what}: {} {:.2?}", kinds(&found[0]), radii(&found[0]));
        assert!(kink(&found[0]) < 0.1, "{what}: kink of {}°", kink(&found[0]));
        let begun = turned(&found[0], &wanted);
        let begun = begun.unwrap_or_else(|| panic!("{what}: {} instead of {wanted}", kinds(&found[0])));
        let true_radii =
            drawn.iter().filter_map(|d| if let Arc(radius, _) = d { Some(radius) } else { None });
        for (found, radius) in radii(&begun).iter().zip(true_radii) {
            let off = 100.0 * (found / radius - 1.0);
            assert!(off.abs() < 1.5, "{what}: radius of {radius} off by {off:.2} %");
        }
    }
}

fn rounded(radius: f64, wide: f64, high: f64) -> Vec<Drawn> {
    [Line(wide), Arc(radius, 90.0), Line(high), Arc(radius, 90.0)].repeat(2)
}

#[test]
fn a_rounded_rectangle_is_four_lines_and_four_arcs() {
    for radius in [15.0, 40.0, 80.0] {
        check(&format!("rounded {radius}"), (180.0, 110.0), &rounded(radius, 160.0, 70.0), true);
    }
}

#[test]
fn a_stadium_is_two_lines_and_two_half_circles() {
    for radius in [20.0, 60.0] {
        check(
            &format!("stadium {radius}"),
            (220.0, 130.0),
            &[Line(180.0), Arc(radius, 180.0)].repeat(2),
            true,
        );
    }
}

#[test]
fn a_letter_u_and_hooks_are_lines_and_arcs() {
    for radius in [20.0, 60.0] {
        check(&format!("U {radius}"), (240.0, 160.0), &[Line(150.0), Arc(radius, 180.0), Line(90.0)], false);
        check(&format!("hook {radius}"), (240.0, 160.0), &[Line(150.0), Arc(radius, 140.0)], false);
        check(&format!("crook {radius}"), (240.0, 160.0), &[Arc(radius, 200.0), Line(100.0)], false);
    }
}

#[test]
fn arcs_pass_into_arcs() {
    check("S", (200.0, 160.0), &[Arc(60.0, 120.0), Arc(80.0, -110.0)], false);
    check("three-centred arch", (220.0, 90.0), &[Arc(80.0, 60.0), Arc(220.0, 45.0), Arc(80.0, 60.0)], false);
    check("road", (160.0, 160.0), &[Line(90.0), Arc(80.0, 60.0), Arc(80.0, -60.0), Line(100.0)], false);
}
