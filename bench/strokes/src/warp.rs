use tracelight_stroke::{Affine, Drawing, Path, Point, Stroke};

use crate::Size;

/// The distance of the camera, in picture widths.
const CAMERA_WIDTHS: f64 = 1.2;
/// The page is shown a little smaller, so that its near edge stays in the picture.
const SHRINK: f64 = 0.97;
/// Truth that was straight, an arc or a cubic is followed to this, px.
const TOLERANCE_PX: f64 = 0.004;

/// A page seen from a little aside: a rotation about an axis in its plane, then a pinhole camera.
#[derive(Clone, Copy)]
pub(crate) struct Warp {
    centre: Point,
    /// Unit vector along the axis.
    axis: (f64, f64),
    tilt: f64,
    distance: f64,
}

impl Warp {
    pub(crate) fn new(size: Size, axis_rad: f64, tilt_rad: f64) -> Self {
        let centre = Point::new(0.5 * size.width as f64, 0.5 * size.height as f64);
        let (sin, cos) = axis_rad.sin_cos();
        Self { centre, axis: (cos, sin), tilt: tilt_rad, distance: CAMERA_WIDTHS * size.width as f64 }
    }

    /// Where a point of the page is seen.
    pub(crate) fn point(&self, p: Point) -> Point {
        let ((c, s), from) = (self.axis, p - self.centre);
        let (along, aside) = (c * from.x + s * from.y, c * from.y - s * from.x);
        let seen = SHRINK * self.distance / (self.distance + aside * self.tilt.sin());
        let aside = aside * self.tilt.cos();
        self.centre + tracelight_stroke::Vec2::new(c * along - s * aside, s * along + c * aside) * seen
    }

    /// How much larger things are seen at a point of the page.
    pub(crate) fn scale(&self, p: Point) -> f64 {
        let near = |x: f64, y: f64| self.point(Point::new(p.x + x, p.y + y)) - self.point(p);
        near(1.0, 0.0).cross(near(0.0, 1.0)).abs().sqrt()
    }

    /// A path as it is seen.
    pub(crate) fn path(&self, path: &Path) -> Path {
        let points: Vec<_> = dense(path).into_iter().map(|p| self.point(p)).collect();
        Path::polyline(&points[..points.len() - usize::from(path.is_closed())], path.is_closed())
            .unwrap_or_else(|| path.transformed(Affine::IDENTITY))
    }

    /// Strokes as they are seen.
    pub(crate) fn drawing(&self, strokes: &[Stroke]) -> Drawing {
        let seen = |s: &Stroke| s.along(self.path(&s.path));
        Drawing { strokes: strokes.iter().map(seen).collect() }
    }
}

/// Points of a path; a straight line stays one under perspective, and needs none between.
fn dense(path: &Path) -> Vec<Point> {
    path.flatten(TOLERANCE_PX)
}
