//! Looks for markers in an image: first among what is clearly cut off from the rest, then in what is left.

use tracelight_image::border::Edge;
use tracelight_image::{Mask, Plane, Region, regions};
use tracelight_stroke::{Point, Vec2};

use super::boundary::Cells;
use super::cells::{Levels, Read};
use super::local::{Darkness, Surroundings};
use super::square::Square;
use super::tag::{Tag, tag_cells};
use super::{pieces, placing, quad, side};

/// What is taken out of a cell that its neighbours' light was mixed into, where it can not be read as it is.
const SHARPENINGS: [f64; 3] = [0.0, 0.25, 0.5];

/// Every marker of an image.
pub(super) fn found(plane: &Plane<u8>) -> Vec<Tag> {
    if (plane.width.min(plane.height) as f64) < quad::LEAST_SIDE_PX {
        return Vec::new();
    }
    let mut search = Search { plane, surroundings: Surroundings::of(plane), found: Vec::new() };
    let all = (0..plane.width, 0..plane.height);
    let dark = search.surroundings.darker(plane, Darkness::Most, &all);
    search.among(&dark, Vec2::ZERO, Darkness::Most);
    search.found
}

/// A search for markers, and those that are found.
struct Search<'a> {
    plane: &'a Plane<u8>,
    surroundings: Surroundings,
    found: Vec<Tag>,
}

impl Search<'_> {
    /// Among what is dark in a part of the image, whose upper left is given; what is large enough for a marker and is none may be one with
    /// something beside it, and is looked at again where it is darker yet.
    fn among(&mut self, dark: &Mask, corner: Vec2, darkness: Darkness) {
        let mut walked = Mask::empty(dark.width(), dark.height());
        for patch in regions(dark) {
            let Some(edges) = quad::outline(dark, &patch, &mut walked) else { continue };
            let before = self.found.len();
            self.add(dark, &patch, &edges, corner);
            if let (true, Some(less)) = (self.found.len() == before, darkness.less()) {
                self.within(dark, &patch, corner, less);
            }
        }
    }

    /// Among what of a patch is darker yet.
    fn within(&mut self, dark: &Mask, patch: &Region, corner: Vec2, darkness: Darkness) {
        // with a pixel about it, for it not to lie at the part's border if it does not at the image's
        let Some((columns, rows)) = patch.bounds(1, (dark.width(), dark.height())) else { return };
        let (left, top) = (corner.x as usize, corner.y as usize);
        let part = (left + columns.start..left + columns.end, top + rows.start..top + rows.end);
        let mut own = Mask::empty(columns.len(), rows.len());
        patch.seen_from(columns.start, rows.start).fill_into(&mut own);
        let darker = own.and(&self.surroundings.darker(self.plane, darkness, &part));
        self.among(&darker, Vec2::new(part.0.start as f64, part.1.start as f64), darkness);
    }

    /// Adds the marker that a patch is, or those that are parts of it.
    fn add(&mut self, dark: &Mask, patch: &Region, edges: &[Edge], corner: Vec2) {
        if let Some(corners) = quad::of(dark, patch, edges) {
            self.found.extend(tag(self.plane, &corners.map(|p| p + corner)));
            return;
        }
        let before = self.found.len();
        for corners in pieces::squares(edges) {
            let corners = corners.map(|p| p + corner);
            let is_known = |tag: &Tag| tag.corners.iter().any(|corner| corner.distance(corners[0]) < 3.0);
            if !self.found[before..].iter().any(is_known) {
                self.found.extend(tag(self.plane, &corners));
            }
        }
    }
}

/// The marker with about these corners.
fn tag(plane: &Plane<u8>, rough: &[Point; 4]) -> Option<Tag> {
    let (read, rough) = read(plane, rough)?;
    let corners = std::array::from_fn(|k| rough[(k + read.turns) % 4]);
    let cells = Cells::new(tag_cells(read.id)?);
    let placed = placing::placed(plane, &cells, &corners)?;
    Some(Tag {
        id: read.id,
        corners: placed.square.corners()?,
        places: placed.places,
        deviation_px: placed.deviation_px,
        wrong_cells: read.wrong,
    })
}

/// What the cells between these corners are, and the corners; where they can not be read, between those that the grey levels have.
fn read(plane: &Plane<u8>, rough: &[Point; 4]) -> Option<(Read, [Point; 4])> {
    if let Some(read) = Levels::of(plane, &Square::of(rough)?)?.read() {
        return Some((read, *rough));
    }
    let corners = side::refined(plane, rough)?;
    let levels = Levels::of(plane, &Square::of(&corners)?)?;
    SHARPENINGS.iter().find_map(|share| levels.sharpened(*share).read()).map(|read| (read, corners))
}
