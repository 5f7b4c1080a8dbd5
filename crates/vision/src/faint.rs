//! Continues lines where they are too pale for the mask.
//!
//! From every free end the line is followed as long as it is darker than the paper on both sides, by far more than that paper varies. Between two
//! ends that face each other the whole gap is examined at once, and may be as broken as grain makes it. The result becomes ink and is traced with
//! the rest.

use tracelight_image::median::median;
use tracelight_image::{Mask, Plane};
use tracelight_maths::planar;
use tracelight_stroke::{Point, Vec2, polyline_length};

use crate::bridge::Tip;
use crate::gap::{End, ends_where, near_pairs, widest_paper};
use crate::row::Row;

/// A step ahead, and the stretch by which its direction is chosen, pens.
const STEP: f64 = 0.75;
const STRETCH: f64 = 1.5;
/// Directions that are tried either side, and how far each turns, rad.
const TURNS: i32 = 3;
const TURN: f64 = 0.09;
/// The paper beside a line, from its middle, pens.
const BESIDE: f64 = 1.4;
/// Stretches of paper either side that tell how much it differs, so many pens apart.
const PAPERS: i32 = 5;
const PAPERS_APART: f64 = 0.7;
/// Smallest contrast of a line to its sides, in deviations of the paper.
const SURE: f64 = 4.0;
/// Smallest such contrast as a share of the ink's darkness; the second value holds after shadows were removed, whose edges leave a pale
/// line.
const LEAST_SHARE: f64 = 0.06;
const LEAST_BY_SHADOWS: f64 = 0.3;
/// Longest continuation of a line, in pens.
const MOST_PENS: f64 = 20.0;
/// Smallest length of a line that is continued, in pens.
const LEAST_LENGTH: f64 = 1.5;
/// What ends in paper is a line if so many pens of it were seen.
const LEAST_SEEN: f64 = 3.0;

/// Lines are looked at as if they were so wide at least, px.
const LEAST_WIDTH_PX: f64 = 1.5;
/// Two ends that face each other are this near at most, pens.
const FACING_PENS: f64 = 12.0;
/// One of them is a line of so many pens: the strokes of letters are shorter, and end beside each other.
const FACING_LENGTH: f64 = 10.0;
/// They are one line that bends by less than this on its way over, rad, and their widths differ by less, as a ratio.
const FACING_BEND: f64 = 1.0;
const FACING_LIKE: f64 = 2.5;
/// On the way over it is darker than its sides by this share of what it is where it is ink, by so many times what the paper beside the way
/// differs, and nowhere paler than by this share for longer than a pen may skip.
const FACING_MEAN: f64 = 0.2;
const FACING_SURE: f64 = 4.0;
const FACING_PALEST: f64 = 0.1;
/// Ways beside it that are paper, pens from it.
const FACING_PAPERS: [f64; 4] = [3.0, 4.0, 5.0, 6.0];

/// The mask with what is found ahead of its lines' free ends; `None` where nothing is. The paper may have had `shadows`.
pub(crate) fn followed(dark: &Plane<u8>, mask: &Mask, rows: &[Row], shadows: bool) -> Option<Mask> {
    let least = if shadows { LEAST_BY_SHADOWS } else { LEAST_SHARE };
    let mut more = Mask::empty(mask.width(), mask.height());
    let is_long = |row: &Row| polyline_length(&row.points) >= LEAST_LENGTH * row.width;
    let ends = ends_where(rows, |_, row| !row.dot && is_long(row));
    // how dark a line is, levels
    let strength = |end: &End| {
        let levels: Vec<f64> = rows[end.row].points.iter().map(|&p| dark.at(p)).collect();
        median(&levels)
    };
    let mut ink = |way: &[Point], width: f64| {
        way.windows(2).for_each(|pair| paint(&mut more, pair[0], pair[1], 0.5 * width));
    };
    for end in &ends {
        let ahead = Ahead { dark, mask, width: width(end), least: least * strength(end) };
        if let Some(way) = ahead.follow(&end.tip) {
            ink(&way, ahead.width);
        }
    }
    for (a, b) in facing(&ends) {
        let over = Over { dark, way: way_over(a, b), width: 0.5 * (width(a) + width(b)) };
        if over.is_line(0.5 * (strength(a) + strength(b)), least) {
            ink(&over.way, over.width);
        }
    }
    if more.is_empty() {
        return None;
    }
    more.add(mask);
    Some(more)
}

/// Pairs of ends that may be one line.
fn facing(ends: &[End]) -> impl Iterator<Item = (&End, &End)> {
    // of two that are alike in width the mean is at most so many times either
    let reach = |end: &End| FACING_PENS * 0.5 * (1.0 + FACING_LIKE) * width(end);
    near_pairs(ends, reach).into_iter().filter(|(a, b)| do_face(a, b))
}

fn do_face(a: &End, b: &End) -> bool {
    let (thin, thick) = (width(a).min(width(b)), width(a).max(width(b)));
    a.tip.at.distance(b.tip.at) <= FACING_PENS * 0.5 * (thin + thick)
        && a.length.max(b.length) >= FACING_LENGTH * thick
        && thick < FACING_LIKE * thin
        && a.tip.bend(&b.tip) < FACING_BEND
}

/// Of an end's line, px: what is thinner is looked at as if it had a px and a half.
fn width(end: &End) -> f64 {
    end.width.max(LEAST_WIDTH_PX)
}

/// A smooth way from one end to another, about 1 px from point to point.
fn way_over(a: &End, b: &End) -> Vec<Point> {
    [a.tip.at].into_iter().chain(a.tip.smoothly_to(&b.tip)).chain([b.tip.at]).collect()
}

/// What lies on a way from one end to another.
struct Over<'a> {
    dark: &'a Plane<u8>,
    way: Vec<Point>,
    width: f64,
}

impl Over<'_> {
    /// Whether a line of this darkness goes on there; `least` is the least share of it that is darker than its sides.
    fn is_line(&self, strength: f64, least: f64) -> bool {
        let along: Vec<f64> = (0..self.way.len()).map(|k| self.contrast(k, 0.0)).collect();
        let skipped = (widest_paper(self.width) as usize).clamp(1, along.len());
        let palest = along.windows(skipped).map(mean).fold(f64::INFINITY, f64::min);
        let beside = |aside: f64| {
            let contrasts: Vec<f64> = (0..self.way.len()).map(|k| self.contrast(k, aside)).collect();
            mean(&contrasts).abs()
        };
        let papers = FACING_PAPERS.into_iter().flat_map(|pens| [pens, -pens]);
        let seen = mean(&along);
        seen > FACING_MEAN.max(least) * strength
            && palest > FACING_PALEST * strength
            && seen > FACING_SURE * median(&papers.map(beside).collect::<Vec<_>>())
    }

    /// By how much it is darker so many pens aside of a point of the way than on both sides of there, levels.
    fn contrast(&self, k: usize, aside: f64) -> f64 {
        let (from, to) = (self.way[k.saturating_sub(1)], self.way[(k + 1).min(self.way.len() - 1)]);
        let across = (to - from).turn_90() * (self.width / from.distance(to).max(1e-9));
        let darkness = |aside: f64| {
            let at = |off: f64| self.dark.at(self.way[k] + across * (aside + off));
            (at(-0.2) + at(0.0) + at(0.2)) / 3.0
        };
        darkness(aside) - 0.5 * (darkness(aside + BESIDE) + darkness(aside - BESIDE))
    }
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// What lies ahead of one end.
struct Ahead<'a> {
    dark: &'a Plane<u8>,
    mask: &'a Mask,
    width: f64,
    /// By how much it is darker than its sides at least, levels.
    least: f64,
}

impl Ahead<'_> {
    /// The way of the line beyond its end: to other ink, or as far as it is seen.
    fn follow(&self, tip: &Tip) -> Option<Vec<Point>> {
        let step = (STEP * self.width).max(1.0);
        let (mut at, mut along) = (tip.at, tip.along);
        if along == Vec2::ZERO || !self.may_go_on(at, along) {
            return None;
        }
        let mut way = vec![at];
        let mut passed = 0.0;
        while let Some(ahead) = self.best(at, along).filter(|_| passed < MOST_PENS * self.width) {
            along = ahead;
            at += along * step;
            if !self.dark.holds(at) {
                break;
            }
            way.push(at);
            // past what the end's own ink covers
            if passed > 0.75 * self.width && self.is_ink(at) {
                return Some(way);
            }
            passed = polyline_length(&way);
        }
        (passed >= LEAST_SEEN * self.width).then_some(way)
    }

    fn is_ink(&self, at: Point) -> bool {
        self.mask.get(at.x.floor() as isize, at.y.floor() as isize)
    }

    /// A quick look: most ends end.
    fn may_go_on(&self, at: Point, along: Vec2) -> bool {
        let from = at + along * (0.5 * self.width);
        ways(along).any(|way| self.contrast(from, way) > self.least)
    }

    /// The direction in which the line goes on, if it does.
    fn best(&self, at: Point, along: Vec2) -> Option<Vec2> {
        let told = ways(along).map(|way| (self.contrast(at, way), way));
        let (contrast, way) = told.max_by(|a, b| a.0.total_cmp(&b.0))?;
        let across = way.turn_90();
        let papers = (1..=PAPERS).flat_map(|k| [f64::from(k), -f64::from(k)]).map(|k| {
            let aside = k * PAPERS_APART + k.signum() * BESIDE;
            self.contrast(at + across * (aside * self.width), way).abs()
        });
        let paper = median(&papers.collect::<Vec<_>>());
        (contrast > (SURE * paper).max(self.least)).then_some(way)
    }

    /// By how much a stretch of the line is darker than the paper on either side of it, at least, levels: where it is palest, twice that, so
    /// that no paper is crossed to what lies beyond.
    fn contrast(&self, from: Point, way: Vec2) -> f64 {
        let across = way.turn_90();
        let length = STRETCH * self.width / 3.0;
        let steps = length.ceil().max(2.0);
        let third = |number: i32| {
            let from = from + way * (f64::from(number) * length);
            let mean = |aside: f64| {
                let places = (0..steps as usize)
                    .map(|k| from + way * (length * (k as f64 + 0.5) / steps) + across * aside * self.width);
                self.dark.mean_at(places)
            };
            let middle = (mean(-0.2) + mean(0.0) + mean(0.2)) / 3.0;
            let side = |sign: f64| 0.5 * (mean(sign * BESIDE) + mean(sign * (BESIDE + 0.3)));
            middle - side(1.0).max(side(-1.0))
        };
        let thirds = [0, 1, 2].map(third);
        let least = thirds.into_iter().fold(f64::INFINITY, f64::min);
        (thirds.iter().sum::<f64>() / 3.0).min(2.0 * least)
    }
}

/// The directions that are tried about one.
fn ways(along: Vec2) -> impl Iterator<Item = Vec2> {
    (-TURNS..=TURNS).map(move |k| along.rotate_scale(planar::direction(f64::from(k) * TURN)))
}

/// Inks what is within a distance of a line, px.
fn paint(mask: &mut Mask, from: Point, to: Point, radius: f64) {
    let steps = (2.0 * from.distance(to)).ceil().max(1.0) as usize;
    let radius = radius.max(0.7);
    for k in 0..=steps {
        let at = from.lerp(to, k as f64 / steps as f64);
        let range = |middle: f64, most: usize| {
            ((middle - radius).round().max(0.0) as usize).min(most)
                ..((middle + radius).round().max(0.0) as usize).min(most)
        };
        range(at.y, mask.height()).for_each(|y| {
            let columns = range(at.x, mask.width());
            mask.fill(y, columns.start, columns.end);
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is found between two rows of 4 px that face each other over 20 px, where marks of so many levels lie two px apart.
    fn between(marks: u8) -> Option<Mask> {
        let mut dark = Plane::filled(120, 60, 0);
        for y in 28..32 {
            dark.row_mut(y)[10..50].fill(200);
            dark.row_mut(y)[70..110].fill(200);
            (50..70).filter(|x| x % 4 < 2).for_each(|x| dark.row_mut(y)[x] = marks);
        }
        let row = |from: i32, to: i32, free| {
            let points = (from..=to).map(|x| Point::new(f64::from(x), 30.0)).collect();
            Row { points, closed: false, width: 4.0, free, dot: false }
        };
        let rows = [row(12, 48, [false, true]), row(72, 108, [true, false])];
        followed(&dark, &tracelight_image::threshold::over(&dark, 150), &rows, false)
    }

    #[test]
    fn between_ends_that_face_each_other_broken_ink_is_a_line_and_paper_is_none() {
        for marks in [110, 140] {
            let found = between(marks).unwrap();
            assert!((48..72).all(|x| found.get(x, 30)), "{marks} levels");
        }
        assert!(between(0).is_none());
    }
}
