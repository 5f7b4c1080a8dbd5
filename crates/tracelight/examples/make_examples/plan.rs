//! `wall.dxf`: a carpenter's plan of a wall 3.6 × 2.4 m, in millimetres: its outline, the studs behind it, sockets as blocks.

use std::fmt::Write;

/// The wall, mm.
const WALL_MM: (f64, f64) = (3600.0, 2400.0);
/// Studs are 45 mm wide, their middles 600 mm apart.
const STUD_MM: f64 = 45.0;
const SPACING_MM: f64 = 600.0;
/// The door: left, right and height, mm. No stud stands in it.
const DOOR_MM: (f64, f64, f64) = (2150.0, 3050.0, 2050.0);
/// Middles of the sockets, from the wall's lower left corner, mm.
const SOCKETS_MM: [(f64, f64); 4] = [(300.0, 300.0), (1500.0, 300.0), (1500.0, 1100.0), (3300.0, 1100.0)];

/// The plan's text: ASCII DXF, `$INSUNITS` 4 (millimetres), three layers with a colour each.
pub(super) fn dxf() -> String {
    let header = "9\n$INSUNITS\n70\n4\n9\n$MEASUREMENT\n70\n1\n";
    section("HEADER", header)
        + &section("TABLES", &layers(&[("WALL", 7), ("STUDS", 3), ("SOCKETS", 1)]))
        + &section("BLOCKS", &socket())
        + &section("ENTITIES", &(wall() + &studs() + &sockets()))
        + "0\nEOF\n"
}

fn section(name: &str, inside: &str) -> String {
    format!("0\nSECTION\n2\n{name}\n{inside}0\nENDSEC\n")
}

fn layers(all: &[(&str, i16)]) -> String {
    let rows: String = all
        .iter()
        .map(|(name, colour)| format!("0\nLAYER\n2\n{name}\n70\n0\n62\n{colour}\n6\nCONTINUOUS\n"))
        .collect();
    format!("0\nTABLE\n2\nLAYER\n70\n{}\n{rows}0\nENDTAB\n", all.len())
}

fn line(layer: &str, (x1, y1): (f64, f64), (x2, y2): (f64, f64)) -> String {
    format!("0\nLINE\n8\n{layer}\n10\n{x1}\n20\n{y1}\n11\n{x2}\n21\n{y2}\n")
}

fn polyline(layer: &str, closed: bool, points: &[(f64, f64)]) -> String {
    let mut text = format!("0\nLWPOLYLINE\n8\n{layer}\n90\n{}\n70\n{}\n", points.len(), u8::from(closed));
    for (x, y) in points {
        // writing to a string cannot fail
        let _ = write!(text, "10\n{x}\n20\n{y}\n");
    }
    text
}

/// The outline, with the door cut out.
fn wall() -> String {
    let ((width, height), (left, right, top)) = (WALL_MM, DOOR_MM);
    let corners = [
        (left, 0.0),
        (0.0, 0.0),
        (0.0, height),
        (width, height),
        (width, 0.0),
        (right, 0.0),
        (right, top),
        (left, top),
    ];
    polyline("WALL", true, &corners)
}

fn studs() -> String {
    let ((width, height), (left, right, _)) = (WALL_MM, DOOR_MM);
    let count = (width / SPACING_MM) as usize;
    let middles = (1..count).map(|k| SPACING_MM * k as f64).filter(|x| !(left..=right).contains(x));
    let edges = middles.flat_map(|x| [x - STUD_MM / 2.0, x + STUD_MM / 2.0]);
    edges.map(|x| line("STUDS", (x, 0.0), (x, height))).collect()
}

/// A block: a box of 70 mm, a hole of 60 mm, a cross in its middle.
fn socket() -> String {
    let half = 35.0;
    let corners = [(-half, -half), (half, -half), (half, half), (-half, half)];
    format!(
        "0\nBLOCK\n8\n0\n2\nSOCKET\n70\n0\n10\n0\n20\n0\n{}0\nCIRCLE\n8\n0\n10\n0\n20\n0\n40\n30\n{}{}0\nENDBLK\n",
        polyline("0", true, &corners),
        line("0", (-20.0, 0.0), (20.0, 0.0)),
        line("0", (0.0, -20.0), (0.0, 20.0))
    )
}

fn sockets() -> String {
    let insert = |(x, y)| format!("0\nINSERT\n8\nSOCKETS\n2\nSOCKET\n10\n{x}\n20\n{y}\n");
    SOCKETS_MM.into_iter().map(insert).collect()
}
