//! A placed drawing as ASCII DXF of release 2004: the oldest that has splines and true colours.

use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};
use std::fmt::{Display, Write};

use kurbo::Rect;
use tracelight_maths::tan;
use tracelight_stroke::{Affine, Colour, Drawing, Element, Path, Piece, Point, Stroke, extent};

use super::aci;
use crate::number::fixed;

/// Handle of the model's block record: the owner of every entity.
const MODEL: &str = "1F";
/// Handles from here on are the entities' and layers'; smaller ones stand in [`TABLES`] and [`BLOCKS`].
const FIRST_FREE: u32 = 0x100;

/// A drawing on the target (metres, y up, origin at the centre) as DXF of true size: millimetres, y up, the origin at
/// the sheet's lower left corner; in tracing order, coordinates to a nanometre.
///
/// Lines and arcs of a stroke are one LWPOLYLINE with bulges, a circle is a CIRCLE, a run of cubics is one SPLINE,
/// exactly. A stroke of both is a chain, each entity beginning where the one before ends. Layers and colours are kept.
pub fn write(drawing: &Drawing, width_m: f64, height_m: f64) -> String {
    let (w, h) = (1e3 * width_m, 1e3 * height_m);
    let millimetres = drawing.transformed(Affine::new([1e3, 0.0, 0.0, 1e3, 0.5 * w, 0.5 * h]));
    let mut dxf = Writer { text: String::new(), handle: FIRST_FREE };
    let layers = layers(drawing);
    dxf.tables(layers.values());
    dxf.text.push_str(BLOCKS);
    dxf.section("ENTITIES");
    for stroke in &millimetres.strokes {
        dxf.stroke(stroke, &layers);
    }
    dxf.group(0, "ENDSEC");
    dxf.text.push_str(OBJECTS);
    let bounds = extent(&millimetres).unwrap_or(Rect::new(0.0, 0.0, w, h));
    header(bounds, (w, h), dxf.handle) + &dxf.text
}

/// The name in the file of each layer but `0`. Two that differ in case only are one.
fn layers(drawing: &Drawing) -> BTreeMap<String, String> {
    let names = drawing.strokes.iter().filter_map(|s| s.layer.as_deref());
    let mut layers: BTreeMap<String, String> = BTreeMap::new();
    for name in names.filter(|n| *n != "0" && !n.is_empty()) {
        layers.entry(name.to_lowercase()).or_insert_with(|| file_name(name));
    }
    layers
}

/// A name without the characters that a layer's may not have; beyond ASCII as `\U+00E9`.
fn file_name(name: &str) -> String {
    let mut out = String::new();
    for c in name.chars() {
        match c {
            '<' | '>' | '/' | '\\' | '"' | ':' | ';' | '?' | '*' | '|' | '=' | '`' | ',' => out.push('_'),
            c if c.is_control() => out.push('_'),
            c if c.is_ascii() => out.push(c),
            c if u32::from(c) <= 0xffff => drop(write!(out, "\\U+{:04X}", u32::from(c))),
            _ => out.push('_'),
        }
    }
    out
}

struct Writer {
    text: String,
    handle: u32,
}

impl Writer {
    fn group(&mut self, code: u16, value: impl Display) {
        let _ = writeln!(self.text, "{code}\n{value}"); // writing to a String cannot fail
    }

    fn next_handle(&mut self) -> String {
        self.handle += 1;
        format!("{:X}", self.handle)
    }

    fn section(&mut self, name: &str) {
        self.group(0, "SECTION");
        self.group(2, name);
    }

    fn point(&mut self, code: u16, p: Point) {
        self.group(code, fixed(p.x, 6));
        self.group(code + 10, fixed(p.y, 6));
    }

    fn tables<'a>(&mut self, layers: impl ExactSizeIterator<Item = &'a String>) {
        self.text.push_str(TABLES);
        self.text.push_str("0\nTABLE\n2\nLAYER\n5\n2\n330\n0\n100\nAcDbSymbolTable\n");
        self.group(70, layers.len() + 1);
        self.layer("10", "0");
        for name in layers {
            let handle = self.next_handle();
            self.layer(&handle, name);
        }
        self.text.push_str("0\nENDTAB\n");
        self.text.push_str(MORE_TABLES);
    }

    fn layer(&mut self, handle: &str, name: &str) {
        let _ = write!(
            self.text,
            "0\nLAYER\n5\n{handle}\n330\n2\n100\nAcDbSymbolTableRecord\n100\nAcDbLayerTableRecord\n2\n{name}\n70\n0\n\
             62\n7\n6\nContinuous\n"
        );
    }

    fn stroke(&mut self, stroke: &Stroke, layers: &BTreeMap<String, String>) {
        let layer = stroke.layer.as_deref().and_then(|name| layers.get(&name.to_lowercase()));
        let look = (layer.map_or("0", String::as_str), stroke.colour);
        if let Some((centre, radius)) = circle(&stroke.path) {
            self.entity("CIRCLE", "AcDbCircle", look);
            self.point(10, centre);
            self.group(30, 0);
            self.group(40, fixed(radius, 6));
            return;
        }
        let pieces: Vec<Piece> = stroke.path.pieces().collect();
        let is_cubic = |p: &Piece| matches!(p.element, Element::Cubic { .. });
        for run in pieces.chunk_by(|a, b| is_cubic(a) == is_cubic(b)) {
            let is_ring = run.len() == pieces.len() && stroke.path.is_closed();
            match is_cubic(&run[0]) {
                true => self.spline(run, is_ring, look),
                false => self.polyline(run, is_ring, look),
            }
        }
    }

    fn entity(&mut self, kind: &str, class: &str, (layer, colour): (&str, Option<Colour>)) {
        let handle = self.next_handle();
        let _ = write!(self.text, "0\n{kind}\n5\n{handle}\n330\n{MODEL}\n100\nAcDbEntity\n8\n{layer}\n");
        if let Some(colour) = colour {
            let (number, is_exact) = aci::nearest(colour);
            self.group(62, number);
            if !is_exact {
                self.group(420, u32::from_be_bytes([0, colour.r, colour.g, colour.b]));
            }
        }
        self.group(100, class);
    }

    fn polyline(&mut self, run: &[Piece], is_ring: bool, look: (&str, Option<Colour>)) {
        let mut vertices: Vec<(Point, f64)> = run.iter().flat_map(vertices).collect();
        if let (false, Some(last)) = (is_ring, run.last()) {
            vertices.push((last.end(), 0.0));
        }
        self.entity("LWPOLYLINE", "AcDbPolyline", look);
        self.group(90, vertices.len());
        self.group(70, u8::from(is_ring));
        self.group(43, 0);
        for (point, bulge) in vertices {
            self.point(10, point);
            if bulge != 0.0 {
                self.group(42, bulge);
            }
        }
    }

    /// Cubics end to end: a B-spline whose inner knots are threefold.
    fn spline(&mut self, run: &[Piece], is_ring: bool, look: (&str, Option<Colour>)) {
        const PLANAR: u8 = 8;
        self.entity("SPLINE", "AcDbSpline", look);
        self.text.push_str("210\n0\n220\n0\n230\n1\n");
        self.group(70, PLANAR + u8::from(is_ring));
        self.group(71, 3);
        self.group(72, 3 * run.len() + 5);
        self.group(73, 3 * run.len() + 1);
        self.group(74, 0);
        let threefold = (0..=run.len()).flat_map(|k| [k; 3]);
        // fourfold at the ends
        let knots = std::iter::once(0).chain(threefold).chain([run.len()]);
        knots.for_each(|knot| self.group(40, knot));
        let controls = run.iter().flat_map(|p| match p.element {
            Element::Cubic { c1, c2, to } => [c1, c2, to],
            _ => [p.end(); 3],
        });
        for control in std::iter::once(run[0].from).chain(controls) {
            self.point(10, control);
            self.group(30, 0);
        }
    }
}

/// Where a piece begins and the bulges on from there; arcs in parts of half a turn at most.
fn vertices(piece: &Piece) -> Vec<(Point, f64)> {
    let Element::Arc { sweep, .. } = piece.element else { return vec![(piece.from, 0.0)] };
    let parts = (sweep.abs() / (1.001 * PI)).ceil().clamp(1.0, 1e3) as usize;
    let bulge = tan(0.25 * sweep / parts as f64);
    (0..parts).map(|i| (piece.at(i as f64 / parts as f64), bulge)).collect()
}

/// Centre and radius of a path that is one whole circle.
fn circle(path: &Path) -> Option<(Point, f64)> {
    match (path.elements(), path.is_closed()) {
        (&[Element::Arc { centre, sweep }], true) if (sweep.abs() - TAU).abs() < 1e-6 => {
            Some((centre, path.start().distance(centre)))
        }
        _ => None,
    }
}

fn header(bounds: Rect, (w, h): (f64, f64), last_handle: u32) -> String {
    let point = |x: f64, y: f64| format!("10\n{}\n20\n{}\n", fixed(x, 6), fixed(y, 6));
    format!(
        "999\nTracelight: millimetres, in tracing order\n0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\nAC1018\n\
         9\n$DWGCODEPAGE\n3\nANSI_1252\n9\n$HANDSEED\n5\n{:X}\n9\n$INSUNITS\n70\n4\n9\n$MEASUREMENT\n70\n1\n\
         9\n$EXTMIN\n{}30\n0\n9\n$EXTMAX\n{}30\n0\n9\n$LIMMIN\n{}9\n$LIMMAX\n{}0\nENDSEC\n",
        last_handle + 1,
        point(bounds.x0, bounds.y0),
        point(bounds.x1, bounds.y1),
        point(0.0, 0.0),
        point(w, h),
    )
}

/// What every reader of release 2000 or later wants to find before the layers.
const TABLES: &str = "\
0\nSECTION\n2\nCLASSES\n0\nENDSEC\n0\nSECTION\n2\nTABLES\n\
0\nTABLE\n2\nVPORT\n5\n8\n330\n0\n100\nAcDbSymbolTable\n70\n0\n0\nENDTAB\n\
0\nTABLE\n2\nLTYPE\n5\n5\n330\n0\n100\nAcDbSymbolTable\n70\n3\n\
0\nLTYPE\n5\n14\n330\n5\n100\nAcDbSymbolTableRecord\n100\nAcDbLinetypeTableRecord\n2\nByBlock\n70\n0\n3\n\n72\n65\n73\n0\n40\n0\n\
0\nLTYPE\n5\n15\n330\n5\n100\nAcDbSymbolTableRecord\n100\nAcDbLinetypeTableRecord\n2\nByLayer\n70\n0\n3\n\n72\n65\n73\n0\n40\n0\n\
0\nLTYPE\n5\n16\n330\n5\n100\nAcDbSymbolTableRecord\n100\nAcDbLinetypeTableRecord\n2\nContinuous\n70\n0\n3\nSolid line\n72\n65\n73\n0\n40\n0\n\
0\nENDTAB\n";

/// And after them.
const MORE_TABLES: &str = "\
0\nTABLE\n2\nSTYLE\n5\n3\n330\n0\n100\nAcDbSymbolTable\n70\n1\n\
0\nSTYLE\n5\n11\n330\n3\n100\nAcDbSymbolTableRecord\n100\nAcDbTextStyleTableRecord\n2\nStandard\n70\n0\n40\n0\n41\n1\n50\n0\n71\n0\n42\n2.5\n3\ntxt\n4\n\n\
0\nENDTAB\n\
0\nTABLE\n2\nVIEW\n5\n6\n330\n0\n100\nAcDbSymbolTable\n70\n0\n0\nENDTAB\n\
0\nTABLE\n2\nUCS\n5\n7\n330\n0\n100\nAcDbSymbolTable\n70\n0\n0\nENDTAB\n\
0\nTABLE\n2\nAPPID\n5\n9\n330\n0\n100\nAcDbSymbolTable\n70\n1\n\
0\nAPPID\n5\n12\n330\n9\n100\nAcDbSymbolTableRecord\n100\nAcDbRegAppTableRecord\n2\nACAD\n70\n0\n\
0\nENDTAB\n\
0\nTABLE\n2\nDIMSTYLE\n5\nA\n330\n0\n100\nAcDbSymbolTable\n70\n1\n100\nAcDbDimStyleTable\n\
0\nDIMSTYLE\n105\n27\n330\nA\n100\nAcDbSymbolTableRecord\n100\nAcDbDimStyleTableRecord\n2\nStandard\n70\n0\n\
0\nENDTAB\n\
0\nTABLE\n2\nBLOCK_RECORD\n5\n1\n330\n0\n100\nAcDbSymbolTable\n70\n2\n\
0\nBLOCK_RECORD\n5\n1F\n330\n1\n100\nAcDbSymbolTableRecord\n100\nAcDbBlockTableRecord\n2\n*Model_Space\n\
0\nBLOCK_RECORD\n5\n1B\n330\n1\n100\nAcDbSymbolTableRecord\n100\nAcDbBlockTableRecord\n2\n*Paper_Space\n\
0\nENDTAB\n0\nENDSEC\n";

/// The model's and the layout's own blocks.
const BLOCKS: &str = "\
0\nSECTION\n2\nBLOCKS\n\
0\nBLOCK\n5\n20\n330\n1F\n100\nAcDbEntity\n8\n0\n100\nAcDbBlockBegin\n2\n*Model_Space\n70\n0\n10\n0\n20\n0\n30\n0\n3\n*Model_Space\n1\n\n\
0\nENDBLK\n5\n21\n330\n1F\n100\nAcDbEntity\n8\n0\n100\nAcDbBlockEnd\n\
0\nBLOCK\n5\n1C\n330\n1B\n100\nAcDbEntity\n67\n1\n8\n0\n100\nAcDbBlockBegin\n2\n*Paper_Space\n70\n0\n10\n0\n20\n0\n30\n0\n3\n*Paper_Space\n1\n\n\
0\nENDBLK\n5\n1D\n330\n1B\n100\nAcDbEntity\n67\n1\n8\n0\n100\nAcDbBlockEnd\n\
0\nENDSEC\n";

/// The root of what is not drawn.
const OBJECTS: &str = "\
0\nSECTION\n2\nOBJECTS\n\
0\nDICTIONARY\n5\nC\n330\n0\n100\nAcDbDictionary\n281\n1\n3\nACAD_GROUP\n350\nD\n\
0\nDICTIONARY\n5\nD\n330\nC\n100\nAcDbDictionary\n281\n1\n\
0\nENDSEC\n0\nEOF\n";
