//! Every letter of Europe's languages in every face, and marks that touch nothing.

use std::sync::Arc;

use crate::{Faces, Kind, bundled, kind_of};

/// Latin-1, Latin Extended-A, Romanian, and what texts are set with.
fn letters_of_europe() -> impl Iterator<Item = char> {
    let codes = (0x21..0x7f).chain(0xa1..0x180).chain(0x218..0x21c).filter(|&code| code != 0xad);
    codes.filter_map(char::from_u32).chain("ẞ€–—‘’‚“”„…•‰−".chars())
}

fn faces(kind: Kind, name: &str) -> Faces {
    let bytes: Arc<[u8]> = bundled(name).unwrap().into();
    Faces::new(kind, &[(name.to_owned(), bytes)]).unwrap()
}

#[test]
fn every_letter_of_europe_is_drawn_in_every_face() {
    for (kind, name) in [(Kind::Line, "ems"), (Kind::Line, "hershey"), (Kind::Outline, "dejavu")] {
        let faces = faces(kind, name);
        for letter in letters_of_europe() {
            let run = faces.run(&letter.to_string());
            assert!(run.missing.is_empty() && run.outlined.is_empty(), "{name} lacks {letter}");
            assert!(run.letters.iter().any(|l| !l.paths.is_empty()), "{name} draws nothing for {letter}");
        }
    }
}

#[test]
fn an_accent_clears_its_letter_and_a_composed_letter_is_as_wide_as_its_base() {
    for name in ["ems", "hershey"] {
        let faces = faces(Kind::Line, name);
        for (letter, base) in ["ČC", "šs", "őo", "Żz", "ňn", "ŪU", "ěe", "ĜG"].map(|pair| {
            let mut letters = pair.chars();
            (letters.next().unwrap(), letters.next().unwrap())
        }) {
            let (composed, plain) =
                (faces.run(&letter.to_string()), faces.run(&base.to_lowercase().to_string()));
            let plain =
                if letter.is_uppercase() { faces.run(&base.to_uppercase().to_string()) } else { plain };
            assert_eq!(composed.advance, plain.advance, "{name}: {letter}");
            let paths =
                |run: &crate::Run| run.letters.iter().flat_map(|l| l.paths.clone()).collect::<Vec<_>>();
            let top = |run: &crate::Run| {
                paths(run).iter().flat_map(|p| p.flatten(1e-3)).map(|p| p.y).fold(f64::MIN, f64::max)
            };
            let marks = paths(&composed).split_off(paths(&plain).len());
            let lowest = marks.iter().flat_map(|p| p.flatten(1e-3)).map(|p| p.y).fold(f64::MAX, f64::min);
            assert!(lowest > top(&plain) + 0.03, "{name}: {letter}, {lowest} over {}", top(&plain));
        }
    }
}

#[test]
fn marks_that_are_typed_apart_are_put_on_their_letter() {
    for (kind, name) in [(Kind::Line, "ems"), (Kind::Outline, "dejavu")] {
        let faces = faces(kind, name);
        assert_eq!(faces.run("e\u{301}"), faces.run("é"), "{name}");
        assert!(faces.run("x\u{30c}").missing.is_empty(), "{name}");
    }
}

#[test]
fn an_outline_face_kerns_and_an_svg_font_too() {
    let run = faces(Kind::Outline, "dejavu");
    assert!(run.run("AV").advance < run.run("A").advance + run.run("V").advance);
    let font = br#"<svg xmlns="http://www.w3.org/2000/svg"><font horiz-adv-x="500"><font-face units-per-em="1000"/>
        <glyph unicode="A" glyph-name="A" d="M0 0L250 700L500 0"/><glyph unicode="V" glyph-name="V" d="M0 700L250 0L500 700"/>
        <hkern g1="A" g2="V" k="100"/></font></svg>"#;
    let own = Faces::new(Kind::Line, &[("own".to_owned(), Arc::from(&font[..]))]).unwrap();
    assert!((own.run("AV").advance - 0.9).abs() < 1e-12);
}

#[test]
fn what_is_no_font_is_refused_by_its_name() {
    let check = |bytes: &[u8], expected: &str| {
        let found = kind_of("my.font", &Arc::from(bytes)).unwrap_err().to_string();
        assert!(found.contains("my.font") && found.contains(expected), "{found}");
    };
    check(b"", "no font");
    check(b"rubbish", "no font");
    check(b"<svg/>", "no glyph");
    let dejavu: Arc<[u8]> = bundled("dejavu").unwrap().into();
    check(&dejavu[..40], "no font");
    assert!(Faces::new(Kind::Line, &[("d.ttf".to_owned(), dejavu)]).is_err());
}

#[test]
fn broken_fonts_do_no_harm() {
    let whole = bundled("dejavu").unwrap();
    for cut in (1_000..whole.len()).step_by(whole.len() / 40) {
        let mut broken = whole[..cut].to_vec();
        broken.resize(whole.len(), 0x5a);
        if let Ok(faces) = Faces::new(Kind::Outline, &[("broken".to_owned(), broken.into())]) {
            let _ = faces.run("Straße ŁÓDŹ fi 12\u{301}");
        }
    }
}
