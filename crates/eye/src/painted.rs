//! A light-painting of what a camera saw: the spot of each image, on the image in which the figure was found.

use tracelight_aim::Camera;
use tracelight_image::Grey;
use tracelight_picture::Raster;
use tracelight_stroke::{Point, Vec2};

/// Share of its light that is left of the wall, so that the spot stands out.
const DIMMED: f64 = 0.4;
/// Levels by which a pixel must be brighter with the spot than without, to be the spot's: more than noise and JPEG leave,
const LEAST_LEVELS: u8 = 16;
/// and as a share of the brightest.
const LEAST_SHARE: f64 = 0.12;
/// How bright the spot's middle is painted: red, green, blue.
const PAINT: [f64; 3] = [255.0, 70.0, 45.0];

/// A wall, and the light on it.
pub struct Painted {
    width: usize,
    height: usize,
    wall: Vec<u8>,
    /// How much of the paint is on each pixel, 0 to 1.
    paint: Vec<f32>,
    camera: Camera,
}

impl Painted {
    /// Nothing on a wall yet, as a camera shows it.
    #[must_use]
    pub fn new(wall: &Raster, camera: Camera) -> Self {
        let (width, height) = (wall.width() as usize, wall.height() as usize);
        Self { width, height, wall: wall.rgb().to_vec(), paint: vec![0.0; width * height], camera }
    }

    /// Adds what an image shows brighter than one without the spot, in a part of it that begins there; a camera that was moved since puts it
    /// where the first would have seen it.
    pub fn add(&mut self, lit: &Grey, dark: &Grey, begins: Vec2, camera: &Camera) {
        let brighter = |i: usize| lit.levels()[i].saturating_sub(dark.levels()[i]);
        let most = (0..lit.levels().len().min(dark.levels().len())).map(brighter).max().unwrap_or(0);
        let least = LEAST_LEVELS.max((LEAST_SHARE * f64::from(most)) as u8);
        for i in 0..lit.levels().len().min(dark.levels().len()) {
            let level = brighter(i);
            if level < least {
                continue;
            }
            let (x, y) = (i % lit.width(), i / lit.width());
            let pixel = Point::new(x as f64 + 0.5, y as f64 + 0.5) + begins;
            let first = if *camera == self.camera {
                Some(pixel)
            } else {
                camera.target(pixel).and_then(|at| self.camera.pixel(at))
            };
            let Some(Point { x, y }) = first.filter(|p| p.x >= 0.0 && p.y >= 0.0) else { continue };
            let (x, y) = (x as usize, y as usize);
            if x < self.width && y < self.height {
                let own = &mut self.paint[y * self.width + x];
                *own = own.max(f32::from(level) / f32::from(most));
            }
        }
    }

    /// As a picture.
    #[must_use]
    pub fn picture(&self) -> Option<Raster> {
        let of = |(i, &v): (usize, &u8)| {
            let share = f64::from(self.paint[i / 3]);
            let dim = DIMMED * f64::from(v);
            (dim + share * (PAINT[i % 3] - dim).max(0.0)).round() as u8
        };
        let rgb = self.wall.iter().enumerate().map(of).collect();
        Raster::new(self.width as u32, self.height as u32, rgb)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tracelight_aim::{CameraPose, Lens};

    #[test]
    fn only_what_the_spot_brightened_is_painted() {
        let camera = Camera {
            lens: Lens::ideal(64, 48, 60.0),
            pose: CameraPose::looking_at([0.0, 0.0, 1.0], [0.0; 3]).unwrap(),
        };
        let wall = Raster::new(64, 48, vec![100; 3 * 64 * 48]).unwrap();
        let mut painted = Painted::new(&wall, camera);
        let grey = |at: usize| {
            let levels = (0..16 * 16).map(|i| if i == at { 220 } else { 40 + (i % 7) as u8 }).collect();
            Grey::new(16, 16, levels).unwrap()
        };
        painted.add(&grey(16 * 5 + 9), &grey(9999), Vec2::new(16.0, 32.0), &camera);
        let picture = painted.picture().unwrap();
        let pixel = |x: usize, y: usize| &picture.rgb()[3 * (y * 64 + x)..][..3];
        assert_eq!(pixel(25, 37), [255, 70, 45]);
        assert_eq!(picture.rgb().chunks_exact(3).filter(|p| p[0] != 40).count(), 1);
        assert_eq!(pixel(24, 37), [40; 3]);
    }
}
