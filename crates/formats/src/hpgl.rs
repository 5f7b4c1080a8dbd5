//! HPGL, for pen plotters and cutters: HP-GL as the HP 7475A reads it (*Interfacing and Programming Manual*, 1983),
//! which every later one does.

use std::f64::consts::TAU;
use std::fmt::Write;

use tracelight_maths::acos;
use tracelight_stroke::{Affine, Colour, Drawing, Element, Path, Piece, Point};

/// Plotter units in a metre: one is 0.025 mm.
const UNITS_PER_M: f64 = 40_000.0;

/// Pens in a carousel.
const PENS: usize = 8;

/// Coordinates after one `PD`: buffers hold 512 bytes and more.
const POINTS_A_LINE: usize = 32;

/// A drawing on the target (metres, y up, origin at the centre) as HPGL: y up, the origin at the sheet's lower left
/// corner, in tracing order. Curves are lines within `tolerance_m`; arcs are `AA` where whole plotter units leave them
/// within it (or one unit, if that is more). Each colour has a pen, in order of appearance, from 1; the ninth is the
/// first again.
pub fn write(drawing: &Drawing, width_m: f64, height_m: f64, tolerance_m: f64) -> String {
    let units = Affine::translate((0.5 * width_m, 0.5 * height_m)).then_scale(UNITS_PER_M);
    let tolerance = (UNITS_PER_M * tolerance_m).max(0.05);
    let mut pens: Vec<Option<Colour>> = Vec::new();
    let mut taken = None;
    // readers know HPGL by how it begins, some only with the defaults asked for as well
    let mut hpgl = String::from("IN;DF;\n");
    for stroke in &drawing.transformed(units).strokes {
        let known = pens.iter().position(|&c| c == stroke.colour);
        let pen = known.unwrap_or_else(|| {
            pens.push(stroke.colour);
            pens.len() - 1
        });
        if taken.replace(pen % PENS) != Some(pen % PENS) {
            let _ = writeln!(hpgl, "SP{};", pen % PENS + 1);
        }
        write_stroke(&mut hpgl, &stroke.path, tolerance);
    }
    hpgl.push_str("PU0,0;\nSP0;\n");
    hpgl
}

fn write_stroke(hpgl: &mut String, path: &Path, tolerance: f64) {
    let _ = writeln!(hpgl, "PU{};", place(path.start()));
    let mut line: Vec<String> = Vec::new();
    for piece in path.pieces() {
        match arc(&piece, tolerance) {
            Some(arc) => {
                flush(hpgl, &mut line);
                let _ = writeln!(hpgl, "PD;{arc}");
            }
            None => line.extend(points(&piece, tolerance).map(place)),
        }
    }
    flush(hpgl, &mut line);
}

fn flush(hpgl: &mut String, line: &mut Vec<String>) {
    for points in line.chunks(POINTS_A_LINE) {
        let _ = writeln!(hpgl, "PD{};", points.join(","));
    }
    line.clear();
}

/// `AA x,y,sweep,chord;` and the way on to the arc's own end, if the centre's rounding is harmless. A plotter draws
/// chords, of 5° unless told: the angle is chosen for the tolerance.
fn arc(piece: &Piece, tolerance: f64) -> Option<String> {
    let Element::Arc { centre, sweep } = piece.element else { return None };
    let (from, rounded) = (piece.from.round(), centre.round());
    let radius = from.distance(rounded);
    let drawn = Piece { from, element: Element::Arc { centre: rounded, sweep } };
    let off = [0.5, 1.0].map(|t| drawn.at(t).distance(piece.at(t)));
    let chord_degrees = (2.0 * acos(1.0 - (0.7 * tolerance / radius).min(1.0))).to_degrees().min(5.0).floor();
    // whole degrees only, for the oldest plotters; and less than a whole turn, which some take for none. A plotter makes
    // the chords even and may round their number down: there should be several
    let is_exact =
        off.iter().all(|&d| d <= tolerance.max(1.0)) && chord_degrees >= 1.0 && sweep.abs() <= TAU - 1e-3;
    let is_long = sweep.abs().to_degrees() >= 3.0 * chord_degrees;
    (is_exact && is_long).then(|| {
        let [x, y] = [rounded.x, rounded.y].map(|v| v as i64);
        let degrees = crate::number::fixed(sweep.to_degrees(), 3);
        format!("AA{x},{y},{degrees},{chord_degrees};PD{};", place(piece.end()))
    })
}

fn points(piece: &Piece, tolerance: f64) -> impl Iterator<Item = Point> + use<> {
    let mut path = Path::new(piece.from);
    path.push(piece.element);
    path.flatten(tolerance).into_iter().skip(1)
}

fn place(p: Point) -> String {
    format!("{},{}", p.x.round() as i64, p.y.round() as i64)
}
