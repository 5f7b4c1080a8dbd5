use tracelight_maths::planar;
use tracelight_stroke::{Affine, Drawing, Vec2};

/// The size a picture is asked to have on the target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SizeRequest {
    /// Width, m; the height follows.
    Width(f64),
    /// Height, m; the width follows.
    Height(f64),
}

/// How a picture lies on the target: pixel frame to target frame.
///
/// Without offset, turn or flip a picture W × H traced at width w has pixel point (u, v) at
/// x = (u/W − ½) w, y = (½ − v/H) wH/W.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// Width of the upright picture on the target, m.
    pub width_m: f64,
    /// Height of the upright picture on the target, m.
    pub height_m: f64,
    /// Where its centre goes, m right and up.
    pub offset_m: Vec2,
    /// Turned anticlockwise as seen from the head, rad.
    pub rotation_rad: f64,
    /// Mirrored left to right before it is turned.
    pub flip: bool,
}

impl Placement {
    /// Upright and centred, for a sheet of the given pixel size.
    pub fn new(size: SizeRequest, sheet_width: f64, sheet_height: f64) -> Self {
        let (width_m, height_m) = match size {
            SizeRequest::Width(w) => (w, w * sheet_height / sheet_width),
            SizeRequest::Height(h) => (h * sheet_width / sheet_height, h),
        };
        Self { width_m, height_m, offset_m: Vec2::ZERO, rotation_rad: 0.0, flip: false }
    }

    /// target_from_pixel for a sheet of the given width in pixels.
    pub fn target_from_pixel(&self, sheet_width: f64) -> Affine {
        let scale = self.width_m / sheet_width;
        let centred = Affine::scale_non_uniform(scale, -scale)
            .then_translate(Vec2::new(-self.width_m / 2.0, self.height_m / 2.0));
        let flipped = if self.flip { centred.then_scale_non_uniform(-1.0, 1.0) } else { centred };
        (planar::rotation(self.rotation_rad) * flipped).then_translate(self.offset_m)
    }

    /// Transforms a drawing from pixels to the target, m.
    pub fn place(&self, pixels: &Drawing, sheet_width: f64) -> Drawing {
        pixels.transformed(self.target_from_pixel(sheet_width))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;
    use tracelight_stroke::Point;

    fn check(placement: Placement, pixel: (f64, f64), target: (f64, f64)) {
        let got = placement.target_from_pixel(640.0) * Point::new(pixel.0, pixel.1);
        assert!(got.distance(Point::new(target.0, target.1)) < 1e-12, "{got:?}");
    }

    #[test]
    fn a_pixel_lands_where_the_contract_says() {
        let plain = Placement::new(SizeRequest::Width(0.64), 640.0, 480.0);
        assert!((plain.height_m - 0.48).abs() < 1e-15);
        check(plain, (0.0, 0.0), (-0.32, 0.24));
        check(plain, (640.0, 480.0), (0.32, -0.24));
        check(Placement { flip: true, ..plain }, (0.0, 0.0), (0.32, 0.24));
        check(Placement { rotation_rad: FRAC_PI_2, ..plain }, (640.0, 240.0), (0.0, 0.32));
        check(Placement { offset_m: Vec2::new(0.1, 0.2), ..plain }, (320.0, 240.0), (0.1, 0.2));
    }

    #[test]
    fn a_height_sets_the_width() {
        let placed = Placement::new(SizeRequest::Height(0.3), 400.0, 200.0);
        assert!((placed.width_m - 0.6).abs() < 1e-15);
    }
}
