//! Any drawing comes back from the files it is written to.

use std::f64::consts::TAU;

use oorandom::Rand64;
use tracelight_formats::json::Traced;
use tracelight_formats::{Hidden, ReadOptions, Sheet, csv, dxf, json, svg};
use tracelight_stroke::{Affine, Colour, Drawing, Element, Path, Point, Stroke, StrokeKind};

const WIDTH_M: f64 = 0.6;
const HEIGHT_M: f64 = 0.4;

fn uniform(r: &mut Rand64, low: f64, high: f64) -> f64 {
    low + (high - low) * r.rand_float()
}

fn place(r: &mut Rand64) -> Point {
    Point::new(uniform(r, -0.5, 0.5) * WIDTH_M, uniform(r, -0.5, 0.5) * HEIGHT_M)
}

fn path(r: &mut Rand64) -> Path {
    let mut path = Path::new(place(r));
    for _ in 0..1 + r.rand_range(0..5) {
        let at = path.end();
        match r.rand_range(0..4) {
            0 | 1 => path.line_to(place(r)),
            2 => path.push(Element::Cubic { c1: place(r), c2: place(r), to: place(r) }),
            _ => {
                // no smaller than a tenth of a millimetre, and in sight
                let centre = at.lerp(place(r), uniform(r, 0.02, 0.3));
                let sweep = uniform(r, 0.1, TAU) * if r.rand_range(0..2) == 0 { 1.0 } else { -1.0 };
                path.push(Element::Arc { centre, sweep });
            }
        }
    }
    if r.rand_range(0..3) == 0 {
        path.close();
    }
    path
}

fn circle(r: &mut Rand64) -> Path {
    let centre = place(r);
    let mut path = Path::new(centre + (uniform(r, 0.001, 0.1), 0.0));
    path.push(Element::Arc { centre, sweep: TAU });
    path.close();
    path
}

fn drawing(r: &mut Rand64) -> Drawing {
    let layers = [None, Some("cut"), Some("1 & <2>"), Some("Grüße")];
    let stroke = |_| Stroke {
        kind: if r.rand_range(0..2) == 0 { StrokeKind::Outline } else { StrokeKind::Centreline },
        pen: (r.rand_range(0..2) == 0).then(|| uniform(r, 1e-4, 1e-2)),
        layer: layers[r.rand_range(0..4) as usize].map(Into::into),
        colour: (r.rand_range(0..2) == 0).then(|| Colour::from_rgb(r.rand_u64() as u32 & 0xff_ffff)),
        ..Stroke::new(if r.rand_range(0..4) == 0 { circle(r) } else { path(r) })
    };
    Drawing { strokes: (0..6).map(stroke).collect() }
}

/// Largest distance from a drawing's points to the nearest of another's lines, m.
fn furthest(from: &Drawing, to: &Drawing) -> f64 {
    const STEP_M: f64 = 1e-5;
    let flat = |d: &Drawing| d.strokes.iter().map(|s| s.path.flatten(STEP_M)).collect::<Vec<_>>();
    let lines = flat(to);
    let nearest = |p: Point| {
        let segments = lines.iter().flat_map(|l| l.windows(2));
        segments.map(|w| distance_to_segment(p, w[0], w[1])).fold(f64::INFINITY, f64::min)
    };
    // every tenth point of many tells as much
    flat(from).into_iter().flatten().step_by(10).map(nearest).fold(0.0, f64::max)
}

fn distance_to_segment(p: Point, a: Point, b: Point) -> f64 {
    let along = b - a;
    let share = ((p - a).dot(along) / along.hypot2().max(1e-300)).clamp(0.0, 1.0);
    p.distance(a + along * share)
}

fn on_target(sheet: &Sheet) -> Drawing {
    let scale = sheet.metres_per_unit.unwrap();
    let centre = Affine::translate((-0.5 * sheet.width, -0.5 * sheet.height));
    sheet.drawing.transformed(centre.then_scale_non_uniform(scale, -scale))
}

fn check_near(format: &str, number: u32, written: &Drawing, read: &Drawing, within_m: f64) {
    let (lost, added) = (furthest(written, read), furthest(read, written));
    assert!(lost <= within_m, "{format}, drawing {number}: {lost} m of it are lost");
    assert!(added <= within_m, "{format}, drawing {number}: {added} m beside it");
}

/// What is hidden or lies off the page comes back too.
fn everything() -> ReadOptions {
    ReadOptions { hidden: Hidden::Keep, crop: false, ..ReadOptions::default() }
}

#[test]
fn any_drawing_comes_back_from_svg_dxf_and_csv() {
    let mut r = Rand64::new(5);
    for number in 0..60 {
        let drawing = drawing(&mut r);
        let back = svg::read_with(svg::write(&drawing, WIDTH_M, HEIGHT_M).as_bytes(), &everything()).unwrap();
        // an arc may come back as a cubic that keeps to it within 3e-4 of its radius
        check_near("SVG", number, &drawing, &on_target(&back.sheet), 1e-4);
        assert_eq!(back.sheet.drawing.strokes.len(), drawing.strokes.len(), "SVG, drawing {number}");
        let back = dxf::read(dxf::write(&drawing, WIDTH_M, HEIGHT_M).as_bytes()).unwrap().sheet;
        // the sheet of a DXF is as large as what is drawn: compared where it lies
        let (a, b) = (drawing.length(1e-6), back.drawing.length(1e-4) * back.metres_per_unit.unwrap());
        assert!((a - b).abs() < 1e-5 * a, "DXF, drawing {number}: {a} m became {b} m");
        let back = csv::read(csv::write(&drawing, 1e-5).as_bytes()).unwrap();
        check_near("CSV", number, &drawing, &back, 2e-5);
        assert_eq!(back.strokes.len(), drawing.strokes.len(), "CSV, drawing {number}");
    }
}

#[test]
fn any_drawing_comes_back_from_json_to_the_last_bit() {
    let mut r = Rand64::new(6);
    for number in 0..500 {
        let scaled = drawing(&mut r).transformed(Affine::scale(uniform(&mut r, 1.0, 3000.0)));
        let sheet = Sheet::in_pixels(640.0, 480.0, scaled);
        let traced = Traced { sheet, mode: "auto".into() };
        let back = json::read(json::write(&traced, 1.0).as_bytes()).unwrap();
        assert_eq!(back, traced, "drawing {number}");
    }
}
