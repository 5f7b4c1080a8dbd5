use super::*;
use crate::options::{LengthUnit, ReadOptions};

#[test]
fn the_unit_is_that_of_the_header() {
    let check = |header: &str, width_m: Option<f64>| {
        let line = "0 LINE, 10 1000000, 20 0, 11 1000002, 21 0";
        let text = section("HEADER", header) + &section("ENTITIES", line) + "0\nEOF\n";
        let sheet = reading(&text).sheet;
        let found = sheet.metres_per_unit.map(|m| m * sheet.width);
        let same = found.zip(width_m).is_some_and(|(a, b)| (a / b - 1.0).abs() < 1e-9) || found == width_m;
        assert!(same, "{header}: {found:?}");
        assert!((10.0..=crate::MAX_COORDINATE).contains(&sheet.width), "{header}: {}", sheet.width);
    };
    check("9 $INSUNITS, 70 4", Some(0.002));
    check("9 $INSUNITS, 70 6", Some(2.0));
    check("9 $INSUNITS, 70 1, 9 $MEASUREMENT, 70 1", Some(0.0508));
    check("9 $INSUNITS, 70 0, 9 $MEASUREMENT, 70 1", Some(0.002));
    check("9 $MEASUREMENT, 70 0", Some(0.002));
    check("9 $INSUNITS, 70 0", Some(0.002));
    check("9 $INSUNITS, 70 99", Some(0.002));
    check("9 $INSUNITS, 70 7", Some(2000.0));
    check("9 $ACADVER, 1 AC1009", Some(0.002));
}

/// A file with a rectangle of so many units.
fn plate(header: &str, [width, height]: [f64; 2]) -> String {
    let plate = format!(
        "0 LWPOLYLINE, 70 1, 10 0, 20 0, 10 {width}, 20 0, 10 {width}, 20 {height}, 10 0, 20 {height}"
    );
    section("HEADER", header) + &section("ENTITIES", &plate) + "0\nEOF\n"
}

#[test]
fn a_unit_that_nobody_tells_is_said_to_be_a_guess() {
    let found = reading(&plate("9 $MEASUREMENT, 70 0", [74.0, 60.5]));
    assert_eq!(
        found.remarks,
        ["the file names no unit: in millimetres it is 74 × 60.5 mm; --unit cm, m, in or ft if it is not"]
    );
    assert_eq!(found.doubt, None);
    assert!(reading(&plate("9 $INSUNITS, 70 1", [4.0, 3.0])).remarks.is_empty());
}

#[test]
fn the_unit_asked_for_rules() {
    let check = |header: &str, unit: LengthUnit, width_m: f64| {
        let options = ReadOptions { unit: Some(unit), ..ReadOptions::default() };
        let found = read_with(plate(header, [2000.0, 1000.0]).as_bytes(), &options).unwrap();
        let width = found.sheet.width * found.sheet.metres_per_unit.unwrap();
        assert!((width / width_m - 1.0).abs() < 1e-9, "{header}: {width}");
        assert!(found.remarks.is_empty() && found.doubt.is_none(), "{found:?}");
    };
    check("9 $INSUNITS, 70 6", LengthUnit::Millimetre, 2.0);
    check("9 $INSUNITS, 70 6", LengthUnit::Metre, 2000.0);
    check("9 $INSUNITS, 70 0", LengthUnit::Inch, 50.8);
    check("9 $INSUNITS, 70 4", LengthUnit::Foot, 609.6);
    check("9 $INSUNITS, 70 4", LengthUnit::Centimetre, 20.0);
}

#[test]
fn a_size_that_cannot_be_meant_is_doubted_with_the_unit_that_makes_sense() {
    let check = |header: &str, size: [f64; 2], said: &[&str]| {
        let doubt = reading(&plate(header, size)).doubt.unwrap_or_default();
        assert!(said.iter().all(|s| doubt.contains(s)) && doubt.is_empty() == said.is_empty(), "{doubt}");
    };
    check("9 $INSUNITS, 70 6", [2000.0, 900.0], &["2000 × 900 m", "--unit mm makes it 2000 × 900 mm"]);
    check("9 $INSUNITS, 70 0", [0.2, 0.1], &["no unit", "0.2 × 0.1 mm", "--unit m makes it 200 × 100 mm"]);
    check("9 $INSUNITS, 70 4", [1e7, 1e7], &["10 × 10 km", "say how large it is to be, --width"]);
    check("9 $INSUNITS, 70 6", [100.0, 9.0], &[]);
    check("9 $INSUNITS, 70 4", [1.0, 1.0], &[]);
    check("9 $INSUNITS, 70 4", [99_000.0, 1.0], &[]);
}
