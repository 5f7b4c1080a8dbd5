//! Good files with bytes, lines and numbers broken at random: readers refuse them or read them, and what they read is
//! sound. By hand, for longer: `cargo test --release -p tracelight-formats --test all mutations -- --ignored`.

use std::time::{Duration, Instant};

use oorandom::Rand32;
use tracelight_formats::{FormatError, MAX_COORDINATE, Sheet, dxf, svg};

use crate::plate::plate;

/// A DXF with blocks, a layer table, and entities that our writer has no use for.
const OTHERS: &str = "0\nSECTION\n2\nTABLES\n0\nTABLE\n2\nLAYER\n0\nLAYER\n2\nL\n62\n3\n70\n0\n0\nENDTAB\n0\nENDSEC\n\
    0\nSECTION\n2\nBLOCKS\n0\nBLOCK\n2\nA\n10\n0\n20\n0\n0\nLINE\n8\n0\n10\n0\n20\n0\n11\n5\n21\n5\n0\nINSERT\n2\nB\n10\n3\n20\n1\n\
    0\nENDBLK\n0\nBLOCK\n2\nB\n10\n1\n20\n1\n0\nARC\n10\n0\n20\n0\n40\n2\n50\n10\n51\n200\n230\n-1\n0\nENDBLK\n0\nENDSEC\n\
    0\nSECTION\n2\nENTITIES\n0\nINSERT\n8\nL\n2\nA\n10\n9\n20\n9\n41\n2\n42\n-3\n50\n30\n70\n3\n71\n2\n44\n10\n45\n10\n\
    0\nPOLYLINE\n66\n1\n70\n1\n0\nVERTEX\n10\n0\n20\n0\n42\n0.5\n0\nVERTEX\n10\n9\n20\n0\n0\nVERTEX\n10\n9\n20\n7\n0\nSEQEND\n\
    0\nELLIPSE\n10\n3\n20\n3\n11\n7\n21\n1\n40\n0.3\n41\n0.2\n42\n5\n210\n0.1\n220\n0.2\n230\n0.9\n\
    0\nSPLINE\n70\n4\n71\n2\n40\n0\n40\n0\n40\n0\n40\n1\n40\n1\n40\n1\n41\n1\n41\n0.7\n41\n1\n10\n10\n20\n0\n10\n10\n20\n10\n10\n0\n20\n10\n\
    0\nSPLINE\n70\n1\n71\n3\n74\n4\n11\n0\n21\n0\n11\n9\n21\n0\n11\n9\n21\n9\n11\n0\n21\n9\n0\nENDSEC\n0\nEOF\n";

/// Numbers that break things.
const NASTY: [&str; 14] = [
    "0",
    "-1",
    "1",
    "1e12",
    "-1e12",
    "1e-300",
    "nan",
    "inf",
    "1e999",
    "99999999999999999999",
    "32767",
    "",
    "0x10",
    "3.5",
];

/// The same text with one to four things wrong with it.
fn broken(text: &str, random: &mut Rand32) -> Vec<u8> {
    let mut lines: Vec<Vec<u8>> = text.lines().map(|l| l.as_bytes().to_vec()).collect();
    for _ in 0..random.rand_range(1..5) {
        if lines.is_empty() {
            break;
        }
        let at = random.rand_range(0..lines.len() as u32) as usize;
        let other = random.rand_range(0..lines.len() as u32) as usize;
        match random.rand_range(0..7) {
            0 => drop(lines.remove(at)),
            1 => lines.insert(at, lines[other].clone()),
            2 => lines.swap(at, other),
            3 => lines.truncate(at.max(1)),
            4 if !lines[at].is_empty() => {
                let byte = random.rand_range(0..lines[at].len() as u32) as usize;
                lines[at][byte] = random.rand_u32() as u8;
            }
            5 => {
                let (low, high) = (at.min(other), at.max(other));
                let copy = lines[low..high].to_vec();
                lines.splice(low..low, copy);
            }
            _ => lines[at] = NASTY[random.rand_range(0..NASTY.len() as u32) as usize].into(),
        }
    }
    lines.join(&b'\n')
}

fn check_sheet(sheet: &Sheet, bytes: &[u8]) {
    assert!(sheet.width > 0.0 && sheet.height > 0.0, "{} × {}", sheet.width, sheet.height);
    assert!(sheet.metres_per_unit.is_none_or(|m| m > 0.0 && m.is_finite()));
    assert!(!sheet.drawing.strokes.is_empty());
    for stroke in &sheet.drawing.strokes {
        let points = stroke.path.pieces().flat_map(|p| [p.from, p.at(0.5), p.end()]);
        for p in points {
            assert!(
                p.x.abs() <= 2.0 * MAX_COORDINATE && p.y.abs() <= 2.0 * MAX_COORDINATE,
                "{p:?} in\n{}",
                String::from_utf8_lossy(bytes)
            );
        }
    }
}

fn check(cases: u32, texts: &[String], read: impl Fn(&[u8]) -> Result<Sheet, FormatError>) {
    let mut random = Rand32::new(3);
    let mut sound = 0;
    for number in 0..cases {
        let bytes = broken(&texts[number as usize % texts.len()], &mut random);
        let began = Instant::now();
        if let Ok(sheet) = read(&bytes) {
            check_sheet(&sheet, &bytes);
            sound += 1;
        }
        let shown = || String::from_utf8_lossy(&bytes).into_owned();
        assert!(
            began.elapsed() < Duration::from_secs(2),
            "case {number} took {:?}:\n{}",
            began.elapsed(),
            shown()
        );
    }
    assert!((1..cases).contains(&sound), "{sound} of {cases} are readable: the mutations test nothing");
}

fn check_dxf(cases: u32) {
    let texts = [dxf::write(&plate(), 0.3, 0.2), OTHERS.to_owned()];
    texts.iter().for_each(|t| check_sheet(&dxf::read(t.as_bytes()).unwrap().sheet, t.as_bytes()));
    check(cases, &texts, |bytes| dxf::read(bytes).map(|r| r.sheet));
}

fn check_svg(cases: u32) {
    // a line an attribute, so that lines are what is broken
    let text = svg::write(&plate(), 0.3, 0.2).replace("\" ", "\"\n").replace('M', "\nM").replace('A', "\nA");
    check(cases, &[text], |bytes| svg::read(bytes).map(|r| r.sheet));
}

#[test]
fn a_broken_dxf_is_refused_or_sound() {
    check_dxf(3_000);
}

#[test]
fn a_broken_svg_is_refused_or_sound() {
    check_svg(1_000);
}

#[test]
#[ignore = "minutes: `bash .ci/run long`; its short twin always runs"]
fn very_many_broken_files_are_refused_or_sound() {
    check_dxf(1_000_000);
    check_svg(50_000);
}
