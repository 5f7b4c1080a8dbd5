//! `wall.mjpeg`: a star drawn on a wall between four pages of markers, as a short film. `lens/`: the pages from five sides.

use std::error::Error;

use tracelight_aim::{Board, Camera, CameraPose, Lens};
use tracelight_eye::board::page_raster;
use tracelight_maths::planar;
use tracelight_pipeline::Paper;
use tracelight_plant::{CameraConfig, Poster, Wall};
use tracelight_stroke::{Affine, Point, Vec2};

use super::Example;
use super::pen::Ink;
use super::photograph;

/// Side of a dot of a printed page and of the star's paper, m.
const DOT_M: f64 = 0.25e-3;
/// Paint of the wall, shares of the light.
const PLAIN: [f32; 3] = [0.62, 0.61, 0.59];
/// Where the middles of the four pages' markers are, m, and how far each page is turned, rad.
const PAGES: [(f64, f64, f64); 4] =
    [(-0.36, -0.16, 0.01), (0.36, -0.165, -0.015), (0.365, 0.16, 0.02), (-0.355, 0.165, -0.01)];
/// Where the camera of each photograph for the lens stands, m.
const SIDES: [(&str, [f64; 3]); 5] = [
    ("lens/left.jpg", [-0.7, -0.1, 1.1]),
    ("lens/right.jpg", [0.7, 0.1, 1.1]),
    ("lens/above.jpg", [0.0, 0.6, 1.1]),
    ("lens/below.jpg", [0.1, -0.6, 1.15]),
    ("lens/near.jpg", [0.0, 0.0, 1.2]),
];
/// Images of the film, at 30 a second, by a hand that is not quite still: where the camera is, m.
const FILM: [[f64; 3]; 3] = [[0.25, -0.12, 1.18], [0.251, -0.121, 1.18], [0.252, -0.121, 1.181]];
const QUALITY: u8 = 72;

/// The film and the photographs.
pub(super) fn images() -> Result<Vec<Example>, Box<dyn Error>> {
    let pages = pages()?;
    let bare = Wall { plain: PLAIN, posters: pages.clone() };
    let drawn = Wall { plain: PLAIN, posters: [pages, vec![star()?]].concat() };
    let mut files = Vec::new();
    for (seed, (name, from_m)) in (1..).zip(SIDES) {
        files.push((name, seen(from_m, &bare, seed)?));
    }
    let film: Result<Vec<_>, _> = (11..).zip(FILM).map(|(seed, from_m)| seen(from_m, &drawn, seed)).collect();
    files.push(("wall.mjpeg", film?.concat()));
    Ok(files)
}

/// By a webcam of 1280 × 720 px whose lens bends lines outwards.
fn seen(from_m: [f64; 3], wall: &Wall, seed: u64) -> Result<Vec<u8>, Box<dyn Error>> {
    let lens = Lens {
        radial: [-0.1, 0.01, 0.0],
        centre_px: Point::new(648.0, 355.0),
        ..Lens::ideal(1280, 720, 1000.0)
    };
    let pose = CameraPose::looking_at(from_m, [0.0; 3]).ok_or("no such pose")?;
    photograph::jpeg(&CameraConfig::webcam(), &Camera { lens, pose }, wall, seed, QUALITY)
}

fn pages() -> Result<Vec<Poster>, Box<dyn Error>> {
    let mut posters = Vec::new();
    for (number, (x, y, turn_rad)) in (0..).zip(PAGES) {
        let (width, levels, middle) = page_raster(&Board::FINE, number, Paper::A4, DOT_M);
        let dots: Vec<[u8; 3]> = levels.iter().map(|&v| [v; 3]).collect();
        let page = Affine::translate(-middle.to_vec2()).then_scale_non_uniform(DOT_M, -DOT_M);
        let place = planar::rotation(turn_rad).then_translate(Vec2::new(x, y)) * page;
        posters.push(Poster::new(width, &dots, place).ok_or("an empty page")?);
    }
    Ok(posters)
}

/// A five-pointed star 0.4 m high in black paint, the wall's own colour about it.
fn star() -> Result<Poster, Box<dyn Error>> {
    /// Dots a side.
    const SIDE: usize = 800;
    const DOT_M: f64 = 0.55e-3;
    /// Lines are 6 mm wide.
    const PEN_PX: f64 = 6.0 / 0.55;
    let middle = Point::new(SIDE as f64 / 2.0, SIDE as f64 / 2.0);
    let tip = |k: usize| {
        let radius = if k.is_multiple_of(2) { 364.0 } else { 145.0 };
        middle + planar::direction(std::f64::consts::PI * (k as f64 / 5.0 - 0.5)) * radius
    };
    let mut ink = Ink::none(SIDE, SIDE);
    ink.draw(&(0..11).map(tip).collect::<Vec<_>>(), PEN_PX);
    // the wall's paint in sRGB is 205, 203, 200
    let dots: Vec<[u8; 3]> = ink
        .coverage
        .iter()
        .map(|share| [205.0, 203.0, 200.0].map(|v| (v - (v - 25.0) * share) as u8))
        .collect();
    let place = Affine::translate(-middle.to_vec2()).then_scale_non_uniform(DOT_M, -DOT_M);
    Ok(Poster::new(SIDE, &dots, place).ok_or("an empty picture")?)
}
