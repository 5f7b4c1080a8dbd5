//! Files for machines, to the letter. Other people's readers read larger ones in `read_back.py`.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use tracelight_formats::gcode::GcodeOptions;
use tracelight_formats::{gcode, hpgl, ild};
use tracelight_stroke::{Colour, Drawing, Element, Path, Point, Stroke};

/// On a sheet of 100 × 80 mm: a line with a quarter circle in red, and a whole circle.
fn drawing() -> Drawing {
    let mut hook = Path::new(Point::new(-0.05, -0.04));
    hook.line_to(Point::new(0.0, -0.04));
    hook.push(Element::Arc { centre: Point::new(0.0, -0.03), sweep: FRAC_PI_2 });
    let mut circle = Path::new(Point::new(0.03, 0.0));
    circle.push(Element::Arc { centre: Point::new(0.02, 0.0), sweep: -TAU });
    circle.close();
    let red = Stroke { colour: Some(Colour::new(255, 0, 0)), ..Stroke::new(hook) };
    Drawing { strokes: vec![red, Stroke::new(circle)] }
}

#[test]
fn gcode_is_dark_between_strokes_and_off_at_both_ends() {
    let text = gcode::write(&drawing(), 0.1, 0.08, &GcodeOptions::default());
    let wanted = "\
; Tracelight: 2 strokes on 100 x 80 mm, origin at the lower left corner
; for GRBL in laser mode ($32=1); S1000 is full power if $30 is 1000
G21 G90 G17 G94
M5
M4 S0
G0 X0 Y0 S0
G1 X50 Y0 F18288 S1000
G3 X60 Y10 I0 J10
G0 X80 Y40 S0
G2 X60 Y40 I-10 J0 F18288 S1000
G2 X80 Y40 I10 J0
M5
G0 X0 Y0 S0
M2
";
    assert_eq!(text, wanted);
}

#[test]
fn gcode_without_arcs_stays_within_its_tolerance() {
    let options =
        GcodeOptions { arcs: false, dynamic: false, feed_mm_min: 1500.0, power: 255.5, tolerance_mm: 0.02 };
    let text = gcode::write(&drawing(), 0.1, 0.08, &options);
    assert!(text.contains("\nM3 S0\n") && text.contains(" F1500 S255.5\n"));
    assert!(!text.contains("G2 ") && !text.contains("G3 "));
    let circle = text.split("G0 X80 Y40 S0\n").nth(1).unwrap();
    let number = |word: &str| word[1..].parse::<f64>().unwrap();
    let points: Vec<Point> = circle
        .lines()
        .filter_map(|l| l.strip_prefix("G1 "))
        .map(|l| l.split(' ').collect::<Vec<_>>())
        .map(|w| Point::new(number(w[0]), number(w[1])))
        .collect();
    for pair in points.windows(2) {
        let off = 10.0 - pair[0].midpoint(pair[1]).distance(Point::new(70.0, 40.0));
        assert!((-1e-3..=0.0201).contains(&off), "{off}");
    }
}

#[test]
fn hpgl_changes_pens_with_colours_and_draws_arcs_where_they_are_exact() {
    let text = hpgl::write(&drawing(), 0.1, 0.08, 1e-4);
    let lines: Vec<&str> = text.lines().collect();
    let begin =
        ["IN;DF;", "SP1;", "PU0,0;", "PD2000,0;", "PD;AA2000,400,90,5;PD2400,400;", "SP2;", "PU3200,1600;"];
    assert_eq!(lines[..7], begin);
    assert!(lines[7].starts_with("PD3") && lines[lines.len() - 3].ends_with("3200,1600;"), "{text}");
    assert_eq!(lines[lines.len() - 2..], ["PU0,0;", "SP0;"]);
}

/// X, Y, status and colour of each point of an ILDA file's first frame.
fn points(file: &[u8]) -> Vec<(i16, i16, u8, [u8; 3])> {
    let count = usize::from(u16::from_be_bytes([file[24], file[25]]));
    let point = |p: &[u8]| {
        let short = |i: usize| i16::from_be_bytes([p[i], p[i + 1]]);
        (short(0), short(2), p[4], [p[7], p[6], p[5]])
    };
    file[32..32 + 8 * count].chunks(8).map(point).collect()
}

#[test]
fn ilda_spans_the_range_and_is_blanked_between_strokes() {
    let file = ild::write(&drawing(), 0.1, 0.08).bytes;
    assert_eq!(file[..8], *b"ILDA\0\0\0\x05");
    assert_eq!(file[28..32], [0, 1, 0, 0]);
    let points = points(&file);
    let end = &file[32 + 8 * points.len()..];
    assert_eq!((end.len(), &end[..8], &end[24..26]), (32, &b"ILDA\0\0\0\x05"[..], &[0, 0][..]));
    assert_eq!(points.iter().map(|p| p.0).min(), Some(-32767));
    assert_eq!(points.iter().map(|p| p.1).min(), Some((-32767.0 * 0.8_f64).round() as i16));
    assert!(points.iter().rev().skip(1).all(|p| p.2 & 0x80 == 0) && points[points.len() - 1].2 & 0x80 != 0);
    let lit = points.chunk_by(|a, b| a.2 & 0x40 == b.2 & 0x40).filter(|run| run[0].2 & 0x40 == 0);
    let colours: Vec<_> = lit.map(|run| run[0].3).collect();
    assert_eq!(colours, [[255, 0, 0], [255, 255, 255]]);
    // no step that mirrors cannot follow
    let step = |a: &(i16, i16, u8, [u8; 3]), b: &(i16, i16, u8, [u8; 3])| {
        (f64::from(a.0) - f64::from(b.0)).hypot(f64::from(a.1) - f64::from(b.1))
    };
    assert!(points.windows(2).all(|w| step(&w[0], &w[1]) <= 3001.0));
    // nor from the last point to the first, as a player shows the frame again and again
    let last = points[points.len() - 1];
    assert_eq!((last.0, last.1), (points[0].0, points[0].1));
}

#[test]
fn an_ilda_frame_never_has_more_points_than_its_header_can_say() {
    let zigzag: Vec<Point> = (0..40_000).map(|i| Point::new(f64::from(i % 2), f64::from(i) * 1e-5)).collect();
    let path = Path::polyline(&zigzag, false).unwrap();
    let file =
        ild::write(&Drawing { strokes: vec![Stroke::new(path.clone()), Stroke::new(path)] }, 2.0, 1.0).bytes;
    let (mut at, mut frames) = (0, 0);
    loop {
        let count = usize::from(u16::from_be_bytes([file[at + 24], file[at + 25]]));
        if count == 0 {
            at += 32;
            break;
        }
        let place = |point: usize| &file[at + 32 + 8 * point..][..4];
        assert_eq!(place(0), place(count - 1), "frame {frames} ends where it began");
        assert_eq!(place(0), &file[32..36], "frame {frames} begins where the first one does");
        at += 32 + 8 * count;
        frames += 1;
    }
    assert!(at == file.len() && frames > 20, "{frames} frames, {at} of {} bytes", file.len());
}

#[test]
fn drawings_beyond_the_sheet_and_of_nothing_are_written_too() {
    let mut far = Path::new(Point::new(-1e6, 0.0));
    far.line_to(Point::new(1e6, 0.0));
    far.push(Element::Arc { centre: Point::new(1e6, 1e-9), sweep: PI });
    for drawing in [Drawing { strokes: vec![Stroke::new(far)] }, Drawing::default()] {
        for (w, h) in [(0.1, 0.1), (0.0, 0.0)] {
            assert!(ild::write(&drawing, w, h).bytes.len() >= 32);
            assert!(gcode::write(&drawing, w, h, &GcodeOptions::default()).ends_with("M2\n"));
            assert!(hpgl::write(&drawing, w, h, 1e-5).ends_with("SP0;\n"));
            assert!(tracelight_formats::dxf::write(&drawing, w, h).ends_with("EOF\n"));
        }
    }
}
