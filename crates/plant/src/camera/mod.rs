//! A camera made of equations: what is on the wall seen through a lens, lit unevenly, blurred, exposed row by row, with the noise of
//! light and of the sensor, in colours one a pixel.

mod config;
mod exposed;
mod part;
mod sensor;
mod splitmix;
mod spot;
mod wall;

use std::sync::Arc;

use tracelight_aim::Camera;

pub use config::{CameraConfig, Lamp, Laser, Sensor};
pub use exposed::{Exposed, SpotSample};
pub use part::Part;
pub use wall::{Poster, Wall};

use sensor::{Electrons, Mosaic};
use spot::Exposure;

/// What a camera gives.
#[derive(Clone, PartialEq)]
pub struct Image {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Red, green and blue of each pixel, row by row from the upper left.
    pub rgb: Vec<u8>,
    /// Number of the image since the camera began.
    pub number: u64,
    /// When its first row began to be exposed, s, by the clock of the rig.
    pub start_s: f64,
    /// How long each row was.
    pub exposure_s: f64,
}

/// Its size; a picture's worth of numbers helps nobody.
impl std::fmt::Debug for Image {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Image({} × {}, number {} at {} s)", self.width, self.height, self.number, self.start_s)
    }
}

impl Image {
    /// Brightness of each pixel as video has it: 0.299 R + 0.587 G + 0.114 B (ITU-R BT.601, §2.5.1).
    pub fn luma(&self) -> Vec<u8> {
        let of = |p: &[u8]| {
            ((77 * u32::from(p[0]) + 150 * u32::from(p[1]) + 29 * u32::from(p[2]) + 128) >> 8) as u8
        };
        self.rgb.chunks_exact(3).map(of).collect()
    }
}

/// A camera in front of a wall.
#[derive(Clone, Debug)]
pub struct SimulatedCamera {
    config: CameraConfig,
    camera: Camera,
    wall: Arc<Wall>,
    /// What each pixel gets from the wall in a reference exposure: one is a pixel that is full.
    scene: Vec<[f32; 3]>,
    electrons: Electrons,
    number: u64,
}

impl SimulatedCamera {
    /// In front of a wall. `seed` draws noise.
    pub fn new(config: &CameraConfig, camera: &Camera, wall: &Wall, seed: u64) -> Self {
        Self {
            config: *config,
            camera: *camera,
            wall: Arc::new(wall.clone()),
            scene: wall.seen(config, camera),
            electrons: Electrons::new(seed, config.sensor.gamma),
            number: 0,
        }
    }

    /// Somebody moves it.
    pub fn stand(&mut self, camera: &Camera) {
        self.camera = *camera;
        self.scene = self.wall.seen(&self.config, camera);
    }

    /// What it is made of.
    pub const fn config(&self) -> &CameraConfig {
        &self.config
    }

    /// Lens and pose as they are.
    pub const fn camera(&self) -> &Camera {
        &self.camera
    }

    /// The next image, whose first row is exposed from `start_s` on, each row for `exposure_s`; see [`Exposed::spots`].
    pub fn expose(&mut self, start_s: f64, exposure_s: f64, spots: &[SpotSample]) -> Image {
        let exposed = Exposed { number: self.number, start_s, exposure_s, spots: spots.to_vec() };
        self.number += 1;
        self.develop(&exposed, &Part::whole(self.camera.lens.size_px))
    }

    /// A part of an image, pixel for pixel as it is in the whole; none of what lies beyond the image.
    pub fn develop(&self, exposed: &Exposed, part: &Part) -> Image {
        let size = self.camera.lens.size_px;
        let (left, top) = (part.left.min(size[0]), part.top.min(size[1]));
        let (width, height) = (part.width.min(size[0] - left), part.height.min(size[1] - top));
        let part = Part { left, top, width, height };
        let wide = part.wider(size);
        let sensor = &self.config.sensor;
        let share = (exposed.exposure_s / sensor.reference_s) as f32;
        let rows = self.scene.chunks_exact(size[0]).skip(wide.top).take(wide.height);
        let mut light: Vec<[f32; 3]> = Vec::with_capacity(wide.width * wide.height);
        rows.for_each(|row| {
            light.extend(row[wide.left..][..wide.width].iter().map(|v| v.map(|v| v * share)))
        });
        Exposure { config: &self.config, camera: &self.camera, exposed }.add(&mut light, &wide);
        let rgb = self.electrons.read(sensor, &light, &Mosaic { size, wide, part, number: exposed.number });
        let Exposed { number, start_s, exposure_s, .. } = *exposed;
        Image { width, height, rgb, number, start_s, exposure_s }
    }

    /// From the first row's start until the image is there, s, for a delay between none and the longest: 0 to 1.
    pub fn delay_s(&self, exposure_s: f64, share: f64) -> f64 {
        let [least, most] = self.config.delay_s;
        exposure_s + self.config.sensor.readout_s + least + share.clamp(0.0, 1.0) * (most - least)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tracelight_aim::{CameraPose, Lens};
    use tracelight_stroke::{Affine, Point, Vec2};

    fn camera() -> Camera {
        let lens = Lens { radial: [-0.1, 0.0, 0.0], ..Lens::ideal(320, 240, 300.0) };
        Camera { lens, pose: CameraPose::looking_at([0.2, 0.1, 1.0], [0.0; 3]).unwrap() }
    }

    /// Without noise; a spot that fills pixels nearly.
    fn quiet(brightness: f64) -> CameraConfig {
        let usual = CameraConfig::webcam();
        let sensor = Sensor { full_well: 1e9, read_noise: 0.0, gamma: 1.0, bayer: false, ..usual.sensor };
        let laser = Laser { speckle: 0.0, brightness: [brightness, 0.0, 0.0], ..usual.laser };
        CameraConfig { vignetting: 0.0, light: [1.0, 1.0], sensor, laser, ..usual }
    }

    fn dark() -> Wall {
        Wall { plain: [0.0; 3], posters: vec![] }
    }

    /// Where the red light of an image is, and how much there is.
    fn centroid(image: &Image) -> (Point, f64) {
        let (mut sum, mut moment) = (0.0, Vec2::ZERO);
        for (i, pixel) in image.rgb.chunks_exact(3).enumerate() {
            let red = f64::from(pixel[0]);
            sum += red;
            moment += Vec2::new((i % image.width) as f64 + 0.5, (i / image.width) as f64 + 0.5) * red;
        }
        ((moment / sum).to_point(), sum)
    }

    fn rest(at: Point, until_s: f64) -> [SpotSample; 2] {
        [SpotSample { time_s: -1.0, at, light: true }, SpotSample { time_s: until_s, at, light: false }]
    }

    #[test]
    fn the_spot_is_seen_where_the_camera_has_it() {
        for at in [Point::new(0.1, 0.05), Point::new(-0.2, 0.13)] {
            let mut eye = SimulatedCamera::new(&quiet(14.0), &camera(), &dark(), 1);
            let image = eye.expose(0.0, 0.01, &rest(at, 1.0));
            let (seen, _) = centroid(&image);
            assert!(seen.distance(camera().pixel(at).unwrap()) < 0.02, "{seen}");
        }
    }

    #[test]
    fn a_moving_spot_leaves_a_streak_as_long_as_the_exposure() {
        let config = CameraConfig { sensor: Sensor { readout_s: 0.0, ..quiet(1.0).sensor }, ..quiet(150.0) };
        let at = |t: f64| Point::new(-0.15 + 10.0 * t, 0.02);
        let spots: Vec<SpotSample> = (0..40)
            .map(|k| SpotSample { time_s: 1e-3 * f64::from(k), at: at(1e-3 * f64::from(k)), light: true })
            .collect();
        let mut eye = SimulatedCamera::new(&config, &camera(), &dark(), 1);
        let (seen, _) = centroid(&eye.expose(0.01, 0.01, &spots));
        // the middle of the exposure is at 15 ms
        assert!(seen.distance(camera().pixel(at(0.015)).unwrap()) < 0.3, "{seen}");
        let (later, _) = centroid(&eye.expose(0.02, 0.01, &spots));
        assert!(later.distance(camera().pixel(at(0.025)).unwrap()) < 0.3, "{later}");
    }

    #[test]
    fn rows_are_exposed_one_after_the_other() {
        // a flash of 2 ms is on the rows that are open then: readout 25 ms, exposure 1 ms
        let flash = |at: Point, start_s: f64| {
            let mut eye = SimulatedCamera::new(&quiet(120.0), &camera(), &dark(), 1);
            let spots = [
                SpotSample { time_s: start_s, at, light: true },
                SpotSample { time_s: start_s + 2e-3, at, light: false },
            ];
            centroid(&eye.expose(0.0, 1e-3, &spots)).1
        };
        let (high, low) = (Point::new(0.0, 0.2), Point::new(0.0, -0.2));
        let row_s = |at: Point| 0.025 * camera().pixel(at).unwrap().y / 240.0;
        for (at, other) in [(high, low), (low, high)] {
            assert!(flash(at, row_s(at) - 0.5e-3) > 50.0);
            assert_eq!(flash(at, row_s(other) - 0.5e-3), 0.0);
        }
    }

    #[test]
    fn a_poster_lies_where_it_is_put() {
        // black but for a white square of 40 mm about (0.05, 0.03)
        let (middle, pixel_m) = (Vec2::new(0.05, 0.03), 1e-3);
        let pixels: Vec<[u8; 3]> = (0..100 * 100)
            .map(|i| {
                if (30..70).contains(&(i % 100)) && (30..70).contains(&(i / 100)) { [255; 3] } else { [0; 3] }
            })
            .collect();
        let place = Affine::scale_non_uniform(pixel_m, -pixel_m)
            .then_translate(middle + Vec2::new(-50.0 * pixel_m, 50.0 * pixel_m));
        let wall = Wall { plain: [0.0; 3], posters: vec![Poster::new(100, &pixels, place).unwrap()] };
        let mut eye = SimulatedCamera::new(&quiet(1.0), &camera(), &wall, 1);
        let (seen, _) = centroid(&eye.expose(0.0, 0.02, &[]));
        // a square's centroid is nearly its middle's image: perspective moves it by a tenth of a pixel here
        assert!(seen.distance(camera().pixel(middle.to_point()).unwrap()) < 0.15, "{seen}");
        assert!(Poster::new(7, &pixels[..20], place).is_none());
    }

    #[test]
    fn a_part_is_as_it_is_in_the_whole() {
        let wall = Wall { plain: [0.5, 0.3, 0.2], posters: vec![] };
        let eye = SimulatedCamera::new(&CameraConfig::webcam(), &camera(), &wall, 1);
        let at = Point::new(0.02, -0.01);
        let exposed = Exposed { number: 7, start_s: 0.0, exposure_s: 5e-3, spots: rest(at, 1.0).to_vec() };
        let whole = eye.develop(&exposed, &Part::whole([320, 240]));
        let spot = camera().pixel(at).unwrap();
        let about = Part { left: spot.x as usize - 15, top: spot.y as usize - 9, width: 31, height: 20 };
        for part in [
            about,
            Part { left: 0, top: 0, width: 5, height: 3 },
            Part { left: 313, top: 238, width: 99, height: 99 },
        ] {
            let image = eye.develop(&exposed, &part);
            assert_eq!(
                (image.width, image.height),
                (part.width.min(320 - part.left), part.height.min(240 - part.top))
            );
            for (y, row) in image.rgb.chunks_exact(3 * image.width).enumerate() {
                let first = 3 * ((part.top + y) * 320 + part.left);
                assert_eq!(row, &whole.rgb[first..first + row.len()], "{part:?} row {y}");
            }
        }
        assert!(eye.develop(&exposed, &Part { left: 400, ..about }).rgb.is_empty());
    }

    #[test]
    fn the_same_seed_gives_the_same_images() {
        let images = |seed: u64| {
            let wall = Wall { plain: [0.5; 3], posters: vec![] };
            let mut eye = SimulatedCamera::new(&CameraConfig::webcam(), &camera(), &wall, seed);
            (0..2)
                .map(|k| eye.expose(f64::from(k) / 30.0, 0.01, &rest(Point::ORIGIN, 0.05)).rgb)
                .collect::<Vec<_>>()
        };
        assert!(images(1) == images(1), "the same");
        assert!(images(1) != images(2), "noise that is not drawn from the seed");
    }
}
