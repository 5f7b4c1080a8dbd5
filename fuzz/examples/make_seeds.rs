//! Writes `seeds/`: a few small inputs for each target, from which the fuzzer goes on.
//!
//!     cargo run --manifest-path fuzz/Cargo.toml --no-default-features --example make_seeds

#![allow(clippy::unwrap_used, reason = "a script ends at the first thing that goes wrong")]

use std::f64::consts::TAU;
use std::fs;
use std::io::Cursor;
use std::path::{Path as FilePath, PathBuf};

#[path = "../../crates/formats/tests/all/support/plate.rs"]
mod plate;

use image::{DynamicImage, ImageFormat, Rgb, RgbImage};
use plate::plate;
use tracelight_formats::json::Traced;
use tracelight_formats::{Sheet, csv, dxf, json, svg};
use tracelight_stroke::Drawing;

fn main() {
    let root = FilePath::new(env!("CARGO_MANIFEST_DIR"));
    pictures(&root.join("seeds/picture"));
    drawings(&root.join("seeds/formats"));
    images(&root.join("seeds/trace"));
    rows(&root.join("seeds/fit"));
    tours(&root.join("seeds/order"));
    packets(&root.join("seeds/wire"));
}

/// A host and a board that shake hands and draw a little, as each of them hears the other, and packets of each kind by themselves.
fn packets(folder: &FilePath) {
    use tracelight_rig::wire::{Ask, Order, Row, Rows, RowsHeader, ToBoard};
    use tracelight_rig::{Command, PanTilt};
    let piece = |kind: u8, bytes: &[u8]| {
        bytes.chunks(255).flat_map(|bytes| [&[kind, bytes.len() as u8], bytes].concat()).collect::<Vec<u8>>()
    };
    let orders = [
        Ask::Arm { nonce: 1, acknowledges: 0 },
        Ask::Command(Command::Home(PanTilt::new(1, -1))),
        Ask::Command(Command::Point(50)),
        Ask::Command(Command::Speed(0.5)),
        Ask::Command(Command::Pause),
        Ask::Command(Command::Abandon),
        Ask::Command(Command::Acknowledge { fault: 1 }),
        Ask::Command(Command::Unhome),
        Ask::Command(Command::Finish),
    ];
    let mut host = tracelight_device::Host::new(tracelight_sim::RigConfig::report().control_config(), 1);
    let mut greeting = Vec::new();
    host.give(0, &mut greeting);
    let hello = piece(tracelight_fuzz::wire::TO_BOARD, &greeting);
    let orders = (0..).zip(orders).map(|(sequence, ask)| ToBoard::Order(Order { sequence, ask }));
    let said = [ToBoard::KeepAlive { host_us: 5 }, ToBoard::Commit { length: 4, crc: 1 }]
        .into_iter()
        .chain(orders)
        .chain([
            ToBoard::Disarm { before: 9, number: 1 },
            ToBoard::Again { from: 0, count: 9 },
            ToBoard::Seen { number: 1 },
        ]);
    let kinds = said.flat_map(|said| piece(tracelight_fuzz::wire::BODY_TO_BOARD, said.body(1).bytes()));
    write(folder, "kinds", hello.iter().copied().chain(kinds).collect::<Vec<u8>>());
    let header = RowsHeader { first_tick: 3, wanted: 1, free: 8, disarm: 0, fault_number: 0 };
    let (rows, _) = Rows::body(1, &header, &[Row::default().told(), Row::default().told()]);
    write(folder, "rows", piece(tracelight_fuzz::wire::BODY_TO_HOST, rows.bytes()));
    write(folder, "session", tracelight_fuzz::wire::session());
}

fn write(folder: &FilePath, name: &str, bytes: impl AsRef<[u8]>) {
    fs::create_dir_all(folder).unwrap();
    let file: PathBuf = folder.join(name);
    fs::write(file, bytes).unwrap();
}

/// A ring and a slash, in every format, grey and coloured, with and without transparency.
fn pictures(folder: &FilePath) {
    let ink = |x: u32, y: u32| {
        let (u, v) = (f64::from(x) - 11.5, f64::from(y) - 11.5);
        (u.hypot(v) - 8.0).abs() < 1.5 || (u + v).abs() < 1.5
    };
    let pixel = |x, y| Rgb(if ink(x, y) { [30, 20, 120] } else { [240, 235, 220] });
    let colour = DynamicImage::from(RgbImage::from_fn(24, 24, pixel));
    let formats = [
        (ImageFormat::Png, "png"),
        (ImageFormat::Jpeg, "jpg"),
        (ImageFormat::WebP, "webp"),
        (ImageFormat::Bmp, "bmp"),
        (ImageFormat::Gif, "gif"),
        (ImageFormat::Pnm, "ppm"),
        (ImageFormat::Tiff, "tif"),
    ];
    for (format, extension) in formats {
        write(folder, &format!("ring.{extension}"), encoded(&colour, format));
    }
    write(folder, "grey.png", encoded(&colour.to_luma8().into(), ImageFormat::Png));
    write(folder, "deep.png", encoded(&colour.to_rgba16().into(), ImageFormat::Png));
    write(folder, "grey.jpg", encoded(&colour.to_luma8().into(), ImageFormat::Jpeg));
    write(folder, "deep.tif", encoded(&colour.to_luma16().into(), ImageFormat::Tiff));
    write(folder, "clear.webp", encoded(&colour.to_rgba8().into(), ImageFormat::WebP));
    write(
        folder,
        "bits.pbm",
        b"P1\n8 8\n00000000 01111110 01000010 01000010 01000010 01000010 01111110 00000000\n",
    );
    write(folder, "plate.svg", svg_of(&plate()));
    write(folder, "plate.dxf", dxf::write(&plate(), 0.3, 0.2));
}

fn encoded(image: &DynamicImage, format: ImageFormat) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    image.write_to(&mut bytes, format).unwrap();
    bytes.into_inner()
}

fn svg_of(drawing: &Drawing) -> String {
    svg::write(drawing, 0.3, 0.2)
}

const SHAPES: &str = "<svg xmlns='http://www.w3.org/2000/svg' xmlns:xlink='http://www.w3.org/1999/xlink' width='9cm' viewBox='0 0 90 60'>\
    <style>.a{stroke:red;fill:none}</style><defs><g id='g'><rect x='1' y='2' width='9' height='5' rx='2'/></g></defs>\
    <use xlink:href='#g' transform='rotate(30) scale(2 1)' class='a'/><circle class='a' cx='40' cy='30' r='9'/>\
    <ellipse class='a' cx='60' cy='30' rx='9' ry='4'/><polyline class='a' points='1,1 5 9 9,1'/>\
    <path class='a' d='M5 5q4 9 9 0t9 0a5 5 0 0 1 9 2v3h-4zm9 9s1 2 3 4'/></svg>";

const BLOCKS: &str = "0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n4\n0\nENDSEC\n\
    0\nSECTION\n2\nBLOCKS\n0\nBLOCK\n2\nA\n10\n0\n20\n0\n0\nLINE\n8\n0\n10\n0\n20\n0\n11\n5\n21\n5\n\
    0\nARC\n10\n0\n20\n0\n40\n2\n50\n10\n51\n200\n0\nENDBLK\n0\nENDSEC\n\
    0\nSECTION\n2\nENTITIES\n0\nINSERT\n8\nL\n2\nA\n10\n9\n20\n9\n41\n2\n42\n-3\n50\n30\n70\n2\n71\n2\n44\n10\n45\n10\n\
    0\nPOLYLINE\n66\n1\n70\n1\n0\nVERTEX\n10\n0\n20\n0\n42\n0.5\n0\nVERTEX\n10\n9\n20\n0\n0\nVERTEX\n10\n9\n20\n7\n0\nSEQEND\n\
    0\nELLIPSE\n10\n3\n20\n3\n11\n7\n21\n1\n40\n0.3\n41\n0.2\n42\n5\n\
    0\nSPLINE\n70\n4\n71\n2\n40\n0\n40\n0\n40\n0\n40\n1\n40\n1\n40\n1\n41\n1\n41\n0.7\n41\n1\n10\n10\n20\n0\n10\n10\n20\n10\n10\n0\n20\n10\n\
    0\nSPLINE\n70\n1\n71\n3\n74\n3\n11\n0\n21\n0\n11\n9\n21\n0\n11\n9\n21\n9\n0\nENDSEC\n0\nEOF\n";

fn drawings(folder: &FilePath) {
    let drawing = plate();
    let sheet = Sheet::in_pixels(1.0, 1.0, drawing.clone());
    write(folder, "plate.svg", svg_of(&drawing));
    write(folder, "plate.dxf", dxf::write(&drawing, 0.3, 0.2));
    write(folder, "plate.csv", csv::write(&drawing, 1e-2));
    write(folder, "plate.json", json::write(&Traced { sheet, mode: "auto".into() }, 1e-2));
    write(folder, "shapes.svg", SHAPES);
    write(folder, "blocks.dxf", BLOCKS);
    // entities alone: mutations then hit what is drawn
    let written = dxf::write(&drawing, 0.3, 0.2);
    let entities = written.find("0\nSECTION\n2\nENTITIES").unwrap();
    write(folder, "entities.dxf", &written[entities..]);
}

/// Pen drawings, textures and a picture of bits, in every mode.
fn images(folder: &FilePath) {
    const PAPER: u8 = 235;
    let pens: [(&str, &[[u8; 6]]); 5] = [
        ("cross", &[[30, 30, 220, 220, 10, 20], [30, 220, 220, 40, 10, 20]]),
        (
            "box",
            &[
                [40, 40, 200, 40, 8, 9],
                [200, 40, 200, 210, 8, 9],
                [200, 210, 40, 210, 8, 9],
                [40, 210, 40, 40, 8, 9],
            ],
        ),
        ("lollipop", &[[128, 80, 128, 82, 47, 30], [128, 80, 128, 240, 8, 30]]),
        ("border", &[[0, 0, 255, 0, 12, 5], [0, 0, 0, 255, 12, 5], [100, 0, 255, 180, 12, 5]]),
        (
            "fan",
            &[
                [20, 128, 240, 20, 5, 0],
                [20, 128, 240, 90, 5, 0],
                [20, 128, 240, 150, 5, 0],
                [20, 128, 240, 230, 5, 0],
            ],
        ),
    ];
    for (number, (name, lines)) in pens.iter().enumerate() {
        for mode in 0..4 {
            let head = [56 + 8 * number as u8, 40, mode, 0, 0, 2, PAPER];
            write(folder, &format!("{name}-{mode}"), [&head[..], &lines.concat()].concat());
        }
    }
    let texture: Vec<u8> = (0..67_u32).map(|i| if i * i % 7 < 3 { 25 } else { 225 }).collect();
    write(folder, "texture", [&[60, 60, 0, 0, 0, 0][..], &texture].concat());
    let bits: Vec<u8> = (0..98_u32)
        .map(|i| (i.wrapping_mul(2_654_435_761) >> 13) as u8 & ((i * 40_503) >> 5) as u8)
        .collect();
    write(folder, "bits", [&[20, 20, 0, 0, 0, 1][..], &bits].concat());
}

fn rows(folder: &FilePath) {
    type Curve = fn(f64) -> (f64, f64);
    let curves: [(&str, u8, Curve); 5] = [
        ("circle", 1, |t| (60.0 * (TAU * t).cos(), 60.0 * (TAU * t).sin())),
        ("wave", 0, |t| (200.0 * t - 100.0, 30.0 * (12.0 * t).sin())),
        ("hook", 0, |t| (100.0 * t, 80.0 * (2.0 * t - 1.0).abs())),
        ("square", 1, |t| {
            let side = |t: f64| ((4.0 * t).rem_euclid(4.0) - 2.0).abs().clamp(0.5, 1.5) * 80.0;
            (side(t), side(t + 0.25))
        }),
        ("back", 0, |t| (50.0 - 100.0 * (t - 0.5).abs(), 0.0)),
    ];
    for (name, closed, curve) in curves {
        let mut bytes = vec![closed, 0, 0, 0];
        for (x, y) in (0..90).map(|i| curve(f64::from(i) / 90.0)) {
            bytes.extend([x, y].iter().flat_map(|v| ((v * 64.0) as i16).to_le_bytes()));
        }
        write(folder, name, &bytes);
    }
    let wild = [0.0, 1.0, f64::NAN, 1e300, -1e-300, f64::INFINITY, 5.0, -7.5];
    let wild: Vec<u8> = wild.iter().flat_map(|v| v.to_le_bytes()).collect();
    write(folder, "wild", [&[3, 0, 0, 0][..], &wild].concat());
}

fn tours(folder: &FilePath) {
    let lines = |flags: u8, count: u8| -> Vec<u8> {
        let stroke = |i: u8| {
            let (x, y) = (i.wrapping_mul(37), i.wrapping_mul(91));
            [flags, x, y, 3, x.wrapping_add(20), y, 3, x, y.wrapping_add(9)]
        };
        (0..count).flat_map(stroke).collect()
    };
    for (name, flags, count, effort) in
        [("open", 4, 12, 0), ("rings", 5, 12, 1), ("few", 4, 2, 1), ("dots", 0, 3, 0)]
    {
        write(folder, name, [&[effort, 7, 0, 0][..], &lines(flags, count)].concat());
    }
}
