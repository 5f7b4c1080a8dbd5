//! Writing with one stroke, as engravers do: letters are lines for a round pen, no font file is needed.

use kurbo::{BezPath, PathEl};
use tracelight_stroke::{Affine, Point};

use super::plane::Plane;

/// A round pen; what it covers is a share from 0 to `strength`.
#[derive(Clone, Copy)]
pub(super) struct Pen {
    /// Half of the line's width, px.
    pub(super) radius: f64,
    /// How much it covers, 0 to 1.
    pub(super) strength: f32,
}

/// Where a text stands against its point.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Align {
    Left,
    Middle,
}

impl Pen {
    /// Draws a polyline; crossings do not add up.
    pub(super) fn line(self, on: &mut Plane, points: &[Point]) {
        for pair in points.windows(2) {
            self.stroke(on, pair[0], pair[1]);
        }
    }

    /// Draws a straight line with round ends.
    pub(super) fn stroke(self, on: &mut Plane, a: Point, b: Point) {
        if !(a.is_finite() && b.is_finite()) {
            return;
        }
        let reach = self.radius + 1.0;
        let columns = span(a.x.min(b.x) - reach, a.x.max(b.x) + reach, on.width);
        for y in span(a.y.min(b.y) - reach, a.y.max(b.y) + reach, on.height) {
            for x in columns.clone() {
                let away = distance(Point::new(x as f64 + 0.5, y as f64 + 0.5), a, b);
                let covered = (self.radius + 0.5 - away).clamp(0.0, 1.0) as f32 * self.strength;
                let pixel = &mut on.values[y * on.width + x];
                *pixel = pixel.max(covered);
            }
        }
    }

    /// Writes a text of capitals `size` px high with its baseline at `at`; unknown letters become a small box.
    pub(super) fn text(self, on: &mut Plane, text: &str, size: f64, at: Point, align: Align) {
        let width = text_width(text, size);
        let mut x = match align {
            Align::Left => at.x,
            Align::Middle => at.x - width / 2.0,
        };
        for letter in text.chars() {
            let (advance, outline) = glyph(letter);
            let place = Affine::translate((x, at.y - size)) * Affine::scale(size / CAPITAL);
            for line in lines(outline) {
                let line: Vec<_> = line.into_iter().map(|p| place * p).collect();
                self.line(on, &line);
            }
            x += (advance + SPACING) * size / CAPITAL;
        }
    }
}

/// Width of a written text, px.
pub(super) fn text_width(text: &str, size: f64) -> f64 {
    let advances: f64 = text.chars().map(|c| glyph(c).0 + SPACING).sum();
    (advances - SPACING).max(0.0) * size / CAPITAL
}

/// A text cut to `width` px, with an ellipsis where something is missing.
pub(super) fn fitted(text: &str, size: f64, width: f64) -> String {
    if text_width(text, size) <= width {
        return text.to_owned();
    }
    let mut kept: Vec<char> = text.chars().take(200).collect();
    while !kept.is_empty() {
        kept.pop();
        let shorter = kept.iter().collect::<String>() + "…";
        if text_width(&shorter, size) <= width {
            return shorter;
        }
    }
    String::new()
}

/// Pixels a span touches, cut to a side of `length`.
fn span(from: f64, to: f64, length: usize) -> std::ops::Range<usize> {
    let from = from.floor().clamp(0.0, length as f64) as usize;
    from..(to.ceil().clamp(0.0, length as f64) as usize).max(from)
}

fn distance(p: Point, a: Point, b: Point) -> f64 {
    let along = b - a;
    let t = ((p - a).dot(along) / along.hypot2().max(1e-12)).clamp(0.0, 1.0);
    p.distance(a + along * t)
}

/// The polylines of a glyph's outline.
fn lines(outline: &str) -> Vec<Vec<Point>> {
    let mut found: Vec<Vec<Point>> = Vec::new();
    let path = BezPath::from_svg(outline).unwrap_or_default();
    kurbo::flatten(&path, 0.05, |element| match element {
        PathEl::MoveTo(p) => found.push(vec![p]),
        PathEl::LineTo(p) => found.iter_mut().last().into_iter().for_each(|line| line.push(p)),
        PathEl::ClosePath => {
            found.iter_mut().last().into_iter().for_each(|line| line.extend(line.first().copied()));
        }
        PathEl::QuadTo(..) | PathEl::CurveTo(..) => {} // flattened away
    });
    found
}

/// Height of a capital in a glyph's units: from 0 down to its baseline at 10.
const CAPITAL: f64 = 10.0;
/// Between letters.
const SPACING: f64 = 2.3;

/// A letter's width and its lines as SVG path data. Small letters rise to 3.4.
fn glyph(letter: char) -> (f64, &'static str) {
    GLYPHS.iter().find(|g| g.0 == letter).map_or((5.0, "M0 2L5 2L5 10L0 10Z"), |g| (g.1, g.2))
}

#[rustfmt::skip]
const GLYPHS: &[(char, f64, &str)] = &[
    (' ', 1.6, ""),
    ('0', 6.0, "M3 0C1 0 0 2 0 5C0 8 1 10 3 10C5 10 6 8 6 5C6 2 5 0 3 0Z"),
    ('1', 3.0, "M0 2.2L3 0L3 10"),
    ('2', 6.0, "M.3 2.6C.5 1 1.6 0 3 0C4.7 0 5.8 1.2 5.8 2.8C5.8 4.6 4.2 6 .1 10L6 10"),
    ('3', 6.0, "M.4 0L5.6 0L2.6 3.9C4.6 3.7 6 5 6 6.9C6 8.8 4.7 10 2.9 10C1.5 10 .4 9.3 0 8"),
    ('4', 6.2, "M4.5 10L4.5 0L0 7.2L6.2 7.2"),
    ('5', 6.0, "M5.4 0L1 0L.6 4.4C1.2 3.9 2 3.6 2.9 3.6C4.8 3.6 6 4.9 6 6.8C6 8.7 4.7 10 2.9 10C1.6 10 .6 9.4 0 8.3"),
    ('6', 6.0, "M5.2 .8C4.6 .3 3.9 0 3.2 0C1.2 0 0 2.2 0 5.6C0 8.4 1.2 10 3 10C4.8 10 6 8.7 6 6.9C6 5.1 4.8 3.9 3.1 3.9C1.6 3.9 .3 4.9 0 6.4"),
    ('7', 6.0, "M0 0L6 0L2.2 10"),
    ('8', 6.0, "M3 4.6C1.5 4.6 .5 3.7 .5 2.3C.5 .9 1.5 0 3 0C4.5 0 5.5 .9 5.5 2.3C5.5 3.7 4.5 4.6 3 4.6C1.2 4.6 0 5.7 0 7.3C0 8.9 1.2 10 3 10C4.8 10 6 8.9 6 7.3C6 5.7 4.8 4.6 3 4.6Z"),
    ('9', 6.0, "M.8 9.2C1.4 9.7 2.1 10 2.8 10C4.8 10 6 7.8 6 4.4C6 1.6 4.8 0 3 0C1.2 0 0 1.3 0 3.1C0 4.9 1.2 6.1 2.9 6.1C4.4 6.1 5.7 5.1 6 3.6"),
    ('A', 7.6, "M0 10L3.8 0L7.6 10M1.3 6.6L6.3 6.6"),
    ('B', 6.0, "M0 0L3 0C4.7 0 5.5 1 5.5 2.3C5.5 3.7 4.6 4.6 3 4.6L0 4.6M3 4.6C5 4.6 6 5.7 6 7.3C6 8.9 5 10 3 10L0 10L0 0"),
    ('C', 7.4, "M7.4 1.8C6.6 .7 5.5 0 4.2 0C1.7 0 0 2.1 0 5C0 7.9 1.7 10 4.2 10C5.5 10 6.6 9.3 7.4 8.2"),
    ('D', 7.0, "M0 0L0 10L2.6 10C5.4 10 7 8 7 5C7 2 5.4 0 2.6 0Z"),
    ('E', 5.4, "M5.4 0L0 0L0 10L5.4 10M0 4.7L4.6 4.7"),
    ('F', 5.2, "M5.2 0L0 0L0 10M0 4.7L4.4 4.7"),
    ('G', 7.6, "M7.2 1.6C6.4 .6 5.4 0 4.2 0C1.7 0 0 2.1 0 5C0 7.9 1.7 10 4.2 10C6.2 10 7.6 8.6 7.6 5.6L4.4 5.6"),
    ('H', 6.6, "M0 0L0 10M6.6 0L6.6 10M0 4.7L6.6 4.7"),
    ('I', 0.0, "M0 0L0 10"),
    ('J', 4.2, "M4.2 0L4.2 7.2C4.2 9 3.4 10 2 10C1 10 .3 9.5 0 8.6"),
    ('K', 6.2, "M0 0L0 10M6 0L0 6M2.2 4L6.2 10"),
    ('L', 5.0, "M0 0L0 10L5 10"),
    ('M', 8.0, "M0 10L0 0L4 7L8 0L8 10"),
    ('N', 6.6, "M0 10L0 0L6.6 10L6.6 0"),
    ('O', 8.4, "M4.2 0C1.7 0 0 2.1 0 5C0 7.9 1.7 10 4.2 10C6.7 10 8.4 7.9 8.4 5C8.4 2.1 6.7 0 4.2 0Z"),
    ('P', 5.8, "M0 10L0 0L3 0C4.9 0 5.8 1.2 5.8 2.8C5.8 4.4 4.9 5.6 3 5.6L0 5.6"),
    ('Q', 8.4, "M4.2 0C1.7 0 0 2.1 0 5C0 7.9 1.7 10 4.2 10C6.7 10 8.4 7.9 8.4 5C8.4 2.1 6.7 0 4.2 0ZM5.4 7.6L8.4 10.8"),
    ('R', 6.0, "M0 10L0 0L3 0C4.9 0 5.8 1.2 5.8 2.7C5.8 4.2 4.9 5.4 3 5.4L0 5.4M3 5.4L6 10"),
    ('S', 5.8, "M5.4 1.5C4.9 .6 4 0 2.9 0C1.4 0 .4 .9 .4 2.3C.4 3.8 1.6 4.3 3 4.7C4.6 5.2 5.8 5.8 5.8 7.4C5.8 9 4.6 10 2.9 10C1.6 10 .5 9.4 0 8.3"),
    ('T', 6.4, "M0 0L6.4 0M3.2 0L3.2 10"),
    ('U', 6.6, "M0 0L0 6.5C0 8.8 1.3 10 3.3 10C5.3 10 6.6 8.8 6.6 6.5L6.6 0"),
    ('V', 7.2, "M0 0L3.6 10L7.2 0"),
    ('W', 10.4, "M0 0L2.8 10L5.2 2L7.6 10L10.4 0"),
    ('X', 6.6, "M0 0L6.6 10M6.6 0L0 10"),
    ('Y', 6.8, "M0 0L3.4 5L6.8 0M3.4 5L3.4 10"),
    ('Z', 6.4, "M0 0L6.4 0L0 10L6.4 10"),
    ('a', 5.2, "M5.2 3.5L5.2 10M5.2 6.7C5.2 4.8 4.2 3.4 2.6 3.4C1 3.4 0 4.8 0 6.7C0 8.6 1 10 2.6 10C4.2 10 5.2 8.6 5.2 6.7"),
    ('b', 5.2, "M0 0L0 10M0 6.7C0 4.8 1 3.4 2.6 3.4C4.2 3.4 5.2 4.8 5.2 6.7C5.2 8.6 4.2 10 2.6 10C1 10 0 8.6 0 6.7"),
    ('c', 4.8, "M4.8 4.6C4.3 3.8 3.5 3.4 2.7 3.4C1.1 3.4 0 4.8 0 6.7C0 8.6 1.1 10 2.7 10C3.5 10 4.3 9.6 4.8 8.8"),
    ('d', 5.2, "M5.2 0L5.2 10M5.2 6.7C5.2 4.8 4.2 3.4 2.6 3.4C1 3.4 0 4.8 0 6.7C0 8.6 1 10 2.6 10C4.2 10 5.2 8.6 5.2 6.7"),
    ('e', 5.1, "M0 6.6L5.1 6.6C5.1 4.7 4.1 3.4 2.6 3.4C1.1 3.4 0 4.8 0 6.7C0 8.7 1.1 10 2.8 10C3.7 10 4.4 9.6 4.9 8.9"),
    ('f', 3.4, "M3.6 .2C2 -.3 1.3 .7 1.3 2.1L1.3 10M0 3.6L3.2 3.6"),
    ('g', 5.2, "M5.2 3.5L5.2 10.8C5.2 12.5 4.2 13.4 2.6 13.4C1.7 13.4 .9 13.1 .3 12.5M5.2 6.7C5.2 4.8 4.2 3.4 2.6 3.4C1 3.4 0 4.8 0 6.7C0 8.6 1 10 2.6 10C4.2 10 5.2 8.6 5.2 6.7"),
    ('h', 5.0, "M0 0L0 10M0 6C.2 4.4 1.3 3.4 2.7 3.4C4.2 3.4 5 4.4 5 6.1L5 10"),
    ('i', 0.0, "M0 3.5L0 10M0 .9L0 1"),
    ('j', 1.0, "M1 3.5L1 11.6C1 12.9 .2 13.3 -.8 13.2M1 .9L1 1"),
    ('k', 4.8, "M0 0L0 10M4.5 3.5L0 7.4M1.7 6L4.8 10"),
    ('l', 0.0, "M0 0L0 10"),
    ('m', 8.4, "M0 3.5L0 10M0 6C.2 4.4 1.1 3.4 2.3 3.4C3.6 3.4 4.2 4.4 4.2 6L4.2 10M4.2 6C4.4 4.4 5.3 3.4 6.5 3.4C7.8 3.4 8.4 4.4 8.4 6L8.4 10"),
    ('n', 5.0, "M0 3.5L0 10M0 6C.2 4.4 1.3 3.4 2.7 3.4C4.2 3.4 5 4.4 5 6.1L5 10"),
    ('o', 5.4, "M2.7 3.4C1.1 3.4 0 4.8 0 6.7C0 8.6 1.1 10 2.7 10C4.3 10 5.4 8.6 5.4 6.7C5.4 4.8 4.3 3.4 2.7 3.4Z"),
    ('p', 5.2, "M0 3.5L0 13.3M0 6.7C0 4.8 1 3.4 2.6 3.4C4.2 3.4 5.2 4.8 5.2 6.7C5.2 8.6 4.2 10 2.6 10C1 10 0 8.6 0 6.7"),
    ('q', 5.2, "M5.2 3.5L5.2 13.3M5.2 6.7C5.2 4.8 4.2 3.4 2.6 3.4C1 3.4 0 4.8 0 6.7C0 8.6 1 10 2.6 10C4.2 10 5.2 8.6 5.2 6.7"),
    ('r', 2.9, "M0 3.5L0 10M0 6C.2 4.4 1.3 3.3 2.9 3.5"),
    ('s', 4.5, "M4.2 4.5C3.7 3.7 2.9 3.4 2.2 3.4C1 3.4 .2 4 .2 5C.2 6.1 1.2 6.4 2.3 6.7C3.5 7 4.5 7.4 4.5 8.5C4.5 9.5 3.5 10 2.3 10C1.3 10 .5 9.6 0 8.8"),
    ('t', 3.3, "M1.4 1L1.4 8.1C1.4 9.6 2.1 10.2 3.3 9.8M0 3.6L3.2 3.6"),
    ('u', 5.0, "M0 3.5L0 7.3C0 9 .8 10 2.3 10C3.7 10 4.8 9 5 7.4M5 3.5L5 10"),
    ('v', 5.2, "M0 3.5L2.6 10L5.2 3.5"),
    ('w', 8.0, "M0 3.5L2.1 10L4 4.6L5.9 10L8 3.5"),
    ('x', 4.8, "M0 3.5L4.8 10M4.8 3.5L0 10"),
    ('y', 5.2, "M0 3.5L2.6 10M5.2 3.5L2.2 11.2C1.7 12.7 1 13.3 -.2 13.2"),
    ('z', 4.6, "M0 3.5L4.6 3.5L0 10L4.6 10"),
    ('.', 0.0, "M0 9.9L0 10"),
    (',', 0.6, "M.5 9.7L0 11.6"),
    (':', 0.0, "M0 4.6L0 4.7M0 9.9L0 10"),
    ('·', 0.0, "M0 5.8L0 5.9"),
    ('…', 6.0, "M0 9.9L0 10M3 9.9L3 10M6 9.9L6 10"),
    ('-', 3.0, "M0 6.2L3 6.2"),
    ('–', 4.4, "M0 6.2L4.4 6.2"),
    ('−', 4.4, "M0 6.2L4.4 6.2"),
    ('+', 4.4, "M0 6.2L4.4 6.2M2.2 4L2.2 8.4"),
    ('×', 4.0, "M0 4.2L4 8.2M4 4.2L0 8.2"),
    ('_', 5.0, "M0 11.5L5 11.5"),
    ('/', 3.8, "M3.8 -.5L0 11"),
    ('(', 2.0, "M2 -1C.7 .7 0 2.8 0 5.2C0 7.6 .7 9.7 2 11.4"),
    (')', 2.0, "M0 -1C1.3 .7 2 2.8 2 5.2C2 7.6 1.3 9.7 0 11.4"),
    ('%', 8.0, "M6.8 0L1.2 10M1.8 0C.8 0 0 1 0 2.2C0 3.4 .8 4.4 1.8 4.4C2.8 4.4 3.6 3.4 3.6 2.2C3.6 1 2.8 0 1.8 0ZM6.2 5.6C5.2 5.6 4.4 6.6 4.4 7.8C4.4 9 5.2 10 6.2 10C7.2 10 8 9 8 7.8C8 6.6 7.2 5.6 6.2 5.6Z"),
    ('\'', 0.0, "M0 0L0 2.4"),
    ('"', 2.0, "M0 0L0 2.4M2 0L2 2.4"),
    ('#', 6.0, "M1.8 1.6L1.2 9M4.8 1.6L4.2 9M.2 3.8L6 3.8M0 6.8L5.8 6.8"),
    ('<', 4.4, "M4.4 3L0 6.2L4.4 9.4"),
    ('>', 4.4, "M0 3L4.4 6.2L0 9.4"),
    ('=', 4.4, "M0 4.8L4.4 4.8M0 7.6L4.4 7.6"),
    ('~', 4.8, "M0 6.8C.8 5.2 1.6 5.2 2.4 6.2C3.2 7.2 4 7.2 4.8 5.6"),
    ('!', 0.0, "M0 0L0 7M0 9.9L0 10"),
    ('?', 4.8, "M0 2C.3 .8 1.2 0 2.4 0C3.8 0 4.8 1 4.8 2.5C4.8 4.6 2.3 4.8 2.3 7.2M2.3 9.9L2.3 10"),
    (';', 0.6, "M.4 4.6L.4 4.7M.5 9.7L0 11.6"),
    ('[', 2.0, "M2 -1L0 -1L0 11.4L2 11.4"),
    (']', 2.0, "M0 -1L2 -1L2 11.4L0 11.4"),
    ('@', 9.0, "M6.4 4L6.4 6.8C6.4 8 7 8.6 7.8 8.6C8.6 8.6 9 7.4 9 5.8C9 2.4 7.2 .6 4.6 .6C1.8 .6 0 2.8 0 6C0 9.2 1.8 11.4 4.8 11.4C5.8 11.4 6.8 11.1 7.6 10.6M6.4 6C6.4 4.6 5.6 3.8 4.6 3.8C3.4 3.8 2.6 4.8 2.6 6.2C2.6 7.6 3.4 8.5 4.5 8.5C5.6 8.5 6.4 7.5 6.4 6"),
    ('&', 6.8, "M6.8 10L1.6 3.4C1 2.6 .9 1.9 .9 1.6C.9 .6 1.6 0 2.6 0C3.6 0 4.3 .7 4.3 1.7C4.3 4 0 4.2 0 7.2C0 8.9 1.2 10 2.9 10C5 10 6.4 8.2 6.5 5.6"),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_glyph_is_a_path_within_its_width() {
        for &(letter, width, outline) in GLYPHS {
            assert!(BezPath::from_svg(outline).is_ok(), "{letter}");
            for p in lines(outline).concat() {
                assert!(p.x >= -0.9 && p.x <= width + 0.3 && p.y >= -1.0 && p.y <= 13.5, "{letter} {p:?}");
            }
        }
    }

    #[test]
    fn a_long_name_is_cut_to_its_room() {
        let name = "a-very-long-name-of-a-picture-that-nobody-would-choose-by-hand.png";
        let cut = fitted(name, 14.0, 200.0);
        assert!(cut.ends_with('…') && text_width(&cut, 14.0) <= 200.0);
        assert_eq!(fitted("star.png", 14.0, 200.0), "star.png");
    }

    #[test]
    fn ink_stays_on_the_page() {
        let mut page = Plane::dark(40, 20);
        Pen { radius: 1.0, strength: 1.0 }.text(
            &mut page,
            "WWW ✏",
            18.0,
            Point::new(20.0, 15.0),
            Align::Middle,
        );
        assert!(page.values.iter().any(|&v| v > 0.9));
        assert!(page.values.iter().all(|&v| (0.0..=1.0).contains(&v)));
    }
}
