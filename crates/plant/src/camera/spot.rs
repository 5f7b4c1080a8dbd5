use tracelight_aim::Camera;
use tracelight_maths::{exp, hypot, powi};
use tracelight_stroke::{Point, Vec2};

use super::config::CameraConfig;
use super::exposed::Exposed;
use super::part::Part;
use super::splitmix::{GOLDEN, mixed};

/// Longest piece of a streak that is drawn as one, in deviations of the spot.
const PIECE: f64 = 0.25;
/// How far a spot reaches, deviations.
const REACH: f64 = 4.0;
/// Most pieces between two samples: a spot that crosses the image in a tick.
const MOST_PIECES: f64 = 4000.0;

/// An image while it is exposed.
pub(super) struct Exposure<'a> {
    pub(super) config: &'a CameraConfig,
    pub(super) camera: &'a Camera,
    pub(super) exposed: &'a Exposed,
}

impl Exposure<'_> {
    /// Adds what the spot leaves on each row while it is open, in a part of the image.
    pub(super) fn add(&self, light: &mut [[f32; 3]], part: &Part) {
        for pair in self.exposed.spots.windows(2) {
            let &[from, to] = pair else { continue };
            if !from.light || to.time_s <= from.time_s {
                continue;
            }
            let (Some(a), Some(b)) = (self.camera.pixel(from.at), self.camera.pixel(to.at)) else { continue };
            let Some(shape) = Shape::of(self.config, self.camera, from.at) else { continue };
            let pieces = (a.distance(b) / (PIECE * shape.least_px)).ceil().clamp(1.0, MOST_PIECES);
            let length_s = (to.time_s - from.time_s) / pieces;
            for k in 0..pieces as usize {
                let at = a.lerp(b, (k as f64 + 0.5) / pieces);
                let from_s = from.time_s + k as f64 * length_s - self.exposed.start_s;
                self.draw((&mut *light, part), &Piece { at, from_s, length_s }, &shape);
            }
        }
    }

    fn draw(&self, (light, part): (&mut [[f32; 3]], &Part), piece: &Piece, shape: &Shape) {
        let height = self.camera.lens.size_px[1];
        let (sensor, laser) = (&self.config.sensor, &self.config.laser);
        let range = |at: f64, reach: f64, first: usize, n: usize| {
            let within = |v: f64| v.clamp(first as f64, (first + n) as f64) as usize;
            within((at - reach).floor())..within((at + reach).ceil())
        };
        for row in range(piece.at.y, shape.reach.y, part.top, part.height) {
            let row_s = sensor.readout_s * row as f64 / height as f64;
            let until_s = (piece.from_s + piece.length_s).min(row_s + self.exposed.exposure_s);
            let open_s = until_s - piece.from_s.max(row_s);
            if open_s <= 0.0 {
                continue;
            }
            let share = shape.middle * open_s / sensor.reference_s;
            for column in range(piece.at.x, shape.reach.x, part.left, part.width) {
                let off = Point::new(column as f64 + 0.5, row as f64 + 0.5) - piece.at;
                let [a, b, c] = shape.inverse;
                let square = a * off.x * off.x + 2.0 * b * off.x * off.y + c * off.y * off.y;
                let grain = 1.0 + laser.speckle * grain(column, row, self.exposed.number);
                let here = share * exp(-0.5 * square) * grain.max(0.0);
                let pixel = &mut light[(row - part.top) * part.width + column - part.left];
                pixel.iter_mut().zip(laser.brightness).for_each(|(v, own)| *v += (own * here) as f32);
            }
        }
    }
}

/// A round spot seen askew and blurred: an ellipse.
#[derive(Clone, Copy, Debug)]
struct Shape {
    /// Inverse of its covariance, 1/px².
    inverse: [f64; 3],
    /// Deviations across and down, px.
    reach: Vec2,
    least_px: f64,
    /// How much brighter its middle is than blurred.
    middle: f64,
}

impl Shape {
    fn of(config: &CameraConfig, camera: &Camera, at: Point) -> Option<Self> {
        let [x, y] = camera.pixels_per_metre(at)?;
        let (beam, blur) = (powi(config.laser.radius_m, 2), powi(config.blur_px, 2));
        let spread =
            [beam * (x.x * x.x + y.x * y.x), beam * (x.x * x.y + y.x * y.y), beam * (x.y * x.y + y.y * y.y)];
        // a pixel is a twelfth of its square more
        let pixel = 1.0 / 12.0;
        let seen = [spread[0] + blur + pixel, spread[1], spread[2] + blur + pixel];
        let area = |[a, b, c]: [f64; 3]| (a * c - b * b).max(1e-12);
        let det = area(seen);
        let least = 0.5 * (seen[0] + seen[2] - hypot(seen[0] - seen[2], 2.0 * seen[1]));
        Some(Self {
            inverse: [seen[2] / det, -seen[1] / det, seen[0] / det],
            reach: Vec2::new(seen[0].sqrt(), seen[2].sqrt()) * REACH,
            least_px: least.sqrt(),
            middle: (area(spread) / det).sqrt(),
        })
    }
}

/// A piece of a streak.
struct Piece {
    at: Point,
    /// After the first row's start, s.
    from_s: f64,
    length_s: f64,
}

/// Speckle of a pixel in an image: between ±√3, evenly, of deviation one.
fn grain(column: usize, row: usize, image: u64) -> f64 {
    let bits = mixed((column as u64) << 40 ^ (row as u64) << 20 ^ image.wrapping_mul(GOLDEN));
    let even = bits as f64 / u64::MAX as f64;
    (2.0 * even - 1.0) * 3.0_f64.sqrt()
}
