//! G-code for GRBL in laser mode.
//!
//! What is dark is so twice. Light is on in `G1`, `G2` and `G3` only and off in `G0`, which is what GRBL's laser mode
//! (`$32=1`) makes of `M3` and `M4`; and every dark move carries `S0` as well, so that it is dark on a machine whose
//! laser mode is off: there `G0` would burn. `S0` is what GRBL's laser documentation ("Grbl v1.1 Laser Mode") has for
//! this: unlike `M5` it is a modal change that laser mode runs through without a stop, and GRBL turns the output off
//! for it whatever `$31` says. `M5` stands at the beginning and the end, where a stop does no harm.

use std::f64::consts::PI;
use std::fmt::Write;

use tracelight_stroke::{Affine, Drawing, Element, Path, Piece, Point};

use crate::number::fixed;

/// How a drawing is lit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GcodeOptions {
    /// Speed of the lit spot, mm/min.
    pub feed_mm_min: f64,
    /// `S` word of full light: a share of the machine's `$30`, which is 1000 unless changed.
    pub power: f64,
    /// `M4`: GRBL dims the laser with the speed, so that slow corners do not burn. Else `M3`: constant.
    pub dynamic: bool,
    /// Arcs as `G2` and `G3`; else as lines.
    pub arcs: bool,
    /// Furthest that lines may be from the curve they stand for, mm.
    pub tolerance_mm: f64,
}

impl Default for GcodeOptions {
    /// 1 ft/s, full dynamic power, arcs as arcs, a hundredth of a millimetre.
    fn default() -> Self {
        Self { feed_mm_min: 18_288.0, power: 1000.0, dynamic: true, arcs: true, tolerance_mm: 0.01 }
    }
}

/// A drawing on the target (metres, y up, origin at the centre) as G-code: millimetres, absolute, y up, the origin at
/// the sheet's lower left corner, so that no coordinate of what lies on the sheet is negative; coordinates to 0.1 µm.
/// Strokes come in tracing order, each after one `G0`.
pub fn write(drawing: &Drawing, width_m: f64, height_m: f64, options: &GcodeOptions) -> String {
    let (w, h) = (1e3 * width_m, 1e3 * height_m);
    let millimetres = drawing.transformed(Affine::new([1e3, 0.0, 0.0, 1e3, 0.5 * w, 0.5 * h]));
    let light = if options.dynamic { "M4" } else { "M3" };
    let mut gcode = format!(
        "; Tracelight: {} stroke{} on {} x {} mm, origin at the lower left corner\n\
         ; for GRBL in laser mode ($32=1); S{} is full power if $30 is 1000\n\
         G21 G90 G17 G94\nM5\n{light} S0\n",
        drawing.strokes.len(),
        if drawing.strokes.len() == 1 { "" } else { "s" },
        fixed(w, 2),
        fixed(h, 2),
        fixed(options.power, 1),
    );
    for stroke in &millimetres.strokes {
        write_stroke(&mut gcode, &stroke.path, options);
    }
    gcode.push_str("M5\nG0 X0 Y0 S0\nM2\n");
    gcode
}

fn write_stroke(gcode: &mut String, path: &Path, options: &GcodeOptions) {
    let _ = writeln!(gcode, "G0 {} S0", place(path.start()));
    // the first lit move says how bright and how fast
    let mut light = format!(" F{} S{}", fixed(options.feed_mm_min, 1), fixed(options.power, 1));
    for piece in path.pieces() {
        for line in moves(&piece, options) {
            let _ = writeln!(gcode, "{line}{light}");
            light.clear();
        }
    }
}

fn moves(piece: &Piece, options: &GcodeOptions) -> Vec<String> {
    match piece.element {
        Element::Arc { centre, sweep } if options.arcs && is_safe(piece, centre) => {
            arcs(piece, centre, sweep)
        }
        _ => lines(piece, options.tolerance_mm),
    }
}

/// Whether a machine cannot take an arc's rounded numbers for another arc, or for a whole turn.
fn is_safe(piece: &Piece, centre: Point) -> bool {
    const LEAST_MM: f64 = 0.05; // five hundred times what coordinates are rounded to
    const MOST_MM: f64 = 1e5; // a radius beyond 100 m is a line to every controller
    let length = piece.length(1.0);
    length >= LEAST_MM && (LEAST_MM..=MOST_MM).contains(&piece.from.distance(centre))
}

/// In equal parts of half a turn at most: where start and end are the same, controllers disagree.
fn arcs(piece: &Piece, centre: Point, sweep: f64) -> Vec<String> {
    let parts = (sweep.abs() / (1.001 * PI)).ceil().clamp(1.0, 1e3) as usize;
    let word = if sweep > 0.0 { "G3" } else { "G2" };
    let at = |i: usize| piece.at(i as f64 / parts as f64);
    let part = |i: usize| {
        let arm = centre - at(i);
        format!("{word} {} I{} J{}", place(at(i + 1)), fixed(arm.x, 4), fixed(arm.y, 4))
    };
    (0..parts).map(part).collect()
}

fn lines(piece: &Piece, tolerance_mm: f64) -> Vec<String> {
    let mut path = Path::new(piece.from);
    path.push(piece.element);
    path.flatten(tolerance_mm).iter().skip(1).map(|&p| format!("G1 {}", place(p))).collect()
}

fn place(p: Point) -> String {
    format!("X{} Y{}", fixed(p.x, 4), fixed(p.y, 4))
}
