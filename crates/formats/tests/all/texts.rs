//! Text in drawings, and words as drawings.

use tracelight_formats::{Letters, ReadOptions, Reading, dxf, lettering, svg};
use tracelight_letters::Align;
use tracelight_stroke::Rect;

/// The box of what is drawn, x right, y down.
fn bounds(reading: &Reading) -> Rect {
    let strokes = &reading.sheet.drawing.strokes;
    let points = strokes.iter().flat_map(|stroke| stroke.path.flatten(1e-3));
    points.map(|p| Rect::from_points(p, p)).reduce(|a, b| a.union(b)).unwrap()
}

fn near(found: f64, expected: f64, within: f64, what: &str) {
    assert!((found - expected).abs() <= within, "{what}: {found}, expected {expected} ± {within}");
}

/// A DXF in millimetres with a frame of 100 × 50 and an entity.
fn plate(entity: &str) -> String {
    let head = "0 SECTION, 2 HEADER, 9 $ACADVER, 1 AC1015, 9 $DWGCODEPAGE, 3 ANSI_1250, 9 $INSUNITS, 70 4, 0 ENDSEC, \
                0 SECTION, 2 ENTITIES, 0 LWPOLYLINE, 70 1, 10 0, 20 0, 10 100, 20 0, 10 100, 20 50, 10 0, 20 50, ";
    let pairs = format!("{head}{entity}, 0 ENDSEC, 0 EOF");
    let lines = pairs.split(", ").map(|pair| pair.trim().split_once(' ').unwrap_or((pair, "")));
    lines.map(|(code, value)| format!("{code}\n{value}\n")).collect()
}

/// The box of the letters on a plate, y up from its lower edge, mm.
fn letters(entity: &str) -> Rect {
    let mut reading = dxf::read(plate(entity).as_bytes()).unwrap();
    assert!(reading.remarks.is_empty(), "{:?}", reading.remarks);
    let sheet_height = reading.sheet.height;
    reading.sheet.drawing.strokes.remove(0);
    let found = bounds(&reading);
    Rect::new(found.x0, sheet_height - found.y1, found.x1, sheet_height - found.y0)
}

#[test]
fn a_text_of_a_dxf_stands_where_and_as_high_as_it_says() {
    let plain = letters("0 TEXT, 10 10, 20 10, 40 8, 1 HEH");
    near(plain.y0, 10.0, 0.5, "baseline");
    near(plain.height(), 8.0, 0.3, "height of capitals");
    near(plain.x0, 11.0, 1.2, "start");
    let wide = letters("0 TEXT, 10 10, 20 10, 40 8, 41 2, 1 HEH");
    near(wide.width(), 2.0 * plain.width(), 0.1, "width factor");
    let turned = letters("0 TEXT, 10 50, 20 10, 40 8, 50 90, 1 HEH");
    near(turned.width(), plain.height(), 0.1, "a quarter of a turn");
    near(turned.y0 - 10.0, plain.x0 - 10.0, 0.1, "start of the turned line");
    let right = letters("0 TEXT, 10 0, 20 0, 11 90, 21 10, 40 8, 72 2, 1 HEH");
    near(right.x1, 90.0 - (plain.x0 - 10.0), 1.0, "end at the right");
    let middle = letters("0 TEXT, 10 0, 20 0, 11 50, 21 25, 40 8, 72 1, 73 2, 1 HEH");
    near(middle.center().x, 50.0, 0.6, "middle of the line");
    near(middle.center().y, 25.0, 0.5, "middle of the height");
    let fit = letters("0 TEXT, 10 10, 20 10, 11 90, 21 10, 40 8, 72 5, 1 HEH");
    near(fit.center().x, 50.0, 1.5, "fit between two points");
    near(fit.width(), 70.0, 9.0, "width of a fitted text, its letters' own room taken off");
    near(fit.height(), 8.0, 0.3, "height of a fitted text");
    let mirrored = letters("0 TEXT, 10 50, 20 10, 40 8, 71 2, 1 HEH");
    near(50.0 - mirrored.x1, plain.x0 - 10.0, 0.1, "backward");
}

#[test]
fn an_mtext_breaks_its_lines_and_hangs_from_its_point() {
    let top = letters("0 MTEXT, 10 10, 20 40, 40 5, 71 1, 1 HH");
    near(top.y1, 40.0, 0.3, "top");
    let two = letters("0 MTEXT, 10 10, 20 40, 40 5, 71 1, 1 HH\\PHH");
    near(two.y0, 40.0 - 5.0 - 5.0 * 5.0 / 3.0, 0.5, "second baseline");
    let wrapped = letters("0 MTEXT, 10 10, 20 40, 40 5, 41 12, 71 1, 1 HH {\\fArial|b0;HH}");
    near(wrapped.height(), two.height(), 0.01, "wrapped at its width");
    let bottom = letters("0 MTEXT, 10 90, 20 10, 40 5, 71 9, 1 HH");
    near(bottom.y0, 10.0, 0.3, "bottom");
    near(bottom.x1, 89.3, 0.7, "right");
}

#[test]
fn a_text_in_a_block_is_moved_with_it() {
    let block =
        "0 ENDSEC, 0 SECTION, 2 BLOCKS, 0 BLOCK, 2 b, 10 0, 20 0, 0 TEXT, 10 0, 20 0, 40 4, 1 H, 0 ENDBLK";
    let once = letters(&format!("0 INSERT, 2 b, 10 20, 20 10, 41 2, 42 2, {block}"));
    near(once.y0, 10.0, 0.5, "baseline");
    near(once.height(), 8.0, 0.3, "scaled height");
}

#[test]
fn a_dxf_draws_single_lines_and_outlines_where_asked() {
    let file = plate("0 TEXT, 10 10, 20 10, 40 8, 1 LI");
    let read = |letters| {
        let options = ReadOptions { letters, ..ReadOptions::default() };
        dxf::read_with(file.as_bytes(), &options).unwrap().sheet.drawing
    };
    let closed = |letters| read(letters).strokes.iter().filter(|stroke| stroke.path.is_closed()).count();
    assert_eq!(closed(None), 1, "the frame alone is closed");
    assert_eq!(closed(Some(Letters::Outline)), 3, "frame and two letters");
    assert!(read(None).length(1e-3) < read(Some(Letters::Outline)).length(1e-3));
}

#[test]
fn what_no_font_has_is_named() {
    let found = dxf::read(plate("0 TEXT, 10 10, 20 10, 40 8, 1 A\\U+4E2D\\U+0416").as_bytes()).unwrap();
    let remarks = found.remarks.join("; ");
    assert!(remarks.contains("中 (U+4E2D), which no font here has"), "{remarks}");
    assert!(remarks.contains("drawn as outlines: Ж"), "{remarks}");
    let svg = "<svg xmlns='http://www.w3.org/2000/svg' width='99' height='99'><text x='9' y='50' font-family='Arial' \
               font-weight='bold'>A中</text></svg>";
    let remarks = svg::read(svg.as_bytes()).unwrap().remarks.join("; ");
    assert!(remarks.contains("text in Arial, bold is drawn in DejaVu Sans"), "{remarks}");
    assert!(remarks.contains("中 (U+4E2D)"), "{remarks}");
}

#[test]
fn a_text_of_an_svg_is_drawn_at_its_place_both_ways() {
    let text = "<svg xmlns='http://www.w3.org/2000/svg' width='100mm' height='100mm' viewBox='0 0 100 100'>\
                <g id='signs' transform='translate(10 0)'><text x='40' y='40' font-size='20' text-anchor='middle' \
                font-family='sans-serif' fill='red'>HEH</text></g></svg>";
    let px = 96.0 / 25.4;
    for letters in [None, Some(Letters::Line)] {
        let options = ReadOptions { letters, ..ReadOptions::default() };
        let reading = svg::read_with(text.as_bytes(), &options).unwrap();
        assert!(reading.remarks.is_empty(), "{:?}", reading.remarks);
        let found = bounds(&reading);
        near(found.y1 / px, 40.0, 0.7, "baseline");
        near(found.height() / px, 13.6, 1.2, "height of capitals");
        near(found.center().x / px, 50.0, 1.0, "middle");
        let first = &reading.sheet.drawing.strokes[0];
        assert_eq!(first.layer.as_deref(), Some("signs"));
        assert_eq!(first.colour, Some(tracelight_stroke::Colour::new(255, 0, 0)));
    }
}

#[test]
fn words_have_the_height_of_their_capitals() {
    let draw = |words: &str, letters| {
        let options = ReadOptions { letters, ..ReadOptions::default() };
        lettering::draw(words, Some(0.2), Align::Centre, &options).unwrap()
    };
    for letters in [None, Some(Letters::Line)] {
        let sign = draw("HEH", letters);
        near(sign.sheet.height, 200.0, 0.5, "height, mm");
        let lines = draw("HEH\nH", letters);
        near(lines.sheet.height, 200.0 * (1.0 + 5.0 / 3.0), 0.5, "height of two lines, mm");
    }
    let empty = lettering::draw("  ", None, Align::Left, &ReadOptions::default());
    assert!(empty.unwrap_err().to_string().contains("no letter"));
}

#[test]
fn texts_without_end_are_refused_in_time() {
    let began = std::time::Instant::now();
    let svg = |content: &str| {
        format!("<svg xmlns='http://www.w3.org/2000/svg' width='9' height='9'>{content}</svg>")
    };
    let long = svg(&format!("<text>{}</text>", "W ".repeat(3_000_000)));
    assert!(svg::read(long.as_bytes()).is_err());
    let most = svg(&format!("<text>{}</text>", "Wa ".repeat(20_000)));
    let _ = svg::read(most.as_bytes());
    let many = plate(&format!("0 TEXT, 40 1, 1 {}", "W".repeat(1_000_000)));
    assert!(dxf::read(many.as_bytes()).is_err());
    // 8 s on a machine that does nothing else; without bounds it would be hours
    assert!(began.elapsed().as_secs_f64() < 60.0, "{:?}", began.elapsed());
}
