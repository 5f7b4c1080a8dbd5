//! Where a page has paper.

use crate::mask::Mask;

/// How a sheet lies in a picture.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lie<'a> {
    /// What of the plane lies beside it; `None` where all is paper.
    pub(crate) beside: Option<&'a Mask>,
    /// How far its sides are turned from the plane's, clockwise as seen, rad.
    pub(crate) turned: f64,
}

/// Of a plane, which part is the sheet; along and across rules of one direction.
#[derive(Clone, Copy, Debug)]
pub(super) struct Paper<'a> {
    beside: Option<&'a Mask>,
    /// Whether along the rules is down the plane.
    is_upright: bool,
    /// By how much a line that is parallel to the sheet's sides moves across a px along.
    pub(super) tilt: f64,
}

impl<'a> Paper<'a> {
    /// For level rules.
    pub(super) fn level(lie: Lie<'a>) -> Self {
        Self { beside: lie.beside, is_upright: false, tilt: lie.turned.tan() }
    }

    /// For upright rules.
    pub(super) fn upright(lie: Lie<'a>) -> Self {
        Self { beside: lie.beside, is_upright: true, tilt: -lie.turned.tan() }
    }

    /// Whether there is more than paper.
    pub(super) const fn is_cut_out(self) -> bool {
        self.beside.is_some()
    }

    /// By how many px a line parallel to the sheet's sides is moved across, so far along from where it is not.
    pub(super) fn shift(self, along: isize) -> isize {
        (self.tilt * along as f64).round() as isize
    }

    /// Whether there is paper.
    pub(super) fn has(self, along: usize, across: usize) -> bool {
        let (x, y) = if self.is_upright { (across, along) } else { (along, across) };
        self.beside.is_none_or(|beside| !beside.get(x as isize, y as isize))
    }

    /// From where to where there is paper across a place along, px from the first of so many pixels' centre.
    pub(super) fn across(self, along: usize, breadth: usize) -> (f64, f64) {
        let first = (0..breadth).find(|&k| self.has(along, k)).unwrap_or(breadth);
        let last = (first..breadth).rfind(|&k| self.has(along, k));
        (first as f64, last.map_or(-1.0, |last| last as f64))
    }
}
