//! Pages of markers on a wall, as files name them.

use std::fmt;

use serde::{Deserialize, Serialize};
use tracelight_aim::PlacedPage;
use tracelight_maths::{hypot, planar};
use tracelight_stroke::{Affine, Point};

/// A page of a board, as people call it: page 3, or of a coarse board page 3 (coarse).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PageName {
    /// Number of the board in `Board::ALL`.
    board: usize,
    /// From 0.
    page: u16,
}

impl PageName {
    /// Of a page that hangs somewhere.
    #[must_use]
    pub const fn of(page: &PlacedPage) -> Self {
        Self { board: page.board, page: page.page }
    }

    /// Of a page, from 0, of a board, by its number in `Board::ALL`.
    #[must_use]
    pub const fn on(board: usize, page: u16) -> Self {
        Self { board, page }
    }
}

impl fmt::Display for PageName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match BOARDS.get(self.board) {
            Some(board) if self.board > 0 => write!(f, "{} ({board})", self.page + 1),
            _ => write!(f, "{}", self.page + 1),
        }
    }
}

/// Where a page lies on the wall.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct PageTable {
    /// fine or coarse.
    board: String,
    /// From 1.
    page: u16,
    /// Where the middle of its markers is, and by how much it is turned anticlockwise.
    middle_m: [f64; 2],
    turn_rad: f64,
}

/// Names of the boards, in the order of `Board::ALL`.
const BOARDS: [&str; 2] = ["fine", "coarse"];

impl PageTable {
    pub(crate) fn of(page: &PlacedPage) -> Self {
        let PlacedPage { board, page, middle, turn_rad, .. } = *page;
        let board = BOARDS.get(board).copied().unwrap_or_default().to_owned();
        Self { board, page: page + 1, middle_m: [middle.x, middle.y], turn_rad }
    }

    /// How far from where the file has it a page hangs, m; `None` if it is another.
    pub(crate) fn off_m(&self, page: &PlacedPage) -> Option<f64> {
        let own = Self::of(page);
        let [x, y] = [0, 1].map(|k| own.middle_m[k] - self.middle_m[k]);
        ((own.board, own.page) == (self.board.clone(), self.page)).then(|| hypot(x, y))
    }

    /// The page's name and the wall's frame from its own; why there is no such page, otherwise.
    pub(crate) fn placed(&self) -> Result<(PageName, Affine), String> {
        let board = BOARDS.iter().position(|name| *name == self.board);
        let wrong = || {
            format!(
                "pages: a page is of the board fine or coarse, and counted from 1, not {} {}",
                self.board, self.page
            )
        };
        let name =
            PageName { board: board.ok_or_else(wrong)?, page: self.page.checked_sub(1).ok_or_else(wrong)? };
        let [x, y] = self.middle_m;
        if !([x, y].iter().all(|v| v.abs() <= 1e3) && self.turn_rad.abs() <= 10.0) {
            return Err(format!(
                "pages: no page hangs at ({x}, {y}) m, turned by {} rad; calibrate the camera again",
                self.turn_rad
            ));
        }
        Ok((name, planar::rotation(self.turn_rad).then_translate(Point::new(x, y).to_vec2())))
    }
}
