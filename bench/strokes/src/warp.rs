use tracelight_stroke::{Affine, Drawing, Path, Point, Rect, Stroke, Vec2};

use crate::Size;

/// The distance of the camera, in picture widths.
const CAMERA_WIDTHS: f64 = 1.2;
/// The page is shown a little smaller, so that its near edge stays in the picture.
const SHRINK: f64 = 0.97;
/// Less of a tilt is none, rad.
const SQUARE_ON_RAD: f64 = 2e-3;
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
    /// How much smaller the page is shown.
    shrink: f64,
    /// The page's own turn, rad, and how far it lies from the picture's middle.
    turn: f64,
    shift: Vec2,
}

impl Warp {
    pub(crate) fn new(size: Size, axis_rad: f64, tilt_rad: f64) -> Self {
        let centre = Point::new(0.5 * size.width as f64, 0.5 * size.height as f64);
        let (sin, cos) = axis_rad.sin_cos();
        Self {
            centre,
            axis: (cos, sin),
            tilt: tilt_rad,
            distance: CAMERA_WIDTHS * size.width as f64,
            shrink: SHRINK,
            turn: 0.0,
            shift: Vec2::ZERO,
        }
    }

    /// The same, but the page is turned and fitted into a box of the picture: as large as the box allows.
    pub(crate) fn fitted(self, size: Size, turn_rad: f64, within: Rect) -> Self {
        let whole = Self { shrink: 1.0, turn: turn_rad, ..self };
        let seen = |warp: &Self| {
            let (w, h) = (size.width as f64, size.height as f64);
            let corners = [(0.0, 0.0), (w, 0.0), (w, h), (0.0, h)];
            corners
                .map(|c| warp.point(c.into()))
                .into_iter()
                .fold(Rect::from_points(warp.point(self.centre), warp.point(self.centre)), |bounds, p| {
                    bounds.union_pt(p)
                })
        };
        let full = seen(&whole);
        let shrink = (within.width() / full.width()).min(within.height() / full.height());
        let fitted = Self { shrink, ..whole };
        Self { shift: within.center() - seen(&fitted).center(), ..fitted }
    }

    /// Whether the page is seen from straight above.
    pub(crate) fn is_square_on(&self) -> bool {
        self.tilt.abs() < SQUARE_ON_RAD
    }

    /// The least scale at which any of the page is seen.
    pub(crate) fn least_scale(&self, size: Size) -> f64 {
        let (w, h) = (size.width as f64, size.height as f64);
        let corners = [(0.0, 0.0), (w, 0.0), (w, h), (0.0, h)];
        corners.map(|c| self.scale(c.into())).into_iter().fold(f64::INFINITY, f64::min)
    }

    /// Where a point of the page is seen.
    pub(crate) fn point(&self, p: Point) -> Point {
        let ((c, s), from) = (self.axis, p - self.centre);
        let ((oc, os), shift) = (self.seen_axis(), self.shift);
        let (along, aside) = (c * from.x + s * from.y, c * from.y - s * from.x);
        let seen = self.shrink * self.distance / (self.distance + aside * self.tilt.sin());
        let aside = aside * self.tilt.cos();
        self.centre + Vec2::new(oc * along - os * aside, os * along + oc * aside) * seen + shift
    }

    fn seen_axis(&self) -> (f64, f64) {
        let (sin, cos) = self.turn.sin_cos();
        (self.axis.0 * cos - self.axis.1 * sin, self.axis.1 * cos + self.axis.0 * sin)
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
