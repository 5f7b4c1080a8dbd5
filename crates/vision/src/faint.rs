//! Where a pencil pressed less its line is too pale for the mask, and goes on.
//!
//! From every free end the line is followed ahead as long as what lies there is darker than the paper on both sides of it, by far more than
//! that paper differs from place to place. What is found becomes ink, and is traced with the rest.

use tracelight_stroke::{Point, Vec2, polyline_length};

use crate::bridge::Tip;
use crate::centreline::Row;
use crate::mask::Mask;
use crate::plane::Plane;
use crate::ridge::median;

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
/// A line is darker than its sides by so many times what the paper differs,
const SURE: f64 = 4.0;
/// and by this share of what it is where it is ink; where shadows were evened out, whose edges leave a pale line, by this one.
const LEAST_SHARE: f64 = 0.06;
const LEAST_BY_SHADOWS: f64 = 0.3;
/// Ink is followed over so many pens at most,
const MOST_PENS: f64 = 20.0;
/// from lines that are at least as long as this.
const LEAST_LENGTH: f64 = 1.5;
/// What ends in paper is a line if so many pens of it were seen.
const LEAST_SEEN: f64 = 3.0;

/// The mask with what is found ahead of its lines' free ends; `None` where nothing is. The paper may have had `shadows`.
pub(crate) fn followed(dark: &Plane<u8>, mask: &Mask, rows: &[Row], shadows: bool) -> Option<Mask> {
    let least = if shadows { LEAST_BY_SHADOWS } else { LEAST_SHARE };
    let mut more = Mask::empty(mask.width, mask.height);
    let is_long =
        |row: &&Row| !row.closed && !row.dot && polyline_length(&row.points) >= LEAST_LENGTH * row.width;
    for row in rows.iter().filter(is_long) {
        for end in [0, 1].into_iter().filter(|&end| row.free[end]) {
            let Some(tip) = Tip::of(&row.points, end) else { continue };
            let strength = median(&row.points.iter().map(|&p| dark.at(p)).collect::<Vec<_>>());
            let ahead = Ahead { dark, mask, width: row.width.max(1.5), least: least * strength };
            if let Some(way) = ahead.follow(&tip) {
                way.windows(2).for_each(|pair| paint(&mut more, pair[0], pair[1], 0.5 * ahead.width));
            }
        }
    }
    if more.is_empty() {
        return None;
    }
    more.add(mask);
    Some(more)
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
                places.map(|p| self.dark.at(p)).sum::<f64>() / steps
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
    (-TURNS..=TURNS).map(move |k| along.rotate_scale(Vec2::from_angle(f64::from(k) * TURN)))
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
        range(at.y, mask.height).for_each(|y| {
            let columns = range(at.x, mask.width);
            mask.fill(y, columns.start, columns.end);
        });
    }
}
