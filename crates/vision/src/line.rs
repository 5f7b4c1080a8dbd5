//! Places the branches of the skeleton on the middle of the pen line.

use tracelight_image::median::median;
use tracelight_image::{Mask, Plane};
use tracelight_stroke::{Parabola, Point, Vec2, polyline_length};

use crate::bridge::{Tip, drop_beyond, from_end, scatter_px};
use crate::graph::{Branch, Graph, Turn, TurnTip};
use crate::prune::is_bent;
use crate::ridge::{self, Ridge};

/// A stretch of pen line without junctions.
#[derive(Clone, Debug)]
pub(crate) struct Line {
    /// At least one.
    pub(crate) points: Vec<Point>,
    /// Width of the pen, px.
    pub(crate) width: f64,
    /// Node of the graph at either end.
    pub(crate) nodes: [Option<usize>; 2],
    pub(crate) ring: bool,
    /// Whether the pen was lifted at either end, away from other ink.
    pub(crate) free: [bool; 2],
    /// The skeleton's way from either end on to its node and that itself, through ink in which the line cannot be seen.
    pub(crate) lost: [Vec<Point>; 2],
}

impl Line {
    /// From a branch: its points without those that show a junction, a corner or an end instead of the line,
    /// centred on the grey levels, with its corners where its sides meet and its free ends where the pen was lifted.
    /// `pen` is half the width of the graph's pen.
    pub(crate) fn of(dark: &Plane<u8>, shapes: &Mask, graph: &Graph, pen: f64, branch: &Branch) -> Self {
        let radius = median(&branch.radii).max(0.5);
        let (from, to) = if branch.ring { (0, branch.points.len()) } else { trusted(graph, branch, radius) };
        let is_letter = graph.is_letter();
        let seen = || {
            let pixels = (&branch.points[from..to], &branch.radii[from..to]);
            centred(dark, pixels, radius, branch.ring, is_letter)
        };
        // where a near turn is, its sides may tell
        let told = branch.turns.iter().all(|turn| turn.tip.is_near).then(seen).filter(|(points, _)| {
            branch.turns.iter().all(|turn| points.iter().any(|p| p.distance(turn.tip.at) < radius))
        });
        let (mut points, width) = told.unwrap_or_else(|| turning(dark, branch, (from, to), radius));
        (0..2).filter(|&end| branch.nodes[end].is_some()).for_each(|end| settle(&mut points, end, width));
        // of a short bar or nub its pixels have to tell the direction, and of a hairpin where it turns
        let is_more_than_a_bump = || match branch.nodes.iter().flatten().count() {
            2 => true,
            1 => !is_letter && branch.length() >= NUB_RADII * pen,
            _ => false,
        };
        if points.len() < 2 && branch.points.len() > 3 && is_more_than_a_bump() {
            points = inner(branch);
        } else if points.is_empty() {
            points.push(branch.points[(from + to) / 2]);
        }
        let to_node = |end: usize| {
            let node = graph.nodes[branch.nodes[end]?];
            let mut way = way_on(branch, &points, end);
            way.push(node.at);
            Some(way)
        };
        let lost = [0, 1].map(|end| to_node(end).unwrap_or_default());
        let mut line = Self { points, width, nodes: branch.nodes, ring: branch.ring, free: [false; 2], lost };
        if !branch.ring {
            (0..2)
                .filter(|&end| branch.nodes[end].is_none())
                .for_each(|end| line.reach_out(dark, shapes, end));
        }
        line
    }

    /// Length, px.
    pub(crate) fn length(&self) -> f64 {
        polyline_length(&self.points)
    }

    /// The line's end (0: at its first point) and the direction out of it: that of a single point is to its node.
    pub(crate) fn tip(&self, end: usize) -> Tip {
        let tip = Tip::of(&self.points, end).unwrap_or(Tip::single(self.points[0]));
        match (&self.points[..], self.lost[end].last()) {
            ([only], Some(node)) if node != only => Tip::towards(*only, *node),
            _ => tip,
        }
    }

    /// Moves a free end, along its curve, to where the pen was lifted or where the line meets a shape.
    fn reach_out(&mut self, dark: &Plane<u8>, shapes: &Mask, end: usize) {
        let tip = self.tip(end);
        let reach = 4.0 * self.width + 4.0;
        let ahead = match shape_ahead(shapes, &tip, reach).filter(|&ahead| tip.is_inked_to(dark, ahead)) {
            Some(ahead) => ahead,
            None => {
                self.free[end] = true;
                // where the ink goes on paler there is no end to be moved to
                let Some(ahead) = ridge::pen_end(dark, |s| tip.beyond(s).0, self.width, reach) else {
                    return;
                };
                ahead
            }
        };
        let whole = (ahead - 0.5).max(0.0) as usize;
        let way = (1..=whole).map(|k| k as f64).chain([ahead]).map(|s| tip.beyond(s).0);
        self.end_with(end, tip.along, way);
    }

    /// Carries an end on along a way, or back to where that begins.
    pub(crate) fn end_along(&mut self, end: usize, way: &[Point]) {
        self.end_with(end, self.tip(end).along, way.iter().copied());
    }

    /// Carries an end, whose direction is `along`, on along a way, or back to where that begins.
    fn end_with(&mut self, end: usize, along: Vec2, way: impl Iterator<Item = Point>) {
        let mut way = way.peekable();
        let Some(&first) = way.peek() else { return };
        if end == 0 {
            self.points.reverse();
        }
        drop_beyond(&mut self.points, first, along, f64::NEG_INFINITY);
        self.points.extend(way);
        if end == 0 {
            self.points.reverse();
        }
    }
}

/// The inner half of a branch by its pixels: two of them where it is straight, and where it turns what lies between.
fn inner(branch: &Branch) -> Vec<Point> {
    let n = branch.points.len();
    let pixels = &branch.points[n / 4..n - n / 4];
    let (first, last) = (pixels[0], pixels[pixels.len() - 1]);
    match branch.turns.is_empty() {
        // of fewer pixels there is no mean
        true if pixels.len() >= MEAN_OF && is_bent(pixels) => off_the_grid(pixels).collect(),
        true => vec![first, last],
        false => {
            let turns = branch.turns.iter().map(|turn| turn.tip.at);
            filled_in(&[first].into_iter().chain(turns).chain([last]).collect::<Vec<_>>(), false)
        }
    }
}

/// The pixels of a branch from the end of its line on.
fn way_on(branch: &Branch, points: &[Point], end: usize) -> Vec<Point> {
    let pixels = || from_end(&branch.points, end).copied();
    let tip = points[end * (points.len() - 1)];
    // the nearest, as seen from the node, of the half that is this end's
    let half = pixels().take(branch.points.len().div_ceil(2)).map(|p| p.distance_squared(tip)).enumerate();
    let nearest = half.min_by(|a, b| a.1.total_cmp(&b.1)).map_or(0, |(k, _)| k);
    pixels().take(nearest).rev().collect()
}

/// Takes away the points at an end that lean towards the ink of a junction: what lies off the straight line through
/// those further in. Blur carries that ink further than its own width. (A bend, carried on, would be less sure than
/// its points are.)
fn settle(points: &mut Vec<Point>, end: usize, width: f64) {
    let noise = scatter_px(points);
    if end == 0 {
        points.reverse();
    }
    let steps: Vec<f64> = points.windows(2).map(|w| w[0].distance(w[1])).collect();
    let spacing = median(&steps).max(0.5);
    let leaning = ((1.5 * width / spacing) as usize).min(points.len() / 4);
    // arc length from the last point inwards
    let mut at = 0.0;
    let places: Vec<(f64, Point)> = (0..points.len())
        .rev()
        .map(|k| {
            at += if k + 1 < points.len() { steps[k] } else { 0.0 };
            (at, points[k])
        })
        .collect();
    let further_in = places.iter().copied().skip(leaning);
    let line = Parabola::widest(further_in, &SETTLED, (1.3 * noise).max(0.06));
    let long = places.len() >= leaning + SETTLED[0];
    if let Some(line) = line.filter(|line| long && line.is_straight()) {
        let off = |&(s, p): &(f64, Point)| line.point(s).distance(p) > (3.0 * noise).max(0.25);
        let leans = places[..leaning].iter().rposition(off).map_or(0, |k| k + 1);
        points.truncate(points.len() - leans);
    }
    if end == 0 {
        points.reverse();
    }
}

/// Points further in from which a line's curve is taken: as many as lie on a parabola.
const SETTLED: [usize; 5] = [8, 12, 18, 26, 38];

/// How far ahead of a tip a shape begins, px.
fn shape_ahead(shapes: &Mask, tip: &Tip, reach: f64) -> Option<f64> {
    const STEP: f64 = 0.25;
    let inside = |s: &f64| {
        let at = tip.beyond(*s).0;
        shapes.get(at.x.floor() as isize, at.y.floor() as isize)
    };
    (0..(reach / STEP) as usize).map(|k| k as f64 * STEP).find(inside)
}

/// Points on the middle of a line along a row of pixels, of which each is known with the half width of its ink; and the
/// line's width.
fn centred(
    dark: &Plane<u8>,
    pixels: (&[Point], &[f64]),
    radius: f64,
    ring: bool,
    is_letter: bool,
) -> (Vec<Point>, f64) {
    // of a letter as many pixels to either side as elsewhere would be half of it
    let reach = if is_letter { (pixels.0.len() / 5).clamp(2, REACH) } else { REACH };
    let ridge = ridge::centred(dark, pixels, radius, ring, reach);
    let mut pixels: Vec<(Point, f64)> = std::iter::zip(pixels.0, pixels.1).map(|(&p, &r)| (p, r)).collect();
    let mut points = bridged(dark, &ridge, &pixels, ring);
    if !ring {
        // first what is lost at the beginning, then at the end
        for _ in 0..2 {
            points.reverse();
            pixels.reverse();
            points.extend(lost(&pixels, points.last(), ridge.width, is_letter));
        }
    }
    (points, ridge.width)
}

/// A line with a free end that is shorter than this, half pen widths, is an edge's bump or a speck beside it.
const NUB_RADII: f64 = 3.5;
/// So many pixels to either side tell the direction of a line.
const REACH: usize = 5;
/// Ink that is this much wider than its line is a blot's or a junction's.
const BLOT: f64 = 1.3;
/// So much of a row of pixels may be without a cross-section at an end, in pens and px: the ink of a junction.
const LOST_PENS: f64 = 1.0;
const LOST_PX: f64 = 2.0;

/// The pixels from where the middle of a line so wide can be seen last to their end, if that is further than a junction's
/// ink reaches: the middle of a jagged line has no cross-section for long.
fn lost(pixels: &[(Point, f64)], last: Option<&Point>, width: f64, is_letter: bool) -> Vec<Point> {
    let Some(&last) = last else { return Vec::new() };
    // a line that goes round ends beside its beginning
    let nearest = (pixels.len() / 2..pixels.len()).min_by(|&a, &b| {
        let off = |k: usize| pixels[k].0.distance_squared(last);
        off(a).total_cmp(&off(b))
    });
    let rest = &pixels[nearest.unwrap_or(0)..];
    let here = rest.first().map_or(0.0, |(_, radius)| 2.0 * radius);
    let as_wide = |(_, radius): &(Point, f64)| 2.0 * radius <= BLOT * width.max(here) + 1.0;
    let rest: Vec<Point> = rest.iter().copied().take_while(as_wide).map(|(at, _)| at).collect();
    let most = LOST_PENS * width + if is_letter { 0.0 } else { LOST_PX };
    match polyline_length(&rest) > most {
        true if is_letter => rest[1..].to_vec(),
        true => off_the_grid(&rest).step_by(2).collect(),
        false => Vec::new(),
    }
}

/// So many pixels in a row have a mean that is off the steps of their grid.
const MEAN_OF: usize = 5;

/// The means of five pixels each, which are off the steps of their grid; none of fewer.
pub(crate) fn off_the_grid(pixels: &[Point]) -> impl Iterator<Item = Point> {
    let mean = |some: &[Point]| some.iter().fold(Vec2::ZERO, |sum, p| sum + p.to_vec2() / MEAN_OF as f64);
    pixels.windows(MEAN_OF).map(move |some| mean(some).to_point())
}

/// Traces a branch that turns back on itself: two parallel lines, connected at each turn.
fn turning(dark: &Plane<u8>, branch: &Branch, (from, to): (usize, usize), radius: f64) -> (Vec<Point>, f64) {
    let (mut pixels, mut radii) = (branch.points[from..to].to_vec(), branch.radii[from..to].to_vec());
    let inside = branch.turns.iter().filter(|turn| (from..to).contains(&turn.index));
    let mut turns: Vec<Turn> = inside.map(|turn| Turn { index: turn.index - from, ..*turn }).collect();
    if let (true, Some(&first)) = (branch.ring, turns.first()) {
        // a ring begins behind its first turn, and returns to it last
        pixels.rotate_left(first.index);
        radii.rotate_left(first.index);
        turns.iter_mut().for_each(|turn| turn.index -= first.index);
        turns.rotate_left(1);
        turns.iter_mut().filter(|turn| turn.index == 0).for_each(|turn| turn.index = pixels.len() - 1);
    }
    let (mut sides, mut widths, mut start) = (Vec::new(), Vec::new(), 0);
    let mut before: Option<Turn> = turns.last().copied().filter(|_| branch.ring);
    for turn in turns.iter().copied().map(Some).chain((!branch.ring).then_some(None)) {
        let end = turn.map_or(pixels.len(), |turn| turn.index + 1);
        let away = |p: &Point, turn: Option<Turn>, fork: usize| {
            turn.is_none_or(|turn| p.distance(pixels[fork]) > turn.reach)
        };
        let clear = |k: &usize| away(&pixels[*k], before, start) && away(&pixels[*k], turn, end - 1);
        let (side, wide): (Vec<Point>, Vec<f64>) =
            (start..end).filter(clear).map(|k| (pixels[k], radii[k])).unzip();
        let (side, width) = match side.is_empty() {
            true => (side, 2.0 * radius),
            false => centred(dark, (&side, &wide), radius, false, false),
        };
        sides.push(side);
        widths.push(width);
        (before, start) = (turn, end.min(pixels.len() - 1));
    }
    let mut points = Vec::new();
    for (k, side) in sides.iter().enumerate() {
        points.extend(side);
        if let Some(turn) = turns.get(k) {
            points.extend(round(dark, side, *turn, &sides[(k + 1) % sides.len()]));
        }
    }
    (filled_in(&points, branch.ring), median(&widths))
}

/// The way round a turn from one side to the next: over the corner where they meet, if they do somewhere.
fn round(dark: &Plane<u8>, side: &[Point], turn: Turn, next: &[Point]) -> Vec<Point> {
    let corner = || Tip::of(side, 1)?.corner(&Tip::of(next, 0)?, dark, &[]);
    let TurnTip { at, corner_px, .. } = turn.tip;
    corner().filter(|way| way.iter().any(|p| p.distance(at) < corner_px)).unwrap_or_else(|| vec![at])
}

/// With points about 1 px apart between those that are further apart than a few.
fn filled_in(points: &[Point], ring: bool) -> Vec<Point> {
    const APART_PX: f64 = 1.5;
    parted(points, ring, |far| if far > APART_PX { far.round() as usize } else { 1 })
}

/// With the way from each point to the next in so many equal steps as `steps` says of its length, px.
pub(crate) fn parted(points: &[Point], ring: bool, steps: impl Fn(f64) -> usize) -> Vec<Point> {
    let mut found = Vec::with_capacity(points.len());
    for (k, &point) in points.iter().enumerate() {
        found.push(point);
        let next = if ring { points.get((k + 1) % points.len()) } else { points.get(k + 1) };
        if let Some(next) = next {
            let steps = steps(next.distance(point));
            found.extend((1..steps).map(|i| point.lerp(*next, i as f64 / steps as f64)));
        }
    }
    found
}

/// The stretches in one row, the gaps between them bridged. The line's pixels are known each with half the width of its ink.
fn bridged(dark: &Plane<u8>, ridge: &Ridge, pixels: &[(Point, f64)], ring: bool) -> Vec<Point> {
    let mut row: Vec<Point> = Vec::new();
    let mut last = 0;
    for stretch in &ridge.stretches {
        row.extend(gap(dark, &row, &stretch.points, &pixels[last..stretch.from[0]]));
        row.extend(&stretch.points);
        last = stretch.from[1];
    }
    if let (true, Some(first)) = (ring, ridge.stretches.first()) {
        // a ring that can be seen all round needs no bridge to its own start
        let open = row.last().is_some_and(|last| last.distance(first.points[0]) > ridge.gap);
        let round = [&pixels[last..], &pixels[..first.from[0]]].concat();
        row.extend(if open { gap(dark, &row, &first.points, &round) } else { Vec::new() });
    }
    row
}

/// Points between the end of one row and the start of another: a corner, or a smooth curve in the middle of the ink between them; else
/// as the pixels lead.
fn gap(dark: &Plane<u8>, before: &[Point], after: &[Point], between: &[(Point, f64)]) -> Vec<Point> {
    let (Some(end), Some(start)) = (Tip::of(before, 1), Tip::of(after, 0)) else { return Vec::new() };
    end.corner(&start, dark, &[]).unwrap_or_else(|| {
        let way = end.smoothly_to(&start);
        let is_near = |p: Point, (at, radius): (Point, f64)| p.distance(at) <= INSIDE * radius + INSIDE_PX;
        let is_inside = |&p: &Point| between.iter().any(|&pixel| is_near(p, pixel));
        let is_followed = |&pixel: &(Point, f64)| way.iter().any(|&p| is_near(p, pixel));
        match way.iter().all(is_inside) && between.iter().all(is_followed) {
            true => way,
            false => off_the_grid(&between.iter().map(|(at, _)| *at).collect::<Vec<_>>()).collect(),
        }
    })
}

/// A way in the middle of the ink is nowhere further from its pixels than this share of its half width, and px.
const INSIDE: f64 = 0.4;
const INSIDE_PX: f64 = 1.0;

/// Points that tell the pen's width near an end.
const NEAR_END: usize = 40;

/// A line that is an even number of pixels wide has its skeleton beside its middle: half its width is up to so much less than that of
/// one with a pixel more.
const PARITY_PX: f64 = 1.0;

/// Ink that is equally wide over so many points runs into no junction.
const STEADY: usize = 8;

/// The points of a branch away from its nodes' discs of ink and from its free ends, as a range of indices.
fn trusted(graph: &Graph, branch: &Branch, radius: f64) -> (usize, usize) {
    let n = branch.points.len();
    let clear = |end: usize| {
        let index = |k: usize| if end == 0 { k } else { n - 1 - k };
        // the pen's half-width near this end: elsewhere on a long branch it may have been another
        let near = (4.0 * radius) as usize;
        let window: Vec<f64> = from_end(&branch.radii, end).skip(near).take(NEAR_END).copied().collect();
        let usual = if window.len() < NEAR_END { radius } else { median(&window).max(0.5) };
        let ok = |k: &usize| match branch.nodes[end] {
            None => branch.points[index(*k)].distance(branch.points[index(0)]) >= radius,
            Some(node) => {
                let node = graph.nodes[node];
                let away = branch.points[index(*k)].distance(node.at);
                let here = branch.radii[index(*k)];
                let steady = || (*k..n.min(k + STEADY)).all(|k| (branch.radii[index(k)] - here).abs() < 0.5);
                away > 1.1 * node.radius + 0.5
                    && (here <= 1.1 * usual + 0.3 || here <= usual + PARITY_PX && steady())
            }
        };
        // never more than 45 % from either end: something of a short branch must stay
        let most = n * 9 / 20;
        (0..most).find(ok).unwrap_or(most)
    };
    (clear(0), (n - clear(1)).max(clear(0) + 1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::graph::Node;

    /// From where on a branch of such radii, which leaves a node, is taken for a line.
    fn begins(radii: Vec<f64>) -> usize {
        let points = (1..=radii.len()).map(|k| Point::new(k as f64, 0.0)).collect();
        let branch = Branch { points, radii, nodes: [Some(0), None], ring: false, turns: Vec::new() };
        let node = Node { at: Point::new(0.0, 0.0), radius: 3.1, turn: None };
        let graph = Graph { nodes: vec![node], branches: vec![branch] };
        trusted(&graph, &graph.branches[0], 1.7).0
    }

    #[test]
    fn a_bent_branch_of_few_pixels_has_two_points_inside() {
        // a branch that leapt over a gap
        let points = [(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (2.0, 9.0), (8.0, 2.0), (9.0, 2.0), (10.0, 2.0)];
        let points: Vec<Point> = points.into_iter().map(Point::from).collect();
        assert!(is_bent(&points[1..6]) && is_bent(&points[1..5]));
        let branch = |points: &[Point]| Branch {
            points: points.to_vec(),
            radii: vec![1.5; points.len()],
            nodes: [Some(0), Some(0)],
            ring: false,
            turns: Vec::new(),
        };
        for few in 4..=points.len() {
            assert!(!inner(&branch(&points[..few])).is_empty(), "{few} pixels");
        }
    }

    #[test]
    fn a_line_a_pixel_wider_at_one_end_is_a_line_there_and_one_that_runs_into_another_is_none() {
        // five pixels wide up to a corner, four behind it
        let wider = [vec![2.5; 28], vec![1.7; 40]].concat();
        assert_eq!(begins(wider), 3);
        let runs_out = (0..68).map(|k| (3.1 - 0.08 * f64::from(k)).max(1.7)).collect();
        assert!(begins(runs_out) > 8);
    }
}
