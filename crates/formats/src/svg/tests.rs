use std::f64::consts::{PI, TAU};

use super::*;
use crate::{FormatError, Sheet};
use tracelight_stroke::{
    Affine, Drawing, Element, Path, Point, Stroke, StrokeKind, compare, without_doubles,
};

fn svg(attributes: &str, content: &str) -> String {
    format!(
        "<svg xmlns='http://www.w3.org/2000/svg' xmlns:xlink='http://www.w3.org/1999/xlink' {attributes}>{content}</svg>"
    )
}

fn of(content: &str) -> Sheet {
    read(svg("width='100' height='80'", content).as_bytes()).unwrap().sheet
}

fn lines(drawing: &Drawing, tolerance: f64) -> Vec<Vec<Point>> {
    drawing.strokes.iter().map(|s| s.path.flatten(tolerance)).collect()
}

fn polyline(points: &[(f64, f64)], closed: bool) -> Stroke {
    let points: Vec<Point> = points.iter().map(|&p| p.into()).collect();
    Stroke::new(Path::polyline(&points, closed).unwrap())
}

/// On the target: a square, a circle, an open line with every kind of element.
fn example() -> Drawing {
    let mut circle = Path::new(Point::new(0.1, 0.0));
    circle.push(Element::Arc { centre: Point::ORIGIN, sweep: TAU });
    circle.close();
    let mut mixed = Path::new(Point::new(-0.2, -0.1));
    mixed.push(Element::Line { to: Point::new(-0.1, -0.1) });
    mixed.push(Element::Arc { centre: Point::new(-0.1, -0.05), sweep: -1.5 * PI });
    let [c1, c2, to] = [(0.0, 0.1), (0.05, 0.0), (0.2, 0.15)].map(Point::from);
    mixed.push(Element::Cubic { c1, c2, to });
    let mut square = polyline(&[(-0.05, -0.05), (0.05, -0.05), (0.05, 0.05), (-0.05, 0.05)], true);
    square.kind = StrokeKind::Outline;
    Drawing { strokes: vec![square, Stroke::new(circle), Stroke::new(mixed)] }
}

#[test]
fn a_drawing_comes_back_in_true_size() {
    let text = write(&example(), 0.6096, 0.4572);
    assert!(text.contains("width=\"609.6mm\" height=\"457.2mm\" viewBox=\"0 0 609.6 457.2\""), "{text}");
    assert_eq!(text.matches("<path").count(), 3);
    let sheet = read(text.as_bytes()).unwrap().sheet;
    let unit = sheet.metres_per_unit.unwrap();
    assert!((sheet.width * unit - 0.6096).abs() < 1e-6, "{}", sheet.width * unit);
    let to_target = Affine::new([unit, 0.0, 0.0, -unit, -0.3048, 0.2286]);
    let back = sheet.drawing.transformed(to_target);
    let same = compare(&lines(&back, 1e-6), &example(), 1e-4).unwrap();
    assert!(same.max < 5e-5 && same.coverage == 1.0 && same.precision == 1.0, "{same:?}");
    let closed: Vec<_> = back.strokes.iter().map(|s| s.path.is_closed()).collect();
    assert_eq!(closed, [true, true, false]);
}

#[test]
fn arcs_turn_the_right_way_on_paper() {
    let mut path = Path::new(Point::new(0.1, 0.0));
    path.push(Element::Arc { centre: Point::ORIGIN, sweep: PI / 2.0 });
    let text = write(&Drawing { strokes: vec![Stroke::new(path)] }, 0.2, 0.2);
    // up on the target is up on paper, where y points down: against the clock is sweep flag 0
    assert!(text.contains("d=\"M200 100A100 100 0 0 0 100 0\""), "{text}");
}

#[test]
fn lines_stay_lines_and_curves_cubics() {
    let sheet = of(
        "<path d='M0 0 L10 0 Q20 0 20 10 C20 20 30 20 30 30' stroke='#000' fill='none' stroke-width='3'/>",
    );
    let stroke = &sheet.drawing.strokes[0];
    let [Element::Line { .. }, Element::Cubic { c1, .. }, Element::Cubic { .. }] = stroke.path.elements()
    else {
        panic!("{:?}", stroke.path);
    };
    assert!(c1.distance(Point::new(10.0 + 20.0 / 3.0, 0.0)) < 1e-5);
    assert_eq!((stroke.kind, stroke.pen), (StrokeKind::Centreline, Some(3.0)));
    assert_eq!((sheet.width, sheet.height, sheet.metres_per_unit), (100.0, 80.0, None));
}

#[test]
fn shapes_uses_styles_and_transforms_are_resolved() {
    let sheet = of("<style>.thin{stroke:red;fill:none;stroke-width:1px}</style>
        <defs><g id='cross'><path class='thin' d='M-5 0H5M0-5V5'/></g></defs>
        <use href='#cross' x='20' y='20'/><use xlink:href='#cross' transform='translate(60 40) scale(2)'/>
        <rect x='1' y='2' width='3' height='4'/><circle cx='50' cy='50' r='10' class='thin'/>
        <path d='M0 0H9' stroke='none' fill='none'/><path d='M0 0H9' class='thin' visibility='hidden'/>
        <path d='M0 0H9' class='thin' stroke-opacity='0'/>");
    let strokes = &sheet.drawing.strokes;
    assert_eq!(strokes.len(), 6);
    assert_eq!(strokes[0].path.start(), Point::new(15.0, 20.0));
    assert_eq!(strokes[3].path.end(), Point::new(60.0, 50.0));
    assert_eq!(strokes[3].pen, Some(2.0));
    assert_eq!((strokes[4].kind, strokes[4].path.is_closed()), (StrokeKind::Outline, true));
    assert!((strokes[5].path.length(1e-6) - 20.0 * PI).abs() < 0.02);
}

#[test]
fn physical_sizes_are_kept() {
    let check = |attributes: &str, width_m: Option<f64>| {
        let sheet = read(svg(attributes, "<path d='M0 0H9' stroke='red'/>").as_bytes()).unwrap().sheet;
        let found = sheet.metres_per_unit.map(|unit| sheet.width * unit);
        let same = found.zip(width_m).is_some_and(|(a, b)| (a - b).abs() < 1e-6) || found == width_m;
        assert!(same, "{attributes}: {found:?}");
    };
    check("width='24in' height='18in' viewBox='0 0 4 3'", Some(0.6096));
    check("width='610mm' height='1e2mm'", Some(0.61));
    check("width='12cm' height='9cm' viewBox='0 0 1200 900'", Some(0.12));
    check("width='72pt' height='72pt'", Some(0.0254));
    check("width='640' height='480'", None);
    check("width='640px' height='480px'", None);
    check("viewBox='0 0 640 480'", None);
    check("width='100%' height='100%' viewBox='0 0 640 480'", None);
}

#[test]
fn the_paper_behind_a_drawing_is_not_drawn() {
    let sheet =
        of("<rect width='100%' height='100%' fill='white'/><rect x='10' y='10' width='5' height='5'/>");
    assert_eq!(sheet.drawing.strokes.len(), 1);
    let framed = of("<rect width='100%' height='100%' fill='white' stroke='black'/>");
    assert_eq!(framed.drawing.strokes.len(), 1);
}

#[test]
fn a_file_that_draws_nothing_says_why() {
    let check = |content: &str, message: &str| {
        let found = read(svg("width='9' height='9'", content).as_bytes()).unwrap_err().to_string();
        assert!(found.contains(message), "{content}: {found}");
    };
    check("", "no visible path");
    check("<text x='1' y='5' fill='none'>hello</text>", "text that shows no letter");
    check("<image href='/etc/passwd' width='9' height='9'/>", "embedded picture");
    check("<path d='M5 5L5 5' stroke='red'/>", "no visible path");
}

#[test]
fn broken_files_are_refused_with_their_place() {
    let check = |bytes: &[u8], message: &str| {
        let found = read(bytes).unwrap_err().to_string();
        assert!(found.contains(message), "{found}");
    };
    check(b"", "line 1");
    check(b"not a drawing", "line 1, column 1");
    check(b"\x89PNG\r\n\x1a\n", "not UTF-8");
    check(b"\x1f\x8b\x08\x00", "packed with gzip, and broken or cut off");
    check(svg("width='9' height='9'", "<g>\n<path></g>").as_bytes(), "line 2");
    check(b"<html><body/></html>", "line 1");
    check(svg("width='0' height='9'", "<path d='M0 0H9' stroke='red'/>").as_bytes(), "size");
    check(svg("width='1e30' height='9'", "<path d='M0 0H9' stroke='red'/>").as_bytes(), "lies beyond");
    let text = write(&example(), 0.5, 0.5);
    for cut in 0..text.len() - 8 {
        assert!(read(&text.as_bytes()[..cut]).is_err(), "cut at {cut}");
    }
}

#[test]
fn coordinates_that_are_no_numbers_are_never_drawn() {
    for d in ["M0 0L1e308 1e308", "M0 0LNaN 1", "M0 0L1e39 0L5 5", "M0 0L-1e20 3"] {
        let content = format!("<path d='{d}' stroke='red'/>");
        let sound = match read(svg("width='9' height='9'", &content).as_bytes()) {
            Ok(reading) => {
                lines(&reading.sheet.drawing, 1e-3).iter().flatten().all(|p| p.to_vec2().hypot() < 1e6)
            }
            Err(_) => true,
        };
        assert!(sound, "{d}");
    }
}

#[test]
fn bombs_are_refused_before_they_go_off() {
    let refused = |text: String| match read(text.as_bytes()) {
        Err(FormatError::TooLarge { .. } | FormatError::Refused { .. } | FormatError::Syntax { .. }) => {}
        other => panic!("{:.80}: {:?}", text, other.map(|r| r.sheet.drawing.strokes.len())),
    };
    let nested = |open: &str, close: &str, n: usize| {
        svg("width='9' height='9'", &(open.repeat(n) + "<path d='M0 0H9' stroke='red'/>" + &close.repeat(n)))
    };
    refused(nested("<g>", "</g>", 2000));
    refused(nested("<g opacity='0.5'>", "</g>", 200_000));
    refused(nested("<svg>", "</svg>", 3000));
    // ten levels of ten uses each
    let level = |n: usize| format!("<g id='u{n}'>{}</g>", format!("<use href='#u{}'/>", n - 1).repeat(10));
    let levels: String = (1..11).map(level).collect();
    refused(svg("width='9' height='9'", &format!("<path id='u0' d='M0 0H9' stroke='red'/>{levels}")));
    refused(svg("width='9' height='9'", "<g id='a'><use href='#b'/></g><g id='b'><use href='#a'/></g>"));
    let [a, b] = [("a", "b"), ("b", "a")]
        .map(|(own, other)| format!("<g id='{own}'>{}</g>", format!("<use href='#{other}'/>").repeat(10)));
    refused(svg("width='9' height='9'", &(a + &b)));
    // one long path used often, and one long marker at every vertex
    let long = "h1v1".repeat(20_000);
    let uses = "<use href='#p'/>".repeat(20_000);
    refused(svg("width='9' height='9'", &format!("<path id='p' d='M0 0{long}' stroke='red'/>{uses}")));
    let marker = format!("<marker id='m'><path d='M0 0{long}'/></marker>");
    refused(svg(
        "width='9' height='9'",
        &format!("{marker}<path d='M0 0{long}' style='marker-mid:url(#m)' stroke='red'/>"),
    ));
    // chains that lead the reader into itself
    for (tag, attribute) in
        [("pattern", "fill"), ("clipPath", "clip-path"), ("mask", "mask"), ("marker", "marker-end")]
    {
        let link = |n: usize| {
            let next = n + 1;
            format!(
                "<{tag} id='c{n}' width='9' height='9'><path d='M0 0H9V9' {attribute}='url(#c{next})'/></{tag}>"
            )
        };
        let chain: String = (0..5000).map(link).collect();
        let shown = "<path d='M0 0H9V9'";
        refused(svg("width='9' height='9'", &format!("{chain}{shown} {attribute}='url(\"#c0\")'/>")));
        let styled = chain.replace(&format!("{attribute}='url"), "class='no' data-n='");
        let sheet = format!("<style>path{{{attribute}:url(#c0)}}</style>{styled}{shown}/>");
        refused(svg("width='9' height='9'", &sheet));
    }
    let laughs =
        "<!DOCTYPE svg [<!ENTITY a 'aaaaaaaaaa'><!ENTITY b '&a;&a;&a;&a;&a;&a;&a;&a;'>]><svg>&b;</svg>";
    refused(laughs.into());
    let quadratic =
        format!("<!DOCTYPE svg [<!ENTITY a '{}'>]><svg>{}</svg>", "a".repeat(100_000), "&a;".repeat(100_000));
    refused(quadratic);
    refused(" ".repeat(crate::MAX_BYTES + 1));
}

#[test]
fn what_is_just_not_too_deep_is_read() {
    let groups = "<g opacity='.99'>".repeat(60) + "<svg>".repeat(60).as_str();
    let content = groups + "<use href='#p'/>" + &"</svg>".repeat(60) + &"</g>".repeat(60);
    let sheet = of(&(content + "<defs><path id='p' d='M0 0H9' stroke='red'/></defs>"));
    assert_eq!(sheet.drawing.strokes.len(), 1);
    let link = |n: usize| format!("<g id='c{n}'><use href='#c{}'/></g>", n + 1);
    let chain: String = (0..50).map(link).collect();
    let sheet = of(&format!("<defs>{chain}<path id='c50' d='M0 0H9' stroke='red'/></defs><use href='#c0'/>"));
    assert_eq!(sheet.drawing.strokes.len(), 1);
}

#[test]
fn short_entities_of_drawing_programs_are_read() {
    let text = "<!DOCTYPE svg [<!ENTITY ns_svg \"http://www.w3.org/2000/svg\">]>\
        <svg xmlns=\"&ns_svg;\" width='9' height='9'><path d='M0 0H9' stroke='red'/></svg>";
    assert_eq!(read(text.as_bytes()).unwrap().sheet.drawing.strokes.len(), 1);
}

#[test]
fn a_long_path_is_read_quickly() {
    let content = format!("<path d='M0 0{}' stroke='red'/>", "l.1 .1l.1-.1".repeat(200_000));
    let sheet = read(svg("width='50000' height='80'", &content).as_bytes()).unwrap().sheet;
    assert_eq!(sheet.drawing.strokes[0].path.elements().len(), 400_000);
}

#[test]
fn circles_are_arcs_wherever_they_are_round() {
    let sheet = of("<g stroke='red' fill='none'><circle cx='50' cy='40' r='10'/>
        <ellipse cx='20' cy='40' rx='5' ry='10' transform='translate(20 0) scale(2 1)'/>
        <ellipse cx='20' cy='40' rx='5' ry='10'/>
        <rect x='1' y='1' width='30' height='20' rx='4'/>
        <path d='M0 0H10A5 5 0 0 1 15 5V9'/><path d='M0 0C10 0 20 0 30 10'/></g>");
    let kinds = |i: usize| -> String {
        let elements = sheet.drawing.strokes[i].path.elements();
        let kind = |e: &Element| match e {
            Element::Line { .. } => 'L',
            Element::Arc { .. } => 'A',
            Element::Cubic { .. } => 'C',
        };
        elements.iter().map(kind).collect()
    };
    assert_eq!([0, 1, 2, 3, 4, 5].map(kinds), ["A", "A", "CCCC", "LALALALA", "LAL", "C"]);
    let circle = &sheet.drawing.strokes[0].path;
    assert!(circle.is_closed() && (circle.length(1e-9) - 20.0 * PI).abs() < 1e-4);
    let corner = &sheet.drawing.strokes[4].path;
    assert!((corner.length(1e-9) - (14.0 + 2.5 * PI)).abs() < 1e-4);
}

#[test]
fn layers_and_colours_are_kept() {
    let content = "<g xmlns:i='http://www.inkscape.org/namespaces/inkscape' stroke='#0a0b0c' fill='none'>
        <g id='layer1' i:groupmode='layer' i:label='Cut &amp; go'><g id='g7'><path d='M0 0H9'/></g></g>
        <g id='plain'><path d='M0 5H9' stroke='teal'/><g id='inner'><path d='M0 6H9'/></g></g>
        <path d='M0 7H9'/><path d='M0 8H9V9Z' stroke='none' fill='#00ff00'/></g>";
    let strokes = of(content).drawing.strokes;
    let looks: Vec<_> = strokes.iter().map(|s| (s.layer.as_deref(), s.colour.unwrap().to_string())).collect();
    let looks: Vec<_> = looks.iter().map(|(layer, colour)| (*layer, colour.as_str())).collect();
    let wanted = [
        (Some("Cut & go"), "#0a0b0c"),
        (Some("plain"), "#008080"),
        (Some("inner"), "#0a0b0c"),
        (None, "#0a0b0c"),
        (None, "#00ff00"),
    ];
    assert_eq!(looks, wanted);
    let text = write(&Drawing { strokes: strokes.clone() }.transformed(Affine::scale(1e-3)), 0.1, 0.08);
    let back = read(text.as_bytes()).unwrap().sheet.drawing.strokes;
    let look = |s: &Stroke| (s.layer.clone(), s.colour);
    assert_eq!(back.iter().map(look).collect::<Vec<_>>(), strokes.iter().map(look).collect::<Vec<_>>());
}

#[test]
fn what_is_left_out_is_said() {
    let found = read(
        svg("width='9' height='9'", "<path d='M0 0H9' stroke='red'/><image width='3' height='3'/><text/>")
            .as_bytes(),
    );
    let remarks = found.unwrap().remarks;
    assert_eq!(remarks, ["not drawn: embedded pictures; trace their own files (1 found)"]);
}

#[test]
fn a_vast_arc_is_refused_before_it_swells() {
    let svg =
        |inner: &str| format!("<svg xmlns='http://www.w3.org/2000/svg' width='90' height='60'>{inner}</svg>");
    let bombs = [
        "<path stroke='red' d='M0 0A1e90 1e90 0 0 1 9 9'/>".to_owned(),
        // a radius too small for the ends is as large as they are apart
        "<path stroke='red' d='M0 0a1 1 0 0 1 1e90 9'/>".to_owned(),
        // not so many that they would not fit, but moved once for each of the others
        "<path stroke='red' d='M0 0A9 9 0 0 1 1e30 9'/>".to_owned(),
        "<circle r='3e38'/>".repeat(100),
        "<ellipse rx='1e38mm' ry='1'/>".repeat(100),
        format!("<g font-size='1e38'>{}</g>", "<circle r='1em'/>".repeat(100)),
    ];
    for bomb in bombs {
        let refused = read(svg(&bomb).as_bytes());
        assert!(matches!(refused, Err(FormatError::TooLarge { .. })), "{bomb}: {refused:?}");
    }
    let many = "<path stroke='red' fill='none' d='M0 0A9 9 0 0 1 9 9a1e5 1e5 0 0 0 1 1'/><circle r='20%'/>";
    let read = read(svg(&many.repeat(2000)).as_bytes()).unwrap();
    let (once, again) = without_doubles(read.sheet.drawing);
    assert_eq!((once.strokes.len(), again.unsearched), (1, 0), "and what is drawn again is found");
}

#[test]
fn strokes_know_their_layer_and_element_whatever_ids_there_are() {
    let layer = |id: &str, label: &str, inner: &str| {
        format!("<g inkscape:groupmode='layer' inkscape:label='{label}'{id}>\n{inner}</g>\n")
    };
    let inner = [
        layer("", "cut", "<path d='M0 0H9'/><g id='part'><circle id='hole' r='4' cx='20' cy='20'/></g>"),
        layer(" id='twin'", "fold", "<path d='M0 5H9'/>"),
        layer(" id='twin'", "score", &layer(" id='in'", "deep", "<path d='M0 10H9'/>")),
        layer("", "cut", "<use href='#hole' x='9'/><use id='copy' href='#part' x='30'/>"),
    ];
    let svg = format!(
        "<svg xmlns='http://www.w3.org/2000/svg' xmlns:inkscape='http://www.inkscape.org/namespaces/inkscape' \
         width='90' height='90' fill='none' stroke='#000'>\n{}<rect id='last' width='3' height='3' y='50'/></svg>",
        inner.concat()
    );
    let found: Vec<(String, String)> = read(svg.as_bytes())
        .unwrap()
        .sheet
        .drawing
        .strokes
        .iter()
        .map(|s| {
            (
                s.layer.as_deref().unwrap_or("-").to_owned(),
                s.entity.as_ref().map_or_else(String::new, |e| e.to_string()),
            )
        })
        .collect();
    let wanted = [
        ("cut", "path at line 3"),
        ("cut", "circle hole"),
        ("fold", "path at line 5"),
        ("deep", "path at line 8"),
        ("cut", "use at line 11"),
        ("cut", "use copy"),
        ("-", "rect last"),
    ];
    assert_eq!(found, wanted.map(|(layer, entity)| (layer.to_owned(), entity.to_owned())));
}
