//! Strokes on the target.

use tracelight_aim::{MarkedBy, MarkedSheet, Placement, SheetMap, SizeRequest};
use tracelight_formats::{Reading, svg};
use tracelight_picture::{Raster, Source};
use tracelight_stroke::{Affine, Drawing, Path, Place, Point, Rect, Vec2, extent};

use tracelight_task::Failure;

use crate::align::{AlignFigures, AskedMark, aligned};
use crate::bent::bent;
use crate::choice::Choice;
use crate::edges::Origin;
use crate::frame::Frame;
use crate::no_go::{KeptDark, LeftOut, rectangle};
use crate::points::{Marked, Points, marked};
use crate::sketch::{Sketch, sketch_at};
use crate::tracing::{LeastLength, Tracing};

/// Width of a picture that says nothing of its size, m: 24 in.
const DEFAULT_WIDTH_M: f64 = 24.0 * 0.0254;

/// Largest side of a picture that marks bend, px.
const MOST_BENT_PX: f64 = 4096.0;

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
    /// What its width, height and corners are those of.
    pub fit: Fit,
    /// What its offset is measured from.
    pub from: Origin,
    /// Where marks of it belong; the turn, the size and the offset are theirs where they tell it.
    pub marks: Vec<AskedMark>,
    /// Areas of the target that are never lit, beside those of layers, m.
    pub no_go: Vec<Rect>,
    /// How far light stays from these, m: the spot's radius.
    pub margin_m: f64,
    /// Its places are marked, and its strokes are not drawn.
    pub points: Option<Points>,
    /// What is drawn round it before it is drawn.
    pub frame: Option<Frame>,
}

/// What a width, a height and corners are those of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Fit {
    /// All of the picture or the page, with what is empty round the drawing.
    #[default]
    Page,
    /// What is drawn.
    Drawing,
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

    /// Whether the size on the target is known only when the strokes are.
    fn is_sized_late(&self) -> bool {
        self.marks.len() > 1 || (self.fit == Fit::Drawing && self.size.is_some())
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
    /// How it lies by its marks, where there are any.
    pub align: Option<AlignFigures>,
    /// What of it is left out, where it is to keep out of something.
    pub left_out: Option<LeftOut>,
    /// Areas that are kept dark: closed paths.
    pub kept_dark: Vec<Path>,
    /// The places that the drawing marks in its order, where it does that.
    pub points: Vec<Place>,
    /// What shows where it will be, before it is drawn.
    pub frame: Option<Drawing>,
    /// What the user should know of where it lies: one sentence each.
    pub notes: Vec<String>,
    /// How its marks bend it, where `target_from_sheet` is not right everywhere.
    bent: Option<SheetMap>,
    /// Where the sheet's corners lie on the target, m.
    corners_m: [Point; 4],
}

impl Placed {
    /// Where the sheet's corners lie on the target, m: from its left top one clockwise, unless it is mirrored.
    #[must_use]
    pub const fn corners_m(&self) -> [Point; 4] {
        self.corners_m
    }

    /// A drawing in target metres, of a sheet of that size in units of its own.
    #[must_use]
    pub fn of(drawing: Drawing, (width, height): (f64, f64), target_from_sheet: Affine) -> Self {
        let corners = [(0.0, 0.0), (width, 0.0), (width, height), (0.0, height)];
        let unit_m = target_from_sheet.determinant().abs().sqrt();
        Self {
            drawing,
            size_m: (width * unit_m, height * unit_m),
            target_from_sheet,
            align: None,
            left_out: None,
            kept_dark: Vec::new(),
            points: Vec::new(),
            frame: None,
            notes: Vec::new(),
            bent: None,
            corners_m: corners.map(|(u, v)| target_from_sheet * Point::new(u, v)),
        }
    }

    /// Where the sheet's centre lies, m.
    #[must_use]
    pub fn centre(&self) -> Point {
        self.corners_m[0].midpoint(self.corners_m[2])
    }

    /// Where on the target a place of the sheet lies; `None` of one beyond the horizon of the wall.
    #[must_use]
    pub fn on_target(&self, at: Point) -> Option<Point> {
        match &self.bent {
            Some(map) => map.apply(at),
            None => Some(self.target_from_sheet * at),
        }
    }

    /// The picture as its marks bend it, and from its pixels to the target; `None` of one that lies by `target_from_sheet`.
    #[must_use]
    pub fn bent_picture(&self, picture: &Raster) -> Option<(Raster, Affine)> {
        let sheet_from_target = self.bent.as_ref()?.inverse()?;
        let sheet = Rect::new(0.0, 0.0, f64::from(picture.width()), f64::from(picture.height()));
        let [first, rest @ ..] = self.corners_m;
        let bounds = rest.iter().fold(Rect::from_points(first, first), |rect, &corner| rect.union_pt(corner));
        let unit_m = self.target_from_sheet.determinant().abs().sqrt();
        let pixel_m = unit_m.max(bounds.width().max(bounds.height()) / MOST_BENT_PX);
        let target_from_pixel = Affine::new([pixel_m, 0.0, 0.0, -pixel_m, bounds.x0, bounds.y1]);
        let side = |m: f64| (m / pixel_m).ceil().max(1.0) as u32;
        let bent = Raster::from_rows(side(bounds.width()), side(bounds.height()), |y, row| {
            for (x, pixel) in row.chunks_exact_mut(3).enumerate() {
                let at = target_from_pixel * Point::new(x as f64 + 0.5, f64::from(y) + 0.5);
                let at = sheet_from_target.apply(at).filter(|at| sheet.contains(*at));
                pixel.copy_from_slice(&at.map_or([255; 3], |at| picture.between(at)));
            }
        });
        Some((bent, target_from_pixel))
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
    if placing.is_sized_late() && matches!(tracing.min_length, LeastLength::Metres(m) if m > 0.0) {
        let message = "--min-length on the target needs a size that is told before the strokes are known: give it in pixels of the picture, such as 8px";
        return Err(Failure::usage("usage", message));
    }
    let asked = placing.size.or_else(|| (placing.marks.len() > 1).then_some(SizeRequest::Width(1.0)));
    if let (Source::Strokes(Reading { doubt: Some(doubt), .. }), None) = (&source, asked) {
        return Err(Failure::usage("size-not-meant", format!("{name}: {doubt}")));
    }
    let scale = |size: (f64, f64), true_width_m: Option<f64>| placing.metres_per_unit(size, true_width_m);
    sketch_at(name, source, tracing, &placing.choice, &scale)
}

/// Puts a sketch on the target: as large as asked, as it is truly, or 24 in wide; where asked, or where its marks belong. What lies in areas to keep out
/// of is left out.
///
/// # Errors
/// `align`, see [`AskedMark`]; `no-points` and `too-many-points`, see [`Points`]; `usage` for a size that the drawing cannot have; `no-strokes` if all of it is to be kept out of.
pub fn place(sketch: &Sketch, placing: &Placing) -> Result<Placed, Failure> {
    let mut placed =
        if placing.marks.is_empty() { laid(sketch, placing)? } else { by_marks(sketch, placing)? };
    placed.placed.notes.extend(placing.from.remark());
    let (areas, map) = (&sketch.no_go, &placed.map);
    let unit_m = placed.placed.target_from_sheet.determinant().abs().sqrt();
    let beyond = || {
        Failure::usage("align", "--align: the marks put a part of the drawing beyond the horizon of the wall")
    };
    let layers = moved(areas, map, unit_m).ok_or_else(beyond)?;
    let areas = placing.no_go.iter().filter_map(|area| rectangle(*area));
    let areas: Vec<Path> = layers.strokes.into_iter().map(|stroke| stroke.path).chain(areas).collect();
    let dark = KeptDark::of(&areas, placing.margin_m);
    if let Some(points) = &placing.points {
        let map = |at: Point| map.apply(at);
        let Marked { points, drawing, left_out, notes } = marked(sketch, points, &map, &dark)?;
        (placed.placed.points, placed.placed.drawing) = (points, drawing);
        placed.placed.left_out = left_out;
        placed.placed.notes.extend(notes);
    } else if !dark.is_empty() {
        let (drawing, left_out) = dark.cut(&placed.placed.drawing);
        if drawing.strokes.is_empty() {
            let message = "all of the drawing lies in what --no-go keeps dark: move it, or keep less dark";
            return Err(Failure::failed("no-strokes", message));
        }
        placed.placed.notes.push(left_out.words());
        placed.placed.drawing = drawing;
        placed.placed.left_out = Some(left_out);
    }
    placed.placed.kept_dark = areas;
    placed.placed.frame = placing.frame.map(|frame| dark.cut(&frame.of(&placed.placed.drawing)).0);
    Ok(placed.placed)
}

/// A drawing on the target, and how it came there.
struct Laid {
    placed: Placed,
    map: SheetMap,
}

/// A drawing by a map: a similarity keeps arcs as arcs.
fn moved(drawing: &Drawing, map: &SheetMap, unit_m: f64) -> Option<Drawing> {
    match map {
        SheetMap::Affine(map) if is_similarity(*map) => Some(drawing.transformed(*map)),
        _ => bent(drawing, map, unit_m),
    }
}

fn is_similarity(map: Affine) -> bool {
    let [a, b, c, d, _, _] = map.as_coeffs();
    let (x, y) = (Vec2::new(a, b), Vec2::new(c, d));
    let size = x.hypot2().max(y.hypot2());
    (x.hypot2() - y.hypot2()).abs() < 1e-9 * size && x.dot(y).abs() < 1e-9 * size
}

/// What of a sheet a width, a height and corners are those of, in its units.
fn fitted(sketch: &Sketch, placing: &Placing) -> Rect {
    let page = Rect::new(0.0, 0.0, sketch.size.0, sketch.size.1);
    match placing.fit {
        Fit::Page => page,
        Fit::Drawing => {
            let places = sketch.places.iter().filter(|_| placing.points.is_some());
            let places = places.map(|place| Rect::from_points(place.at, place.at));
            extent(&sketch.drawing)
                .into_iter()
                .chain(places)
                .reduce(|all, one| all.union(one))
                .unwrap_or(page)
        }
    }
}

/// Length of the sheet's unit on the target, m: by the size asked for, or its own.
fn unit_m(sketch: &Sketch, placing: &Placing, of: Rect) -> Result<f64, Failure> {
    let own = || sketch.true_width_m.map_or(DEFAULT_WIDTH_M / of.width(), |m| m / sketch.size.0);
    let (unit_m, lacks, way_out) = match placing.size {
        Some(SizeRequest::Width(m)) => (m / of.width(), "width", "--height"),
        Some(SizeRequest::Height(m)) => (m / of.height(), "height", "--width"),
        None => (own(), "width", "--height"),
    };
    if unit_m.is_finite() {
        return Ok(unit_m);
    }
    Err(Failure::usage(
        "usage",
        format!("--fit drawing: what is drawn has no {lacks}: give {way_out}, or --fit page"),
    ))
}

/// Where it is asked to be.
fn laid(sketch: &Sketch, placing: &Placing) -> Result<Laid, Failure> {
    let of = fitted(sketch, placing);
    let unit_m = unit_m(sketch, placing, of)?;
    if placing.fit == Fit::Page && placing.from == Origin::default() {
        let placement = placing.placement(sketch.size, sketch.true_width_m.unwrap_or(DEFAULT_WIDTH_M));
        let map = placement.target_from_pixel(sketch.size.0);
        let drawing = placement.place(&sketch.drawing, sketch.size.0);
        let size_m = (placement.width_m, placement.height_m);
        return Ok(Laid {
            placed: Placed { size_m, ..Placed::of(drawing, sketch.size, map) },
            map: SheetMap::Affine(map),
        });
    }
    let size_m = (unit_m * of.width(), unit_m * of.height());
    let upright = Placement {
        width_m: unit_m * sketch.size.0,
        height_m: unit_m * sketch.size.1,
        offset_m: Vec2::ZERO,
        rotation_rad: placing.rotation_rad,
        flip: placing.flip,
    };
    let turned = upright.target_from_pixel(sketch.size.0);
    let lies = turned.transform_rect_bbox(of);
    let asked = placing.from.place(placing.offset_m.unwrap_or(Vec2::ZERO));
    let map = turned.then_translate(asked - placing.from.corner.of(lies));
    let drawing = sketch.drawing.transformed(map);
    Ok(Laid {
        placed: Placed { size_m, ..Placed::of(drawing, sketch.size, map) },
        map: SheetMap::Affine(map),
    })
}

/// Where its marks belong.
fn by_marks(sketch: &Sketch, placing: &Placing) -> Result<Laid, Failure> {
    let of = fitted(sketch, placing);
    let drawn = extent(&sketch.drawing).unwrap_or(of);
    let is_told = placing.marks.len() == 1 || placing.size.is_some();
    let sheet = MarkedSheet {
        unit_m: is_told.then(|| unit_m(sketch, placing, of)).transpose()?,
        rotation_rad: placing.rotation_rad,
        flip: placing.flip,
        corners: [(drawn.x0, drawn.y0), (drawn.x1, drawn.y0), (drawn.x1, drawn.y1), (drawn.x0, drawn.y1)]
            .map(Point::from),
    };
    let (found, figures) = aligned(sketch, &placing.marks, &sheet)?;
    let beyond = || {
        Failure::usage("align", "--align: the marks put a part of the drawing beyond the horizon of the wall")
    };
    let drawing = moved(&sketch.drawing, &found.map, found.unit_m).ok_or_else(beyond)?;
    let near = found.map.near(drawn.center()).ok_or_else(beyond)?;
    let mut placed = Placed::of(drawing, sketch.size, near);
    placed.size_m = (found.unit_m * of.width(), found.unit_m * of.height());
    if found.by == MarkedBy::Projective {
        placed.bent = Some(found.map);
        placed.corners_m = sheet.corners.map(|corner| found.map.apply(corner).unwrap_or(near * corner));
    }
    placed.notes = figures.words(found.by);
    placed.align = Some(figures);
    Ok(Laid { placed, map: found.map })
}
