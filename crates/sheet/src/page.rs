//! What of a picture is looked at: its sheet, or all of it.

use std::borrow::Cow;

use tracelight_image::border::area;
use tracelight_image::levels::sampled_histogram;
use tracelight_image::{Grey, Plane, Region, regions};
use tracelight_stroke::Point;

use crate::alone::{Alone, Beside, alone};
use crate::found::Found;
use crate::sheet::Sheet;
use crate::small::Small;
use crate::two_tones::TwoTones;

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
    /// What of the picture is not the sheet's; `None` where all of it is.
    pub beside: Option<Beside>,
    /// The whole picture, where the sheet was looked for and found in it.
    whole: Option<&'a Grey>,
    /// Whether the sheet is seen to be brighter than what lies beside it: its paper is, not its ink.
    pub is_brighter: bool,
    /// The quadrilateral on whose lines its sides lie, clockwise from the upper left, px of the whole picture.
    square: Option<[Point; 4]>,
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
            let tones = TwoTones::of(&sampled_histogram(image.plane()));
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
        let small = Small::of_any(image.plane());
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
    pub fn lines_meet(&self, reduction: usize) -> Option<[Point; 4]> {
        let (right, down) = (self.origin.0 as f64, self.origin.1 as f64);
        let by = reduction as f64;
        self.square.map(|corners| corners.map(|at| Point::new((at.x - right) / by, (at.y - down) / by)))
    }

    /// What tells whether a drawing was given: all of the picture, but for what its corners were told of.
    pub fn given(&self) -> &Grey {
        self.whole.unwrap_or(&self.picture)
    }
}

/// Whether what has the brighter of two tones is the sheet and nothing else, and something is drawn on it.
fn is_page(plane: &Plane<u8>, tones: TwoTones, sheet: &Sheet) -> bool {
    let pixels = plane.values.len() as f64;
    let dark = tones.dark(plane);
    let (beside, drawn): (Vec<Region>, Vec<Region>) =
        regions(&dark).into_iter().partition(|region| region.at_border_px(&dark) > 0);
    let px = |regions: &[Region]| regions.iter().map(Region::area).sum::<usize>() as f64;
    let page = pixels - px(&beside);
    let is_sheet = (page - area(&sheet.outline)).abs() < SAME_AREA * page;
    is_sheet && !beside.is_empty() && px(&drawn) > LEAST_DRAWN * pixels
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A bright quadrilateral on a dark table, with a line on it.
    fn photograph(corners: &[Point; 4]) -> Grey {
        let (width, height) = (320, 240);
        let is_inside =
            |p: Point| (0..4).all(|k| (corners[(k + 1) % 4] - corners[k]).cross(p - corners[k]) > 0.0);
        let level = |i: usize| {
            let at = Point::new((i % width) as f64 + 0.5, (i / width) as f64 + 0.5);
            let is_line = (at.y - 120.0).abs() < 2.0 && (110.0..210.0).contains(&at.x);
            match is_inside(at) {
                true if is_line => 40,
                true => 220,
                false => 90,
            }
        };
        Grey::new(width, height, (0..width * height).map(level).collect()).unwrap()
    }

    #[test]
    fn a_sheet_on_a_table_is_cut_out_with_paper_beside_it() {
        let corners = [(60.0, 40.0), (262.0, 48.0), (255.0, 205.0), (52.0, 198.0)].map(Point::from);
        let image = photograph(&corners);
        let page = Page::of(&image);
        let found = page.sheet.as_ref().unwrap().corners.unwrap();
        let off = corners.iter().zip(found).map(|(a, b)| a.distance(b)).fold(0.0, f64::max);
        assert!(off < 1.0, "{off} px: {found:?}");
        assert!(page.is_brighter && page.size == (320, 240));
        let beside = page.beside.unwrap();
        let (width, height) = (page.picture.width(), page.picture.height());
        assert_eq!((beside.papered.width, beside.papered.height), (width, height));
        assert!(beside.mask.get(0, 0) && !beside.mask.get(width as isize / 2, height as isize / 2));
        assert!(beside.papered.row(0)[0].abs_diff(220) < 3, "{}", beside.papered.row(0)[0]);
    }

    #[test]
    fn without_a_sheet_all_of_a_picture_is_looked_at() {
        let far = [(-9.0, -9.0), (400.0, -9.0), (400.0, 400.0), (-9.0, 400.0)].map(Point::from);
        let image = photograph(&far);
        let page = Page::of(&image);
        assert!(page.sheet.is_none() && page.beside.is_none() && page.origin == (0, 0));
        assert_eq!(page.given().levels(), image.levels());
    }
}
