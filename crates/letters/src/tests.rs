//! Every letter of Europe's languages in every face, and marks that touch nothing.

use std::collections::BTreeSet;
use std::sync::Arc;

use crate::{Faces, Kind, bundled, kind_of};

/// Letters beyond a to z of the languages of Europe that are written in Latin script, small; those that have no capital, or another one
/// than Unicode says, are in [`OTHERS`].
const LANGUAGES: [(&str, &str); 47] = [
    ("Albanian", "çë"),
    ("Asturian", "áéíóúüñḥḷ"),
    ("Azerbaijani", "çəğıöşü"),
    ("Basque", "çñü"),
    ("Bosnian, Croatian, Serbian, Montenegrin", "čćđšžśź"),
    ("Breton", "âêîôûùüñ"),
    ("Catalan", "àçèéíïòóúü·"),
    ("Corsican", "àèìïòùü"),
    ("Czech", "áčďéěíňóřšťúůýž"),
    ("Danish, Norwegian", "æøåáéèêóòôü"),
    ("Dutch", "áäéèëêíïóöôúüĳ"),
    ("English", "éèïöæœ"),
    ("Esperanto", "ĉĝĥĵŝŭ"),
    ("Estonian", "äõöüšž"),
    ("Faroese", "áðíóúýæø"),
    ("Finnish", "åäöšž"),
    ("French", "àâæçèéêëîïôœùûüÿ"),
    ("Frisian", "âêôûúë"),
    ("Friulian", "âêîôûàèìòùç"),
    ("Gaelic, Irish", "áéíóúàèìòùḃċḋḟġṁṗṡṫ"),
    ("Galician", "áéíóúüïñ"),
    ("German", "äöüß"),
    ("Hungarian", "áéíóöőúüű"),
    ("Icelandic", "áðéíóúýþæö"),
    ("Italian", "àèéìíîòóùú"),
    ("Kashubian", "ãąéëłńòóôùż"),
    ("Kurdish", "çêîşû"),
    ("Latin", "āēīōūȳăĕĭŏŭæœë"),
    ("Latvian", "āčēģīķļņšūžōŗ"),
    ("Lithuanian", "ąčęėįšųūž"),
    ("Livonian", "āäǟḑēīļņōȯȱõȭŗšțūž"),
    ("Luxembourgish", "äéëöü"),
    ("Maltese", "àċġħìòùż"),
    ("Manx, Cornish", "çïâêîôûŵŷ"),
    ("Moldovan, Romanian", "ăâîșțşţ"),
    ("Occitan", "àáçèéíïòóúü"),
    ("Polish", "ąćęłńóśźż"),
    ("Portuguese", "àáâãçéêíóôõúü"),
    ("Romansh", "àèéìîòù"),
    ("Sami", "áâäåæčđǧǥǩŋñöøõšŧžǯʒïẅ"),
    ("Slovak", "áäčďéíĺľňóôŕšťúýž"),
    ("Slovene", "čšžáéíóúȃȇȋȏȗȁȅȉȍȑȓ"),
    ("Sorbian", "čćěłńóŕřšśžź"),
    ("Spanish", "áéíñóúü¿¡ªº"),
    ("Swedish", "åäöéüáà"),
    ("Turkish", "çğıöşüâîû"),
    ("Welsh", "àáâäèéêëìíîïòóôöùúûüẁẃŵẅỳýŷÿ"),
];

/// Capitals that are no plain ones of these, and what texts are set with.
const OTHERS: &str = "İẞĿŀŉſĸ€–—‘’‚“”„…•‰−«»‹›§¶°±²³µ×÷©®ªº";

/// Letters of Europe, small and capital: those of the languages, all of Latin-1, Latin Extended-A and Romanian.
fn letters_of_europe() -> BTreeSet<char> {
    let small = LANGUAGES.iter().flat_map(|(_, letters)| letters.chars());
    let both = small.flat_map(|letter| letter.to_uppercase().chain([letter]));
    let codes = (0x21..0x7f).chain(0xa1..0x180).chain(0x218..0x21c).filter(|&code| code != 0xad);
    both.chain(codes.filter_map(char::from_u32)).chain(OTHERS.chars()).collect()
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

/// The accent of a letter: what its run has above its base's.
fn accent(faces: &Faces, letter: char, base: char) -> Vec<tracelight_stroke::Point> {
    let points = |letter: char| -> Vec<tracelight_stroke::Point> {
        let run = faces.run(&letter.to_string());
        run.letters.iter().flat_map(|l| &l.paths).flat_map(|path| path.flatten(1e-4)).collect()
    };
    let base = points(base);
    let top = base.iter().map(|p| p.y).fold(f64::MIN, f64::max);
    let bottom = |points: &[tracelight_stroke::Point]| points.iter().map(|p| p.x).fold(f64::MAX, f64::min);
    let above: Vec<_> = points(letter).into_iter().filter(|p| p.y > top + 1e-6).collect();
    let left = bottom(&above);
    above.iter().map(|p| tracelight_stroke::Point::new(p.x - left, p.y - top)).collect()
}

#[test]
fn an_accent_is_of_one_design_on_the_letters_that_a_font_has_and_on_those_that_it_lacks() {
    for name in ["ems", "hershey"] {
        let faces = faces(Kind::Line, name);
        for (own, base, composed, other) in [
            ('É', 'E', 'Ź', 'Z'),
            ('é', 'e', 'ć', 'c'),
            ('Ê', 'E', 'Ŵ', 'W'),
            ('ê', 'e', 'ŵ', 'w'),
            ('Å', 'A', 'Ů', 'U'),
        ] {
            let (own, composed) = (accent(&faces, own, base), accent(&faces, composed, other));
            assert_eq!(own.len(), composed.len(), "{name}");
            let lowest =
                |points: &[tracelight_stroke::Point]| points.iter().map(|p| p.y).fold(f64::MAX, f64::min);
            let (from, to) = (lowest(&own), lowest(&composed));
            // a font rounds its own points to a thousandth of its em
            let is_alike = own
                .iter()
                .zip(&composed)
                .all(|(a, b)| (a.x - b.x).abs() < 2e-3 && ((a.y - from) - (b.y - to)).abs() < 2e-3);
            assert!(is_alike && !own.is_empty(), "{name}: {own:?} against {composed:?}");
            // a font's own letters are not all of one height
            assert!((from - to).abs() < 0.06, "{name}: {from} em over {base}, {to} em over {other}");
        }
    }
}

#[test]
fn no_line_of_a_single_line_letter_is_drawn_twice() {
    for name in ["ems", "hershey"] {
        let faces = faces(Kind::Line, name);
        for letter in letters_of_europe() {
            let run = faces.run(&letter.to_string());
            let paths: Vec<_> = run.letters.iter().flat_map(|l| &l.paths).collect();
            let (splits, _) = tracelight_stroke::doubles(&paths);
            let again: f64 =
                splits.iter().flatten().flat_map(|split| &split.again).map(|path| path.length(1e-6)).sum();
            assert!(again < 0.01, "{name} draws {again} em of {letter} twice");
        }
    }
}
