//! Finds the points near a position.

use tracelight_stroke::Point;

/// Points, each with what is known of it, by square cells as wide as the reach they are asked for.
pub(crate) struct Near<T> {
    reach: f64,
    /// Sorted by cell.
    points: Vec<((i32, i32), Point, T)>,
}

impl<T> Near<T> {
    pub(crate) fn of(points: impl Iterator<Item = (Point, T)>, reach: f64) -> Self {
        let mut points: Vec<_> = points.map(|(p, known)| (Self::cell(p, reach), p, known)).collect();
        points.sort_by_key(|(cell, ..)| *cell);
        Self { reach, points }
    }

    fn cell(p: Point, reach: f64) -> (i32, i32) {
        ((p.y / reach).floor() as i32, (p.x / reach).floor() as i32)
    }

    /// Those within reach of `p`.
    pub(crate) fn around(&self, p: Point) -> impl Iterator<Item = (Point, &T)> {
        let (row, column) = Self::cell(p, self.reach);
        let cells = (row - 1..=row + 1).flat_map(move |row| {
            let from = self.points.partition_point(|(cell, ..)| *cell < (row, column - 1));
            self.points[from..].iter().take_while(move |(cell, ..)| *cell <= (row, column + 1))
        });
        let near = move |(_, q, _): &&((i32, i32), Point, T)| q.distance(p) <= self.reach;
        cells.filter(near).map(|(_, q, known)| (*q, known))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn those_within_reach_are_found_and_no_others() {
        let at = |k: u32| Point::new(f64::from(k * 37 % 101) - 50.0, f64::from(k * 53 % 89) - 40.0);
        let near = Near::of((0..400).map(|k| (at(k), k)), 7.5);
        for place in [Point::new(0.0, 0.0), Point::new(-49.0, 30.0), Point::new(33.3, -21.7)] {
            let mut found: Vec<u32> = near.around(place).map(|(_, k)| *k).collect();
            found.sort_unstable();
            let all: Vec<u32> = (0..400).filter(|&k| at(k).distance(place) <= 7.5).collect();
            assert_eq!(found, all);
        }
    }
}
