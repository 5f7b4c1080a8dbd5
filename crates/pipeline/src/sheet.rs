//! The sheet of paper in a picture: what is looked at, and how one that was photographed at a slant is laid square.

use tracelight_aim::{Homography, proportions};
use tracelight_image::Grey;
use tracelight_maths::planar;
use tracelight_picture::Raster;
use tracelight_sheet::{Page, Sheet};
use tracelight_stroke::{Drawing, Point};
use tracelight_task::Failure;

use crate::carried::carried;
use crate::paper::Paper;
use crate::tracing::{Straighten, Tracing};

/// How a sheet in a picture is seen from straight ahead.
#[derive(Clone, Debug)]
pub struct Straight {
    from_picture: Homography,
    to_picture: Homography,
    /// Width and height of the sheet, in px that are about as large as the picture's.
    pub size_px: (f64, f64),
    /// Its true width, where it is known.
    pub width_m: Option<f64>,
}

/// Largest side of a straightened picture, px.
const MOST_PX: f64 = 16_384.0;

impl Straight {
    /// Of a sheet's corners in a picture of that size, clockwise from the upper left, px; `None` where they are no
    /// rectangle's seen at a slant.
    #[must_use]
    pub fn of(corners: [Point; 4], picture: (f64, f64), paper: Option<Paper>) -> Option<Self> {
        let seen = proportions(corners, picture)?;
        let size_m = paper.map(|paper| paper.lying_m(seen));
        let ratio = size_m.map_or(seen, |(width, height)| width / height);
        let length = |a: usize, b: usize| corners[a].distance(corners[b]);
        let (across, down) = (0.5 * (length(0, 1) + length(3, 2)), 0.5 * (length(0, 3) + length(1, 2)));
        let height = (across * down / ratio).sqrt();
        let (width, height) = ((ratio * height).round(), height.round());
        if !(1.0..MOST_PX).contains(&width) || !(1.0..MOST_PX).contains(&height) {
            return None;
        }
        let flat = [(0.0, 0.0), (width, 0.0), (width, height), (0.0, height)].map(Point::from);
        let pairs: [(Point, Point); 4] = std::array::from_fn(|k| (corners[k], flat[k]));
        let from_picture = Homography::through(&pairs, 1.0)?;
        Some(Self {
            to_picture: from_picture.inverse()?,
            from_picture,
            size_px: (width, height),
            width_m: size_m.map(|(width, _)| width),
        })
    }

    /// Where on the sheet a pixel of the picture is.
    pub(crate) fn on_sheet(&self, pixel: Point) -> Option<Point> {
        self.from_picture.apply(pixel)
    }

    /// Where in the picture a place of the sheet is, px.
    pub(crate) fn in_picture(&self, at: Point) -> Option<Point> {
        self.to_picture.apply(at)
    }

    /// Strokes of the picture, on the sheet.
    #[must_use]
    pub fn drawing(&self, drawing: &Drawing) -> Drawing {
        carried(drawing, 1.0, &|p| self.from_picture.apply(p))
    }

    /// The sheet by itself.
    #[must_use]
    pub fn picture(&self, picture: &Raster) -> Raster {
        let (width, height) = (self.size_px.0 as u32, self.size_px.1 as u32);
        Raster::from_rows(width, height, |y, row| {
            for (x, pixel) in row.chunks_exact_mut(3).enumerate() {
                let at = self.to_picture.apply(Point::new(x as f64 + 0.5, f64::from(y) + 0.5));
                pixel.copy_from_slice(&at.map_or([255; 3], |at| picture.between(at)));
            }
        })
    }
}

/// A sheet of paper in a picture, and what was drawn on it there.
#[derive(Clone, Debug)]
pub struct PaperSeen {
    /// Where it is.
    pub sheet: Sheet,
    /// The picture's size, px.
    pub picture_px: (f64, f64),
    /// How it is laid square, where it is.
    pub straight: Option<Straight>,
    /// The strokes in the picture, px, where the sketch's own are those of the sheet laid square.
    pub slanted: Option<Drawing>,
}

/// What of a picture is looked at.
///
/// # Errors
/// Where corners were given that are no sheet's in it, or all of the picture as well.
pub fn page<'a>(name: &str, grey: &'a Grey, tracing: &Tracing) -> Result<Page<'a>, Failure> {
    match (tracing.whole, tracing.straighten) {
        (true, Straighten::By(_)) => Err(Failure::usage(
            "usage",
            format!("{name}: --whole draws all of the picture, and --straighten what lies within four corners: give one"),
        )),
        (false, Straighten::By(corners)) => Page::within(grey, corners).ok_or_else(|| {
            Failure::usage(
                "usage",
                format!(
                    "{name}: the corners of --straighten are no sheet in a picture of {} × {} px: give them in pixels \
                     from its upper left",
                    grey.width(),
                    grey.height()
                ),
            )
        }),
        (true, _) => Ok(Page::whole(grey)),
        (false, _) => Ok(Page::of(grey)),
    }
}

/// A whole picture of paper is so near to the paper's proportions, as a share.
const LIKE_PAPER: f64 = 0.04;

/// How a page's sheet is laid square; `None` where it is not.
///
/// # Errors
/// `not-straightened`, where its corners are no rectangle's or are not all seen.
pub(crate) fn straight(name: &str, page: &Page<'_>, tracing: &Tracing) -> Result<Option<Straight>, Failure> {
    let picture = (page.size.0 as f64, page.size.1 as f64);
    let corners = page.sheet.as_ref().and_then(|sheet| sheet.corners);
    if let (Some(corners), false) = (corners, tracing.straighten == Straighten::Off) {
        let straight = Straight::of(corners, picture, tracing.paper);
        let refused = || {
            let message = format!(
                "{name}: its sheet's corners are no rectangle's: --straighten off leaves it as it is"
            );
            Failure::failed("not-straightened", message)
        };
        return straight.map(Some).ok_or_else(refused);
    }
    if let Some(paper) = tracing.paper {
        let ratio = picture.0 / picture.1;
        let (width, height) = paper.lying_m(ratio);
        if page.sheet.is_some() || (ratio * height / width - 1.0).abs() > LIKE_PAPER {
            return Err(Failure::failed(
                "not-straightened",
                format!(
                    "{name}: --paper says how large the sheet is, but its four corners are not all seen, and the \
                     picture as a whole has other proportions: give the corners, --straighten \"X,Y X,Y X,Y X,Y\""
                ),
            ));
        }
    }
    Ok(None)
}

/// That there is a sheet, and what was done with it.
pub(crate) fn remark(sheet: &Sheet, straight: Option<&Straight>) -> String {
    let beside = 100.0 * sheet.beside;
    let square = straight.map_or(String::new(), |straight| {
        let (width, height) = straight.size_px;
        format!("; it is laid square by its corners, {:.3} times as wide as high", width / height)
    });
    let whole = if straight.is_some() { "--straighten off leaves it as it is, " } else { "" };
    format!(
        "only the sheet of paper is traced, without the {beside:.0} % of the picture beside it{square}: {whole}--whole traces all"
    )
}

/// Four corners in whatever order, clockwise from the upper left.
#[must_use]
pub fn clockwise(mut corners: [Point; 4]) -> [Point; 4] {
    let middle = corners.iter().fold(Point::ORIGIN, |sum, c| sum + c.to_vec2() / 4.0);
    corners.sort_by(|a, b| planar::heading(*a - middle).total_cmp(&planar::heading(*b - middle)));
    // angles run from −π, clockwise as seen: the upper left is the one of least x + y
    let first = (0..4).min_by(|&a, &b| {
        let sum = |k: usize| corners[k].x + corners[k].y;
        sum(a).total_cmp(&sum(b))
    });
    corners.rotate_left(first.unwrap_or(0));
    corners
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_are_sorted_clockwise_from_the_upper_left() {
        let sorted = [(10.0, 12.0), (90.0, 8.0), (95.0, 70.0), (5.0, 66.0)].map(Point::from);
        for order in [[0, 1, 2, 3], [2, 0, 3, 1], [3, 2, 1, 0], [1, 3, 0, 2]] {
            assert_eq!(clockwise(order.map(|k| sorted[k])), sorted, "{order:?}");
        }
    }

    #[test]
    fn a_sheet_of_known_paper_is_as_wide_as_that() {
        let corners = [(100.0, 100.0), (310.0, 110.0), (320.0, 400.0), (95.0, 395.0)].map(Point::from);
        let straight = Straight::of(corners, (640.0, 480.0), Some(Paper::A4)).unwrap();
        assert_eq!(straight.width_m, Some(0.21));
        let (width, height) = straight.size_px;
        assert!((width / height - 210.0 / 297.0).abs() < 2e-3, "{width} × {height}");
        let on_sheet = straight.from_picture.apply(corners[2]).unwrap();
        assert!(on_sheet.distance(Point::new(width, height)) < 1e-6);
    }
}
