//! Cameras that are plugged in: the program is given one that is not there, by a library that answers for the kernel (`support/fake_camera.c`).
#![cfg(target_os = "linux")]

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::sync::OnceLock;
use std::time::Duration;

use image::RgbImage;
use serde_json::Value;

use crate::support::{folder, program, root};

const CAMERA: &str = "/dev/video42";

/// The library that answers for the kernel.
fn driver() -> &'static Path {
    static BUILT: OnceLock<PathBuf> = OnceLock::new();
    BUILT.get_or_init(|| {
        let library = folder("device-driver").join("fake_camera.so");
        let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/all/support/fake_camera.c");
        let mut compiler = Command::new("cc");
        compiler
            .args(["-shared", "-fPIC", "-O2", "-Wall", "-Wextra", "-Werror", "-o"])
            .arg(&library)
            .arg(source);
        let built =
            compiler.arg("-ldl").output().expect("a C compiler, `cc`, builds what answers for the kernel");
        assert!(built.status.success(), "{}", String::from_utf8_lossy(&built.stderr));
        library
    })
}

/// A camera that sends one image over and over, in the codings given.
struct Camera {
    images: PathBuf,
    log: PathBuf,
}

impl Camera {
    fn new(name: &str, codings: &[&str], picture: &str) -> Self {
        let images = folder(name);
        let path = root().join(picture);
        let pixels = image::open(&path).unwrap().to_rgb8();
        for coding in codings {
            let bytes = match *coding {
                "MJPG" => std::fs::read(&path).unwrap(),
                "bare" => without_tables(&std::fs::read(&path).unwrap()),
                "YUYV" => yuyv(&pixels),
                _ => pixels.pixels().map(|p| luma(p.0)).collect(),
            };
            std::fs::write(images.join(if *coding == "bare" { "MJPG" } else { coding }), bytes).unwrap();
        }
        Self { log: images.join("log"), images }
    }

    /// The program, with the camera plugged in.
    fn program(&self, like: &str) -> Command {
        let mut program = program();
        program.env("LD_PRELOAD", driver()).env("FAKE_CAMERA", like);
        program.env("FAKE_CAMERA_IMAGES", &self.images).env("FAKE_CAMERA_LOG", &self.log);
        program
    }

    fn run(&self, like: &str, arguments: &[&str]) -> Output {
        self.program(like).args(arguments).output().unwrap()
    }

    fn json(&self, like: &str, arguments: &[&str]) -> Value {
        let output = self.run(like, &[arguments, &["--json"]].concat());
        assert!(output.status.success(), "{like}: {}", String::from_utf8_lossy(&output.stderr));
        serde_json::from_slice(&output.stdout).unwrap()
    }

    /// What controls were set to, in order.
    fn settings(&self) -> Vec<(String, i64)> {
        let text = std::fs::read_to_string(&self.log).unwrap();
        let pair =
            |line: &str| line.split_once('=').map(|(name, value)| (name.to_owned(), value.parse().unwrap()));
        text.lines().map(|line| pair(line).unwrap()).collect()
    }
}

fn luma([r, g, b]: [u8; 3]) -> u8 {
    (0.299 * f64::from(r) + 0.587 * f64::from(g) + 0.114 * f64::from(b)).round() as u8
}

/// By Rec. ITU-R BT.601, Y from 16 to 235.
fn yuyv(pixels: &RgbImage) -> Vec<u8> {
    let coded = |p: [u8; 3]| {
        let y = f64::from(luma(p));
        let chroma = |c: u8, share: f64| (128.0 + (f64::from(c) - y) * share * 224.0 / 255.0).round() as u8;
        ((16.0 + y * 219.0 / 255.0).round() as u8, chroma(p[2], 1.0 / 1.772), chroma(p[0], 1.0 / 1.402))
    };
    let pixels: Vec<[u8; 3]> = pixels.pixels().map(|p| p.0).collect();
    pixels
        .chunks_exact(2)
        .flat_map(|two| {
            let ((y, cb, cr), (after, ..)) = (coded(two[0]), coded(two[1]));
            [y, cb, after, cr]
        })
        .collect()
}

/// A JPEG file as webcams send it, which leave out the Huffman tables that every decoder of Motion JPEG knows.
fn without_tables(bytes: &[u8]) -> Vec<u8> {
    let mut kept = bytes[..2].to_vec();
    let mut at = 2;
    loop {
        let (mark, length) = (bytes[at + 1], usize::from(u16::from_be_bytes([bytes[at + 2], bytes[at + 3]])));
        if mark == 0xda {
            kept.extend(&bytes[at..]);
            return kept;
        }
        if mark != 0xc4 {
            kept.extend(&bytes[at..at + 2 + length]);
        }
        at += 2 + length;
    }
}

#[test]
fn the_doctor_tells_what_a_camera_can_and_leaves_it_as_it_was() {
    let camera = Camera::new("device-doctor", &["MJPG", "GREY"], "docs/camera/wall.jpg");
    // a kind of control that is younger than the program must not matter
    for like in ["rate=30", "rate=30,young=1"] {
        let found = camera.json(like, &["doctor", "--camera", CAMERA]);
        let found = &found["cameras"][0];
        assert_eq!(found["name"], "A camera that is not there");
        assert_eq!(found["driver"], "fake");
        assert_eq!(found["modes"], serde_json::json!(["MJPG 1280x720 30/s", "GREY 1280x720 30/s"]));
        assert_eq!(found["mode"], "MJPG 1280x720 30/s", "in colour");
        assert_eq!(found["stamped"], "beginning");
        assert_eq!(found["broken"], 0);
        assert_eq!(found["exposure_ms"], serde_json::json!([0.1, 500.0]));
        assert_eq!(found["gain"]["most"], 192);
        assert_eq!(found["focuses"], true);
        assert_eq!(found["markers"], 80);
        let rate = found["rate_hz"].as_f64().unwrap();
        assert!((rate - 30.0).abs() < 0.5, "{found}");
        // an image is 60 ms late, and the machine may be busy
        let late = found["latency_ms"]["least"].as_f64().unwrap();
        assert!((60.0..90.0).contains(&late), "{found}");
        let mut last = std::collections::BTreeMap::new();
        last.extend(camera.settings());
        let is = |name: &str| last.get(name).copied();
        assert_eq!(is("refused"), None, "{like} {last:?}");
        assert_eq!(is("Auto Exposure"), Some(3), "{like} {last:?}");
        assert_eq!(is("Exposure Time, Absolute"), Some(157), "{like} {last:?}");
        assert_eq!(is("Exposure, Dynamic Framerate"), Some(1), "{like} {last:?}");
        assert!(is("Gain").is_none_or(|gain| gain == 64), "{like} {last:?}");
    }
    let text =
        String::from_utf8(camera.run("auto=1,stamps=0", &["doctor", "--camera", CAMERA]).stdout).unwrap();
    for part in ["exposes as it likes", "does not stamp images", "focuses by itself", "80 markers in sight"] {
        assert!(text.contains(part), "{part}: {text}");
    }
}

#[test]
fn a_camera_that_fails_is_told_of_by_why() {
    let camera = Camera::new("device-fails", &["MJPG"], "docs/camera/wall.jpg");
    for (like, code, part) in [
        ("denied=1", "no-camera", "usermod"),
        ("busy=1", "no-camera", "another program"),
        ("narrow=1", "no-image", "bus has no room"),
        ("meta=1", "not-a-camera", "sends no images"),
        ("width=640", "no-camera", "sends no images of 1280x720 px, but 640x720"),
        ("stall=5", "no-image", "no image for 5 s"),
        ("unplug=5", "no-image", "unplugged"),
        ("broken=1", "no-image", "none of them whole"),
    ] {
        let output = camera.run(like, &["doctor", "--camera", CAMERA, "--camera-size", "1280x720", "--json"]);
        assert_eq!(output.status.code(), Some(1), "{like}");
        let answer: Value = serde_json::from_slice(&output.stdout).unwrap();
        assert_eq!(answer["error"]["code"], code, "{like} {answer}");
        let message = answer["cameras"][0]["error"]["message"].as_str().unwrap();
        assert!(message.contains(part) && message.contains(CAMERA), "{like} {message}");
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(!said.contains("panicked"), "{said}");
    }
    let absent = program().args(["calibrate", "markers", "--camera", "/dev/video43"]).output().unwrap();
    assert_eq!(absent.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&absent.stderr).contains("is it plugged in?"));
    let none = program().args(["doctor", "--camera", "sim"]).output().unwrap();
    assert_eq!(none.status.code(), Some(2));
}

#[test]
fn every_coding_shows_the_same_wall() {
    let mut places = Vec::new();
    for coding in ["MJPG", "bare", "YUYV", "GREY"] {
        let camera = Camera::new(&format!("device-{coding}"), &[coding], "docs/camera/wall.jpg");
        let file = camera.images.join("camera.toml").to_str().unwrap().to_owned();
        let found = camera.json("broken=3", &["calibrate", "markers", "--camera", CAMERA, "-o", &file]);
        let pages = found["pages"].as_array().unwrap().iter();
        let middles = pages.flat_map(|page| page["middle_m"].as_array().unwrap());
        places.push((coding, middles.map(|m| m.as_f64().unwrap()).collect::<Vec<_>>()));
    }
    for (coding, place) in &places {
        let off = place.iter().zip(&places[0].1).map(|(is, other)| (is - other).abs()).fold(0.0, f64::max);
        assert!(off < 0.5e-3 && place.len() == 8, "{coding}: {off} {places:?}");
    }
}

#[test]
fn an_image_without_an_end_is_one_where_none_ever_has_one() {
    let camera = Camera::new("device-endless", &["MJPG"], "docs/camera/wall.jpg");
    let file = camera.images.join("camera.toml").to_str().unwrap().to_owned();
    let found = camera.json("endless=1", &["calibrate", "markers", "--camera", CAMERA, "-o", &file]);
    assert_eq!(found["markers"], 80);
}

#[test]
fn where_there_is_too_much_light_for_any_exposure_the_darkest_image_is_taken() {
    let camera = Camera::new("device-bright", &["GREY"], "docs/camera/wall.jpg");
    let found = camera.json("light=300", &["doctor", "--camera", CAMERA]);
    assert_eq!(found["cameras"][0]["source"], CAMERA);
    let least = camera.settings().into_iter().filter(|(name, _)| name.starts_with("Exposure Time"));
    assert_eq!(least.map(|(_, value)| value).min(), Some(1));
}

#[test]
fn a_stop_in_the_middle_leaves_the_camera_as_it_was() {
    let camera = Camera::new("device-stop", &["MJPG"], "docs/camera/wall.jpg");
    let mut running = camera.program("rate=30");
    running.args(["doctor", "--camera", CAMERA]).stderr(Stdio::null()).stdout(Stdio::null());
    let mut running = running.spawn().unwrap();
    // once it was told something
    while !camera.log.exists() || camera.settings().len() < 3 {
        assert!(running.try_wait().unwrap().is_none(), "ended by itself");
        std::thread::sleep(Duration::from_millis(10));
    }
    let killed = Command::new("kill").args(["-INT", &running.id().to_string()]).status().unwrap();
    assert!(killed.success());
    assert_eq!(running.wait().unwrap().code(), Some(130));
    let settings = camera.settings();
    let last = |name: &str| settings.iter().rfind(|(is, _)| is == name).map(|(_, value)| *value);
    assert_eq!(
        (last("Auto Exposure"), last("Exposure Time, Absolute")),
        (Some(3), Some(157)),
        "{settings:?}"
    );
}

#[test]
fn where_there_is_little_light_exposure_and_then_gain_are_raised() {
    let camera = Camera::new("device-dark", &["GREY"], "docs/camera/wall.jpg");
    let file = camera.images.join("camera.toml").to_str().unwrap().to_owned();
    let most = |name: &str| {
        let settings = camera.settings();
        settings.iter().filter(|(is, _)| is == name).map(|(_, value)| *value).max()
    };
    camera.json("light=0.6", &["calibrate", "markers", "--camera", CAMERA, "-o", &file]);
    assert!((120..=330).contains(&most("Exposure Time, Absolute").unwrap()), "{:?}", camera.settings());
    assert_eq!(most("Gain"), None);
    camera.json("light=0.15", &["calibrate", "markers", "--camera", CAMERA, "-o", &file]);
    // longer than from one image to the next it is not exposed
    assert_eq!(most("Exposure Time, Absolute"), Some(333));
    assert!(most("Gain").unwrap() > 100, "{:?}", camera.settings());
    assert_eq!(camera.settings().iter().rfind(|(name, _)| name == "Gain").unwrap().1, 64, "put back");
}

#[test]
fn a_figure_is_traced_where_a_plugged_in_camera_sees_it() {
    let camera = Camera::new("device-trace", &["MJPG", "YUYV"], "docs/camera/house.jpg");
    let out = camera.images.join("out").to_str().unwrap().to_owned();
    let summary = camera.json("late=0.1", &["trace", "--camera", CAMERA, "--out", &out]);
    assert_eq!(summary["camera"]["source"], CAMERA);
    assert_eq!(summary["camera"]["markers"], 80);
    assert!((20..40).contains(&summary["strokes"]["count"].as_u64().unwrap()), "{summary}");
    assert!(summary["tracking"]["rms_mm"].as_f64().unwrap() < 0.3, "{summary}");
    let image = image::open(camera.images.join("out/camera.jpg")).unwrap();
    assert_eq!((image.width(), image.height()), (1280, 720));
}
