//! Strokes on the target.

use tracelight_aim::{Placement, SizeRequest};
use tracelight_formats::{Reading, svg};
use tracelight_picture::Source;
use tracelight_stroke::{Affine, Drawing, Point, Vec2};

use tracelight_task::Failure;

use crate::choice::Choice;
use crate::sketch::{Sketch, sketch_at};
use crate::tracing::Tracing;

/// Width of a picture that says nothing of its size, m: 24 in.
const DEFAULT_WIDTH_M: f64 = 24.0 * 0.0254;

/// What of a picture is drawn, where and how large it lies on the target.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Placing {
    /// How large; otherwise as it is truly, or 24 in wide.
    pub size: Option<SizeRequest>,
    /// Where its centre goes, right and up of the target's, m.
    pub offset_m: Option<Vec2>,
    /// By how much it is turned anticlockwise, rad.
    pub rotation_rad: f64,
    /// Mirrored left to right.
    pub flip: bool,
    /// Which of its strokes.
    pub choice: Choice,
}

impl Placing {
    /// How long a unit of a sheet of such a size is on the target, m, if that is asked for.
    #[must_use]
    pub fn asked_m(&self, (width, height): (f64, f64)) -> Option<f64> {
        self.size.map(|size| match size {
            SizeRequest::Width(m) => m / width,
            SizeRequest::Height(m) => m / height,
        })
    }

    /// Where a sheet of a size in units of its own goes, as large as asked or so wide.
    #[must_use]
    pub fn placement(&self, (width, height): (f64, f64), width_m: f64) -> Placement {
        let upright = Placement::new(self.size.unwrap_or(SizeRequest::Width(width_m)), width, height);
        Placement {
            offset_m: self.offset_m.unwrap_or(upright.offset_m),
            rotation_rad: self.rotation_rad,
            flip: self.flip,
            ..upright
        }
    }

    /// How long a sheet's unit is on the target, m: as large as asked, as it is truly, or 24 in wide.
    #[must_use]
    pub fn metres_per_unit(&self, size: (f64, f64), true_width_m: Option<f64>) -> f64 {
        self.asked_m(size).unwrap_or_else(|| true_width_m.unwrap_or(DEFAULT_WIDTH_M) / size.0)
    }
}

/// Strokes on a page of their own, for a file.
#[derive(Clone, Debug)]
pub struct Page {
    /// Metres, y up, the origin at the page's centre.
    pub drawing: Drawing,
    /// The page's width, m.
    pub width_m: f64,
    /// The page's height, m.
    pub height_m: f64,
}

/// A drawing on the target.
#[derive(Clone, Debug)]
pub struct Placed {
    /// In target metres.
    pub drawing: Drawing,
    /// Size of the sheet on the target, m.
    pub size_m: (f64, f64),
    /// From the sheet to the target.
    pub target_from_sheet: Affine,
    /// Where the sheet's corners lie on the target, m.
    corners_m: [Point; 4],
}

impl Placed {
    /// A drawing in target metres, of a sheet of that size in units of its own.
    #[must_use]
    pub fn of(drawing: Drawing, (width, height): (f64, f64), target_from_sheet: Affine) -> Self {
        let corners = [(0.0, 0.0), (width, 0.0), (width, height), (0.0, height)];
        let unit_m = target_from_sheet.determinant().abs().sqrt();
        Self {
            drawing,
            size_m: (width * unit_m, height * unit_m),
            target_from_sheet,
            corners_m: corners.map(|(u, v)| target_from_sheet * Point::new(u, v)),
        }
    }

    /// Where the sheet's centre lies, m.
    pub(crate) fn centre(&self) -> Point {
        self.corners_m[0].midpoint(self.corners_m[2])
    }

    /// Its strokes as an SVG of true size.
    #[must_use]
    pub fn svg(&self, drawing: &Drawing) -> String {
        let Page { drawing, width_m, height_m } = self.page(drawing);
        svg::write(&drawing, width_m, height_m)
    }

    /// Strokes on a page that just holds the sheet as it lies, moved and turned.
    #[must_use]
    pub fn page(&self, drawing: &Drawing) -> Page {
        let corners = self.corners_m;
        let reach = |of: fn(&Point) -> f64| {
            let values = corners.iter().map(of);
            (values.clone().fold(f64::INFINITY, f64::min), values.fold(f64::NEG_INFINITY, f64::max))
        };
        let ((left, right), (low, high)) = (reach(|p| p.x), reach(|p| p.y));
        let to_centre = Vec2::new(-0.5 * (left + right), -0.5 * (low + high));
        let drawing = drawing.transformed(Affine::translate(to_centre));
        Page { drawing, width_m: right - left, height_m: high - low }
    }
}

/// As [`sketch_at`], of a sheet that goes where `placing` says.
///
/// # Errors
/// As there; and a drawing whose own size cannot be meant, if no other is asked for.
pub fn sketch(name: &str, source: Source, tracing: &Tracing, placing: &Placing) -> Result<Sketch, Failure> {
    if let (Source::Strokes(Reading { doubt: Some(doubt), .. }), None) = (&source, placing.size) {
        return Err(Failure::usage("size-not-meant", format!("{name}: {doubt}")));
    }
    let scale = |size: (f64, f64), true_width_m: Option<f64>| placing.metres_per_unit(size, true_width_m);
    sketch_at(name, source, tracing, &placing.choice, &scale)
}

/// Puts a sketch on the target: as large as asked, as it is truly, or 24 in wide.
#[must_use]
pub fn place(sketch: &Sketch, placing: &Placing) -> Placed {
    let placement = placing.placement(sketch.size, sketch.true_width_m.unwrap_or(DEFAULT_WIDTH_M));
    let width = sketch.size.0;
    let drawing = placement.place(&sketch.drawing, width);
    Placed {
        size_m: (placement.width_m, placement.height_m),
        ..Placed::of(drawing, sketch.size, placement.target_from_pixel(width))
    }
}
