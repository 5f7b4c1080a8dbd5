//! A camera looks, the head is found from dots, the figure is traced where it is seen: in simulated rooms whose truth the program tells.

use std::io::{Read, Write};
use std::net::{TcpListener, TcpStream};

use serde_json::Value;

use crate::support::{self, check_at_most, folder, json, run};

/// The folder that a test was given before, with what is in it.
fn folder_of(name: &str) -> std::path::PathBuf {
    std::path::PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name)
}

const HOUSE: &str = concat!("sim:", env!("CARGO_MANIFEST_DIR"), "/../../examples/house.png");

#[test]
fn a_webcam_finds_the_head_and_the_figure_and_the_light_is_on_it() {
    let dir = folder("camera-webcam");
    let [out, camera] = ["out", "camera.toml"].map(|name| dir.join(name).to_str().unwrap().to_owned());
    // where it stood is made two millimetres another, as if somebody had moved it since
    json(&run(&["calibrate", "markers", "--camera", HOUSE, "--seed", "7", "-o", &camera, "--json"]));
    let file = std::fs::read_to_string(&camera).unwrap();
    let first = file.split_once("translation_m = [").unwrap().1.split_once(',').unwrap().0.trim();
    let moved = first.parse::<f64>().unwrap() + 0.002;
    std::fs::write(&camera, file.replace(first, &moved.to_string())).unwrap();
    let output =
        run(&["trace", "--camera", HOUSE, "--seed", "7", "--calibration", &camera, "--out", &out, "--json"]);
    let summary = json(&output);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(said.contains("the camera moved 1.") || said.contains("the camera moved 2."), "{said}");
    check_at_most(&summary, "/camera/figure_mm/rms", 0.5);
    check_at_most(&summary, "/camera/figure_mm/p99", 1.5);
    check_at_most(&summary, "/camera/head/truth_rms_mm", 0.3);
    check_at_most(&summary, "/camera/head/truth_max_mm", 0.8);
    assert!(summary["camera"]["figure_mm"]["covered_share"].as_f64().unwrap() > 0.99, "{summary}");
    assert_eq!(summary["camera"]["markers"], 80);
    assert_eq!(summary["camera"]["head"]["dots"], 25);
    for file in ["report.html", "trace.png", "strokes.svg", "trace.csv", "run.mcap"] {
        assert!(dir.join("out").join(file).exists(), "{file}");
    }
}

#[test]
fn the_reports_camera_is_calibrated_first_and_a_known_head_draws_no_dots() {
    let dir = folder("camera-report");
    let [out, camera, head] =
        ["out", "camera.toml", "head.toml"].map(|name| dir.join(name).to_str().unwrap().to_owned());
    let report = ["--sim-camera", "report", "--seed", "3"];
    let with = |args: &[&'static str], more: &[&str]| {
        let all: Vec<String> = args.iter().chain(&report).chain(more).map(|s| (*s).to_owned()).collect();
        let all: Vec<&str> = all.iter().map(String::as_str).collect();
        run(&all)
    };
    let refused = with(&["trace", "--camera", HOUSE], &["--out", &out]);
    assert_eq!(refused.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&refused.stderr).contains("calibrate markers"), "says what to do");
    json(&with(&["calibrate", "markers", "--camera", "sim", "--json"], &["-o", &camera]));
    let found = json(&with(
        &["calibrate", "head", "--camera", "sim", "--json"],
        &["--calibration", &camera, "-o", &head],
    ));
    check_at_most(&found, "/truth_mm/rms", 0.5);
    check_at_most(&found, "/truth_mm/max", 1.2);
    // its rows are read one after the other in 25 ms, and its stamps are right; a spot's half millimetre is 6 ms of a dot
    assert!((found["images"]["readout_s"].as_f64().unwrap() - 0.025).abs() < 4e-3, "{found}");
    assert!(found["images"]["late_s"].as_f64().unwrap().abs() < 3e-3, "{found}");
    let traced = json(&with(
        &["trace", "--camera", HOUSE, "--json"],
        &["--calibration", &camera, "--head", &head, "--out", &out],
    ));
    check_at_most(&traced, "/camera/figure_mm/rms", 1.2);
    check_at_most(&traced, "/camera/figure_mm/p99", 3.0);
    assert_eq!(traced["camera"]["head"], Value::Null);
    assert_eq!(traced["camera"]["markers"], 0);
    // the head of one rig is not another's
    let other = with(
        &["trace", "--camera", HOUSE, "--rig", "worn"],
        &["--calibration", &camera, "--head", &head, "--out", &out],
    );
    assert_eq!(other.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&other.stderr).contains("it is of the rig report, and this is worn"));
}

/// A trace of the house in room 7, with more flags; its summary, and what was said.
fn traced(name: &str, more: &[&str]) -> (Value, String) {
    let dir = folder(name);
    let out = dir.join("out").to_str().unwrap().to_owned();
    let mut args = vec!["trace", "--camera", HOUSE, "--seed", "7", "--out", &out, "--json"];
    args.extend(more);
    let output = run(&args);
    for file in ["seen.csv", "seen.jpg", "report.html"] {
        assert!(dir.join("out").join(file).exists(), "{file}");
    }
    (json(&output), String::from_utf8_lossy(&output.stderr).into_owned())
}

#[test]
fn what_drifts_is_trimmed_through_the_camera() {
    let drift = ["--rig", "worn", "--sim-trouble", "drift=0.5@0"];
    let (closed, _) = traced("camera-drift", &drift);
    let (open, _) = traced("camera-drift-open", &[&drift[..], &["--open-loop"]].concat());
    check_at_most(&closed, "/camera/figure_mm/rms", 0.35);
    let rms = |summary: &Value| summary["camera"]["figure_mm"]["rms"].as_f64().unwrap();
    assert!(rms(&open) > 1.7 * rms(&closed), "{} {}", rms(&open), rms(&closed));
    check_at_most(&closed, "/camera/follow/off_mm/rms", 0.4);
    let scale = closed["camera"]["follow"]["trim"]["pan_scale_percent"].as_f64().unwrap();
    assert!((0.3..0.6).contains(&scale), "{scale}");
    assert_eq!(
        (&closed["camera"]["follow"]["closed"], &open["camera"]["follow"]["closed"]),
        (&true.into(), &false.into())
    );
}

#[test]
fn an_encoder_that_slips_and_a_camera_that_is_bumped_are_found_again_and_no_light_goes_astray() {
    for (trouble, why) in [
        ("pan-slip=20@6", "fault encoder-jumped: the head was found anew by 9 dots, its spot had moved by 2"),
        (
            "tilt-slip=-20@6",
            "fault encoder-jumped: the head was found anew by 9 dots, its spot had moved by 2",
        ),
        ("camera-bump=5@6", "the camera moved 5"),
    ] {
        let (found, said) = traced(&format!("camera-{}", &trouble[..8]), &["--sim-trouble", trouble]);
        assert!(said.contains(why), "{trouble}: {said}");
        assert_eq!(found["camera"]["follow"]["recoveries"].as_array().unwrap().len(), 1, "{trouble}");
        check_at_most(&found, "/tracking/off_stroke_max_mm", 3.0);
        check_at_most(&found, "/camera/figure_mm/rms", 0.5);
        assert!(found["camera"]["figure_mm"]["covered_share"].as_f64().unwrap() > 0.99, "{trouble}: {found}");
        assert_eq!(found["run"]["finished"], true);
    }
}

#[test]
fn a_head_that_is_bumped_is_dark_within_a_fifth_of_a_second_and_draws_on() {
    let (found, said) = traced("camera-head-bump", &["--sim-trouble", "head-bump=1@6"]);
    assert!(said.contains("the head was found anew by 9 dots, its spot had moved by 16"), "{said}");
    assert!(found["camera"]["figure_mm"]["covered_share"].as_f64().unwrap() > 0.99, "{found}");
    check_at_most(&found, "/camera/figure_mm/p99", 1.5);
    let table = std::fs::read_to_string(folder_of("camera-head-bump").join("out/trace.csv")).unwrap();
    let wrong = table.lines().skip(1).filter(|row| {
        let cells: Vec<&str> = row.split(',').collect();
        cells[3] == "1" && cells[15].parse::<f64>().is_ok_and(|mm| mm > 3.0)
    });
    let ticks = wrong.count();
    assert!((1..200).contains(&ticks), "{ticks}");
}

#[test]
fn with_a_gyroscope_on_its_foot_no_light_goes_astray_before_it_is_found_again() {
    let rig = folder("gyroscope-rig").join("rig.toml");
    std::fs::write(&rig, "base = \"report\"\n[truth.gyroscope]\nfitted = true\n").unwrap();
    let rig = rig.to_str().unwrap();
    let (found, said) = traced("camera-gyroscope", &["--rig", rig, "--sim-trouble", "head-bump=1@6"]);
    assert!(
        said.contains("fault bumped: the head was found anew by 9 dots, its spot had moved by 16"),
        "{said}"
    );
    check_at_most(&found, "/tracking/max_mm", 0.5);
    let turned = found["laser"]["faults"].as_array().unwrap().iter().find_map(|f| f.get("foot_turned_deg"));
    let turned: Vec<f64> = turned.unwrap().as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect();
    // of 1 degree, 0.6 downwards and 0.8 to the left
    assert!((turned[1] - 0.6).abs() < 0.01 && (turned[2] - 0.8).abs() < 0.01, "{turned:?}");
}

#[test]
fn a_camera_that_fails_does_no_harm_and_is_told() {
    for (trouble, why) in [
        ("camera-unplugged@4", "sends no images any more"),
        ("camera-frozen@4", "the same image again and again"),
        ("camera-black@4", "sees nothing any more"),
        ("camera-stamps=0.1@4", "stamps can not be true"),
        ("camera-slow=5@0", ""),
    ] {
        let (found, said) = traced("camera-fails", &["--sim-trouble", trouble]);
        assert!(said.contains(why), "{trouble}: {said}");
        assert_eq!(found["run"]["finished"], true, "{trouble}");
        check_at_most(&found, "/tracking/off_stroke_max_mm", 1.0);
        check_at_most(&found, "/camera/figure_mm/rms", 0.5);
    }
}

#[test]
fn troubles_are_for_simulated_rooms_and_what_is_wrong_with_them_is_told() {
    let wrong = run(&["trace", "--camera", HOUSE, "--sim-trouble", "quake@3"]);
    assert_eq!(wrong.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&wrong.stderr).contains("nobody knows \"quake\""));
    let none = run(&["trace", "../../examples/house.png", "--sim-trouble", "pan-slip=20@3"]);
    assert_eq!(none.status.code(), Some(2));
    let real = run(&["trace", "--camera", "http://127.0.0.1:9/", "--sim-trouble", "pan-slip=20@3"]);
    assert_eq!(real.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&real.stderr).contains("simulated"), "{real:?}");
}

/// An image that a camera took: the one of the page on cameras.
fn house() -> Vec<u8> {
    std::fs::read(support::root().join("docs/camera/house.jpg")).unwrap()
}

/// What a camera on the net sends: a stream, its parts with their lengths or without, or an image each time.
#[derive(Clone, Copy)]
enum Sends {
    Stream {
        lengths: bool,
    },
    Image,
    /// The head of a stream, and then nothing.
    Nothing,
    Page,
}

/// A camera on the net; its address.
fn camera(sends: Sends) -> String {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = listener.local_addr().unwrap();
    std::thread::spawn(move || {
        for connection in listener.incoming() {
            std::thread::spawn(move || serve(connection.unwrap(), sends));
        }
    });
    format!("http://{address}/video")
}

/// Answers one request; whoever asked may go before the end.
fn serve(mut to: TcpStream, sends: Sends) -> std::io::Result<()> {
    let mut request = [0; 4096];
    let _ = to.read(&mut request)?;
    let image = house();
    let stream = "HTTP/1.1 200 OK\r\nContent-Type: multipart/x-mixed-replace; boundary=--cut\r\n\r\n";
    match sends {
        Sends::Page => {
            to.write_all(b"HTTP/1.1 200 OK\r\nContent-Type: text/html\r\nContent-Length: 2\r\n\r\nhi")
        }
        Sends::Image => {
            write!(
                to,
                "HTTP/1.1 200 OK\r\nContent-Type: image/jpeg\r\nContent-Length: {}\r\n\r\n",
                image.len()
            )?;
            to.write_all(&image)
        }
        Sends::Nothing => {
            to.write_all(stream.as_bytes())?;
            std::thread::sleep(std::time::Duration::from_secs(30));
            Ok(())
        }
        Sends::Stream { lengths } => {
            to.write_all(stream.as_bytes())?;
            loop {
                let length =
                    if lengths { format!("Content-Length: {}\r\n", image.len()) } else { String::new() };
                write!(to, "--cut\r\nContent-Type: image/jpeg\r\n{length}\r\n")?;
                to.write_all(&image)?;
                to.write_all(b"\r\n")?;
                std::thread::sleep(std::time::Duration::from_millis(33));
            }
        }
    }
}

#[test]
fn a_camera_on_the_net_is_looked_through() {
    let dir = folder("camera-net");
    let [out, file] = ["out", "camera.toml"].map(|name| dir.join(name).to_str().unwrap().to_owned());
    for sends in [Sends::Stream { lengths: true }, Sends::Stream { lengths: false }, Sends::Image] {
        let found = json(&run(&["calibrate", "markers", "--camera", &camera(sends), "-o", &file, "--json"]));
        assert_eq!(found["markers"], 80);
    }
    let url = camera(Sends::Stream { lengths: true });
    let traced = run(&["trace", "--camera", &url, "--calibration", &file, "--out", &out, "--json"]);
    let said = String::from_utf8_lossy(&traced.stderr).into_owned();
    assert!(said.contains("it is taken to stand 0.914 m in front of the middle"), "{said}");
    assert!(!said.contains("moved"), "{said}");
    let summary = json(&traced);
    assert_eq!((&summary["strokes"]["count"], &summary["camera"]["head"]), (&28.into(), &Value::Null));
    assert_eq!(summary["camera"]["figure_mm"], Value::Null, "nobody knows");
    // 21.7 in of the poster's 24
    check_at_most(&summary, "/target/width_m", 0.555);
}

#[test]
fn a_camera_on_the_net_that_sends_nothing_of_use_is_named() {
    for (url, what) in [
        (camera(Sends::Nothing), "no image for 5 s"),
        (camera(Sends::Page), "it sends text/html"),
        ("http://127.0.0.1:9/video".to_owned(), "127.0.0.1:9/video: "),
    ] {
        let output = run(&["calibrate", "markers", "--camera", &url, "-o", "target/tmp/none.toml"]);
        let message = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{message}");
        assert!(message.contains(what) && message.contains(&url), "{message}");
    }
}

#[test]
fn bad_images_of_a_folder_are_passed_over_so_often_and_no_more() {
    let dir = folder("camera-folder");
    let [images, out] = ["images", "out"].map(|name| dir.join(name).to_str().unwrap().to_owned());
    std::fs::create_dir_all(&images).unwrap();
    let grey = image::RgbImage::from_pixel(1280, 720, image::Rgb([90; 3]));
    grey.save(dir.join("images/1.png")).unwrap();
    grey.save(dir.join("images/2.png")).unwrap();
    std::fs::write(dir.join("images/3.jpg"), house()).unwrap();
    let traced = run(&["trace", "--camera", &images, "--out", &out, "--json"]);
    let said = String::from_utf8_lossy(&traced.stderr).into_owned();
    assert!(said.contains("image 2 is refused") && said.contains("dark to light: |"), "{said}");
    assert_eq!(json(&traced)["camera"]["refused_images"], 2);
    let refused = run(&["trace", "--camera", &images, "--out", &out, "--retakes", "1"]);
    assert_eq!(refused.status.code(), Some(1));
    let said = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert!(said.contains("2 images of the wall were refused"), "{said}");
    std::fs::remove_file(dir.join("images/3.jpg")).unwrap();
    let none = run(&["trace", "--camera", &images, "--out", &out]);
    assert_eq!(none.status.code(), Some(1));
    let said = String::from_utf8_lossy(&none.stderr).into_owned();
    assert!(said.contains("shows no marker"), "says why, not only that there is no more: {said}");
}

#[test]
fn a_film_is_gone_through_image_by_image() {
    let dir = folder("camera-film");
    let [film, out] = ["wall.avi", "out"].map(|name| dir.join(name).to_str().unwrap().to_owned());
    let mut grey = Vec::new();
    let mut encoder = image::codecs::jpeg::JpegEncoder::new(&mut grey);
    encoder.encode_image(&image::RgbImage::from_pixel(1280, 720, image::Rgb([90; 3]))).unwrap();
    let chunks = [&grey, &grey, &house()].map(|image| [b"00dc\x10\x20\x30\x00", &image[..]].concat());
    std::fs::write(&film, [b"RIFF\x00\x00\x00\x00AVI LIST".to_vec(), chunks.concat()].concat()).unwrap();
    let traced = run(&["trace", "--camera", &film, "--out", &out, "--json"]);
    assert_eq!(json(&traced)["camera"]["refused_images"], 2);
    let refused = run(&["trace", "--camera", &film, "--out", &out, "--retakes", "1"]);
    assert_eq!(refused.status.code(), Some(1));
    let marked = run(&["calibrate", "markers", &film, "-o", dir.join("camera.toml").to_str().unwrap()]);
    assert!(!marked.status.success(), "an image is wanted there");
}

#[test]
fn a_source_that_is_no_camera_is_refused() {
    for args in [
        &["trace"][..],
        &["trace", "--camera", "nothing"],
        &["trace", "--camera", "sim:"],
        &["trace", "examples/star.png", "--camera", "sim"],
        &["trace", "examples/star.png", "--head", "head.toml"],
        &["calibrate", "markers"],
        &["calibrate", "head", "--camera", "/dev/nothing"],
        &["calibrate", "head"],
        &["trace", "examples/star.png", "--calibration", "camera.toml"],
        &["trace", "examples/star.png", "--sim-camera", "report"],
        &["calibrate", "head", "--camera", "docs/camera/house.jpg"],
        &["trace", "--camera", "https://127.0.0.1/video"],
    ] {
        let output = run(args);
        assert_eq!(output.status.code(), Some(2), "{args:?}: {}", String::from_utf8_lossy(&output.stderr));
    }
}
