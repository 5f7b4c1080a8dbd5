use tracelight_maths::{exp, planar, powi};
use tracelight_picture::Raster;
use tracelight_stroke::{Affine, Point, Vec2};

use super::film::linear_from_srgb;
use super::layout::{Layout, SHEET_OVER_PICTURE};
use super::lettering::Pen;
use super::plane::Plane;
use crate::finished::{DISPLAY_TOLERANCE_M, Finished};

/// The picture on a sheet of paper, pinned to the wall a little askew.
pub(super) struct Sheet {
    picture: Raster,
    linear: [f32; 256],
    /// From painting pixels to the sheet: pixels from its middle, along its edges.
    sheet_from_pixel: Affine,
    /// Half of the picture's size on the sheet.
    picture_half: Vec2,
    /// Half of the sheet's.
    half: Vec2,
    /// Its size over that of a sheet as large as there is room for: of pin and shadow too.
    scale: f64,
}

/// What the sheet does to a pixel of the wall.
pub(super) struct Cover {
    /// Share of the pixel that is paper, or the pin in it.
    pub(super) share: f32,
    /// What it sends back of the light, per channel.
    pub(super) albedo: [f32; 3],
    /// Share of the lamp's light its shadow leaves for the wall.
    pub(super) unshadowed: f32,
}

/// Nobody hangs a sheet quite level.
const TILT_RAD: f64 = -0.022;
const PAPER: [f32; 3] = [0.86, 0.83, 0.76];
const SHADOW_OFFSET_PX: Vec2 = Vec2::new(7.0, 12.0);
/// The longer side of the picture on a sheet for which the sizes here are.
const FULL_PX: f64 = 400.0;
const SHADOW_SOFT_PX: f64 = 22.0;
const PIN_RADIUS_PX: f64 = 6.5;

impl Sheet {
    /// Prepares a job's picture, or a drawing of its strokes where there is none.
    pub(super) fn new(job: &Finished<'_>, layout: &Layout) -> Self {
        // twice the size it is shown at: sharp under the slight turn
        let side = (layout.sheet_size.x.max(layout.sheet_size.y) * 2.0) as u32;
        let picture_half = layout.sheet_size / 2.0;
        let longest = layout.sheet_size.x.max(layout.sheet_size.y);
        let margin = 0.5 * (SHEET_OVER_PICTURE - 1.0) * longest;
        Self {
            picture: job.picture.map_or_else(|| drawn(job, layout), |p| p.raster.shrunk(side)),
            linear: std::array::from_fn(|i| linear_from_srgb(i as u8)),
            sheet_from_pixel: planar::rotation(-TILT_RAD) * Affine::translate(-layout.sheet_middle.to_vec2()),
            picture_half,
            half: picture_half + Vec2::new(margin, margin),
            scale: (longest / FULL_PX).clamp(0.02, 1.0),
        }
    }

    /// What lies at a pixel; `None` where neither the sheet nor its shadow reaches.
    pub(super) fn at(&self, x: usize, y: usize) -> Option<Cover> {
        let p = self.sheet_from_pixel * Point::new(x as f64 + 0.5, y as f64 + 0.5);
        let (offset, soft) = (SHADOW_OFFSET_PX * self.scale, SHADOW_SOFT_PX * self.scale);
        let shadow_edge = outside(p - offset, self.half);
        if shadow_edge > 3.0 * soft {
            return None;
        }
        let share = (0.5 - outside(p, self.half)).clamp(0.0, 1.0) as f32;
        let shadow = 1.0 / (1.0 + exp((shadow_edge + 4.0 * self.scale) / (0.3 * soft)));
        Some(Cover { share, albedo: self.albedo(p), unshadowed: 1.0 - 0.8 * shadow as f32 })
    }

    fn albedo(&self, p: Point) -> [f32; 3] {
        // as it is on a sheet of full size
        let pin = (p - Point::new(0.0, -self.half.y + 15.0 * self.scale)) / self.scale;
        let pin_shadow = 1.0 - 0.45 * falloff((pin - Vec2::new(4.0, 6.0)).hypot(), PIN_RADIUS_PX + 1.0, 3.0);
        let curl = 1.0 - 0.10 * powi((p.y / self.half.y + 1.0) / 2.0, 3) as f32;
        let shade = pin_shadow as f32 * curl;
        let inside = outside(p, self.picture_half);
        let ink = (0.5 - inside).clamp(0.0, 1.0) as f32;
        let bevel = 1.0 - 0.16 * falloff((inside - 2.0).abs(), 0.6, 0.8) as f32;
        let print = self.print(p);
        let on_pin = falloff(pin.hypot(), PIN_RADIUS_PX, 0.7 / self.scale) as f32;
        let pin = pin_colour(pin);
        std::array::from_fn(|c| {
            let paper = PAPER[c] * shade * (print[c] * ink + bevel * (1.0 - ink));
            paper * (1.0 - on_pin) + pin[c] * on_pin
        })
    }

    /// The picture's linear colour at a place of the sheet.
    fn print(&self, p: Point) -> [f32; 3] {
        let (w, h) = (f64::from(self.picture.width()), f64::from(self.picture.height()));
        let u = (p.x / self.picture_half.x + 1.0) / 2.0 * w - 0.5;
        let v = (p.y / self.picture_half.y + 1.0) / 2.0 * h - 0.5;
        let (left, top) = (u.floor(), v.floor());
        let (fu, fv) = ((u - left) as f32, (v - top) as f32);
        let at = |du: i64, dv: i64| self.picture.pixel(left as i64 + du, top as i64 + dv);
        let (a, b, c, d) = (at(0, 0), at(1, 0), at(0, 1), at(1, 1));
        std::array::from_fn(|i| {
            let [a, b, c, d] = [a, b, c, d].map(|pixel| self.linear[usize::from(pixel[i])]);
            let (upper, lower) = (a + (b - a) * fu, c + (d - c) * fu);
            upper + (lower - upper) * fv
        })
    }
}

/// Signed distance to a rectangle about the origin; negative inside.
fn outside(p: Point, half: Vec2) -> f64 {
    let d = Vec2::new(p.x.abs() - half.x, p.y.abs() - half.y);
    Vec2::new(d.x.max(0.0), d.y.max(0.0)).hypot() + d.x.max(d.y).min(0.0)
}

/// One up to `radius`, zero from `soft` beyond it.
fn falloff(distance: f64, radius: f64, soft: f64) -> f64 {
    ((radius + soft - distance) / soft).clamp(0.0, 1.0)
}

/// A brass ball lit from the upper left.
fn pin_colour(at: Vec2) -> [f32; 3] {
    let lift = (1.0 - powi(at.hypot() / PIN_RADIUS_PX, 2)).max(0.0).sqrt();
    let facing = (-0.55 * at.x - 0.6 * at.y) / PIN_RADIUS_PX + 0.58 * lift;
    let glint = falloff((at - Vec2::new(-2.0, -2.2)).hypot(), 0.6, 1.8) as f32;
    let body = (0.22 + 0.9 * facing.max(0.0)) as f32;
    [0.85, 0.56, 0.22].map(|c: f32| c * body + 1.4 * glint)
}

/// The strokes in ink on white, for a job whose picture has no pixels.
fn drawn(job: &Finished<'_>, layout: &Layout) -> Raster {
    let size = layout.sheet_size * 2.0;
    let (low, high) = job.bounds();
    let scale = (size.x / (high.x - low.x)).min(size.y / (high.y - low.y));
    let place = Affine::scale_non_uniform(scale, -scale) * Affine::translate((-low.x, -high.y));
    let mut ink = Plane::dark(size.x.ceil() as usize, size.y.ceil() as usize);
    for stroke in &job.drawing.strokes {
        let line: Vec<_> = stroke.path.flatten(DISPLAY_TOLERANCE_M).iter().map(|&p| place * p).collect();
        Pen { radius: 1.6, strength: 1.0 }.line(&mut ink, &line);
    }
    Raster::from_rows(ink.width as u32, ink.height as u32, |y, row| {
        for (out, &covered) in row.chunks_exact_mut(3).zip(ink.row(y as usize)) {
            out.fill((250.0 - 215.0 * covered) as u8);
        }
    })
}
