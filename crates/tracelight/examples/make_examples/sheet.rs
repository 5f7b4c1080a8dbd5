//! `sheet.jpg`: a sheet of A4 with the house of `house.png` in felt pen, photographed by hand on a wooden table.

use std::error::Error;

use tracelight_aim::{Camera, CameraPose, Lens};
use tracelight_maths::planar;
use tracelight_plant::{CameraConfig, Poster, Sensor, Wall};
use tracelight_stroke::{Affine, Point, Vec2};

use super::grain::{grain, smooth};
use super::pen::Ink;
use super::photograph;

/// The drawing: the exact lines of `house.png`.
const HOUSE: &str = include_str!("../../../../examples/truth/house.json");

/// Side of a dot of the sheet, m.
const DOT_M: f64 = 0.2e-3;
/// A4, lying: columns and rows of dots.
const DOTS: (usize, usize) = (1485, 1050);
/// One pixel of the house is this many dots: it is 256 mm wide on the sheet.
const DOTS_A_PIXEL: f64 = 2.0;
/// Upper left corner of the house on the sheet, dots.
const CORNER: Vec2 = Vec2::new(102.0, 45.0);
/// Paper and ink, sRGB.
const PAPER: [f64; 3] = [236.0, 234.0, 228.0];
const INK: [f64; 3] = [38.0, 42.0, 70.0];

/// Side of a dot of the table, m, and how many there are.
const TABLE_DOT_M: f64 = 1e-3;
const TABLE: (usize, usize) = (1400, 1100);
/// Its wood, sRGB.
const WOOD: [f64; 3] = [134.0, 94.0, 60.0];

/// Seeds of table, paper and sensor.
const SEEDS: [u64; 3] = [71, 72, 73];

/// The photograph: 1600 × 1200 px, seen from the front at a slant, light from the left.
pub(super) fn jpeg() -> Result<Vec<u8>, Box<dyn Error>> {
    let scene = Wall { plain: [0.1; 3], posters: vec![table()?, sheet()?] };
    let usual = CameraConfig::webcam();
    let config = CameraConfig {
        blur_px: 0.7,
        vignetting: 0.25,
        light: [1.0, 0.6],
        sensor: Sensor { full_well: 20_000.0, ..usual.sensor },
        ..usual
    };
    let lens = Lens { radial: [-0.04, 0.0, 0.0], ..Lens::ideal(1600, 1200, 1500.0) };
    let pose = CameraPose::looking_at([0.06, -0.22, 0.42], [0.0; 3]).ok_or("no such pose")?;
    photograph::jpeg(&config, &Camera { lens, pose }, &scene, SEEDS[2], 80)
}

fn tinted(tone: [f64; 3], light: f64) -> [u8; 3] {
    tone.map(|v| (v * light).round().clamp(0.0, 255.0) as u8)
}

/// Boards of wood: rings that are long along the board, fine pores on them.
fn table() -> Result<Poster, Box<dyn Error>> {
    let (width, height) = TABLE;
    let dot = |i: usize| {
        let (x, y) = ((i % width) as f64, (i / width) as f64);
        let rings = smooth(x / 260.0, y / 7.0, SEEDS[0]) + 0.5 * smooth(x / 90.0, y / 2.5, SEEDS[0] + 1);
        tinted(WOOD, 1.0 + 0.07 * rings + 0.02 * grain(i % width, i / width, SEEDS[0] + 2))
    };
    let dots: Vec<_> = (0..width * height).map(dot).collect();
    poster(width, &dots, TABLE_DOT_M, height, 0.0)
}

fn sheet() -> Result<Poster, Box<dyn Error>> {
    let (width, height) = DOTS;
    let mut ink = Ink::none(width, height);
    let house: serde_json::Value = serde_json::from_str(HOUSE)?;
    for stroke in house["strokes"].as_array().ok_or("no strokes")? {
        let at = |p: &serde_json::Value| {
            Some(Point::new(p[0].as_f64()? * DOTS_A_PIXEL, p[1].as_f64()? * DOTS_A_PIXEL) + CORNER)
        };
        let mut line: Vec<Point> = stroke["points"].as_array().into_iter().flatten().filter_map(at).collect();
        if stroke["closed"] == true {
            line.extend(line.first().copied());
        }
        ink.draw(&line, DOTS_A_PIXEL * stroke["pen_px"].as_f64().ok_or("no pen")?);
    }
    let dot = |i: usize| {
        let light = 1.0 + 0.006 * grain(i % width, i / width, SEEDS[1]);
        let share = ink.coverage[i];
        tinted([0, 1, 2].map(|k| PAPER[k] + (INK[k] - PAPER[k]) * share), light)
    };
    let dots: Vec<_> = (0..width * height).map(dot).collect();
    poster(width, &dots, DOT_M, height, 0.07)
}

/// Dots of `dot_m` about the origin, turned by `turn_rad`.
fn poster(
    width: usize,
    dots: &[[u8; 3]],
    dot_m: f64,
    height: usize,
    turn_rad: f64,
) -> Result<Poster, Box<dyn Error>> {
    let middle = Vec2::new(width as f64 / 2.0, height as f64 / 2.0);
    let place = planar::rotation(turn_rad) * Affine::translate(-middle).then_scale_non_uniform(dot_m, -dot_m);
    Ok(Poster::new(width, dots, place).ok_or("an empty poster")?)
}
