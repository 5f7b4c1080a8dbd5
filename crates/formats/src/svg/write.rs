use std::f64::consts::PI;
use std::fmt::Write;

use tracelight_stroke::{Affine, Drawing, Element, Path, Piece, Point, Stroke};

use crate::number::fixed;

/// What layers need.
const INKSCAPE: &str = " xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\"";

/// Width of the line where the pen's is not known, mm.
const USUAL_PEN_MM: f64 = 0.8;

/// A drawing on the target (metres, y up, origin at the centre) as an SVG of true size: millimetres, one path a
/// stroke, in tracing order. Lines stay lines, arcs arcs, cubics cubics; coordinates to 0.1 µm.
///
/// Colours are kept, and what a stroke comes from is its title. Where a stroke has a layer, each run of strokes of one layer is a group that Inkscape shows as a
/// layer, directly below the root, where plotter programs look for layers; a layer that tracing comes back to has several groups of its name, for the order is kept above all.
pub fn write(drawing: &Drawing, width_m: f64, height_m: f64) -> String {
    let (w, h) = (1e3 * width_m, 1e3 * height_m);
    let millimetres = drawing.transformed(Affine::new([1e3, 0.0, 0.0, -1e3, 0.5 * w, 0.5 * h]));
    let (w, h) = (number(w), number(h));
    let layered = drawing.strokes.iter().any(|s| s.layer.is_some());
    let inkscape = if layered { INKSCAPE } else { "" };
    let mut svg = format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
         <svg xmlns=\"http://www.w3.org/2000/svg\"{inkscape} width=\"{w}mm\" height=\"{h}mm\" viewBox=\"0 0 {w} {h}\" \
         fill=\"none\" stroke=\"#c8102e\" stroke-linecap=\"round\" stroke-linejoin=\"round\">\n\
         <title>{} strokes, in tracing order, {w} × {h} mm</title>\n",
        drawing.strokes.len()
    );
    let mut number_of = 0;
    for (i, run) in millimetres.strokes.chunk_by(|a, b| a.layer == b.layer).enumerate() {
        let layer = run.first().and_then(|s| s.layer.as_deref());
        if let Some(name) = layer {
            open_layer(&mut svg, i + 1, name);
        }
        for stroke in run {
            number_of += 1;
            write_stroke(&mut svg, number_of, stroke);
        }
        svg.push_str(if layer.is_some() { "</g>\n" } else { "" });
    }
    svg.push_str("</svg>\n");
    svg
}

fn open_layer(svg: &mut String, number_of: usize, name: &str) {
    let name = escaped(name);
    let _ =
        writeln!(svg, "<g id=\"layer-{number_of}\" inkscape:groupmode=\"layer\" inkscape:label=\"{name}\">");
}

/// Text as it may stand in an attribute. What XML 1.0 cannot say at all becomes a space.
fn escaped(text: &str) -> String {
    let mut out = String::new();
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '"' => out.push_str("&quot;"),
            c if c.is_control() || matches!(c, '\u{FFFE}' | '\u{FFFF}') => out.push(' '),
            c => out.push(c),
        }
    }
    out
}

fn write_stroke(svg: &mut String, number_of: usize, stroke: &Stroke) {
    let pen = number(stroke.pen.unwrap_or(USUAL_PEN_MM));
    let kind = stroke.kind.name();
    let colour = stroke.colour.map_or_else(String::new, |c| format!(" stroke=\"{c}\""));
    let _ = write!(
        svg,
        "<path id=\"stroke-{number_of}\" data-kind=\"{kind}\"{colour} stroke-width=\"{pen}\" d=\"{}\"",
        path_data(&stroke.path)
    );
    let _ = match &stroke.entity {
        // a browser shows the title of what the pointer is on
        Some(entity) => {
            let entity = escaped(&entity.to_string());
            writeln!(svg, " data-entity=\"{entity}\"><title>{number_of}: {entity}</title></path>")
        }
        None => writeln!(svg, "/>"),
    };
}

fn path_data(path: &Path) -> String {
    let mut data = format!("M{}", point(path.start()));
    for piece in path.pieces() {
        match piece.element {
            Element::Line { to } => push(&mut data, 'L', &[to]),
            Element::Cubic { c1, c2, to } => push(&mut data, 'C', &[c1, c2, to]),
            Element::Arc { centre, sweep } => push_arc(&mut data, &piece, centre, sweep),
        }
    }
    if path.is_closed() {
        data.push('Z');
    }
    data
}

fn push(data: &mut String, command: char, points: &[Point]) {
    data.push(command);
    data.push_str(&points.iter().map(|&p| point(p)).collect::<Vec<_>>().join(" "));
}

/// An SVG arc names its end, not its centre: a half turn or more is cut into equal parts of less.
fn push_arc(data: &mut String, piece: &Piece, centre: Point, sweep: f64) {
    const MOST: f64 = 1000.0;
    let parts = (sweep.abs() / (0.99 * PI)).ceil().clamp(1.0, MOST) as usize;
    let radius = number(piece.from.distance(centre));
    let turn = u8::from(sweep > 0.0);
    for i in 1..=parts {
        let to = point(piece.at(i as f64 / parts as f64));
        let _ = write!(data, "A{radius} {radius} 0 0 {turn} {to}");
    }
}

fn point(p: Point) -> String {
    format!("{} {}", number(p.x), number(p.y))
}

/// Four decimals, without trailing zeros.
fn number(value: f64) -> String {
    fixed(value, 4)
}
