//! Pages are printed, stuck on a simulated wall and seen by a simulated camera; the program finds the wall to where it is.

use std::path::Path;

use resvg::{tiny_skia, usvg};
use serde_json::Value;
use tracelight_aim::{Camera, CameraPose, Lens};
use tracelight_maths::planar;
use tracelight_plant::{CameraConfig, Image, Poster, SimulatedCamera, Wall};
use tracelight_stroke::{Affine, Point, Vec2};

use crate::support::{folder, near, run};

/// Dots of a printer a millimetre.
const DOTS: f64 = 4.0;

fn lens() -> Lens {
    Lens { radial: [-0.1, 0.01, 0.0], centre_px: Point::new(648.0, 355.0), ..Lens::ideal(1280, 720, 1000.0) }
}

/// Where pages are stuck: their middles, m, and how they are turned.
const PLACES: [(f64, f64, f64); 4] =
    [(-0.4, 0.16, 1.6), (0.4, 0.17, 1.5), (0.41, -0.16, -1.6), (-0.39, -0.17, 0.02)];

/// A page as the program prints it, `scale` times as large as meant, on the wall.
fn stuck(dir: &Path, page: usize, scale: f64) -> Poster {
    let file = dir.join(format!("page{page}.svg"));
    let number = (page + 1).to_string();
    let printed = run(&["calibrate", "sheet", "-o", file.to_str().unwrap(), "--first", &number]);
    assert!(printed.status.success(), "{}", String::from_utf8_lossy(&printed.stderr));
    let tree = usvg::Tree::from_data(&std::fs::read(&file).unwrap(), &usvg::Options::default()).unwrap();
    // 210 × 297 mm at 96 px an inch
    let zoom = (DOTS * 25.4 / 96.0) as f32;
    let (width, height) = ((210.0 * DOTS) as u32, (297.0 * DOTS) as u32);
    let mut map = tiny_skia::Pixmap::new(width, height).unwrap();
    resvg::render(&tree, tiny_skia::Transform::from_scale(zoom, zoom), &mut map.as_mut());
    // a printer's white is no light, nor is its black none
    let ink = |v: u8| 25 + (u32::from(v) * 215 / 255) as u8;
    let dots: Vec<[u8; 3]> =
        map.pixels().iter().map(|p| [ink(p.red()), ink(p.green()), ink(p.blue())]).collect();
    // markers are 13 mm from the upper edge, 232 mm high, in the middle across
    let dot = 1e-3 * scale / DOTS;
    let page_from_dot = Affine::scale_non_uniform(dot, -dot)
        .then_translate(Vec2::new(-0.105 * scale, 1e-3 * scale * (13.0 + 116.0)));
    let (x, y, turn_rad) = PLACES[page];
    let wall_from_page = planar::rotation(turn_rad).then_translate(Vec2::new(x, y));
    Poster::new(width as usize, &dots, wall_from_page * page_from_dot).unwrap()
}

fn wall(dir: &Path, pages: &[usize], scale: f64) -> Wall {
    Wall { plain: [0.5, 0.5, 0.48], posters: pages.iter().map(|&page| stuck(dir, page, scale)).collect() }
}

fn looking(from_m: [f64; 3]) -> Camera {
    Camera { lens: lens(), pose: CameraPose::looking_at(from_m, [0.0; 3]).unwrap() }
}

/// What the camera sees, as a file.
fn taken(dir: &Path, name: &str, camera: &Camera, wall: &Wall, seed: u64) -> String {
    let config = CameraConfig::webcam();
    let image =
        SimulatedCamera::new(&config, camera, wall, seed).expose(0.0, 0.9 * config.sensor.reference_s, &[]);
    let path = dir.join(name);
    save(&path, &image);
    path.to_str().unwrap().to_owned()
}

fn save(path: &Path, image: &Image) {
    let file = std::io::BufWriter::new(std::fs::File::create(path).unwrap());
    let mut encoder = png::Encoder::new(file, image.width as u32, image.height as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.write_header().unwrap().write_image_data(&image.rgb).unwrap();
}

fn calibrate(arguments: &[&str]) -> Value {
    let output = run(&[&["calibrate"], arguments, &["--json"]].concat());
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

fn numbers<const N: usize>(value: &Value) -> [f64; N] {
    std::array::from_fn(|k| value[k].as_f64().unwrap())
}

/// The camera that the program found.
fn found(told: &Value) -> Camera {
    let (lens, pose) = (&told["lens"], &told["pose"]);
    let [x, y] = numbers(&lens["centre_px"]);
    let lens = Lens {
        size_px: [1280, 720],
        focal_px: numbers(&lens["focal_px"]),
        centre_px: Point::new(x, y),
        radial: numbers(&lens["radial"]),
        tangential: numbers(&lens["tangential"]),
    };
    Camera { lens, pose: CameraPose::new(numbers(&pose["turn_rad"]), numbers(&pose["translation_m"])) }
}

/// How far points of the wall between the pages are off by the camera that was found, m: root of the mean square.
fn off_m(told: &Value, truth: &Camera, first: usize, scale: f64) -> f64 {
    let camera = found(told);
    let (x, y, turn_rad) = PLACES[first];
    let wall_from_first = planar::rotation(turn_rad).then_translate(Vec2::new(x, y));
    let square = |k: i32| {
        let on_wall = Point::new(0.06 * f64::from(k % 11 - 5), 0.06 * f64::from(k / 11 - 2));
        // the program believes the pages are as meant
        let seen = camera.target(truth.pixel(on_wall).unwrap()).unwrap();
        let by = wall_from_first * Point::new(seen.x * scale, seen.y * scale);
        by.distance_squared(on_wall)
    };
    ((0..55).map(square).sum::<f64>() / 55.0).sqrt()
}

#[test]
fn a_wall_with_printed_pages_is_found_to_a_tenth_of_a_millimetre() {
    let dir = folder("calibrate-markers");
    let wall = wall(&dir, &[0, 1, 2, 3], 1.0);
    let out = dir.join("camera.toml");
    for (seed, from_m) in [(1, [0.5, -0.2, 1.1]), (2, [-0.1, 0.15, 1.25])] {
        let truth = looking(from_m);
        let image = taken(&dir, &format!("{seed}.png"), &truth, &wall, seed);
        let told = calibrate(&["markers", &image, "-o", out.to_str().unwrap()]);
        assert!(told["markers"].as_u64().unwrap() >= 79, "{}", told["markers"]);
        let off_m = off_m(&told, &truth, 0, 1.0);
        assert!(off_m < 1e-4, "{} mm", 1e3 * off_m);
        let known_mm = told["wall_mm"]["between_pages"].as_f64().unwrap();
        assert!(1e3 * off_m < 3.0 * known_mm && known_mm < 0.1, "{off_m} m off and {known_mm} mm told");
        for (page, (x, y, turn_rad)) in PLACES.into_iter().enumerate() {
            let (fx, fy, f_rad) = PLACES[0];
            let from_first = planar::rotation(-f_rad) * Point::new(x - fx, y - fy);
            near(&told["pages"][page]["middle_m"][0], from_first.x, 3e-4);
            near(&told["pages"][page]["middle_m"][1], from_first.y, 3e-4);
            let turned = told["pages"][page]["turn_rad"].as_f64().unwrap() - (turn_rad - f_rad);
            assert!(
                turned.sin().abs() < 1e-3 && turned.cos() > 0.0,
                "page {page} is turned by {turned} rad more"
            );
        }
    }
}

#[test]
fn a_print_that_came_out_small_is_put_right_by_its_bar() {
    let dir = folder("calibrate-bar");
    let truth = looking([0.2, -0.1, 1.2]);
    let image = taken(&dir, "wall.png", &truth, &wall(&dir, &[0, 1, 2, 3], 0.97), 3);
    let out = dir.join("camera.toml");
    let told = calibrate(&["markers", &image, "--bar", "145.5mm", "-o", out.to_str().unwrap()]);
    assert!(off_m(&told, &truth, 0, 1.0) < 1.5e-4);
    let told = calibrate(&["markers", &image, "-o", out.to_str().unwrap()]);
    assert!(off_m(&told, &truth, 0, 1.0) > 5e-3, "3 % of half a metre");
    assert!(off_m(&told, &truth, 0, 0.97) < 1.5e-4);
}

#[test]
fn a_lens_found_from_several_sides_makes_one_page_enough() {
    let dir = folder("calibrate-lens");
    let all = wall(&dir, &[0, 1, 2, 3], 1.0);
    let places = [[0.0, 0.0, 1.25], [0.7, 0.1, 1.1], [-0.7, -0.1, 1.1], [0.0, 0.6, 1.1], [0.1, -0.6, 1.15]];
    let images: Vec<String> =
        (0..5).map(|k| taken(&dir, &format!("{k}.png"), &looking(places[k]), &all, k as u64)).collect();
    let lens_file = dir.join("lens.toml");
    let lens_file = lens_file.to_str().unwrap();
    let names: Vec<&str> = images.iter().map(String::as_str).collect();
    let told = calibrate(&[&["lens"], names.as_slice(), &["-o", lens_file]].concat());
    near(&told["lens"]["focal_px"][0], 1000.0, 2.0);
    near(&told["lens"]["centre_px"][0], 648.0, 2.0);
    near(&told["lens"]["radial"][0], -0.1, 5e-3);
    // one page in the corner, and half a metre from it the wall is known to half a millimetre
    let truth = looking([0.25, -0.1, 1.2]);
    let image = taken(&dir, "one.png", &truth, &wall(&dir, &[2], 1.0), 9);
    let out = dir.join("camera.toml");
    let known = calibrate(&["markers", &image, "--lens", lens_file, "-o", out.to_str().unwrap()]);
    let off = off_m(&known, &truth, 2, 1.0);
    assert!(off < 6e-4, "{} mm", 1e3 * off);
    // somebody zoomed since: it is seen
    let zoomed = dir.join("zoomed.toml");
    let text = std::fs::read_to_string(lens_file).unwrap();
    let line = text.lines().find(|line| line.starts_with("focal_px")).unwrap();
    std::fs::write(&zoomed, text.replace(line, "focal_px = [1150.0, 1150.0]")).unwrap();
    let image = taken(&dir, "four.png", &truth, &all, 10);
    let doubtful =
        calibrate(&["markers", &image, "--lens", zoomed.to_str().unwrap(), "-o", out.to_str().unwrap()]);
    assert!(
        doubtful["warnings"].as_array().unwrap().iter().any(|w| w.as_str().unwrap().contains("zoomed")),
        "{}",
        doubtful["warnings"]
    );
    assert_eq!(known["warnings"].as_array().unwrap().len(), 0, "{}", known["warnings"]);
    // a lens of another size of image
    let small = dir.join("small.toml");
    std::fs::write(&small, std::fs::read_to_string(lens_file).unwrap().replace("[1280, 720]", "[640, 480]"))
        .unwrap();
    let refused = run(&["calibrate", "markers", &image, "--lens", small.to_str().unwrap()]);
    assert_eq!(refused.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&refused.stderr).contains("1280 × 720 px, not 640 × 480"));
}

#[test]
fn what_is_no_calibration_says_why() {
    let dir = folder("calibrate-refused");
    let file = |name: &str, text: &str| {
        let path = dir.join(name);
        std::fs::write(&path, text).unwrap();
        path.to_str().unwrap().to_owned()
    };
    let check = |arguments: &[&str], code: i32, what: &str| {
        let output = run(&[&["calibrate"], arguments].concat());
        let message = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(code), "{arguments:?}: {message}");
        assert!(message.contains(what), "{arguments:?}: {message}");
    };
    let star = "examples/star.png";
    check(&["markers", star], 1, "shows no marker");
    check(&["markers", star, "--bar", "4mm"], 2, "--bar");
    check(&["lens", star, star], 2, "at least 3");
    check(&["markers", star, "--lens", &file("a.toml", "[lens]\nsize_px = 3\n")], 2, "no camera file");
    let lens = "date = \"2026-01-01\"\n[lens]\nsize_px = [640, 480]\nfocal_px = [0.0, 1.0]\ncentre_px = [1.0, 1.0]\nradial = [0.0, 0.0, 0.0]\n\
                tangential = [0.0, 0.0]\ncovariance = []\n[score]\nrms_px = 0.1\nplaces = 3\nprint_scale = 1.0\n";
    check(&["markers", star, "--lens", &file("b.toml", lens)], 2, "lens.focal_px");
    check(
        &["markers", star, "--lens", &file("c.toml", &lens.replace("[0.0, 1.0]", "[500.0, 500.0]"))],
        2,
        "lens.covariance",
    );
    let known = lens.replace("[0.0, 1.0]", "[500.0, 500.0]");
    for (from, to, what) in [
        ("centre_px = [1.0, 1.0]", "centre_px = [nan, 1.0]", "lens.centre_px"),
        ("radial = [0.0, 0.0, 0.0]", "radial = [inf, 0.0, 0.0]", "lens.radial"),
        ("tangential = [0.0, 0.0]", "tangential = [1e300, 0.0]", "lens.tangential"),
        ("focal_px = [500.0, 500.0]", "focal_px = [500.0, 5.0]", "twice as long"),
    ] {
        check(&["markers", star, "--lens", &file("d.toml", &known.replace(from, to))], 2, what);
    }
    // a pose without its covariance, and a page of no board
    let pose =
        "[pose]\nturn_rad = [0.0, 0.0, 9.0]\ntranslation_m = [0.0, 0.0, 1.0]\ncovariance = []\n[score]";
    let sure = (0..9).map(|i| {
        format!("[{}]", (0..9).map(|k| if i == k { "1.0" } else { "0.0" }).collect::<Vec<_>>().join(", "))
    });
    let sure =
        known.replace("covariance = []", &format!("covariance = [{}]", sure.collect::<Vec<_>>().join(", ")));
    let posed = sure.replace("[score]", pose);
    check(&["markers", star, "--lens", &file("e.toml", &posed)], 2, "pose: no camera stands at");
    check(
        &["markers", star, "--lens", &file("f.toml", &posed.replace("9.0]", "1.0]"))],
        2,
        "pose.covariance",
    );
    let page = "\n[[pages]]\nboard = \"large\"\npage = 1\nmiddle_m = [0.0, 0.0]\nturn_rad = 0.0\n";
    check(
        &["markers", star, "--lens", &file("g.toml", &(sure.clone() + page))],
        2,
        "a page is of the board fine or coarse",
    );

    let out = dir.join("page");
    let name = |extension: &str| format!("{}.{extension}", out.display());
    check(&["sheet", "-o", &name("png")], 2, ".pdf or .svg");
    check(&["sheet", "-o", &name("svg"), "--pages", "2"], 2, "an SVG holds one page");
    check(&["sheet", "-o", &name("pdf"), "--first", "24", "--pages", "4"], 2, "page 27");
    check(&["sheet", "-o", &name("pdf"), "--first", "26", "--pages", "1"], 2, "1 to 24");
}
