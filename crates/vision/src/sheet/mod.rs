//! The sheet of paper that was photographed or scanned, and what lies beside it.
//!
//! Its border is a long step of brightness that is seen from one side only: a line comes back behind it, a table does
//! not. On the picture averaged down to some 180 rows, medians over five pixels take lines out (`steps`); what steps
//! are left are gathered into straight sides (`sides`), which may go on as a dark line where the sheet lies on another
//! one. Of these and the picture's own borders the quadrilateral (`quad`) with most of its sides seen is chosen (`choice`),
//! a shadow that falls across it with it (`shade`), if what is seen along it and beside it says that it is a sheet
//! (`evidence`), and moved on to the full picture's steps (`edge`). Where it runs out of the picture a narrow strip of
//! the table may be left along the border (`rim`). All beside it, with what reaches in from there (`over`), is given its
//! paper's brightness (`alone`).

mod alone;
mod choice;
mod edge;
mod evidence;
mod over;
mod quad;
mod rim;
mod shade;
mod sides;
mod steps;

use std::borrow::Cow;
use std::cell::OnceCell;

use tracelight_image::border::area;
use tracelight_image::levels::sampled_histogram;
use tracelight_image::{Grey, Mask, Plane, Region, regions};
use tracelight_stroke::{Point, Vec2};

use crate::tones::Tones;
use alone::{Alone, alone};
use edge::Edge;
use quad::Quad;

/// A sheet of paper in a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Sheet {
    /// Where its paper ends, clockwise from the upper left, px; where it runs out of the picture, the picture's border.
    /// A bent side has more points than its ends.
    pub outline: Vec<Point>,
    /// Its corners, clockwise from the upper left, px, where all four of its sides are in the picture.
    pub corners: Option<[Point; 4]>,
    /// Share of the picture that lies beside it.
    pub beside: f64,
}

/// A copied page fills the sheet that was found within this share, and so much of the picture at least is drawn on it.
const SAME_AREA: f64 = 0.02;
const LEAST_DRAWN: f64 = 0.001;

/// What of a picture is looked at.
#[derive(Clone, Debug)]
pub struct Page<'a> {
    /// The picture, or the part of it that holds its sheet.
    pub picture: Cow<'a, Grey>,
    /// Of the whole picture, px.
    pub size: (usize, usize),
    /// Where the first pixel of that part lies in the whole, px to the right and down.
    pub origin: (usize, usize),
    /// The sheet; `None` where all of the picture is one, or none is seen.
    pub sheet: Option<Sheet>,
    pub(crate) beside: Option<Beside>,
    /// The whole picture, where the sheet was looked for and found in it.
    whole: Option<&'a Grey>,
    /// Whether the sheet is seen to be brighter than what lies beside it: its paper is, not its ink.
    pub(crate) is_brighter: bool,
    /// The quadrilateral on whose lines its sides lie, clockwise from the upper left, px of the whole picture.
    square: Option<[Point; 4]>,
}

/// What of a page's picture is not its sheet's.
#[derive(Clone, Debug)]
pub(crate) struct Beside {
    pub(crate) mask: Mask,
    /// The picture with paper in its place.
    pub(crate) papered: Plane<u8>,
}

impl<'a> Page<'a> {
    /// All of a picture.
    pub const fn whole(image: &'a Grey) -> Self {
        let size = (image.width(), image.height());
        let (picture, origin) = (Cow::Borrowed(image), (0, 0));
        Self {
            picture,
            size,
            origin,
            sheet: None,
            beside: None,
            whole: None,
            is_brighter: false,
            square: None,
        }
    }

    /// The sheet in a picture, if there is one, else all of it. In one of two tones what is white on black is a silhouette, unless it is
    /// a page that was copied with a black margin.
    pub fn of(image: &'a Grey) -> Self {
        let found = Small::of(image.plane()).and_then(|small| {
            let found = Found::of(image.plane(), &small)?;
            let tones = Tones::of(&sampled_histogram(image.plane()));
            let is_sheet = tones.is_none_or(|tones| is_page(image.plane(), tones, &found.sheet));
            is_sheet.then(|| (alone(image.plane(), &small, &found), found))
        });
        found.map_or(Self::whole(image), |(alone, Found { sheet, quad, square, .. })| Self {
            whole: Some(image),
            is_brighter: quad.is_brighter && quad.seen() > 0,
            square,
            ..Self::cut(image, alone, sheet)
        })
    }

    /// What of a picture lies within four corners, clockwise from the upper left, px; `None` where they are no
    /// quadrilateral of some size in it.
    pub fn within(image: &'a Grey, corners: [Point; 4]) -> Option<Self> {
        let side = image.width().min(image.height());
        let small = Small::by(image.plane(), (side / SIDE).max(1));
        let found = Found::within(image.plane(), &small, corners)?;
        let alone = alone(image.plane(), &small, &found);
        Some(Self { square: found.square, ..Self::cut(image, alone, found.sheet) })
    }

    fn cut(image: &Grey, alone: Alone, sheet: Sheet) -> Self {
        Self {
            picture: Cow::Owned(Grey::of_part(alone.plane)),
            size: (image.width(), image.height()),
            origin: alone.origin,
            sheet: Some(sheet),
            beside: Some(alone.beside),
            whole: None,
            is_brighter: false,
            square: None,
        }
    }

    /// Where the lines of the sheet's sides meet, px of its picture of which so many either way are one.
    pub(crate) fn lines_meet(&self, reduction: usize) -> Option<[Point; 4]> {
        let (right, down) = (self.origin.0 as f64, self.origin.1 as f64);
        let by = reduction as f64;
        self.square.map(|corners| corners.map(|at| Point::new((at.x - right) / by, (at.y - down) / by)))
    }

    /// What tells whether a drawing was given: all of the picture, but for what its corners were told of.
    pub(crate) fn given(&self) -> &Grey {
        self.whole.unwrap_or(&self.picture)
    }
}

/// A sheet, and what is known of it at a smaller scale.
struct Found {
    sheet: Sheet,
    quad: Quad,
    /// On whose lines its sides lie.
    square: Option<[Point; 4]>,
    /// How far inside its edge that is over.
    blur_px: f64,
}

impl Found {
    fn of(plane: &Plane<u8>, small: &Small) -> Option<Self> {
        let by = |quad: Quad| {
            let Edge { sheet, square, blur_px } = edge::sheet(plane, small, &quad)?;
            Some(Self { sheet, quad, square, blur_px })
        };
        choice::best(small).and_then(by).or_else(|| by(Quad::all(&small.levels)))
    }

    /// What someone says to be one.
    fn within(plane: &Plane<u8>, small: &Small, corners: [Point; 4]) -> Option<Self> {
        let by = small.by as f64;
        let quad = Quad::between(corners.map(|c| Point::new(c.x / by, c.y / by)))?;
        let sheet = edge::between(plane, corners)?;
        Some(Self { sheet, quad, square: Some(corners), blur_px: 0.0 })
    }
}

/// Whether what has the brighter of two tones is the sheet and nothing else, and something is drawn on it.
fn is_page(plane: &Plane<u8>, tones: Tones, sheet: &Sheet) -> bool {
    let pixels = plane.values.len() as f64;
    let dark = tones.dark(plane);
    let (beside, drawn): (Vec<Region>, Vec<Region>) =
        regions(&dark).into_iter().partition(|region| region.at_border_px(&dark) > 0);
    let px = |regions: &[Region]| regions.iter().map(Region::area).sum::<usize>() as f64;
    let page = pixels - px(&beside);
    let is_sheet = (page - area(&sheet.outline)).abs() < SAME_AREA * page;
    is_sheet && !beside.is_empty() && px(&drawn) > LEAST_DRAWN * pixels
}

/// The way into what lies on the right of the way from one place to another, square to that: clockwise round a sheet, into it.
fn inward(from: Point, to: Point) -> Vec2 {
    let way = (to - from) / from.distance(to).max(1e-9);
    Vec2::new(-way.y, way.x)
}

/// A frame along the picture's border is as wide everywhere within so many px, and as a share.
const SAME_WIDTH_PX: f64 = 1.0;
const SAME_WIDTH: f64 = 0.15;

/// Whether some widths are those of one frame, px.
fn are_as_wide(widths: impl Iterator<Item = f64>) -> bool {
    let (narrowest, widest) =
        widths.fold((f64::INFINITY, 0.0_f64), |(low, high), width| (low.min(width), high.max(width)));
    widest - narrowest < SAME_WIDTH_PX + SAME_WIDTH * widest
}

/// About so many rows, or columns, tell where a sheet lies.
const SIDE: usize = 180;
/// And at most so many the other way.
const LONGER: usize = 600;
/// Levels beside a side are taken so far from it, px.
const BESIDE: f64 = 4.0;
/// With fewer pixels a side a picture shows a figure, hardly its surroundings.
const LEAST_SIDE: usize = 64;

/// A picture averaged down.
struct Small {
    /// Pixels of the picture in one, either way.
    by: usize,
    levels: Plane<u8>,
    /// The same without lines; most pictures are known to show no sheet before it is asked for.
    calm: OnceCell<Plane<u8>>,
}

impl Small {
    /// `None` of a picture that is too small to show more than a figure.
    fn of(plane: &Plane<u8>) -> Option<Self> {
        let side = plane.width.min(plane.height);
        let longer = plane.width.max(plane.height);
        (side >= LEAST_SIDE).then(|| Self::by(plane, (side / SIDE).max(longer / LONGER).max(1)))
    }

    fn by(plane: &Plane<u8>, by: usize) -> Self {
        Self { by, levels: plane.reduced(by), calm: OnceCell::new() }
    }

    /// Without its lines.
    fn calm(&self) -> &Plane<u8> {
        self.calm.get_or_init(|| steps::without_lines(&self.levels))
    }
}
