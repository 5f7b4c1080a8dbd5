//! An SVG is drawn as it is seen, and what is left out is said with its length.

use tracelight_formats::{Hidden, ReadOptions, Reading, svg};
use tracelight_stroke::Element;

fn read(content: &str, options: &ReadOptions) -> Reading {
    let text = format!(
        "<svg xmlns='http://www.w3.org/2000/svg' width='100mm' height='100mm' viewBox='0 0 100 100'>{content}</svg>"
    );
    svg::read_with(text.as_bytes(), options).unwrap()
}

fn length_mm(reading: &Reading) -> f64 {
    1e3 * reading.sheet.metres_per_unit.unwrap() * reading.sheet.drawing.length(1e-6)
}

/// Strokes and length that are drawn, and words that one of the remarks holds; no remark where there are no words.
#[track_caller]
fn check(content: &str, strokes: usize, wanted_mm: f64, words: &str) {
    let found = read(content, &ReadOptions::default());
    let (drawn, long) = (found.sheet.drawing.strokes.len(), length_mm(&found));
    assert!(drawn == strokes && (long - wanted_mm).abs() < 0.1, "{drawn} strokes, {long} mm: {content}");
    let is_said = found.remarks.iter().any(|remark| remark.contains(words));
    assert!(is_said != words.is_empty(), "{:?}: {content}", found.remarks);
}

const PLATE: &str = "<path d='M30 30H70V70H30z' fill='#fff' stroke='#000' stroke-width='2'/>";

#[test]
fn what_is_painted_above_hides_what_is_below() {
    let line = "<path d='M0 50H100' stroke='#f00'/>";
    // the plate's own band hides a millimetre more on each side
    check(&format!("{line}{PLATE}"), 3, 58.0 + 160.0, "covered by what is painted above");
    check(&format!("{PLATE}{line}"), 3, 258.0, "covered by what is painted above");
    let glass = PLATE.replace("fill='#fff'", "fill='#fff' fill-opacity='.5'");
    check(&format!("{line}{glass}"), 4, 256.0, "covered");
    let group = format!("<g opacity='.5'>{line}{PLATE}</g>");
    check(&group, 3, 218.0, "covered");
}

#[test]
fn lines_of_one_colour_and_width_do_not_cut_each_other() {
    check("<g stroke='#000'><path d='M10 50H90'/><path d='M50 10V90'/></g>", 2, 160.0, "");
    check(
        "<rect x='1' y='1' width='9' height='9'/><g stroke='#000'><path d='M10 50H90'/><path d='M50 10V90'/></g>",
        3,
        196.0,
        "",
    );
}

#[test]
fn seams_and_white_on_white_are_not_drawn() {
    let bars = "<rect x='10' y='40' width='40' height='20'/><rect x='50' y='40' width='40' height='20'/>";
    check(bars, 2, 200.0, "in the colour of what lies around");
    check(&format!("<circle cx='50' cy='50' r='9' fill='#fff'/>{bars}"), 2, 200.0, "covered");
    check("<path d='M10 10H90' stroke='#fff'/><path d='M10 50H90' stroke='#00f'/>", 1, 80.0, "in the colour");
    check("<path d='M10 10H90' stroke='#fff'/>", 1, 80.0, "on black");
}

#[test]
fn an_edge_of_two_fills_is_drawn_once() {
    let two = "<rect x='10' y='40' width='40' height='20' fill='red'/><rect x='50' y='40' width='40' height='20' fill='blue'/>";
    check(two, 2, 220.0, "where shapes above them have an edge");
}

#[test]
fn clip_paths_and_masks_keep_a_region_and_arcs_stay_arcs() {
    let clip = "<clipPath id='c'><circle cx='50' cy='50' r='20'/></clipPath>";
    check(
        &format!("{clip}<path clip-path='url(#c)' d='M0 50H100' stroke='#000'/>"),
        1,
        40.0,
        "outside clip paths",
    );
    // what a clip cuts ends where the clip does
    let plate = "<rect x='0' y='0' width='100' height='100' fill='teal'/>";
    check(
        &format!("{clip}<g clip-path='url(#c)'>{plate}</g>"),
        1,
        40.0 * std::f64::consts::PI,
        "outside clip paths",
    );
    let nested =
        "<clipPath id='d' clip-path='url(#c)'><rect x='50' y='0' width='50' height='100'/></clipPath>";
    check(
        &format!("{clip}{nested}<path clip-path='url(#d)' d='M0 50H100' stroke='#000'/>"),
        1,
        20.0,
        "outside clip",
    );
    let mask = "<mask id='m' maskUnits='userSpaceOnUse' x='0' y='0' width='100' height='100'>
        <rect x='30' y='30' width='40' height='40' fill='#fff'/><rect x='45' y='0' width='10' height='100'/></mask>";
    check(&format!("{mask}<path mask='url(#m)' d='M0 50H100' stroke='#000'/>"), 2, 30.0, "hidden by masks");
    let arc = read(
        &format!("<circle cx='50' cy='20' r='20' fill='none' stroke='red'/>{PLATE}"),
        &ReadOptions::default(),
    );
    let is_arc = |e: &Element| matches!(e, Element::Arc { .. });
    assert!(arc.sheet.drawing.strokes[0].path.elements().iter().all(is_arc));
}

/// Length that is drawn, to a step in which gradients are followed.
#[track_caller]
fn check_length(content: &str, wanted_mm: f64) {
    let long = length_mm(&read(content, &ReadOptions::default()));
    assert!((long - wanted_mm).abs() < 1.5, "{long} mm: {content}");
}

#[test]
fn gradients_are_drawn_as_far_as_they_are_seen() {
    let fades = |stop: &str| {
        format!(
            "<linearGradient id='g' gradientUnits='userSpaceOnUse' x1='10' x2='90'><stop/>{stop}</linearGradient>"
        )
    };
    let bar = "<rect x='10' y='40' width='80' height='20' fill='url(#g)'/>";
    // the last 6 % of black cannot be told from the paper
    let seen = 20.0 + 2.0 * 80.0 * (1.0 - 15.0 / 255.0);
    check_length(&(fades("<stop offset='1' stop-opacity='0'/>") + bar), seen);
    check_length(&(fades("<stop offset='1' stop-color='#fff'/>") + bar), seen);
    check_length(&(fades("<stop offset='1' stop-color='#800'/>") + bar), 200.0);
    let round = "<radialGradient id='g'><stop stop-opacity='0'/><stop offset='1'/></radialGradient>";
    check_length(
        &format!("{round}<circle cx='50' cy='50' r='20' fill='url(#g)'/>"),
        40.0 * std::f64::consts::PI,
    );
}

#[test]
fn masks_of_gradients_hide_what_is_in_their_dark() {
    let light = "<linearGradient id='g' gradientUnits='userSpaceOnUse' x1='0' x2='50'>
        <stop stop-color='#fff'/><stop offset='1'/></linearGradient>";
    let mask = "<mask id='m' maskUnits='userSpaceOnUse' x='0' y='0' width='100' height='100'>
        <rect width='100' height='100' fill='url(#g)'/></mask>";
    check_length(&format!("{light}{mask}<path mask='url(#m)' d='M0 50H100' stroke='#000'/>"), 49.0);
}

#[test]
fn what_lies_off_the_page_or_has_no_area_or_opacity_is_not_drawn() {
    check("<path d='M50 50H1000' stroke='#000'/>", 1, 50.0, "off the page; --crop off");
    check("<path d='M10 10H90'/><path d='M10 50H90' stroke='#000'/>", 1, 80.0, "no area");
    check(
        "<g opacity='0'><path d='M10 10H90' stroke='red'/></g><path d='M10 50H90' stroke='#000'/>",
        1,
        80.0,
        "opacity 0",
    );
}

#[test]
fn only_a_white_rectangle_with_something_on_it_is_paper() {
    let line = "<path d='M10 50H90' stroke='#000'/>";
    check(&format!("<rect width='100' height='100' fill='#fff'/>{line}"), 1, 80.0, "the paper");
    check(&format!("<rect width='100' height='100' fill='#08c'/>{line}"), 2, 480.0, "");
    check(
        &format!("<circle cx='50' cy='50' r='50' fill='#08c'/>{line}"),
        2,
        80.0 + 100.0 * std::f64::consts::PI,
        "",
    );
    check("<path d='M0 0H100V100H0z' fill='lightgray'/>", 1, 400.0, "");
}

#[test]
fn dashes_and_dots_are_drawn_as_they_are() {
    let dashed = "<path stroke-dasharray='10 10' d='M0 50H100' stroke='#000'/>";
    check(dashed, 5, 50.0, "");
    let solid = read(dashed, &ReadOptions { dashes: false, ..ReadOptions::default() });
    assert!((length_mm(&solid) - 100.0).abs() < 1e-3);
    check("<path d='M50 50h0' stroke='#000' stroke-width='3' stroke-linecap='round'/>", 1, 3.0, "");
}

#[test]
fn a_template_for_cutting_keeps_what_is_hidden() {
    let all = ReadOptions { hidden: Hidden::Keep, ..ReadOptions::default() };
    let found = read(&format!("<path d='M0 50H100' stroke='#f00'/>{PLATE}"), &all);
    assert!((length_mm(&found) - 260.0).abs() < 1e-3 && found.remarks.is_empty());
    let open = ReadOptions { crop: false, ..ReadOptions::default() };
    assert!((length_mm(&read("<path d='M50 50H1000' stroke='#000'/>", &open)) - 950.0).abs() < 1e-2);
}

#[test]
fn an_edge_that_all_but_runs_along_another_is_seen_where_it_leaves_it() {
    // a white bar over a coloured one, a hundredth beside it, as programs export shapes that were cut out of each other
    let below = "<path d='M20 40H80A15 15 0 0 1 80 70H20z' fill='#3c6eb4'/>";
    for beside in [0.0, 0.004, 0.008, 0.012] {
        let top = 40.0 + beside;
        let above = format!("<path d='M20 {top}H60V70H20z' fill='#000'/>");
        let found = read(&format!("{below}{above}"), &ReadOptions::default());
        let long = length_mm(&found);
        // the black one's edge, and what is left of the other: top, arc, bottom
        let wanted = 140.0 - 2.0 * beside + 40.0 + 15.0 * std::f64::consts::PI;
        assert!((long - wanted).abs() < 0.5, "{beside}: {long} mm of {wanted}");
    }
}

#[test]
fn however_many_shapes_there_are_each_ends_where_the_page_does() {
    // rings across the upper edge, one beside the other: the more there are, the smaller the tiles in which they are looked at
    for count in [1_usize, 3, 10, 40] {
        let side = 100.0 / count as f64;
        let ring = |k: usize| {
            format!(
                "<circle cx='{}' cy='0' r='{}' fill='none' stroke='#000' stroke-width='0.1'/>",
                (k as f64 + 0.5) * side,
                0.4 * side
            )
        };
        let rings: String = (0..count).map(ring).collect();
        let plate = "<rect x='-5' y='-5' width='120' height='120' fill='#ddd'/>";
        let found = read(&format!("{plate}{rings}"), &ReadOptions::default());
        let wanted = count as f64 * 0.4 * side * std::f64::consts::PI;
        assert!((length_mm(&found) - wanted).abs() < 0.2, "{count}: {} mm of {wanted}", length_mm(&found));
    }
}

#[test]
fn a_white_line_on_a_wider_black_one_is_drawn_and_across_one_it_is_not() {
    let line = |d: &str, width: f64, colour: &str| {
        format!("<path d='{d}' fill='none' stroke='{colour}' stroke-width='{width}'/>")
    };
    let along = line("M20 20H80V80", 3.0, "#000") + &line("M20 20H80V80", 1.0, "#fff");
    let found = read(&along, &ReadOptions::default());
    assert!((length_mm(&found) - 120.0).abs() < 2.0, "{} mm", length_mm(&found));
    // one that crosses below shows on both sides, too, for as long as it is wide
    let across = line("M50 0V100", 3.0, "#000") + &line("M10 50H90", 1.0, "#fff");
    let found = read(&across, &ReadOptions::default());
    assert!((length_mm(&found) - 100.0).abs() < 2.0, "{} mm: {:?}", length_mm(&found), found.remarks);
}

#[test]
fn white_lines_on_black_ones_go_on_where_they_cross() {
    let cross = |colour: &str, width: f64| {
        let line = |d: &str| format!("<path d='{d}' fill='none' stroke='{colour}' stroke-width='{width}'/>");
        line("M10 50H90") + &line("M50 10V90")
    };
    check(&(cross("#000", 6.0) + &cross("#fff", 2.0)), 2, 160.0, "covered");
}

/// Strokes and lengths, mm, that are drawn in each colour, and whether a pen draws them or they are an edge.
fn drawn(content: &str) -> Vec<(String, bool, f64)> {
    let found = read(content, &ReadOptions::default());
    let mm = 1e3 * found.sheet.metres_per_unit.unwrap();
    let strokes = found.sheet.drawing.strokes.iter();
    strokes.map(|s| (s.colour.unwrap().to_string(), s.pen.is_some(), mm * s.path.length(1e-6))).collect()
}

#[test]
fn where_the_middle_of_a_wide_pen_is_not_seen_its_sides_are() {
    let plate = "<rect x='30' y='30' width='40' height='40' fill='#fa0'/>";
    // white on white, but its side cuts the plate
    let rubbed = format!("{plate}<path d='M26 10V90' stroke='#fff' stroke-width='12'/>");
    check(&rubbed, 2, 38.0 + 40.0 + 38.0 + 40.0, "covered");
    // below a plate of its colour one side is left; the ends belong to what is drawn of the middle
    let behind = format!("<path d='M32 10V90' stroke='#fa0' stroke-width='8'/>{plate}");
    let sides: Vec<_> =
        drawn(&behind).into_iter().filter(|(_, is_pen, long)| !is_pen && *long < 38.0).collect();
    assert!(matches!(&sides[..], [(.., long)] if (long - 31.7).abs() < 2.0), "{:?}", drawn(&behind));
    // a shadow
    let shadow = "<path d='M20 21H80' stroke='#888' stroke-width='4'/><path d='M20 20H80' stroke='#fff' stroke-width='4'/>";
    let black = "<path d='M10 90H90' stroke='#000' stroke-width='4'/>";
    let found = drawn(&format!("{shadow}{black}"));
    let grey: f64 = found.iter().filter(|(colour, ..)| colour == "#888888").map(|(.., long)| long).sum();
    assert!(grey > 60.0 && grey < 64.0, "{found:?}");
}

#[test]
fn lines_that_cross_at_a_slant_leave_no_scraps_of_their_sides() {
    let lines = "<path d='M10 40L90 60' stroke='#00f' stroke-width='4'/><path d='M10 50H90' stroke='#f00' stroke-width='4'/>";
    let found = drawn(lines);
    assert!(found.len() == 3 && found.iter().all(|(_, is_pen, _)| *is_pen), "{found:?}");
}

#[test]
fn what_is_not_drawn_of_gradients_masks_and_windows_is_told() {
    let plate = |x: &str, fill: &str| format!("<rect x='{x}' y='10' width='40' height='40' fill='{fill}'/>");
    let gradient =
        |stops: &str| format!("<linearGradient id='g'>{stops}</linearGradient>{}", plate("10", "url(#g)"));
    let said = |content: &str, words: &str| {
        let found = read(content, &ReadOptions::default());
        found.remarks.iter().any(|remark| remark.contains(words))
    };
    let stop = |offset: f64, colour: &str| format!("<stop offset='{offset}' stop-color='{colour}'/>");
    let soft = gradient(&(stop(0.0, "red") + &stop(0.5, "blue") + &stop(1.0, "green")));
    let hard = gradient(&(stop(0.0, "red") + &stop(0.5, "red") + &stop(0.5, "blue") + &stop(1.0, "blue")));
    // one colour from both sides, or a change at the very end, is no edge inside
    let same = gradient(&(stop(0.0, "red") + &stop(0.5, "blue") + &stop(0.5, "blue") + &stop(1.0, "green")));
    let end = gradient(&(stop(0.0, "red") + &stop(1.0, "blue") + &stop(1.0, "green")));
    let found = [&soft, &hard, &same, &end].map(|content| said(content, "edges inside gradients"));
    assert_eq!(found, [false, true, false, false]);
    assert!(said(&(plate("1", "#000") + &plate("50vw", "#000")), "vw, vh"));
    assert!(!said(&plate("5", "#000"), "vw, vh"));
    let mask = "<mask id='m' style='color-interpolation: linearRGB'><circle cx='30' cy='30' r='9' fill='#fff'/></mask>";
    assert!(said(&format!("{mask}<g mask='url(#m)'>{}</g>", plate("10", "#000")), "linearRGB"));
}

#[test]
fn a_shape_stays_whole_whose_own_pen_below_it_has_the_colour_of_the_ground() {
    let disc = |fill: &str, pen: &str| {
        format!(
            "<circle cx='50' cy='50' r='30' fill='{fill}' stroke='{pen}' stroke-width='6' paint-order='stroke'/>"
        )
    };
    let round = 60.0 * std::f64::consts::PI;
    check(&disc("#000", "#fff"), 1, round, "in the colour of what lies around");
    let ground = "<rect width='100' height='100' fill='#246'/>";
    check(
        &format!("{ground}{}", disc("#fff", "#246")),
        2,
        round + 400.0,
        "in the colour of what lies around",
    );
    // a halo that shows: one line, the pen's
    check(&disc("#000", "#c00"), 1, round, "");
    // and one that shows in part: the line of the pen there, the edge of the shape elsewhere
    let over = format!("<rect x='50' y='10' width='45' height='80' fill='#c33'/>{}", disc("#33c", "#fff"));
    let found = drawn(&over);
    let about: f64 = found.iter().filter(|(colour, ..)| colour != "#cc3333").map(|(.., long)| long).sum();
    assert!((about - round).abs() < 10.0, "{found:?}");
}

#[test]
fn thin_lines_on_a_wide_band_do_not_hide_its_sides() {
    // a plate of its colour hides its middle, and leaves both parts of one side, and all of the other
    let band = "<path d='M0 50H100' stroke='#000' stroke-width='20'/><rect x='30' y='35' width='40' height='20' fill='#000'/>\
                <path d='M0 50H100' stroke='#fff' stroke-width='1'/>";
    let sides: f64 = drawn(band).iter().filter(|(.., is_pen, _)| !is_pen).map(|(.., long)| long).sum();
    assert!((sides - (30.0 + 30.0 + 100.0 + 40.0 + 10.0)).abs() < 6.0, "{sides}: {:?}", drawn(band));
}
