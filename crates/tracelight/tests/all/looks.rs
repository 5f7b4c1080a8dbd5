//! How what is drawn looks, as far as no browser is needed: `.ci/looks` has one.

use std::fs;
use std::path::{Path, PathBuf};

use crate::support::{folder, root, run};

/// Crates that draw.
const DRAWING: [&str; 4] = ["chart", "report", "book", "experiment"];
/// Letters of a plot by itself, px; a page shrinks it to eleven twelfths at most, so that none is below 11.
const LEAST_PX: f64 = 12.0;

/// Every file below a folder whose name ends so.
fn files(dir: &Path, extensions: &[&str]) -> Vec<PathBuf> {
    let paths = fs::read_dir(dir).unwrap().map(|entry| entry.unwrap().path());
    let of = |path: PathBuf| if path.is_dir() { files(&path, extensions) } else { vec![path] };
    let is_one = |path: &PathBuf| extensions.iter().any(|e| path.extension().is_some_and(|x| x == *e));
    paths.flat_map(of).filter(is_one).collect()
}

/// Colours that are made of numbers in a text: `#abc`, `#aabbcc`, and by functions. A shadow's black is none.
fn colours(text: &str) -> Vec<String> {
    let mut found = Vec::new();
    for (at, _) in text.match_indices('#') {
        let digits: String = text[at + 1..].chars().take_while(char::is_ascii_alphanumeric).collect();
        let is_entity = text[..at].ends_with('&');
        if [3, 6].contains(&digits.len()) && digits.chars().all(|c| c.is_ascii_hexdigit()) && !is_entity {
            found.push(format!("#{digits}"));
        }
    }
    for function in ["rgb(", "rgba(", "hsl(", "RGBColor("] {
        let calls = text.match_indices(function).filter(|(at, _)| {
            let before = text[..*at].chars().next_back();
            let is_own = before.is_some_and(|c| c.is_ascii_alphanumeric() || "_:.".contains(c));
            !is_own && !text[..*at].ends_with("fn ") && !text[*at..].starts_with("rgb(0 0 0 /")
        });
        found.extend(calls.map(|(at, _)| text[at..].chars().take(24).collect()));
    }
    found
}

#[test]
fn colours_are_made_in_one_place() {
    let mut found = Vec::new();
    for name in DRAWING {
        let source = root().join("crates").join(name).join("src");
        for file in files(&source, &["rs", "css", "js", "html"]) {
            let text = fs::read_to_string(&file).unwrap();
            let code = text.split("#[cfg(test)]").next().unwrap_or_default();
            // the one place is chart's; its `rgb` makes what the drawing library wants
            if file.ends_with("chart/src/rgb.rs") {
                continue;
            }
            found.extend(colours(code).into_iter().map(|colour| format!("{}: {colour}", file.display())));
        }
    }
    assert!(found.is_empty(), "colours that `chart` does not name:\n{}", found.join("\n"));
}

#[test]
fn a_colour_made_elsewhere_is_found() {
    let text = "a { color: #fff; b: rgba(1, 2, 3, .5); c: rgb(0 0 0 / .2) } &#39; x#\"#12 RGBColor(1, 2, 3)";
    assert_eq!(colours(text), ["#fff", "rgba(1, 2, 3, .5); c: rg", "RGBColor(1, 2, 3)"]);
}

/// A number in front of a unit.
fn number(text: &str) -> (f64, &str) {
    let end = text.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(text.len());
    (text[..end].parse().unwrap(), &text[end..])
}

/// The value of a root's attribute.
fn attribute<'a>(root: &'a str, name: &str) -> Option<&'a str> {
    Some(root.split_once(&format!(" {name}=\""))?.1.split_once('"')?.0)
}

/// The smallest letters of a drawing as it is shown by itself, px.
fn smallest_px(svg: &str) -> f64 {
    let root = svg.split_once("<svg").unwrap().1.split_once('>').unwrap().0;
    let (width, unit) = number(attribute(root, "width").unwrap());
    let width_px = if unit == "mm" { width * 96.0 / 25.4 } else { width };
    let box_wide: f64 = attribute(root, "viewBox").unwrap().split(' ').nth(2).unwrap().parse().unwrap();
    let sizes = svg.split("font-size=\"").skip(1).map(|rest| number(rest).0);
    sizes.fold(f64::INFINITY, f64::min) * width_px / box_wide
}

/// What is wrong with a figure.
fn complaints(svg: &str) -> Vec<String> {
    let mut found = Vec::new();
    for tag in ["title", "desc"] {
        let words = svg.split_once(&format!("<{tag}>")).and_then(|(_, rest)| rest.split_once("</"));
        if words.is_none_or(|(words, _)| words.trim().len() < 5) {
            found.push(format!("no {tag}"));
        }
    }
    if !svg.contains("role=\"img\"") {
        found.push("no role".to_owned());
    }
    if !svg.contains("prefers-color-scheme:dark") {
        found.push("nothing for a dark screen".to_owned());
    }
    let smallest = smallest_px(svg);
    if smallest < LEAST_PX - 0.01 {
        found.push(format!("letters of {smallest:.2} px"));
    }
    found
}

#[test]
fn every_figure_says_what_it_is_and_can_be_read() {
    let dir = folder("looks");
    let commands = [
        "lab step --axis tilt -o FILE",
        "lab bode G11 -o FILE",
        "lab nichols G11 -o FILE",
        "lab gang G11 --controller K11 -o FILE",
        "lab locus G11 -o FILE",
        "lab profile --distance 180deg -o FILE",
        "lab move arc --start 10in,0in --angle 90deg -o FILE",
        "lab simulate --random --law state,report-pd -o FILE",
        "lab lesson 1 -o FILE",
        "plan examples/star.png --preview FILE",
        "plan examples/house.png --colour-by limit --preview FILE",
        "strokes examples/star.png --stages FILE",
    ];
    for (number, command) in commands.into_iter().enumerate() {
        let file = dir.join(format!("{number}.svg"));
        let words: Vec<&str> =
            command.split(' ').map(|w| if w == "FILE" { file.to_str().unwrap() } else { w }).collect();
        let output = run(&words);
        assert!(output.status.success(), "{command}: {}", String::from_utf8_lossy(&output.stderr));
        let found = complaints(&fs::read_to_string(&file).unwrap());
        assert!(found.is_empty(), "{command}: {found:?}");
    }
}

#[test]
fn a_figure_without_words_is_told() {
    let svg = r#"<svg width="100" viewBox="0 0 800 10"><text font-size="80">a</text></svg>"#;
    let found = complaints(svg);
    assert_eq!(found, ["no title", "no desc", "no role", "nothing for a dark screen", "letters of 10.00 px"]);
}

#[test]
fn a_preview_is_as_large_as_the_drawing() {
    let file = folder("looks-size").join("star.svg");
    let output = run(&[
        "plan",
        "examples/star.png",
        "--width",
        "400mm",
        "--preview",
        file.to_str().unwrap(),
        "--json",
    ]);
    assert!(output.status.success());
    let svg = fs::read_to_string(file).unwrap();
    let root = svg.split_once("<svg").unwrap().1.split_once('>').unwrap().0;
    let (width_mm, unit) = number(attribute(root, "width").unwrap());
    assert_eq!(unit, "mm");
    let box_wide: f64 = attribute(root, "viewBox").unwrap().split(' ').nth(2).unwrap().parse().unwrap();
    // the scale bar says how long it is
    let (_, bar) = svg.split_once("v8H").unwrap();
    let to = number(bar).0;
    let (before, _) = svg.split_once("v8H").unwrap();
    let from: f64 = before.rsplit_once('M').unwrap().1.split(' ').next().unwrap().parse().unwrap();
    let label = bar.split_once(" mm</text>").unwrap().0.rsplit_once('>').unwrap().1;
    let said: f64 = label.parse().unwrap();
    let is = (to - from) * width_mm / box_wide;
    assert!((is / said - 1.0).abs() < 2e-3, "{is} mm is called {said} mm");
}
