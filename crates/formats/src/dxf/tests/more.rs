use std::sync::Arc;

use super::*;
use crate::Coordinates;
use crate::options::{Hatch, ReadOptions};
use tracelight_stroke::Place;

/// Lengths of strokes, mm.
fn lengths_of(sheet: &Sheet) -> Vec<f64> {
    let mm = 1e3 * sheet.metres_per_unit.unwrap();
    sheet.drawing.strokes.iter().map(|s| s.path.length(1e-9) * mm).collect()
}

fn lengths(entities: &str) -> Vec<f64> {
    lengths_of(&sheet(entities))
}

fn check(entities: &str, wanted: &[f64]) {
    let found = lengths(entities);
    let same = found.len() == wanted.len() && found.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-3);
    assert!(same, "{entities}: {found:?}, expected {wanted:?}");
}

#[test]
fn faces_are_drawn_by_their_visible_edges() {
    // the third and fourth corner of a SOLID are crossed
    check("0 SOLID, 10 0, 20 0, 11 4, 21 0, 12 0, 22 3, 13 4, 23 3", &[14.0]);
    check("0 TRACE, 10 0, 20 0, 11 4, 21 0, 12 0, 22 3, 13 0, 23 3", &[12.0]);
    check("0 3DFACE, 10 0, 20 0, 11 4, 21 0, 12 4, 22 3, 13 0, 23 3", &[14.0]);
    check("0 3DFACE, 10 0, 20 0, 11 4, 21 0, 12 4, 22 3, 13 0, 23 3, 70 10", &[4.0, 4.0]);
    check("0 3DFACE, 10 0, 20 0, 11 4, 21 0, 12 4, 22 3", &[12.0]);
}

#[test]
fn meshes_are_drawn_by_each_edge_once() {
    let length = |entities: &str| lengths(entities).iter().sum::<f64>();
    let vertex = |(x, y): (i32, i32)| format!("0 VERTEX, 70 64, 10 {x}, 20 {y},");
    let grid: String = (0..6).map(|i| vertex((i / 3, i % 3))).collect();
    assert!((length(&format!("0 POLYLINE, 70 16, 71 2, 72 3, {grid} 0 SEQEND")) - 7.0).abs() < 1e-9);
    let corners: String =
        [(0, 0), (1, 0), (1, 1), (0, 1)].map(|p| vertex(p).replace("70 64", "70 192")).concat();
    let faces = "0 VERTEX, 70 128, 71 1, 72 2, 73 -3, 0 VERTEX, 70 128, 71 1, 72 3, 73 4, 0 SEQEND";
    let sides = length(&format!("0 POLYLINE, 70 64, {corners} {faces}"));
    assert!(
        (sides - 4.0 - 2f64.sqrt()).abs() < 1e-9,
        "the edge that is invisible in one face is seen in the other"
    );
    // two squares side by side
    let points = "92 6, 10 0, 20 0, 10 1, 20 0, 10 2, 20 0, 10 0, 20 1, 10 1, 20 1, 10 2, 20 1";
    let mesh = format!(
        "0 MESH, 91 0, {points}, 93 10, 90 4, 90 0, 90 1, 90 4, 90 3, 90 4, 90 1, 90 2, 90 5, 90 4, 94 0"
    );
    assert!((length(&mesh) - 7.0).abs() < 1e-9);
}

#[test]
fn leaders_and_multilines_are_lines() {
    check("0 LEADER, 71 1, 72 0, 76 3, 10 0, 20 0, 10 3, 20 4, 10 13, 20 4", &[15.0]);
    let multileader = "0 MULTILEADER, 300 CONTEXT_DATA{, 40 1, 10 99, 20 99, 304 words, 302 LEADER{, 290 1, 10 30, 20 0,
        11 1, 21 0, 40 5, 304 LEADER_LINE{, 10 0, 20 0, 305 }, 304 LEADER_LINE{, 10 30, 20 40, 305 }, 303 }, 301 }, 10 7";
    check(multileader, &[35.0, 40.0]);
    assert!(reading(&file(multileader)).remarks[0].contains("1 MULTILEADER text"));
    let vertex = |x: f64, y: f64, mitre: (f64, f64)| {
        format!(
            "11 {x}, 21 {y}, 12 1, 22 0, 13 {}, 23 {}, 74 2, 41 1, 41 0, 75 0, 74 2, 41 -1, 41 0, 75 0,",
            mitre.0, mitre.1
        )
    };
    let line =
        vertex(0.0, 0.0, (0.0, 1.0)) + &vertex(10.0, 0.0, (-1.0, 1.0)) + &vertex(10.0, 10.0, (-1.0, 0.0));
    check(&format!("0 MLINE, 71 1, 72 3, 73 2, {line}"), &[18.0, 22.0]);
}

#[test]
fn dimensions_are_drawn_by_their_blocks() {
    let blocks = "0 BLOCK, 2 *D1, 10 0, 20 0, 0 LINE, 10 0, 20 60, 11 100, 21 60, 0 POINT, 8 Defpoints, 10 5, 20 5, 0 ENDBLK";
    let with = |entities: &str| {
        let text = section("HEADER", "9 $INSUNITS, 70 4") + &section("BLOCKS", blocks);
        reading(&(text + &section("ENTITIES", entities) + "0\nEOF\n"))
    };
    let found = with("0 LINE, 10 0, 20 0, 11 50, 21 0, 0 DIMENSION, 2 *D1, 10 0, 20 60");
    assert_eq!(found.sheet.drawing.strokes.len(), 2);
    assert_eq!(found.sheet.height, 60.0);
    assert!(found.remarks[0].contains("points on the layer Defpoints"), "{:?}", found.remarks);
    let told = with("0 LINE, 10 0, 20 0, 11 50, 21 0, 0 DIMENSION, 10 0, 20 60, 0 DIMENSION, 2 *D7").remarks;
    assert!(told[0].contains("1 DIMENSION") && told[1].contains("does not hold; bind them"), "{told:?}");
    // those of constraints have an empty block
    let empty = blocks.to_owned() + ", 0 BLOCK, 2 *D2, 10 0, 20 0, 0 ENDBLK";
    let text = section("BLOCKS", &empty)
        + &section("ENTITIES", "0 LINE, 10 0, 20 0, 11 50, 21 0, 0 DIMENSION, 2 *D2");
    let told = reading(&(text + "0\nEOF\n")).remarks;
    assert!(told.iter().any(|told| told.contains("holds no lines; explode them (1 found)")), "{told:?}");
}

/// A square of 10 with a hole, and lines of a pattern 1 apart.
const HATCH: &str = "0 HATCH, 10 0, 20 0, 30 0, 210 0, 220 0, 230 1, 2 LINES, 70 0, 71 0, 91 2,
    92 3, 72 0, 73 1, 93 4, 10 0, 20 0, 10 10, 20 0, 10 10, 20 10, 10 0, 20 10, 97 0,
    92 0, 93 1, 72 2, 10 5, 20 5, 40 2, 50 0, 51 360, 73 1, 97 0,
    75 0, 76 1, 52 0, 41 1, 77 0, 78 1, 53 0, 43 0, 44 0.5, 45 0, 46 1, 79 0, 98 1, 10 1, 20 1";

#[test]
fn hatches_are_drawn_by_their_edges_and_their_pattern_if_asked() {
    check(HATCH, &[40.0, 4.0 * PI]);
    let options = ReadOptions { hatch: Hatch::Pattern, ..ReadOptions::default() };
    let strokes = read_with(file(HATCH).as_bytes(), &options).unwrap().sheet.drawing.strokes;
    let pattern: f64 = strokes[2..].iter().map(|s| s.path.length(1e-9)).sum();
    // ten lines, of which the circle takes the chords at ±0.5 and ±1.5
    let chords = 4.0 * ((4.0 - 0.25_f64).sqrt() + (4.0 - 2.25_f64).sqrt());
    assert!((pattern - 100.0 + chords).abs() < 0.05, "{pattern}");
    let solid = HATCH.replace("2 LINES, 70 0", "2 SOLID, 70 1");
    let strokes = read_with(file(&solid).as_bytes(), &options).unwrap().sheet.drawing.strokes;
    assert_eq!(strokes.len(), 2);
}

#[test]
fn edges_of_hatches_are_chained_whichever_way_round_they_are() {
    let edges = "72 1, 10 10, 20 0, 11 0, 21 0, 72 2, 10 10, 20 5, 40 5, 50 270, 51 90, 73 0, 72 1, 10 10, 20 10, 11 0, 21 10,
        72 4, 94 1, 73 0, 74 0, 95 4, 96 2, 40 0, 40 0, 40 1, 40 1, 10 0, 20 10, 10 0, 20 0, 97 0";
    let hatch = format!("0 HATCH, 2 SOLID, 70 1, 91 1, 92 1, 93 4, {edges}, 97 0, 75 0");
    let strokes = sheet(&hatch).drawing.strokes;
    assert_eq!(strokes.len(), 1);
    assert!(strokes[0].path.is_closed());
    assert!((strokes[0].path.length(1e-9) - 30.0 - 5.0 * PI).abs() < 1e-3);
    let ellipse = "0 HATCH, 70 1, 91 1, 92 1, 93 1, 72 3, 10 0, 20 0, 11 0, 21 10, 40 1, 50 0, 51 360, 73 0, 97 0, 75 0";
    check(ellipse, &[20.0 * PI]);
    let told = reading(&file("0 LINE, 11 9, 21 9, 0 HATCH, 70 1, 91 0, 75 0")).remarks;
    assert!(told[0].contains("1 HATCH"), "{told:?}");
}

#[test]
fn linetypes_make_dashes_by_layer_by_block_and_by_themselves() {
    let tables = section(
        "TABLES",
        "0 LTYPE, 2 Dash, 73 2, 40 3, 49 2, 49 -1, 0 LTYPE, 2 Full, 73 0, 40 0, 0 LAYER, 2 dashed, 62 1, 6 DASH,
         0 LAYER, 2 full, 62 1, 6 full",
    );
    let blocks = section("BLOCKS", "0 BLOCK, 2 b, 0 LINE, 6 ByBlock, 10 0, 20 9, 11 30, 21 9, 0 ENDBLK");
    let check = |scale: &str, entity: &str, dashes: usize, length: f64| {
        let header = section("HEADER", &format!("9 $INSUNITS, 70 4, 9 $LTSCALE, 40 {scale}"));
        let text = header + &tables + &blocks + &section("ENTITIES", entity) + "0\nEOF\n";
        let strokes = reading(&text).sheet.drawing.strokes;
        let found: f64 = strokes.iter().map(|s| s.path.length(1e-9)).sum();
        assert!(
            strokes.len() == dashes && (found - length).abs() < 1e-6,
            "{entity}: {} {found}",
            strokes.len()
        );
        let whole = read_with(text.as_bytes(), &ReadOptions { dashes: false, ..ReadOptions::default() });
        assert_eq!(whole.unwrap().sheet.drawing.strokes.len(), 1);
    };
    let line = "10 0, 20 0, 11 30, 21 0";
    check("1", &format!("0 LINE, 8 dashed, {line}"), 11, 20.0);
    check("1", &format!("0 LINE, 8 full, {line}"), 1, 30.0);
    check("1", &format!("0 LINE, 8 dashed, 6 Continuous, {line}"), 1, 30.0);
    check("1", &format!("0 LINE, 8 full, 6 dash, {line}"), 11, 20.0);
    check("2", &format!("0 LINE, 8 full, 6 dash, {line}"), 6, 20.0);
    check("2", &format!("0 LINE, 8 full, 6 dash, 48 0.5, {line}"), 11, 20.0);
    check("20", &format!("0 LINE, 8 full, 6 dash, {line}"), 1, 30.0);
    check("1", "0 INSERT, 2 b, 8 dashed", 11, 20.0);
    check("1", "0 INSERT, 2 b, 8 full, 6 dash", 11, 20.0);
    check("1", "0 INSERT, 2 b, 8 full", 1, 30.0);
}

#[test]
fn points_are_dots() {
    let strokes = sheet("0 LINE, 10 0, 20 0, 11 100, 21 0, 0 POINT, 10 50, 20 20, 0 POINT, 10 100, 20 0")
        .drawing
        .strokes;
    let lengths: Vec<f64> = strokes.iter().map(|s| s.path.length(1e-9)).collect();
    assert_eq!(strokes.len(), 3, "a point at the end of a line is no part of it");
    assert!((lengths[1] - 0.2).abs() < 1e-9 && near(strokes[1].path.start(), (49.9, 0.0)), "{strokes:?}");
}

#[test]
fn a_layout_is_drawn_where_the_model_is_empty() {
    let layout = "0 VIEWPORT, 67 1, 10 5, 20 5, 0 LINE, 67 1, 10 0, 20 0, 11 50, 21 0,
                  0 POLYLINE, 67 1, 0 VERTEX, 10 0, 20 0, 0 VERTEX, 10 0, 20 9, 0 SEQEND";
    let found = reading(&file(layout));
    assert_eq!(found.remarks, ["its model is empty: the layout (paper space) is drawn"]);
    assert_eq!(lengths_of(&found.sheet), [59.0]);
    let found = reading(&file(&format!("{layout}, 0 LINE, 10 0, 20 0, 11 7, 21 0")));
    assert_eq!(found.remarks, ["not drawn: layouts (paper space); the model is (2 found)"]);
    assert_eq!(lengths_of(&found.sheet), [7.0]);
    let blocks = section("BLOCKS", "0 BLOCK, 2 *Paper_Space0, 0 LINE, 67 1, 11 3, 21 4, 0 ENDBLK");
    let found = reading(&(blocks + &file("0 VIEWPORT, 67 1")));
    assert_eq!(lengths_of(&found.sheet), [5.0]);
}

#[test]
fn hints_are_about_what_the_model_holds() {
    let check = |entities: &str, said: &str| {
        let found = read(file(entities).as_bytes()).unwrap_err().to_string();
        assert!(found.contains(said), "{entities}: {found}");
    };
    let viewport = "0 VIEWPORT, 67 1, 10 5, 20 5";
    check(viewport, "no line, arc, polyline, ellipse or spline in its model");
    check(&format!("{viewport}, 0 3DSOLID, 1 x"), "solids or surfaces");
    check(&format!("{viewport}, 0 RTEXT, 1 x"), "explode the text");
    check("0 XLINE, 10 0, 20 0, 11 1, 21 0", "without an end");
    check("0 IMAGE, 10 0, 20 0", "pictures");
    check("0 TOLERANCE, 10 0, 20 0, 0 CAMERA, 10 0", "lines and arcs (1 CAMERA, 1 TOLERANCE found)");
    check("0 POINT, 10 5, 20 5", "no line");
    check("0 DIMENSION, 2 *D9", "blocks that it does not hold");
    check("0 LINE, 10 1, 20 1, 30 0, 11 1, 21 1, 31 9", "no length seen from above");
}

#[test]
fn all_that_is_not_drawn_is_told_by_name() {
    let remarks = reading(&file(
        "0 LINE, 11 9, 21 9, 0 RAY, 0 XLINE, 0 IMAGE, 0 WIPEOUT, 0 CAMERA, 0 TOLERANCE, 0 SHAPE, 0 OLE2FRAME, 0 REGION,
         0 ACAD_PROXY_ENTITY, 0 LIGHT, 0 LINE, 30 0, 31 9",
    ))
    .remarks
    .join("\n");
    for kind in ["RAY", "XLINE", "IMAGE", "WIPEOUT", "CAMERA", "TOLERANCE", "SHAPE", "OLE2FRAME", "REGION"] {
        assert!(remarks.contains(&format!("1 {kind}")), "{kind}: {remarks}");
    }
    assert!(
        remarks.contains("1 ACAD_PROXY_ENTITY, 1 CAMERA") && remarks.contains("seen from above"),
        "{remarks}"
    );
}

#[test]
fn an_arc_of_nearly_a_whole_turn_is_a_circle() {
    check(
        "0 ARC, 10 5, 20 5, 40 2.5, 50 270, 51 269.99999427, 0 LINE, 10 0, 20 0, 11 10, 21 0",
        &[5.0 * PI, 10.0],
    );
    // a line that ends near its end moves it, and leaves its radius
    let kept = "0 ARC, 10 0, 20 0, 40 10, 50 0, 51 359.99, 0 LINE, 10 10.00015, 20 -0.0018, 11 30, 21 0";
    assert!((lengths(kept).iter().sum::<f64>() - 20.0 * PI - 20.0).abs() < 0.01, "{:?}", lengths(kept));
}

#[test]
fn a_helix_is_drawn_by_its_spline() {
    let spline = "100 AcDbSpline, 71 3, 10 0, 20 0, 10 10, 20 0, 10 20, 20 0, 10 30, 20 0";
    check(&format!("0 HELIX, {spline}, 100 AcDbHelix, 10 99, 20 99, 11 5, 21 5, 40 7"), &[30.0]);
}

#[test]
fn a_spline_that_returns_is_closed_only_if_nothing_else_meets_it() {
    let spline = "0 SPLINE, 70 8, 71 3, 10 10, 20 0, 10 20, 20 0, 10 0, 20 10, 10 10, 20 0";
    assert!(sheet(spline).drawing.strokes[0].path.is_closed());
    let burnt = format!("0 LINE, 10 0, 20 0, 11 10, 21 0, {spline}, 0 LINE, 10 10, 20 0, 11 20, 21 -10");
    let strokes = sheet(&burnt).drawing.strokes;
    assert_eq!(strokes.len(), 1, "line, loop and line are one");
}

#[test]
fn strokes_know_the_entities_that_they_come_from() {
    let found = sheet(
        "0 LINE, 5 2F, 10 0, 20 0, 11 9, 21 0, 0 LINE, 5 30, 10 9, 20 0, 11 9, 21 9, 0 CIRCLE, 10 50, 20 50, 40 2,
         0 TEXT, 5 a1, 10 70, 20 0, 40 5, 1 L",
    );
    let named: Vec<String> =
        found.drawing.strokes.iter().map(|s| s.entity.as_ref().unwrap().to_string()).collect();
    assert_eq!(named[0], "LINE 2F and 1 more");
    assert!(named[1].starts_with("CIRCLE at line "), "{named:?}");
    assert_eq!(named[2], "TEXT A1");
    let block = "0 BLOCK, 2 b, 10 0, 20 0, 0 LINE, 5 7, 11 5, 21 5, 0 ENDBLK";
    let text = section("BLOCKS", block) + &file("0 INSERT, 5 3C, 2 b, 10 1, 20 1");
    let found = reading(&text).sheet.drawing;
    assert_eq!(found.strokes[0].entity.as_ref().unwrap().to_string(), "INSERT 3C");
}

#[test]
fn points_and_places_of_blocks_are_told() {
    // a nested block, an array, one whose layer is off, and the picture of a dimension, which is no place
    let tables = section(
        "TABLES",
        "0 TABLE, 2 LAYER, 0 LAYER, 2 off, 70 0, 62 -7, 0 LAYER, 2 cold, 70 1, 62 7, 0 ENDTAB",
    );
    let blocks = section(
        "BLOCKS",
        "0 BLOCK, 2 Lamp, 10 1, 20 1, 0 LINE, 8 0, 10 1, 20 1, 11 2, 21 1, 0 POINT, 8 0, 10 3, 20 1, 0 ENDBLK,
         0 BLOCK, 2 room, 10 0, 20 0, 0 INSERT, 8 0, 2 Lamp, 10 10, 20 0, 0 ENDBLK,
         0 BLOCK, 2 *D1, 10 0, 20 0, 0 LINE, 8 0, 10 0, 20 0, 11 9, 21 0, 0 ENDBLK",
    );
    let entities = section(
        "ENTITIES",
        "0 INSERT, 8 a, 5 2A, 2 room, 10 100, 20 100, 50 90, 0 INSERT, 8 b, 2 lamp, 10 0, 20 0, 70 2, 44 50,
         0 INSERT, 8 off, 2 lamp, 10 7, 20 7, 0 INSERT, 8 cold, 2 lamp, 10 8, 20 8,
         0 POINT, 8 b, 10 20, 20 30, 0 DIMENSION, 8 b, 2 *D1",
    );
    let sheet =
        reading(&(section("HEADER", "9 $INSUNITS, 70 4") + &tables + &blocks + &entities + "0\nEOF\n")).sheet;
    let Coordinates::File(sheet_from_file) = sheet.coordinates else { panic!("{:?}", sheet.coordinates) };
    let told = |place: &Place| {
        let at = (sheet_from_file.inverse() * place.at).to_vec2() * 1e3;
        let word = |text: &Option<Arc<str>>| text.as_deref().unwrap_or_default().to_owned();
        let [x, y] = [at.x, at.y].map(|mm| mm.round() as i64);
        format!("{} {} {} {x} {y}", place.kind.name(), word(&place.block), word(&place.layer))
    };
    let found: Vec<String> = sheet.places.iter().map(told).collect();
    let wanted = [
        "block room a 100 100",
        "block Lamp a 100 110",
        "point  a 100 112",
        "block lamp b 0 0",
        "point  b 2 0",
        "block lamp b 50 0",
        "point  b 52 0",
        "point  b 20 30",
    ];
    assert_eq!(found, wanted);
    assert_eq!(sheet.places[1].entity.as_ref().unwrap().to_string(), "INSERT 2A");
}
