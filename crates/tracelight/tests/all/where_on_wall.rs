//! Where on the wall a drawing goes: marks, edges, no-go areas, the head's place.

use std::path::Path;

use serde_json::Value;

use crate::support::{folder, json, near, run, trace};

/// A plan of 2 × 1 m in millimetres: its frame, a circle in the middle, and a closed square on a layer of its own.
const PLAN: &str = "0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n4\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n\
    0\nLWPOLYLINE\n8\nWALL\n90\n4\n70\n1\n10\n0\n20\n0\n10\n2000\n20\n0\n10\n2000\n20\n1000\n10\n0\n20\n1000\n\
    0\nCIRCLE\n8\nSOCKETS\n10\n1000\n20\n500\n40\n100\n\
    0\nLWPOLYLINE\n8\nDOOR\n90\n4\n70\n1\n10\n1500\n20\n-50\n10\n1700\n20\n-50\n10\n1700\n20\n300\n10\n1500\n20\n300\n\
    0\nENDSEC\n0\nEOF\n";

fn plan_file(folder: &Path) -> String {
    let path = folder.join("plan.dxf");
    std::fs::write(&path, PLAN).unwrap();
    path.to_str().unwrap().to_owned()
}

fn plan(arguments: &[&str]) -> Value {
    json(&run(&[&["plan", "--json", "--quiet"], arguments].concat()))
}

/// What a command is refused with, and its exit status.
fn refused(arguments: &[&str]) -> (i32, String) {
    let output = run(arguments);
    (output.status.code().unwrap(), String::from_utf8_lossy(&output.stderr).into_owned())
}

/// Points of strokes written as CSV, m.
fn points(arguments: &[&str], folder: &Path) -> Vec<(f64, f64)> {
    let out = folder.join("out.csv").to_str().unwrap().to_owned();
    let output = run(&[&["strokes", "--quiet", "-o", &out], arguments].concat());
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    let text = std::fs::read_to_string(out).unwrap();
    let row = |line: &str| {
        let fields: Vec<f64> = line.split(',').map(|field| field.parse().unwrap()).collect();
        (fields[1], fields[2])
    };
    text.lines().skip(1).map(row).collect()
}

/// Lowest and highest x, lowest and highest y, m.
fn bounds(points: &[(f64, f64)]) -> [f64; 4] {
    let fold =
        |of: fn(&(f64, f64)) -> f64, best: fn(f64, f64) -> f64| points.iter().map(of).reduce(best).unwrap();
    [fold(|p| p.0, f64::min), fold(|p| p.0, f64::max), fold(|p| p.1, f64::min), fold(|p| p.1, f64::max)]
}

fn check(found: [f64; 4], wanted: [f64; 4]) {
    for (a, b) in found.into_iter().zip(wanted) {
        assert!((a - b).abs() < 2e-4, "{found:?}, not {wanted:?}");
    }
}

#[test]
fn marks_put_a_plan_where_the_crosses_are() {
    let folder = folder("where-marks");
    let file = plan_file(&folder);
    let layer = ["--layer", "WALL"];
    let of = |marks: &[&str]| {
        let flags: Vec<&str> = marks.iter().flat_map(|mark| ["--align", mark]).chain(layer).collect();
        bounds(&points(&[&[file.as_str()], flags.as_slice()].concat(), &folder))
    };
    check(of(&["0mm,0mm=-0.4m,0.1m"]), [-0.4, 1.6, 0.1, 1.1]);
    // half as large, turned by a quarter
    check(of(&["0mm,0mm=0.5m,0m", "2m,0m=0.5m,1m"]), [0.0, 0.5, 0.0, 1.0]);
    // all of it in one flag; skewed, then with keystone
    check(of(&["0m,0m=0m,0m 2m,0m=1m,0.2m 0m,1m=0m,1m"]), [0.0, 1.0, 0.0, 1.2]);
    check(of(&["0m,0m=0m,0m 2m,0m=1m,0m 2m,1m=1m,0.9m 0m,1m=0m,0.6m"]), [0.0, 1.0, 0.0, 0.9]);
}

#[test]
fn residuals_and_what_is_wrong_with_marks_are_told() {
    let folder = folder("where-residual");
    let file = plan_file(&folder);
    let told = plan(&[&file, "--align", "0mm,0mm=-0.8m,-0.4m 2m,0m=1.202m,-0.4m", "--distance", "3m"]);
    near(&told["align"]["further_apart_mm"], 2.0, 1e-6);
    near(&told["align"]["larger_percent"], 0.1, 1e-6);
    assert_eq!(told["align"]["by"], "similarity");
    // with a size two marks check it
    let told = plan(&[
        &file,
        "--width",
        "2m",
        "--layer",
        "WALL",
        "--align",
        "0mm,0mm=-0.8m,-0.4m 2m,0m=1.202m,-0.4m",
        "--distance",
        "3m",
    ]);
    near(&told["align"]["rms_mm"], 1.0, 1e-6);
    // a fifth mark read 2 cm wrongly is named
    let told = plan(&[
        &file,
        "--distance",
        "3m",
        "--align",
        "0m,0m=-1m,-0.5m 2m,0m=1m,-0.5m 2m,1m=1m,0.5m 0m,1m=-1m,0.5m 1m,0.5m=0m,0.02m 0m,0.5m=-1m,0m 2m,0.5m=1m,0m",
    ]);
    assert_eq!(told["align"]["worst"], 5);
    let check = |marks: &str, said: &str| {
        let (status, message) = refused(&["plan", &file, "--align", marks]);
        assert!(status == 2 && message.contains(said), "{marks}: {status} {message}");
    };
    check("0m,0m=0m,0m 1mm,0m=1m,0m", "too near each other");
    check("0m,0m=0m,0m 1m,0m=1m,0m 2m,0m=2m,0m", "on one line");
    check("0m,0m=0m,0m 2m,0m=-1m,0m 0m,1m=0m,1m", "mirror");
    check("5px,5px=0m,0m", "no pixels");
    check("0,0=0m,0m", "no unit");
    let (status, message) = refused(&["plan", &file, "--align", "0m,0m=0m,0m", "--offset", "1m,0m"]);
    assert!(status == 2 && message.contains("leave one of them out"), "{message}");
    let (status, message) = refused(&["strokes", &file, "--align", "0m,0m=1deg,0deg"]);
    assert!(status == 2 && message.contains("no head"), "{message}");
}

#[test]
fn a_mark_may_be_where_the_dot_of_the_head_is() {
    let folder = folder("where-angles");
    let file = plan_file(&folder);
    let by_angles = plan(&[
        &file,
        "--distance",
        "2m",
        "--align",
        "0m,0m=26.56505117707799deg,0deg 2m,0m=-26.56505117707799deg,0deg",
    ]);
    near(&by_angles["align"]["larger_percent"], 0.0, 1e-6);
    near(&by_angles["align"]["turn_deg"], 0.0, 1e-6);
}

#[test]
fn offsets_go_from_the_edges_of_the_wall_to_the_same_corner_of_the_drawing() {
    let folder = folder("where-edges");
    let file = plan_file(&folder);
    let of = |flags: &[&str]| {
        bounds(&points(&[&[file.as_str(), "--layer", "WALL", "--fit", "drawing"], flags].concat(), &folder))
    };
    let origin = ["--origin", "-1.5m,-1.2m"];
    check(
        of(&[&["--from", "bottom-left", "--offset", "0.4m,0.1m"], origin.as_slice()].concat()),
        [-1.1, 0.9, -1.1, -0.1],
    );
    check(
        of(&["--from", "top-right", "--origin", "1.5m,1.2m", "--offset", "0.4m,0.1m"]),
        [-0.9, 1.1, 0.1, 1.1],
    );
    check(of(&["--from", "centre", "--offset", "0.4m,0.1m"]), [-0.6, 1.4, -0.4, 0.6]);
    let (_, said) = refused(&["strokes", &file, "--from", "bottom-left"]);
    assert!(said.contains("--origin tells it"), "{said}");
}

#[test]
fn a_width_is_the_pages_or_the_drawings() {
    let folder = folder("where-fit");
    let path = folder.join("page.svg");
    let svg = "<svg xmlns='http://www.w3.org/2000/svg' width='400' height='200'><rect x='100' y='50' width='200' height='100' fill='none' stroke='black'/></svg>";
    std::fs::write(&path, svg).unwrap();
    let file = path.to_str().unwrap();
    check(bounds(&points(&[file, "--width", "1m"], &folder)), [-0.25, 0.25, -0.125, 0.125]);
    check(bounds(&points(&[file, "--width", "1m", "--fit", "drawing"], &folder)), [-0.5, 0.5, -0.25, 0.25]);
}

#[test]
fn no_light_falls_on_what_is_no_go() {
    let folder = folder("where-no-go");
    let file = plan_file(&folder);
    let out = folder.join("run");
    let summary =
        trace(&[&file, "--distance", "2m", "--no-go", "DOOR", "--no-go", "-0.2m,0.4m,0.4m,0.3m"], &out);
    assert_eq!(summary["no_go"]["areas"], 2);
    // the frame goes through the door for 0.2 m, and through the area for 0.4 m; and the spot's radius at both ends of both
    let margin_m = 1e-3 * summary["no_go"]["margin_mm"].as_f64().unwrap();
    near(&summary["no_go"]["length_m"], 0.6 + 4.0 * margin_m, 1e-4);
    // the drawing's middle, 1000 mm and 475 mm, is the target's
    let is_dark = |x: f64, y: f64| {
        let door = (0.5..0.7).contains(&x) && (-0.525..-0.175).contains(&y);
        let area = (-0.2..0.2).contains(&x) && (0.4..0.7).contains(&y);
        door || area
    };
    let lit: Vec<_> = crate::support::rows(&out).into_iter().filter(|row| row.lit).collect();
    assert!(lit.len() > 1000 && lit.iter().all(|row| !is_dark(row.spot.x, row.spot.y)));
    let (status, message) = refused(&["plan", &file, "--no-go", "WINDOW"]);
    assert!(status == 1 && message.contains("there are: WALL, SOCKETS, DOOR"), "{message}");
    let (status, message) = refused(&["plan", &file, "--no-go", "-9m,-9m,18m,18m"]);
    assert!(status == 1 && message.contains("all of the drawing"), "{message}");
}

/// A corner of what `plan` tells of a sheet, as a mark that belongs where it lies already.
fn told_mark(sheet: &Value, corner: usize) -> String {
    let (at, on) = (&sheet["corners"][corner], &sheet["target_m"][corner]);
    let unit = sheet["unit"].as_str().unwrap();
    format!("{}{unit},{}{unit}={}m,{}m", at[0], at[1], on[0], on[1])
}

#[test]
fn places_of_a_sheet_are_told_as_marks_name_them() {
    let folder = folder("where-sheet");
    let dxf = plan_file(&folder);
    // of a sheet at a slant its corners are named in the photograph
    let photo = crate::paper::photograph("where-photo", 1.6e-3);
    let svg = "examples/sign.svg";
    let house = "examples/house.png";
    for (file, flags) in [
        (dxf.as_str(), &["--rotate", "20deg", "--offset", "0.3m,-0.2m", "--distance", "3m"][..]),
        (photo.to_str().unwrap(), &["--width", "0.5m", "--rotate", "-10deg"]),
        (svg, &["--width", "0.4m", "--flip"]),
        (house, &["--width", "0.4m", "--from", "top-left", "--origin", "-0.3m,0.3m"]),
    ] {
        let told = plan(&[&[file], flags].concat());
        let sheet = &told["sheet"];
        let marks: Vec<String> = (0..3).map(|corner| told_mark(sheet, corner)).collect();
        let flips = flags.contains(&"--flip").then_some("--flip");
        let distance = flags.contains(&"--distance").then_some(["--distance", "3m"]);
        let mut again: Vec<&str> = vec![file];
        again.extend(flips);
        again.extend(distance.iter().flatten());
        again.extend(marks.iter().flat_map(|mark| ["--align", mark]));
        let marked = plan(&again);
        for corner in 0..4 {
            for axis in 0..2 {
                let wanted = sheet["target_m"][corner][axis].as_f64().unwrap();
                near(&marked["sheet"]["target_m"][corner][axis], wanted, 1e-5);
            }
        }
        near(&marked["align"]["rms_mm"], 0.0, 1e-3);
    }
    assert_eq!(plan(&[&dxf])["sheet"]["unit_guessed"], false);
    assert_eq!(plan(&[&dxf])["sheet"]["picture_px"], Value::Null);
    let nameless = folder.join("nameless.dxf");
    std::fs::write(&nameless, PLAN.replace("9\n$INSUNITS\n70\n4\n", "")).unwrap();
    let nameless = nameless.to_str().unwrap();
    assert_eq!(plan(&[nameless])["sheet"]["unit_guessed"], true);
    assert_eq!(plan(&[nameless, "--unit", "mm"])["sheet"]["unit_guessed"], false);
    // a door that nobody draws, and where it is
    let dark = plan(&[&dxf, "--no-go", "DOOR"]);
    let outline = dark["no_go"]["outlines_m"][0].as_array().unwrap();
    assert_eq!(outline.len(), 5, "{outline:?}");
    assert!(outline.iter().all(|at| (0.49..0.71).contains(&at[0].as_f64().unwrap())), "{outline:?}");
}

#[test]
fn who_says_how_far_the_head_stands_is_told_and_from_where_it_is_best() {
    let folder = folder("where-distance");
    let file = plan_file(&folder);
    let assumed = plan(&[&file]);
    assert_eq!(assumed["head"]["from"], "assumed");
    near(&assumed["head"]["distance_m"], 0.9144, 1e-9);
    let best = assumed["head"]["best_distance_m"].as_f64().unwrap();
    let told = plan(&[&file, "--distance", &format!("{best}m")]);
    assert_eq!(told["head"]["from"], "asked");
    assert!((29.0..=30.0).contains(&told["head"]["largest_angle_deg"].as_f64().unwrap()), "{}", told["head"]);
    let output = run(&["plan", &file]);
    assert!(String::from_utf8_lossy(&output.stdout).contains("assumed, --distance tells it"));
}

#[test]
fn corners_of_a_rectangle_tell_where_the_head_stands_and_a_drawing_goes_by_them() {
    let folder = folder("where-corners");
    let file = plan_file(&folder);
    let head = folder.join("head.toml").to_str().unwrap().to_owned();
    for seed in ["0", "1", "2", "3", "4"] {
        let found = json(&run(&[
            "calibrate",
            "corners",
            "--size",
            "2.4m,1.2m",
            "--simulate",
            "--seed",
            seed,
            "-o",
            &head,
            "--json",
        ]));
        let rms = found["truth"]["rms_mm"].as_f64().unwrap();
        assert!(rms < 4.0, "seed {seed}: {rms} mm");
        let (told, truth) = (&found["pose"]["distance_m"], &found["truth"]["pose"]["distance_m"]);
        near(told, truth.as_f64().unwrap(), 4.0 * found["deviation"]["distance_m"].as_f64().unwrap());
    }
    let asked = [
        &file,
        "--layer",
        "WALL",
        "--fit",
        "drawing",
        "--head",
        &head,
        "--from",
        "bottom-left",
        "--offset",
        "20cm,10cm",
    ];
    let used = plan(&asked);
    assert_eq!(used["head"]["from"], "file");
    // the rectangle's edges are the wall's: nobody has to say where they are
    let drawn = trace(&asked, &folder.join("run"));
    assert!(drawn["run"]["finished"] == true, "{drawn}");
    let spots: Vec<(f64, f64)> = crate::support::rows(&folder.join("run"))
        .iter()
        .filter(|row| row.lit)
        .map(|row| (row.spot.x, row.spot.y))
        .collect();
    let [left, right, low, high] = bounds(&spots);
    for (found, wanted) in [(left, -1.0), (right, 1.0), (low, -0.5), (high, 0.5)] {
        assert!((found - wanted).abs() < 2e-3, "{found} {wanted}");
    }
}

#[test]
fn angles_are_told_by_flags_or_by_a_file_and_wrong_ones_are_refused() {
    let folder = folder("where-angles-file");
    let head = folder.join("head.toml").to_str().unwrap().to_owned();
    let csv = folder.join("angles.csv");
    // 2 m before the middle of 2 m × 1 m
    let pan = 26.565_051_177_077_99_f64;
    let tilt = (0.5_f64 * pan.to_radians().cos() / 2.0).atan().to_degrees();
    let rows = [
        ("bottom-left", pan, tilt),
        ("bottom-right", -pan, tilt),
        ("top-right", -pan, -tilt),
        ("top-left", pan, -tilt),
    ];
    let line = |(name, pan, tilt): &(&str, f64, f64)| format!("{name},{pan}deg,{tilt}deg\n");
    std::fs::write(&csv, format!("corner,pan,tilt\n{}", rows.iter().map(line).collect::<String>())).unwrap();
    let by_file =
        ["calibrate", "corners", "--size", "2m,1m", "--angles", csv.to_str().unwrap(), "-o", &head, "--json"];
    let found = json(&run(&by_file));
    near(&found["pose"]["distance_m"], 2.0, 1e-6);
    near(&found["pose"]["yaw_rad"], 0.0, 1e-6);
    let wrong = |by: fn(&mut Vec<String>), said: &str| {
        let mut flags: Vec<String> =
            ["calibrate", "corners", "--size", "2m,1m", "-o", &head].map(str::to_owned).into();
        flags.extend(
            rows.iter().flat_map(|(name, pan, tilt)| [format!("--{name}"), format!("{pan}deg,{tilt}deg")]),
        );
        by(&mut flags);
        let flags: Vec<&str> = flags.iter().map(String::as_str).collect();
        let (status, message) = refused(&flags);
        assert!(status > 0 && message.contains(said), "{status} {message}");
    };
    wrong(|flags| flags.truncate(12), "--top-left is missing");
    wrong(|flags| flags.swap(7, 9), "cross over");
    let mirrored = |flags: &mut Vec<String>| {
        flags.swap(7, 9);
        flags.swap(11, 13);
    };
    wrong(mirrored, "go round the other way");
    wrong(|flags| flags[3] = "1m,2m".to_owned(), "as high as you say it is wide");
    wrong(|flags| flags[7] = flags[9].clone(), "two of the corners are one");
    wrong(|flags| flags[3] = "3m,1m".to_owned(), "off, rms");
}
