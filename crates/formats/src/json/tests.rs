use super::*;
use std::f64::consts::PI;

fn example() -> Traced {
    let mut curved = Path::new(Point::new(10.5, 20.25));
    curved.push(Element::Line { to: Point::new(30.0, 1.0 / 3.0) });
    curved.push(Element::Arc { centre: Point::new(30.0, 5.0), sweep: -PI });
    let end = curved.end();
    curved.push(Element::Cubic { c1: end, c2: Point::new(1.0, 2.0), to: Point::new(3.0, 4.0) });
    let square = [(0., 0.), (9., 0.), (9., 9.), (0., 9.)].map(Point::from);
    let square = polyline(&square, true).unwrap();
    let strokes = vec![
        Stroke {
            pen: Some(2.5),
            layer: Some("Lines & more".into()),
            colour: Some(Colour::new(200, 16, 46)),
            ..Stroke::new(curved)
        },
        Stroke { kind: StrokeKind::Outline, ..Stroke::new(square) },
    ];
    let sheet = Sheet::in_pixels(640.0, 480.0, Drawing { strokes });
    Traced { sheet, mode: "auto".into() }
}

#[test]
fn strokes_come_back_exactly_from_their_paths() {
    let json = write(&example(), 0.1);
    assert!(json.starts_with(
        "{\"width_px\":640,\"height_px\":480,\"mode\":\"auto\",\"strokes\":[{\"closed\":false,"
    ));
    assert_eq!(read(json.as_bytes()).unwrap(), example());
}

#[test]
fn points_alone_are_enough() {
    let json = r#"{"width_px":4,"height_px":3,"mode":"outline","author":"me","strokes":[
        {"closed":true,"kind":"outline","pen_px":null,"points":[[0,0],[1,0],[1,1]]},
        {"closed":false,"points":[[0,0],[2.5,1e0]]}]}"#;
    let drawing = read(json.as_bytes()).unwrap().sheet.drawing;
    assert!(drawing.strokes[0].path.is_closed());
    assert_eq!(drawing.strokes[0].kind, StrokeKind::Outline);
    assert_eq!(drawing.strokes[1].path.end(), Point::new(2.5, 1.0));
}

#[test]
fn points_and_path_tell_the_same_line() {
    let json = write(&example(), 0.01);
    let mut plain: serde_json::Value = serde_json::from_str(&json).unwrap();
    for stroke in plain["strokes"].as_array_mut().unwrap() {
        stroke.as_object_mut().unwrap().remove("path");
    }
    let from_points = read(plain.to_string().as_bytes()).unwrap().sheet.drawing;
    let lines: Vec<_> = from_points.strokes.iter().map(|s| s.path.flatten(1.0)).collect();
    let same = tracelight_stroke::compare(&lines, &example().sheet.drawing, 0.02).unwrap();
    assert!(same.max < 0.011 && same.coverage == 1.0, "{same:?}");
}

#[test]
fn broken_json_is_refused_with_its_place() {
    let check = |json: &str, message: &str| {
        let found = read(json.as_bytes()).unwrap_err().to_string();
        assert!(found.contains(message), "{json}: {found}");
    };
    let one = |stroke: &str| format!(r#"{{"width_px":4,"height_px":3,"mode":"auto","strokes":[{stroke}]}}"#);
    check("", "line 1, column 0");
    check("{\"width_px\":4,\n\"height_px\":", "line 2");
    check(&one(""), "nothing to draw");
    check(&"[".repeat(100_000), "line 1");
    check(&one(&"[".repeat(100_000)), "line 1");
    check(r#"{"width_px":0,"height_px":3,"mode":"","strokes":[]}"#, "two positive numbers");
    check(&one(r#"{"closed":false,"points":[[0,0]]}"#), "strokes[0]: points is a list of 1");
    check(&one(r#"{"closed":false,"points":[[0,0],[0,NaN]]}"#), "line 1");
    check(&one(r#"{"closed":false,"points":[[0,0],[0,1e308]]}"#), "lies beyond");
    check(&one(r#"{"closed":false,"points":[[0,0],[0,1e999]]}"#), "out of range");
    check(&one(r#"{"closed":false,"points":[[0,0],[0,0,0]]}"#), "line 1");
    check(&one(r#"{"closed":false,"points":[[0,0],[1,1]],"pen_px":-1}"#), "pen_px is -1");
    check(&one(r#"{"closed":false,"path":{"start":[0,0],"elements":[]}}"#), "path.elements is a list of 0");
    check(&one(r#"{"closed":false,"path":{"start":[0,0],"elements":[{"spiral":[1,1]}]}}"#), "spiral");
    let arc = |sweep: &str| {
        one(&format!(
            r#"{{"closed":false,"path":{{"start":[0,0],"elements":[{{"arc":{{"centre":[1,0],"sweep_rad":{sweep}}}}}]}}}}"#
        ))
    };
    check(&arc("1e9"), "sweep_rad is 1000000000, expected an angle up to one turn");
    assert!(read(arc("6.2832").as_bytes()).is_ok());
    let whole = write(&example(), 0.1);
    for cut in 0..whole.len() {
        assert!(read(&whole.as_bytes()[..cut]).is_err());
    }
    assert!(matches!(read(&vec![b' '; crate::MAX_BYTES + 1]), Err(FormatError::TooLarge { .. })));
}

#[test]
fn every_bit_of_a_number_comes_back() {
    let x = 0.003_711_742_597_104_224_2; // the quick way to read numbers is one bit off here
    let path = Path::polyline(&[Point::ORIGIN, Point::new(x, 1.0)], false).unwrap();
    let sheet = Sheet::in_pixels(1.0, 1.0, Drawing { strokes: vec![Stroke::new(path)] });
    let traced = Traced { sheet, mode: "auto".into() };
    assert_eq!(read(write(&traced, 0.1).as_bytes()).unwrap(), traced);
}
