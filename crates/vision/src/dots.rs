//! Detects the dots of dotted paper: many small patches on a square grid.

use tracelight_image::Region;
use tracelight_image::median::middle;
use tracelight_stroke::{Point, Vec2};

use crate::comb::ratio;
use crate::near::Near;
use crate::row::Row;

/// Dots of the paper that are in no stroke.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dots {
    /// How many.
    pub count: usize,
    /// From one's middle to the next one's, px.
    pub spacing_px: f64,
}

/// Fewer dots that have most of their neighbours are none of the paper's.
const FEWEST: usize = 20;
/// They lie all over at least this share of the picture, either way.
const LEAST_SPREAD: f64 = 0.3;
/// A dot is at most so many times as long as wide, and no longer than this share of the way to the next one.
const ROUND: f64 = 2.2;
const MOST_SPACED: f64 = 0.5;
/// And it covers at least this share of the box about it.
const FILLED: f64 = 0.4;
/// Neighbours cover as many pixels, within this ratio; one that is known by its place within the other.
const ALIKE: f64 = 2.5;
const KNOWN_ALIKE: f64 = 4.0;
/// And are so near to where they must be: share of their distance, and px.
const OFF: f64 = 0.1;
const OFF_PX: f64 = 0.7;
/// One on a line reaches so far beyond it, px.
const BESIDE_PX: f64 = 1.5;
/// The next ones lie within so many times the distance of as many as there are, strewn all over.
const REACH: f64 = 2.5;
/// Ways to neighbours are as long as the usual one, within this ratio.
const SAME_LENGTH: f64 = 1.25;
/// And nothing alike is nearer than this share of it.
const BETWEEN: f64 = 0.7;
/// So many of the nearest are asked for the way from one to the next.
const ASKED: usize = 6;
/// Of its four neighbours at least so many are seen.
const NEIGHBOURS: usize = 3;
/// At least so many of these have their own the same way, within this share of it.
const AGREEING: usize = 2;
const SAME_WAY: f64 = 0.2;

/// A patch that may be a dot.
#[derive(Clone, Copy)]
struct Patch {
    number: usize,
    area: f64,
    /// The longer side of the box about it, px.
    side: f64,
}

/// What a page is printed with.
pub(crate) struct Dotted {
    pub(crate) told: Dots,
    /// Which of the patches are dots.
    pub(crate) is_dot: Vec<bool>,
    /// Where one must be that is no patch of its own: on a line.
    hidden: Vec<Point>,
    /// Their usual width, px.
    side: f64,
}

impl Dotted {
    /// Without the rows that lead to a dot on a line, and no further.
    pub(crate) fn off(&self, mut rows: Vec<Row>) -> Vec<Row> {
        let pen = middle(rows.iter().map(|row| row.width).collect()).unwrap_or(0.0);
        let is_spur = |row: &Row| {
            let reach = 0.5 * (self.side + pen.max(row.width)) + BESIDE_PX;
            let is_at = |dot: &Point| row.points.iter().all(|p| p.distance(*dot) < reach);
            !row.closed && row.free != [true; 2] && self.hidden.iter().any(is_at)
        };
        rows.retain(|row| !is_spur(row));
        rows
    }
}

/// The dots among some patches of a picture, and `specks` that are too small to be drawn; `None` where its paper has none.
pub(crate) fn of_paper(
    regions: &[Region],
    specks: &[Region],
    (width, height): (usize, usize),
) -> Option<Dotted> {
    let all = regions.iter().chain(specks).enumerate();
    let patches: Vec<(Point, Patch)> = all.filter_map(|(number, region)| patch(number, region)).collect();
    if patches.len() < FEWEST {
        return None;
    }
    let reach = REACH * ((width * height) as f64 / patches.len() as f64).sqrt();
    let near = Near::of(patches.iter().copied(), reach);
    let ways: Vec<Dot> =
        patches.iter().filter_map(|&(at, patch)| Some((at, patch, way(&near, at, &patch)?))).collect();
    if ways.len() < FEWEST {
        return None;
    }
    let spacing_px = middle(ways.iter().map(|(_, _, way)| way.hypot()).collect())?;
    let is_usual = |way: &Vec2| ratio(way.hypot(), spacing_px) < SAME_LENGTH;
    let mut known: Vec<Option<Vec2>> = vec![None; regions.len() + specks.len()];
    ways.iter()
        .filter(|(.., way)| is_usual(way))
        .for_each(|(_, patch, way)| known[patch.number] = Some(*way));
    let seeds = ways.into_iter().filter(|dot| known[dot.1.number].is_some() && agrees(&near, &known, dot));
    let dots = with_neighbours(&near, seeds.collect(), &mut vec![false; known.len()]);
    let spread = |of: fn(&Point) -> f64, most: usize| {
        let (low, high) = dots
            .iter()
            .fold((f64::INFINITY, 0.0_f64), |(low, high), (at, ..)| (low.min(of(at)), high.max(of(at))));
        high - low > LEAST_SPREAD * most as f64
    };
    if dots.len() < FEWEST || !spread(|p| p.x, width) || !spread(|p| p.y, height) {
        return None;
    }
    let mut is_dot = vec![false; regions.len()];
    for (_, patch, _) in &dots {
        if let Some(is_dot) = is_dot.get_mut(patch.number) {
            *is_dot = true;
        }
    }
    let side = middle(dots.iter().map(|(_, patch, _)| patch.side).collect())?;
    Some(Dotted { told: Dots { count: dots.len(), spacing_px }, is_dot, hidden: hidden(&near, &dots), side })
}

/// Where at least two dots have a neighbour that is none.
fn hidden(near: &Near<Patch>, dots: &[Dot]) -> Vec<Point> {
    let mut found: Vec<(Point, usize)> = Vec::new();
    for (at, patch, way) in dots {
        for way in ways_from(*way)
            .into_iter()
            .filter(|w| nearest(near, *at, *w, (patch.area, KNOWN_ALIKE)).is_none())
        {
            let expected = *at + way;
            match found.iter_mut().find(|(p, _)| p.distance(expected) < tolerance(way)) {
                Some((p, votes)) => {
                    *votes += 1;
                    *p = p.lerp(expected, 1.0 / *votes as f64);
                }
                None => found.push((expected, 1)),
            }
        }
    }
    found.into_iter().filter(|(_, votes)| *votes > 1).map(|(p, _)| p).collect()
}

/// A region by its middle, if it is round.
fn patch(number: usize, region: &Region) -> Option<(Point, Patch)> {
    let (width, height) = region.extent();
    let (area, side) = (region.area() as f64, width.max(height) as f64);
    let is_round = side <= ROUND * width.min(height) as f64 && area > FILLED * (width * height) as f64;
    is_round.then(|| {
        let sum = region.places().fold(Vec2::ZERO, |sum, (x, y)| sum + Vec2::new(x as f64, y as f64));
        (Point::new(sum.x / area + 0.5, sum.y / area + 0.5), Patch { number, area, side })
    })
}

/// Where a dot is, and the way to one of its neighbours.
type Dot = (Point, Patch, Vec2);

/// How far from where it must be a dot may lie, one way from another, px.
fn tolerance(way: Vec2) -> f64 {
    OFF * way.hypot() + OFF_PX
}

/// The patch nearest to a place where a dot must be, one way from another.
fn nearest(near: &Near<Patch>, at: Point, way: Vec2, like: (f64, f64)) -> Option<(Point, &Patch)> {
    let (area, alike) = like;
    let expected = at + way;
    let most = tolerance(way);
    let found = near
        .around(expected)
        .filter(|(p, patch)| p.distance(expected) < most && ratio(patch.area, area) < alike);
    found.min_by(|(a, _), (b, _)| a.distance(expected).total_cmp(&b.distance(expected)))
}

/// The way from a patch to its neighbour, if it has most of the four that a dot has.
fn way(near: &Near<Patch>, at: Point, patch: &Patch) -> Option<Vec2> {
    let mut ways: Vec<Vec2> = near
        .around(at)
        .map(|(p, other)| (p - at, other))
        .filter(|(way, other)| way.hypot() > 0.0 && ratio(other.area, patch.area) < ALIKE)
        .map(|(way, _)| way)
        .collect();
    ways.sort_unstable_by(|a, b| a.hypot().total_cmp(&b.hypot()));
    // letters of a page of type have others beside them
    let nearest_px = ways.first()?.hypot();
    let is_apart = |way: &Vec2| patch.side < MOST_SPACED * way.hypot() && nearest_px > BETWEEN * way.hypot();
    ways.into_iter().take(ASKED).filter(is_apart).find(|way| {
        let [_, others @ ..] = ways_from(*way);
        let seen = others.iter().filter(|way| nearest(near, at, **way, (patch.area, ALIKE)).is_some());
        seen.count() + 1 >= NEIGHBOURS
    })
}

/// The ways to a dot's four neighbours, by that to one of them.
fn ways_from(way: Vec2) -> [Vec2; 4] {
    [way, way.turn_90(), -way, -way.turn_90()]
}

/// Whether most of a dot's neighbours have theirs the same way: specks that lie so by chance have not.
fn agrees(near: &Near<Patch>, known: &[Option<Vec2>], (at, patch, way): &Dot) -> bool {
    let ways = ways_from(*way);
    let is_same = |other: Vec2| ways.iter().any(|way| (*way - other).hypot() < SAME_WAY * way.hypot());
    let seen = ways.iter().filter_map(|way| nearest(near, *at, *way, (patch.area, ALIKE)));
    seen.filter(|(_, other)| known[other.number].is_some_and(is_same)).count() >= AGREEING
}

/// Some dots, and all patches that lie beside one as its neighbours do.
fn with_neighbours(near: &Near<Patch>, mut dots: Vec<Dot>, seen: &mut [bool]) -> Vec<Dot> {
    dots.iter().for_each(|(_, patch, _)| seen[patch.number] = true);
    let mut next = 0;
    while let Some(&(at, patch, way)) = dots.get(next) {
        next += 1;
        for way_on in ways_from(way) {
            let like = (patch.area, KNOWN_ALIKE);
            // over one that lies on a line
            let found = [1.0, 2.0].into_iter().find_map(|far| nearest(near, at, far * way_on, like));
            if let Some((p, other)) = found.filter(|(_, other)| !seen[other.number]) {
                seen[other.number] = true;
                dots.push((p, *other, way));
            }
        }
    }
    dots
}

#[cfg(test)]
mod tests {
    use tracelight_image::{Mask, regions};

    use super::*;

    /// A mask of 400 × 300 px by what is ink.
    fn mask(is_ink: impl Fn(f64, f64) -> bool) -> Mask {
        let mut mask = Mask::empty(400, 300);
        for (x, y) in (0..400 * 300).map(|i| (i % 400, i / 400)) {
            if is_ink(x as f64 + 0.5, y as f64 + 0.5) {
                mask.fill(y, x, x + 1);
            }
        }
        mask
    }

    /// Whether a place is on a dot of dotted paper that lies bent and a little aslant.
    fn is_dot(x: f64, y: f64) -> bool {
        let (u, v) = (x + 0.05 * y, y - 0.05 * x + 0.0002 * (x - 200.0).powi(2));
        let off = |at: f64| (at / 16.0 - (at / 16.0).round()) * 16.0;
        off(u).hypot(off(v)) < 1.8
    }

    #[test]
    fn the_dots_of_bent_paper_are_found_and_those_that_no_one_printed_are_not() {
        let found = |mask: &Mask| of_paper(&regions(mask), &[], (400, 300));
        let dotted = found(&mask(is_dot)).expect("dots");
        assert!(dotted.told.count > 400 && dotted.is_dot.iter().filter(|dot| !**dot).count() < 8);
        assert!((dotted.told.spacing_px - 16.0).abs() < 0.5, "{}", dotted.told.spacing_px);
        // as many, anywhere
        let specks: Vec<Point> = (0..450_u32)
            .map(|k| Point::new(f64::from(k * k % 3989) / 10.0, f64::from(k * k * k % 2999) / 10.0))
            .collect();
        let is_speck = |x: f64, y: f64| specks.iter().any(|p| p.distance(Point::new(x, y)) < 1.8);
        assert!(found(&mask(is_speck)).is_none());
        // a page of type, every second letter of which is as far from the next one as from that of the next line
        let is_letter = |x: f64, y: f64| x % 11.0 < 7.0 && y % 22.0 < 7.0;
        assert!(found(&mask(is_letter)).is_none());
        // a few that someone drew
        let is_few =
            |x: f64, y: f64| is_dot(x, y) && (150.0..210.0).contains(&x) && (90.0..150.0).contains(&y);
        assert!(found(&mask(is_few)).is_none());
    }

    #[test]
    fn a_row_that_leads_to_a_dot_on_a_line_is_none_and_another_is_one() {
        let line = |x: f64, y: f64| (y - 0.4 * x - 60.0).abs() < 2.5;
        let ink = mask(|x, y| is_dot(x, y) || line(x, y));
        let dotted = of_paper(&regions(&ink), &[], (400, 300)).expect("dots");
        assert!(dotted.hidden.len() > 5, "{}", dotted.hidden.len());
        let row = |points: &[Point], free: [bool; 2]| Row {
            points: points.to_vec(),
            closed: false,
            width: 4.0,
            free,
            dot: false,
        };
        let dot = dotted.hidden[0];
        let spur = row(&[dot + Vec2::new(0.0, 3.0), dot], [false, true]);
        let mark = row(&[dot + Vec2::new(0.0, 3.0), dot], [true; 2]);
        let long = row(&[dot + Vec2::new(0.0, 9.0), dot], [false, true]);
        assert_eq!(dotted.off(vec![spur, mark.clone(), long.clone()]), vec![mark, long]);
    }
}
