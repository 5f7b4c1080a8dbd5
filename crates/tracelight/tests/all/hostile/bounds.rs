//! Inputs that would take long, or much, and are refused before they do: by the real program.

use std::fs;
use std::os::unix::ffi::OsStringExt;
use std::process::Command;
use std::time::Instant;

use image::{DynamicImage, ImageBuffer, ImageFormat, Rgba};

use crate::hostile::program::{Case, Exit, check};
use crate::hostile::{folder, pictures, write};

/// The program here is no release; what is refused takes it no longer.
const AT_ONCE_S: f64 = 5.0;

#[test]
fn a_vast_picture_is_refused_before_it_is_decoded() {
    let folder = folder("vast");
    let deep: ImageBuffer<Rgba<u16>, Vec<u16>> = ImageBuffer::new(20, 20);
    let deep = pictures::encoded(&DynamicImage::from(deep), ImageFormat::Png);
    write(&folder, "deep.png", &pictures::with_png_size(&deep, 9_950, 9_950));
    write(&folder, "scans.jpg", &many_scans());
    let cases = [
        Case::new(
            "trace deep.png --out out",
            Exit::Wrong,
            &["deep.png", "792 MB", "400 MB", "8 bits a channel"],
        ),
        Case::new("trace scans.jpg --out out", Exit::Wrong, &["scans.jpg", "501 scans", "progressive"]),
    ];
    let started = Instant::now();
    check(&folder, &cases);
    assert!(started.elapsed().as_secs_f64() < AT_ONCE_S, "refused after {:?}", started.elapsed());
}

/// A JPEG that declares 99 megapixels and 500 scans more than it has.
fn many_scans() -> Vec<u8> {
    let mut jpeg = pictures::jpeg_of(9_950, 9_950);
    let end = jpeg.len() - 2;
    let scan = [0xFF, 0xDA, 0, 8, 1, 1, 0, 0, 63, 0, 0x12];
    jpeg.splice(end..end, scan.repeat(500));
    jpeg
}

#[test]
fn a_job_that_is_far_too_long_is_refused_before_its_order() {
    let folder = folder("long");
    let row = |i: u32| {
        let [x, y] = [i % 300, i / 300].map(|k| 0.001 * f64::from(k) - 0.15);
        format!("{i},{x},{y}\n{i},{},{y}\n", x + 0.0001)
    };
    let rows: String = (0..100_000).map(row).collect();
    write(&folder, "many.csv", format!("stroke,x_m,y_m\n{rows}").as_bytes());
    let words = ["too-long|would take", "100000 strokes", "1800 s", "in parts"];
    check(&folder, &[Case::new("plan many.csv -o plan.csv", Exit::Refused, &words)]);
}

#[test]
fn a_file_that_may_not_grow_is_told_and_no_half_of_it_is_left() {
    let folder = folder("largest");
    let started = Command::new("sh")
        .args(["-c", "ulimit -f 64; exec \"$0\" trace good.png --out out", env!("CARGO_BIN_EXE_tracelight")])
        .current_dir(&folder)
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&started.stderr);
    assert_eq!(started.status.code(), Some(1), "{said}");
    assert!(said.contains("cannot write"), "{said}");
    assert!(!folder.join("out/summary.json").exists() && !folder.join("out/report.html").exists());
}

#[test]
fn a_name_that_is_no_text_is_told_as_it_is() {
    let folder = folder("names");
    let name = std::ffi::OsString::from_vec(b"caf\xe9.png".to_vec());
    fs::rename(folder.join("good.png"), folder.join(&name)).unwrap();
    let program = env!("CARGO_BIN_EXE_tracelight");
    let ended = Command::new(program).arg("strokes").arg(&name).current_dir(&folder).output().unwrap();
    let said = String::from_utf8_lossy(&ended.stderr);
    assert_eq!(ended.status.code(), Some(2), "{said}");
    assert!(said.contains("caf\\xE9.png") && said.contains("UTF-8") && said.contains("rename"), "{said}");
}
