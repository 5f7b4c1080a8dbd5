use tracelight_stroke::{Point, Vec2};

/// A board of printed square markers in columns and rows. Its pages are alike but for the markers' ids, so that each tells which
/// page it is on and where.
///
/// The board's frame has its origin in the middle of the markers, x right and y up as printed, metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Board {
    /// Id of the first page's upper left marker; ids go on along the rows, and from page to page.
    pub first_id: u16,
    /// Number of pages that ids are kept for.
    pub pages: u16,
    /// Markers in a row.
    pub columns: u16,
    /// Rows.
    pub rows: u16,
    /// Side of a marker's black border, m.
    pub tag_m: f64,
    /// From a marker to the next, m.
    pub pitch_m: f64,
}

impl Board {
    /// Twenty markers of 40 mm: what fits on A4 and on US letter paper. For cameras that see a millimetre on half a pixel or more.
    pub const FINE: Self = Self { first_id: 0, pages: 24, columns: 4, rows: 5, tag_m: 0.040, pitch_m: 0.048 };

    /// Four markers of 84 mm on the same paper, for coarser cameras.
    pub const COARSE: Self =
        Self { first_id: 480, pages: 26, columns: 2, rows: 2, tag_m: 0.084, pitch_m: 0.0985 };

    /// Both.
    pub const ALL: [Self; 2] = [Self::FINE, Self::COARSE];

    /// Markers on a page.
    pub const fn tags(&self) -> u16 {
        self.columns * self.rows
    }

    /// Which page a marker is on, and where it is there: its number among the page's.
    pub fn find(&self, id: u16) -> Option<(u16, u16)> {
        let number = id.checked_sub(self.first_id)?;
        (number < self.pages * self.tags()).then(|| (number / self.tags(), number % self.tags()))
    }

    /// Id of a page's marker.
    pub const fn id(&self, page: u16, number: u16) -> u16 {
        self.first_id + page * self.tags() + number
    }

    /// Corners of a page's marker, upper left first, then clockwise, m.
    pub fn corners(&self, number: u16) -> [Point; 4] {
        let (column, row) = (f64::from(number % self.columns), f64::from(number / self.columns));
        let middle = |count: u16| f64::from(count - 1) / 2.0;
        let centre = Vec2::new(column - middle(self.columns), middle(self.rows) - row) * self.pitch_m;
        let half = self.tag_m / 2.0;
        [(-half, half), (half, half), (half, -half), (-half, -half)]
            .map(|(x, y)| (centre + Vec2::new(x, y)).to_point())
    }

    /// Rescales the board as it was printed.
    #[must_use]
    pub fn scaled(&self, by: f64) -> Self {
        Self { tag_m: by * self.tag_m, pitch_m: by * self.pitch_m, ..*self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_id_is_on_one_page_of_one_sheet() {
        for id in 0..584 {
            let on: Vec<_> =
                Board::ALL.iter().filter_map(|board| board.find(id).map(|at| (board, at))).collect();
            let [(board, (page, number))] = on.as_slice() else { panic!("{id} is on {} boards", on.len()) };
            assert_eq!(board.id(*page, *number), id);
        }
        assert!(Board::ALL.iter().all(|board| board.find(584).is_none()));
    }

    #[test]
    fn markers_lie_about_the_middle_of_the_sheet() {
        for board in Board::ALL {
            let all: Vec<Point> = (0..board.tags()).flat_map(|number| board.corners(number)).collect();
            let sum = all.iter().map(|p| p.to_vec2()).sum::<Vec2>();
            assert!(sum.hypot() < 1e-12);
            let [upper_left, upper_right, ..] = board.corners(0);
            assert!(upper_left.x < upper_right.x && upper_left.x < 0.0 && upper_left.y > 0.0);
            assert!((upper_left.distance(upper_right) - board.tag_m).abs() < 1e-12);
        }
    }
}
