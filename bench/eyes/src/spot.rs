use std::time::Instant;

use tracelight_image::Grey;
use tracelight_markers::{SpotWindow, find_spot};
use tracelight_plant::{CameraConfig, Image, SpotSample};
use tracelight_stroke::{Point, Vec2};

use crate::scene::{Dice, Scene};

/// Spots in front of each camera.
const SPOTS: usize = 20;

/// Finds spots at rest at random places of walls from seeds 0 on: bright, dim and clipped ones, with speckle and without.
pub(crate) fn score(seeds: u64) {
    for speckle in [0.0, 0.2] {
        // share of the exposure at which a white wall is full
        for (name, exposure) in [("unclipped", 0.12), ("dim", 0.02), ("clipped", 0.9)] {
            let mut tally = Tally::default();
            (0..seeds).for_each(|seed| tally.scene(seed, exposure, speckle));
            tally.print(&format!("{name}, speckle {speckle}"));
        }
    }
}

#[derive(Default)]
struct Tally {
    there: usize,
    squares: Vec<f64>,
    told: f64,
    us: Vec<f64>,
}

impl Tally {
    fn scene(&mut self, seed: u64, exposure: f64, speckle: f64) {
        let mut dice = Dice::new(seed);
        let scene = Scene::with_pages(&mut dice, &tracelight_aim::Board::FINE);
        let usual = CameraConfig::webcam();
        let mut eye = scene.eye(seed, speckle);
        let exposure_s = exposure * usual.sensor.reference_s;
        let dark = red(&eye.expose(0.0, exposure_s, &[]));
        for _ in 0..SPOTS {
            let at = Point::new(dice.between(-0.33, 0.33), dice.between(-0.17, 0.17));
            let truth = scene.camera.pixel(at).expect("in sight");
            if scene.is_under_lamp(truth) {
                continue;
            }
            let spots =
                [SpotSample { time_s: -1.0, at, light: true }, SpotSample { time_s: 1.0, at, light: false }];
            let lit = red(&eye.expose(0.0, exposure_s, &spots));
            let off = Vec2::new(dice.between(-12.0, 12.0), dice.between(-12.0, 12.0));
            let window = SpotWindow { centre: truth + off, half_px: 32 };
            self.there += 1;
            let started = Instant::now();
            let found = find_spot(&lit, &dark, &window);
            self.us.push(started.elapsed().as_secs_f64() * 1e6);
            if let Ok(spot) = found.filter_near(truth) {
                self.squares.push(spot.at.distance_squared(truth));
                self.told += 2.0 * spot.deviation_px * spot.deviation_px;
            }
        }
    }

    fn print(&mut self, name: &str) {
        let found = self.squares.len();
        let rms = (self.squares.iter().sum::<f64>() / found as f64).sqrt();
        let told = (self.told / found as f64).sqrt();
        self.us.sort_by(f64::total_cmp);
        let worst = self.squares.iter().copied().fold(0.0, f64::max).sqrt();
        println!(
            "{name}: {found} of {} found; rms {rms:.3} px, worst {worst:.3}, told {told:.3}; {:.0} µs",
            self.there,
            self.us[self.us.len() / 2]
        );
    }
}

/// The red of an image, where a red laser is.
fn red(image: &Image) -> Grey {
    Grey::new(image.width, image.height, image.rgb.iter().copied().step_by(3).collect()).expect("an image")
}

/// What is found somewhere else is not found.
trait Near {
    fn filter_near(self, truth: Point) -> Self;
}

impl Near for Result<tracelight_markers::Spot, tracelight_markers::SpotLost> {
    fn filter_near(self, truth: Point) -> Self {
        self.and_then(|spot| {
            let near = spot.at.distance(truth) < 5.0;
            if near { Ok(spot) } else { Err(tracelight_markers::SpotLost::OutOfSight(spot.at)) }
        })
    }
}
