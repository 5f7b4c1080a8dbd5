use std::f64::consts::{FRAC_PI_2, PI};

use super::*;
use crate::{FormatError, Reading, Sheet};
use tracelight_stroke::{Colour, Drawing, Element, Path, Point, Stroke};

mod cut;
mod more;
mod units;

/// Groups given as `code value` pairs, separated by commas.
fn groups(pairs: &str) -> String {
    let pairs = pairs.split(',').map(str::trim).filter(|p| !p.is_empty());
    pairs
        .map(|pair| pair.split_once(' ').unwrap())
        .map(|(code, value)| format!("{code}\n{value}\n"))
        .collect()
}

fn section(name: &str, content: &str) -> String {
    groups(&format!("0 SECTION, 2 {name}, {content}, 0 ENDSEC"))
}

/// A file of millimetres with these entities.
fn file(entities: &str) -> String {
    section("HEADER", "9 $INSUNITS, 70 4") + &section("ENTITIES", entities) + "0\nEOF\n"
}

fn reading(text: &str) -> Reading {
    read(text.as_bytes()).unwrap()
}

fn sheet(entities: &str) -> Sheet {
    reading(&file(entities)).sheet
}

fn near(a: Point, b: (f64, f64)) -> bool {
    a.distance(Point::from(b)) < 1e-6
}

#[test]
fn lines_and_arcs_that_meet_are_one_closed_stroke() {
    // a slot, its pieces out of order and out of direction
    let sheet = sheet(
        "0 LINE, 8 0, 10 0, 20 0, 11 40, 21 0,
         0 ARC, 8 0, 10 0, 20 10, 40 10, 50 90, 51 270,
         0 LINE, 8 0, 10 0, 20 20, 11 40, 21 20.00001,
         0 ARC, 8 0, 10 40, 20 10, 40 10, 50 270, 51 90,
         0 LINE, 8 other, 10 0, 20 0, 11 -10, 21 30",
    );
    assert_eq!(sheet.drawing.strokes.len(), 2);
    let slot = &sheet.drawing.strokes[0].path;
    assert!(slot.is_closed());
    assert_eq!(slot.elements().len(), 4);
    assert!((slot.length(1e-9) - (80.0 + 20.0 * PI)).abs() < 1e-4, "{}", slot.length(1e-9));
    assert_eq!(sheet.drawing.strokes[1].layer.as_deref(), Some("other"));
    assert!((sheet.width - 60.0).abs() < 1e-4 && (sheet.height - 30.0).abs() < 1e-4, "{sheet:?}");
    assert_eq!(sheet.metres_per_unit, Some(1e-3));
}

#[test]
fn a_crossing_keeps_its_two_lines() {
    let arms = [(-10, 0), (0, 10), (10, 0), (0, -10)];
    let arms: String = arms.map(|(x, y)| format!("0 LINE, 10 0, 20 0, 11 {x}, 21 {y},")).concat();
    let strokes = sheet(&arms).drawing.strokes;
    assert_eq!(strokes.len(), 2);
    assert!(
        strokes.iter().all(|s| (s.path.length(1e-9) - 20.0).abs() < 1e-9 && s.path.elements().len() == 2)
    );
}

#[test]
fn a_line_drawn_twice_does_not_turn_back_on_itself() {
    let twice = "0 LINE, 10 0, 20 0, 11 10, 21 0, 0 LINE, 10 0, 20 0, 11 10, 21 0";
    let strokes = sheet(twice).drawing.strokes;
    assert_eq!(strokes.len(), 2);
    assert!(strokes.iter().all(|s| !s.path.is_closed()));
}

#[test]
fn ends_at_the_very_same_point_belong_together() {
    // a third line ends a micrometre beside a corner
    let corner = "0 LINE, 10 0, 20 0, 11 100, 21 0, 0 LINE, 10 100, 20 0, 11 100, 21 100,
                  0 LINE, 10 100.001, 20 0, 11 150, 21 -80";
    let strokes = sheet(corner).drawing.strokes;
    let lengths: Vec<f64> = strokes.iter().map(|s| s.path.length(1e-9).round()).collect();
    assert_eq!(lengths, [200.0, 94.0]);
}

#[test]
fn bulges_are_arcs() {
    let path = sheet("0 LWPOLYLINE, 90 3, 70 1, 10 0, 20 0, 42 1, 10 10, 20 0, 10 10, 20 20").drawing.strokes;
    let path = &path[0].path;
    assert!(matches!(path.elements()[0], Element::Arc { sweep, .. } if (sweep.abs() - PI).abs() < 1e-12));
    assert!((path.length(1e-9) - (5.0 * PI + 20.0 + 500f64.sqrt())).abs() < 1e-9);
    let old = "0 POLYLINE, 66 1, 70 1, 0 VERTEX, 10 0, 20 0, 42 1, 0 VERTEX, 10 10, 20 0, 0 VERTEX, 70 16, 10 99, 20 99,
               0 VERTEX, 10 10, 20 20, 0 SEQEND";
    assert_eq!(&sheet(old).drawing.strokes[0].path, path);
}

#[test]
fn circles_and_round_ellipses_stay_round() {
    let strokes = sheet(
        "0 CIRCLE, 10 5, 20 5, 40 5,
         0 ELLIPSE, 10 50, 20 5, 11 0, 21 5, 40 1, 41 0, 42 6.283185307179586,
         0 ELLIPSE, 10 100, 20 5, 11 10, 21 0, 40 0.5, 41 0, 42 3.141592653589793",
    )
    .drawing
    .strokes;
    for stroke in &strokes[..2] {
        assert!(stroke.path.is_closed() && matches!(stroke.path.elements(), [Element::Arc { .. }]));
        assert!((stroke.path.length(1e-9) - 10.0 * PI).abs() < 1e-9);
    }
    // half the circumference of an ellipse of 10 and 5, by its elliptic integral
    assert!((strokes[2].path.length(1e-9) - 24.221_120_55).abs() < 1e-3);
    assert!(strokes[2].path.pieces().all(|p| p.at(0.5).y <= strokes[2].path.start().y + 1e-9), "upper half");
}

#[test]
fn splines_of_every_kind_are_read() {
    // a quarter circle as a rational quadratic
    let quarter =
        "0 SPLINE, 70 4, 71 2, 40 0, 40 0, 40 0, 40 1, 40 1, 40 1, 41 1, 41 0.7071067811865476, 41 1,
                   10 10, 20 0, 10 10, 20 10, 10 0, 20 10";
    let path = sheet(quarter).drawing.strokes[0].path.clone();
    assert!((path.length(1e-9) - 5.0 * PI).abs() < 1e-3);
    // one cubic Bézier, exactly
    let cubic = "0 SPLINE, 71 3, 40 0, 40 0, 40 0, 40 0, 40 1, 40 1, 40 1, 40 1, 10 0, 20 0, 10 0, 20 10, 10 10, 20 10,
                 10 10, 20 0";
    let path = sheet(cubic).drawing.strokes[0].path.clone();
    assert!(matches!(path.elements(), [Element::Cubic { .. }]));
    // two spans that a knot joins smoothly; no knots at all means even ones
    let two = "0 SPLINE, 71 3, 10 0, 20 0, 10 0, 20 10, 10 10, 20 10, 10 20, 20 10, 10 20, 20 0";
    let path = sheet(two).drawing.strokes[0].path.clone();
    let pieces: Vec<_> = path.pieces().collect();
    assert_eq!(pieces.len(), 2);
    assert!((pieces[0].end_tangent() - pieces[1].start_tangent()).hypot() < 1e-9);
    // of degree five
    let high =
        "0 SPLINE, 71 5, 10 0, 20 0, 10 0, 20 10, 10 10, 20 10, 10 20, 20 10, 10 20, 20 0, 10 30, 20 0";
    assert!(sheet(high).drawing.strokes[0].path.length(1e-6) > 30.0);
    // points only, on a circle
    let on_circle = |i: u32| {
        let (sin, cos) = (f64::from(i) * PI / 6.0).sin_cos();
        format!(", 11 {}, 21 {}", 10.0 * cos, 10.0 * sin)
    };
    let closed: String = (0..12).map(on_circle).collect();
    let path = sheet(&format!("0 SPLINE, 70 1, 71 3, 74 12{closed}")).drawing.strokes[0].path.clone();
    assert!(path.is_closed() && (path.length(1e-9) - 20.0 * PI).abs() < 0.02, "{}", path.length(1e-9));
    let open: String = (0..7).map(on_circle).collect();
    let tangents = "12 0, 22 1, 13 0, 23 -1";
    let path = sheet(&format!("0 SPLINE, 71 3, {tangents} {open}")).drawing.strokes[0].path.clone();
    assert!((path.length(1e-9) - 10.0 * PI).abs() < 0.01, "{}", path.length(1e-9));
}

#[test]
fn blocks_are_unfolded_scaled_turned_and_repeated() {
    let blocks = section(
        "BLOCKS",
        "0 BLOCK, 2 tick, 10 1, 20 0, 0 LINE, 8 0, 62 0, 10 1, 20 0, 11 2, 21 0, 0 ENDBLK,
         0 BLOCK, 2 Pair, 10 0, 20 0, 0 INSERT, 8 0, 62 0, 2 TICK, 10 0, 20 0, 70 2, 44 10, 0 ENDBLK",
    );
    let entities = section("ENTITIES", "0 INSERT, 8 marks, 62 1, 2 pair, 10 100, 20 100, 41 2, 42 2, 50 90");
    let sheet = reading(&(section("HEADER", "9 $INSUNITS, 70 4") + &entities + &blocks + "0\nEOF\n")).sheet;
    let strokes = &sheet.drawing.strokes;
    assert_eq!(strokes.len(), 2);
    assert!((sheet.height - 22.0).abs() < 1e-9, "{sheet:?}");
    assert!(near(strokes[0].path.end(), (strokes[0].path.start().x, strokes[0].path.start().y - 2.0)));
    assert_eq!(strokes[1].layer.as_deref(), Some("marks"));
    assert_eq!(strokes[1].colour, Some(Colour::new(255, 0, 0)));
}

#[test]
fn a_mirrored_plane_mirrors() {
    let strokes = sheet(
        "0 ARC, 10 0, 20 0, 40 10, 50 0, 51 90, 230 -1,
         0 LINE, 8 axes, 10 0, 20 0, 11 0, 21 -5",
    )
    .drawing
    .strokes;
    // in the plane that looks down, x goes left: the arc lies from (-10, 0) to (0, 10)
    let (start, end) = (strokes[0].path.start(), strokes[0].path.end());
    assert!(near(start, (0.0, 10.0)) && near(end, (10.0, 0.0)), "{start:?} {end:?}");
    assert!(
        matches!(strokes[0].path.elements(), [Element::Arc { sweep, .. }] if (sweep.abs() - FRAC_PI_2).abs() < 1e-9)
    );
}

#[test]
fn layers_give_colours_and_hide() {
    let tables = section(
        "TABLES",
        "0 TABLE, 2 LAYER, 0 LAYER, 2 Red, 62 1, 70 0, 0 LAYER, 2 Off, 62 -3, 70 0, 0 LAYER, 2 Ice, 62 3, 70 1,
         0 LAYER, 2 True, 62 1, 420 1193046, 0 ENDTAB",
    );
    let line = |layer: &str, more: &str| format!("0 LINE, 8 {layer}, {more} 10 0, 20 0, 11 10, 21 10,");
    let entities = [
        line("RED", ""),
        line("off", ""),
        line("ice", ""),
        line("true", ""),
        line("red", "420 255,"),
        line("red", "60 1,"),
        line("red", "67 1,"),
        "0 ATTDEF, 8 0, 1 hello, 0 ATTDEF, 8 0, 1 again, 0 HATCH, 8 0, 0 INSERT, 2 nowhere".into(),
    ];
    let found = reading(&(tables + &section("ENTITIES", &entities.concat()) + "0\nEOF\n"));
    let looks: Vec<_> = found
        .sheet
        .drawing
        .strokes
        .iter()
        .map(|s| (s.layer.as_deref().unwrap(), s.colour.unwrap()))
        .collect();
    let rgb = Colour::from_rgb;
    assert_eq!(looks, [("Red", rgb(0xff0000)), ("True", rgb(0x123456)), ("Red", rgb(0x0000ff))]);
    assert_eq!(found.sheet.metres_per_unit, Some(1e-3));
    let remarks = found.remarks.join("; ");
    for said in [
        "2 ATTDEF, 1 HATCH",
        "is off or frozen (3 found)",
        "the model is (1 found)",
        "bind them to it (1 found)",
    ] {
        assert!(remarks.contains(said), "{said}: {remarks}");
    }
}

#[test]
fn a_drawing_comes_back_from_dxf() {
    let mut mixed = Path::new(Point::new(-0.1, -0.05));
    mixed.line_to(Point::new(0.0, -0.05));
    mixed.push(Element::Arc { centre: Point::new(0.0, 0.0), sweep: 4.5 });
    let end = mixed.end();
    mixed.push(Element::Cubic {
        c1: Point::new(end.x - 0.02, end.y),
        c2: Point::new(-0.1, 0.08),
        to: Point::new(-0.09, 0.03),
    });
    let mut circle = Path::new(Point::new(0.03, 0.02));
    circle.push(Element::Arc { centre: Point::new(0.02, 0.02), sweep: -2.0 * PI });
    circle.close();
    let triangle = [(0.05, -0.02), (0.08, -0.02), (0.06, 0.01)].map(Point::from);
    let look = |path, layer: &str, rgb| Stroke {
        layer: Some(layer.into()),
        colour: Some(Colour::from_rgb(rgb)),
        ..Stroke::new(path)
    };
    let triangle = Path::polyline(&triangle, true).unwrap();
    let strokes =
        vec![look(mixed, "Größe: 1", 0x123456), look(circle, "cut", 0xff0000), look(triangle, "cut", 0)];
    let drawing = Drawing { strokes };
    let found = reading(&write(&drawing, 0.3, 0.2));
    assert_eq!(found.remarks, Vec::<String>::new());
    let back = &found.sheet.drawing.strokes;
    assert_eq!(back.len(), 3);
    for (own, back) in drawing.strokes.iter().zip(back) {
        let (length, wanted) = (back.path.length(1e-9), 1e3 * own.path.length(1e-12));
        assert!((length - wanted).abs() < 1e-5, "{length} {wanted}");
        assert_eq!((back.colour, back.path.is_closed()), (own.colour, own.path.is_closed()));
    }
    assert_eq!(back[0].layer.as_deref(), Some("Größe_ 1"));
    assert_eq!(back[0].path.elements().len(), 4, "an arc of more than half a turn is two");
}

#[test]
fn what_is_no_dxf_is_refused_with_what_to_do() {
    let check = |bytes: &[u8], message: &str| {
        let found = read(bytes).unwrap_err().to_string();
        assert!(found.contains(message), "{message}: {found}");
    };
    check(b"AutoCAD Binary DXF\r\n\x1a\x00", "byte 22 of a binary file: the file is cut off");
    check(b"AC1032\x00\x00", "DWG is not read: save it as ASCII");
    check(file("").as_bytes(), "nothing to draw: the DXF has no line");
    check(file("0 ATTDEF, 1 hello").as_bytes(), "explode the text");
    check(file("0 LINE, 10 1, 20 1, 11 1, 21 1").as_bytes(), "nothing to draw");
    check(file("0 LINE, 10 1, 20 1, 11 nan, 21 1").as_bytes(), "line 22: an x coordinate is \"nan\"");
    check(
        file("0 SPLINE, 71 3, 10 0, 20 0, 10 1, 20 1").as_bytes(),
        "SPLINE at line 16: the degree is 3 with 2",
    );
    check(file("0 SPLINE, 71 1, 40 0, 10 0, 20 0, 10 1, 20 1").as_bytes(), "the list of knots is 1 for 2");
}

#[test]
fn blocks_that_hold_themselves_or_too_much_are_refused() {
    let refused = |blocks: &str, entities: &str| {
        let text = section("BLOCKS", blocks) + &section("ENTITIES", entities) + "0\nEOF\n";
        match read(text.as_bytes()) {
            Err(FormatError::TooLarge { .. }) => {}
            other => panic!("{other:?}"),
        }
    };
    refused("0 BLOCK, 2 a, 0 INSERT, 2 b, 0 ENDBLK, 0 BLOCK, 2 b, 0 INSERT, 2 a, 0 ENDBLK", "0 INSERT, 2 a");
    let level = |i: usize| {
        format!("0 BLOCK, 2 b{}, {} 0 ENDBLK,", i + 1, format!("0 INSERT, 2 b{i}, 10 {i}, 20 1,").repeat(10))
    };
    let levels: String = (0..12).map(level).collect();
    refused(&format!("0 BLOCK, 2 b0, 0 LINE, 11 1, 21 1, 0 ENDBLK, {levels}"), "0 INSERT, 2 b12");
    refused(&format!("0 BLOCK, 2 b0, 0 ENDBLK, {levels}"), "0 INSERT, 2 b12");
    refused("0 BLOCK, 2 a, 0 TEXT, 0 ENDBLK", "0 INSERT, 2 a, 70 32767, 71 32767");
}

#[test]
fn a_large_drawing_is_read_quickly() {
    // ten megabytes of an outline in pieces, and a star of lines that all meet
    let mut entities = String::new();
    for i in 0..60_000 {
        let at = |i: u32| (f64::from(i) * 0.01, (f64::from(i) * 0.1).sin());
        let ((x, y), (u, v)) = (at(i), at(i + 1));
        let look = "100\nAcDbEntity\n8\nOutline\n100\nAcDbLine\n";
        entities += &format!(
            "0\nLINE\n5\n{i:X}\n{look}10\n{x:.9}\n20\n{y:.9}\n30\n0.0\n11\n{u:.9}\n21\n{v:.9}\n31\n0.0\n"
        );
    }
    for i in 0..20_000 {
        let (y, x) = (f64::from(i) * 0.001).sin_cos();
        entities += &format!("0\nLINE\n8\nstar\n10\n0\n20\n0\n11\n{x:.9}\n21\n{y:.9}\n");
    }
    let text = groups("0 SECTION, 2 ENTITIES") + &entities + "0\nENDSEC\n0\nEOF\n";
    let began = std::time::Instant::now();
    let strokes = reading(&text).sheet.drawing.strokes;
    assert_eq!(strokes.len(), 20_001);
    assert_eq!(strokes[0].path.elements().len(), 60_000);
    // measured: 0.1 s for 10 MB; ten times that on a busy machine
    assert!(began.elapsed().as_secs_f64() < 2.0, "{:?} for {} bytes", began.elapsed(), text.len());
}
