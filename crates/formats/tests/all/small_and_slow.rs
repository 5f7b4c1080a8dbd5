//! Small SVGs that would keep a parser busy for minutes are refused at once, with what they have too much of; drawings as
//! programs write them are not.

use std::fmt::Write;
use std::time::Instant;

use tracelight_formats::{FormatError, Hidden, ReadOptions, svg};

const LINE: &str = "<path d='M0 0H9' stroke='red'/>";

fn document(head: &str, body: &str) -> String {
    format!("{head}<svg xmlns='http://www.w3.org/2000/svg' width='9' height='9'>{body}</svg>")
}

/// Text made of a piece for each number.
fn all(count: usize, piece: impl Fn(usize, &mut String)) -> String {
    (0..count).fold(String::new(), |mut text, number| {
        piece(number, &mut text);
        text
    })
}

#[track_caller]
fn check_refused(text: &str, words: &[&str]) {
    let started = Instant::now();
    let refused = svg::read(text.as_bytes()).unwrap_err();
    let took_s = started.elapsed().as_secs_f64();
    assert!(took_s < 1.0, "refused after {took_s:.2} s: {refused}");
    let said = refused.to_string();
    assert!(words.iter().all(|word| said.contains(word)), "{said} does not say {words:?}");
}

#[test]
fn nested_namespaces_are_refused_before_they_are_resolved() {
    let open = |depth| all(depth, |k, text| write!(text, "<g xmlns:a{k}='u{k}'>").unwrap());
    let nested = |depth| document("", &(open(depth) + LINE + &"</g>".repeat(depth)));
    check_refused(&nested(5000), &["nesting", "5002 levels", "128"]);
    let one = all(60_000, |k, text| write!(text, " xmlns:a{k}='u{k}'").unwrap());
    check_refused(&document("", &format!("<g{one}>{LINE}</g>")), &["60000 attributes", "256"]);
    let declared = all(200, |k, text| write!(text, " xmlns:a{k}='u{k}'").unwrap());
    let anew = format!("<g xmlns:a1='u'>{LINE}</g>").repeat(20_000);
    check_refused(&document("", &format!("<g{declared}>{anew}</g>")), &["namespaces in scope"]);
}

#[test]
fn a_tag_of_many_attributes_is_refused() {
    let many = all(80_000, |k, text| write!(text, " a{k}=''").unwrap());
    check_refused(&document("", &format!("<g{many}>{LINE}</g>")), &["80000 attributes", "at most 256"]);
    let quoted = all(300, |k, text| write!(text, "\ta{k} = \">='\"").unwrap());
    check_refused(&document("", &format!("<g{quoted}>{LINE}</g>")), &["300 attributes"]);
}

#[test]
fn a_style_sheet_of_many_rules_for_many_elements_is_refused() {
    let rules = all(20_000, |k, text| write!(text, ".c{k}{{fill:red}}").unwrap());
    let body = LINE.repeat(5000);
    let words = ["style sheet", "rules times elements", "60000000"];
    check_refused(&document("", &format!("<style>{rules}</style>{body}")), &words);
    check_refused(&document("", &format!("<style><![CDATA[{rules}]]></style>{body}")), &words);
    check_refused(&document("", &format!("<a:style xmlns:a='b'>{rules}</a:style>{body}")), &words);
    // few rules, each of which tries every way up through a deep tree
    let above = "g ".repeat(20) + "path{fill:red}";
    let deep = "<g>".repeat(100) + &LINE.repeat(100) + &"</g>".repeat(100);
    check_refused(&document("", &format!("<style>a {above}</style>{deep}")), &words);
    // one rule whose value each element would keep
    let long = format!("<style>path{{fill:{}}}</style>", "r".repeat(500_000));
    check_refused(&document("", &(long + &LINE.repeat(2000))), &["bytes of declarations"]);
    // rules by entity
    let head = format!("<!DOCTYPE svg [<!ENTITY r '{}'>]>", ".c{fill:red}".repeat(1000));
    let sheet = format!("<style>{}</style>", "&r;".repeat(50));
    check_refused(&document(&head, &(sheet + &body)), &words);
}

#[test]
fn tags_hide_in_no_entity() {
    let tag = all(300, |k, text| write!(text, " a{k}=\"\"").unwrap());
    let head = format!("<!DOCTYPE svg [<!ENTITY t '<g{tag}/>'>]>");
    check_refused(&document(&head, "&t;"), &["300 attributes"]);
    let head = "<!DOCTYPE svg [<!ENTITY t '<g/><g/><g/><g/><g/>'>]>";
    check_refused(&document(head, &"&t;".repeat(3000)), &["15000 tags"]);
    check_refused(&document("<!DOCTYPE svg [<!ENTITY t '<style>a{}</style>'>]>", "&t;"), &["style sheet"]);
    check_refused(
        &document("<!DOCTYPE svg [<!ENTITY t 'a>&b;'>]>", "&t;"),
        &["an entity that names another"],
    );
    let few = document(
        "<!DOCTYPE svg [<!ENTITY t '<path d=\"M0 0H9\" stroke=\"red\"/>'>]>",
        "&t;<g transform='translate(0 2)'>&t;</g>",
    );
    assert_eq!(svg::read(few.as_bytes()).unwrap().sheet.drawing.strokes.len(), 2);
}

#[test]
fn so_many_elements_are_refused_before_there_is_a_tree() {
    check_refused(&document("", &"<g/>".repeat(1_200_000)), &["1200001 elements", "1000000"]);
}

#[test]
fn a_map_of_a_hundred_thousand_elements_and_hundreds_of_rules_is_read() {
    let rules = all(400, |k, text| {
        writeln!(text, ".road{k} {{ fill:none; stroke:#{k:03}; stroke-width:2px }}").unwrap()
    });
    let roads = all(100_000, |k, text| {
        let class = k % 500;
        writeln!(text, "<path id='p{k}' class='road{class}' inkscape:label='{k}' d='M{k} 0l5 5' />").unwrap();
    });
    let comments = "<!-- <g> ' \" --><?xml-stylesheet <g> ?><!-- a{b{ -->";
    let body = format!(
        "<style type='text/css'>{rules}</style><g xmlns:inkscape='http://www.inkscape.org/namespaces/inkscape'>{comments}{roads}</g>"
    );
    let text = document("<?xml version='1.0'?>\n", &body);
    let all_of_it = ReadOptions { hidden: Hidden::Keep, crop: false, ..ReadOptions::default() };
    let read = svg::read_with(text.as_bytes(), &all_of_it).unwrap();
    assert_eq!(read.sheet.drawing.strokes.len(), 100_000);
}

#[test]
fn a_tag_is_told_from_what_only_looks_like_one() {
    let head = "<!DOCTYPE svg PUBLIC \"-//W3C//DTD SVG 1.1//EN\" \"a>b\" [\n<!ENTITY ns 'http://x/'>\n<!-- > ' -->\n<!ELEMENT g ANY>\n]>";
    let body =
        format!("<desc>a ' b \" c &gt; d</desc><g id='a>b' class=\"'\">{LINE}</g><![CDATA[ <g <g <g ]]>");
    assert_eq!(svg::read(document(head, &body).as_bytes()).unwrap().sheet.drawing.strokes.len(), 1);
}

#[test]
fn what_is_said_has_the_unit_and_no_number_that_nobody_can_read() {
    let [path, ellipse] =
        ["<path stroke='red' d='M0 0A1e300 1e300 0 0 1 9 9'/>", "<ellipse rx='1e200' ry='1e200'/>"]
            .map(|body| svg::read(document("", body).as_bytes()).unwrap_err().to_string());
    for said in [&path, &ellipse] {
        assert!(
            said.contains("arcs and ellipses") && said.contains("bytes") && !said.contains("1844674"),
            "{said}"
        );
    }
    let long = svg::read(&vec![b' '; 20_000_140]).unwrap_err().to_string();
    assert!(long.contains("20000140 bytes") && long.contains("16777216"), "{long}");
    let far = FormatError::Far { place: "stroke 1".into(), x: 1e300, y: -1e300 }.to_string();
    assert!(far.len() < 200 && far.contains("(301 digits)"), "{far}");
}
