//! Words beside places of a diagram, where they cover nothing.

use plotters::coord::Shift;
use plotters::prelude::{DrawingArea, PathElement, Rectangle, SVGBackend, Text};
use plotters::style::Color;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use crate::arrow::distance;
use crate::lettering::{FINE, SMALL, lettering, width_px};
use crate::theme::Theme;

/// Words beside a place of a diagram. They are put where they cover neither other words nor, if that can be, a curve; words for which
/// there is no room are left out, so those that matter most come first.
#[derive(Clone, Debug, PartialEq)]
pub struct Label {
    /// The place, x and y.
    pub at: (f64, f64),
    /// The words.
    pub text: String,
}

impl Label {
    /// Of a place and its words.
    pub fn new(at: (f64, f64), text: impl Into<String>) -> Self {
        Self { at, text: text.into() }
    }
}

/// A rectangle, pixels from the left and from the top.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Rect {
    pub(crate) left: f64,
    pub(crate) top: f64,
    pub(crate) width: f64,
    pub(crate) height: f64,
}

/// Pixels that words are high, with the air about them.
const HIGH: f64 = 16.0;

impl Rect {
    /// About a place.
    pub(crate) fn about(at: (f64, f64), radius: f64) -> Self {
        Self { left: at.0 - radius, top: at.1 - radius, width: 2.0 * radius, height: 2.0 * radius }
    }

    /// Of words whose middle is there.
    fn of(text: &str, middle: (f64, f64)) -> Self {
        let width = width_px(text, SMALL) + 6.0;
        Self { left: middle.0 - 0.5 * width, top: middle.1 - 0.5 * HIGH, width, height: HIGH }
    }

    /// Of words that end at a place: those to the left of it, or to the right; above it, or below.
    pub(crate) fn beside(text: &str, at: (f64, f64), is_left: bool, is_above: bool) -> Self {
        let width = width_px(text, SMALL);
        let left = if is_left { at.0 - width } else { at.0 };
        Self { left, top: if is_above { at.1 - HIGH } else { at.1 }, width, height: HIGH }
    }

    /// Whether they have a place in common.
    pub(crate) fn meets(&self, other: &Self) -> bool {
        self.left < other.left + other.width
            && other.left < self.left + self.width
            && self.top < other.top + other.height
            && other.top < self.top + self.height
    }

    /// The place in it that is nearest to another.
    fn nearest(&self, to: (f64, f64)) -> (f64, f64) {
        (to.0.clamp(self.left, self.left + self.width), to.1.clamp(self.top, self.top + self.height))
    }
}

/// What of a diagram is covered already.
pub(crate) struct Taken {
    size: (f64, f64),
    columns: usize,
    /// How many pieces of curves are in each cell, row by row.
    cells: Vec<u16>,
    /// Marks, arrows and words.
    rects: Vec<Rect>,
}

/// Directions in which words may stand from their place, x and y upwards: up and to the right first.
const AROUND: [(f64, f64); 16] = [
    (HALF, HALF),
    (HALF, -HALF),
    (-HALF, HALF),
    (-HALF, -HALF),
    (1.0, 0.0),
    (-1.0, 0.0),
    (0.0, 1.0),
    (0.0, -1.0),
    (0.92, 0.38),
    (0.92, -0.38),
    (-0.92, 0.38),
    (-0.92, -0.38),
    (0.38, 0.92),
    (0.38, -0.92),
    (-0.38, 0.92),
    (-0.38, -0.92),
];
const HALF: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// Pixels of a cell.
const CELL: f64 = 3.0;

impl Taken {
    /// Nothing yet, of a diagram so wide and high, pixels.
    pub(crate) fn new(size: (f64, f64)) -> Self {
        let cells = |length: f64| (length / CELL).ceil().max(1.0) as usize;
        let (columns, rows) = (cells(size.0), cells(size.1));
        Self { size, columns, cells: vec![0; columns * rows], rects: Vec::new() }
    }

    /// Covers what a line goes through.
    pub(crate) fn line(&mut self, points: &[(f64, f64)]) {
        for pair in points.windows(2) {
            let (from, to) = (pair[0], pair[1]);
            let steps = (distance(from, to) / CELL).ceil().clamp(1.0, 1e4);
            for k in 0..steps as usize {
                let share = k as f64 / steps;
                self.touch((from.0 + share * (to.0 - from.0), from.1 + share * (to.1 - from.1)));
            }
        }
    }

    fn touch(&mut self, at: (f64, f64)) {
        let (column, row) = ((at.0 / CELL).max(0.0) as usize, (at.1 / CELL).max(0.0) as usize);
        if column < self.columns
            && let Some(cell) = self.cells.get_mut(row * self.columns + column)
        {
            *cell = cell.saturating_add(1);
        }
    }

    /// Covers a rectangle.
    pub(crate) fn rect(&mut self, rect: Rect) {
        self.rects.push(rect);
    }

    /// Where words beside a place have room, which they then cover; none where they would cover others, or a mark.
    fn place(&mut self, text: &str, at: (f64, f64)) -> Option<Rect> {
        const DISTANCES_PX: [f64; 7] = [9.0, 15.0, 24.0, 38.0, 56.0, 80.0, 110.0];
        /// What a covered cell of a curve is worth, in pixels of distance.
        const COVERED_PX: f64 = 9.0;
        let half = 0.5 * (width_px(text, SMALL) + 6.0);
        let mut best: Option<(f64, Rect)> = None;
        for apart in DISTANCES_PX {
            for (x, y) in AROUND {
                let middle = (at.0 + (apart + half * x.abs()) * x, at.1 - (apart + 0.5 * HIGH * y.abs()) * y);
                let rect = Rect::of(text, middle);
                if !self.is_free(&rect) {
                    continue;
                }
                let gap = rect.nearest(at);
                let cost = distance(gap, at) + COVERED_PX * f64::from(self.crossed(&rect));
                if best.is_none_or(|(least, _)| cost < least - 1e-9) {
                    best = Some((cost, rect));
                }
            }
        }
        let rect = best?.1;
        self.rects.push(rect);
        Some(rect)
    }

    /// Whether a rectangle is inside, and covers neither words nor marks.
    fn is_free(&self, rect: &Rect) -> bool {
        rect.left >= 1.0
            && rect.top >= 1.0
            && rect.left + rect.width <= self.size.0 - 1.0
            && rect.top + rect.height <= self.size.1 - 1.0
            && !self.rects.iter().any(|other| other.meets(rect))
    }

    /// How many cells of curves a rectangle covers.
    fn crossed(&self, rect: &Rect) -> u32 {
        let cell = |place: f64| (place / CELL).max(0.0) as usize;
        let (first, last) = (cell(rect.left), cell(rect.left + rect.width).min(self.columns - 1));
        let rows = cell(rect.top)..=cell(rect.top + rect.height);
        let row = |row: usize| self.cells.get(row * self.columns + first..=row * self.columns + last);
        rows.filter_map(row).flatten().map(|&count| u32::from(count.min(2))).sum()
    }
}

/// Draws words that belong to places of an area, pixels.
pub(crate) fn draw(
    area: &DrawingArea<SVGBackend<'_>, Shift>,
    labels: &[((f64, f64), &str)],
    taken: &mut Taken,
    theme: Theme,
) -> Result<(), Box<dyn std::error::Error>> {
    /// From here on a line leads from the place to its words.
    const FAR_PX: f64 = 11.0;
    let fine = |at: (f64, f64)| ((f64::from(FINE) * at.0) as i32, (f64::from(FINE) * at.1) as i32);
    for &(at, text) in labels {
        let Some(rect) = taken.place(text, at) else { continue };
        let near = rect.nearest(at);
        if distance(near, at) > FAR_PX {
            let soft = theme.soft().plotted().stroke_width(FINE as u32 / 2);
            area.draw(&PathElement::new([fine(at), fine(near)], soft))?;
        }
        let corners = [fine((rect.left, rect.top)), fine((rect.left + rect.width, rect.top + rect.height))];
        area.draw(&Rectangle::new(corners, theme.ground().plotted().mix(0.75).filled()))?;
        // towards its place, as fonts may be narrower than the rectangle allows for
        let is_left = rect.left + 0.5 * rect.width < at.0 - 1.0;
        let (side, x) =
            if is_left { (HPos::Right, rect.left + rect.width - 3.0) } else { (HPos::Left, rect.left + 3.0) };
        let style = lettering(SMALL, theme.ink()).pos(Pos::new(side, VPos::Center));
        area.draw(&Text::new(text, fine((x, rect.top + 0.5 * rect.height)), style))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_cover_neither_words_nor_marks_and_keep_off_curves() {
        let mut taken = Taken::new((400.0, 300.0));
        let curve: Vec<(f64, f64)> = (0..=400).map(|x| (f64::from(x), 150.0)).collect();
        taken.line(&curve);
        taken.rect(Rect::about((200.0, 150.0), 5.0));
        let placed: Vec<Rect> =
            (0..8).filter_map(|_| taken.place("gain margin 6 dB", (200.0, 150.0))).collect();
        assert_eq!(placed.len(), 8);
        for (i, rect) in placed.iter().enumerate() {
            assert!(placed[..i].iter().all(|other| !other.meets(rect)), "{rect:?}");
            assert!(rect.top > 150.0 || rect.top + rect.height < 150.0, "on the curve: {rect:?}");
        }
    }

    #[test]
    fn words_without_room_are_left_out() {
        let mut taken = Taken::new((60.0, 20.0));
        assert!(taken.place("far too long for so small a diagram", (30.0, 10.0)).is_none());
        assert!(taken.place("short", (4.0, 10.0)).is_some());
        assert!(taken.place("short", (4.0, 10.0)).is_none());
    }
}
