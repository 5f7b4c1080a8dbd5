//! Classifies each branch of a skeleton as line or shape, by its own width.
//!
//! A line is long for its own width, and changes it slowly; a shape is wide where the way through it is short. Neither
//! needs a pen that is the same all over the picture: a brush swells, felt pen and pencil lie on one sheet.

use tracelight_image::Region;
use tracelight_stroke::polyline_length;

use crate::graph::{Branch, Graph};

/// A line is at least this many of its own widths long, away from the ink of its junctions.
const LONG: f64 = 3.0;
/// And round a hole as many: round one as wide as 1.6 of its widths. What goes round a smaller one is a shape with a hole.
const LONG_ROUND: f64 = 8.0;
/// A line's width changes by less than this over its length: a brush that lifts off over five of its widths changes it by
/// 0.2, the medial axis into a corner of 60° by 1, into a star's tip of 30° by 0.5, into a disc by 2.
const STEADY: f64 = 0.5;
/// Widths are compared over so many points either way at least: between pixels they jump.
const LEAST_REACH: usize = 4;
/// Places in a row where the width changes, that a line bears: its edge is rough there.
const ROUGH: usize = 3;

/// Of a pen's line four fifths are this much wider than one fifth at most, as a share of its width.
const EVEN: f64 = 0.25;

/// And a shape's stick is as wide at both ends, within this share and so many px.
const NARROWS: f64 = 0.1;
const NARROWS_PX: f64 = 0.8;
/// Where a stick meets its shape the ink is this much wider within so many widths.
const SUDDENLY: f64 = 1.8;
const SUDDEN_WITHIN: f64 = 1.5;
/// There its width grows by this over its length somewhere: into a disc by up to 2, along a horse's leg by 0.6.
const OPENS: f64 = 1.0;

/// A stretch of a branch, away from the ink of its nodes, over which the width changes slowly.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Reach {
    /// Its length, px.
    pub(crate) length: f64,
    /// Its median width, px.
    pub(crate) width: f64,
    /// Whether it is about as wide all along and much wider, or at an end, right behind its ends: a shape's stick. A
    /// horse's leg grows wider slowly.
    stick: bool,
    /// Whether it goes round.
    ring: bool,
}

impl Reach {
    /// Those of a branch.
    fn all(graph: &Graph, branch: &Branch) -> Vec<Self> {
        let steady: Vec<usize> = clear(graph, branch).filter(|&i| is_steady(branch, i)).collect();
        let loops = branch.nodes[0].is_some() && branch.nodes[0] == branch.nodes[1];
        let whole = steady.len() + ROUGH > branch.points.len();
        let ring = loops || (branch.ring && whole);
        let of = |run: &[usize]| {
            let (first, last) = (run[0], run[run.len() - 1]);
            let radii = sorted(&branch.radii[first..=last]);
            let at = |share: usize| 2.0 * radii[radii.len() * share / 100];
            let length = polyline_length(&branch.points[first..=last]);
            // distances to pixels go in steps of up to a pixel where they are small
            let even = at(80) - at(20) <= (EVEN * at(50)).max(2.1);
            let stick = even
                && !narrows(&branch.radii[first..=last])
                && ends_suddenly(graph, branch, (first, last), at(50));
            Self { length, width: at(50), stick, ring }
        };
        steady.chunk_by(|a, b| b - a <= ROUGH).map(of).collect()
    }

    /// Whether this is a line, whatever the pen of others.
    fn is_line(&self) -> bool {
        let long = if self.ring { LONG_ROUND } else { LONG };
        self.length >= long * self.width
    }
}

/// Whether the width is less at one end than at the other, by more than pixels make of it: limbs taper.
fn narrows(radii: &[f64]) -> bool {
    let third = (radii.len() / 3).max(1);
    let width = |radii: &[f64]| 2.0 * radii.iter().sum::<f64>() / radii.len() as f64;
    let (first, last) = (width(&radii[..third]), width(&radii[radii.len() - third..]));
    (first - last).abs() > (NARROWS * 0.5 * (first + last)).max(NARROWS_PX)
}

/// Whether, where a stretch of a branch ends, the branch ends or opens at once into what is much wider.
fn ends_suddenly(graph: &Graph, branch: &Branch, (first, last): (usize, usize), width: f64) -> bool {
    let beyond = LEAST_REACH + (SUDDEN_WITHIN * width).ceil() as usize;
    let suddenly = |end: usize, there: Option<usize>| {
        let (from, to) = match end {
            0 => (there.unwrap_or(0), first),
            _ => (last, there.unwrap_or(branch.points.len() - 1)),
        };
        let radius = match (there, branch.nodes[end]) {
            (Some(i), _) => branch.radii[i],
            (None, Some(node)) => graph.nodes[node].radius,
            (None, None) => return true,
        };
        2.0 * radius >= SUDDENLY * width && (from..=to).any(|i| slope(branch, i) >= OPENS)
    };
    let after = Some(last + beyond).filter(|&i| i < branch.points.len());
    suddenly(0, first.checked_sub(beyond)) && suddenly(1, after)
}

/// The points of a branch away from the ink of its nodes, by number.
fn clear<'a>(graph: &'a Graph, branch: &'a Branch) -> impl Iterator<Item = usize> + 'a {
    let clear = |i: &usize| {
        let at = branch.points[*i];
        branch.nodes.iter().flatten().all(|&n| at.distance(graph.nodes[n].at) > graph.nodes[n].radius)
    };
    (0..branch.points.len()).filter(clear)
}

/// Whether a branch's width changes slowly about one of its points.
fn is_steady(branch: &Branch, i: usize) -> bool {
    slope(branch, i) <= STEADY
}

/// Whether the width of all branches changes quickly over most of their length, as along the middle of a triangle.
fn tapers_all_along(graph: &Graph) -> bool {
    let mut counts = [0, 0];
    for branch in &graph.branches {
        clear(graph, branch).for_each(|i| counts[usize::from(is_steady(branch, i))] += 1);
    }
    counts[1] < counts[0]
}

/// By how much a branch's width changes about one of its points, over the length there.
fn slope(branch: &Branch, i: usize) -> f64 {
    let reach = LEAST_REACH.max(branch.radii[i] as usize);
    let (from, to) = (i.saturating_sub(reach), (i + reach).min(branch.points.len() - 1));
    let length = (to - from).max(1) as f64;
    2.0 * (branch.radii[to] - branch.radii[from]).abs() / length
}

/// What hangs on a shape as its stick is narrower than it by this.
const STICK: f64 = 2.5;
/// Its sticks are so many times as long as all that is as narrow and no stick.
const LIMBS: f64 = 2.0;
/// No limb is so many times as long as wide.
const PEN_LONG: f64 = 20.0;

/// Ratio of total line length to largest width from which ink counts as drawn.
const MANY_WIDTHS: f64 = 10.0;
/// Ratio of skeleton length to mean width from which ink counts as drawn, with the largest ratio of widest to mean width. The
/// shorter the ink, the more even it must be: a brush stroke, or a letter by a felt pen.
const DRAWN: [(f64, f64); 2] = [(LONG_LINE, 1.8), (3.5, 1.4)];
/// What is so many times as long as wide is a line for sure.
pub(crate) const LONG_LINE: f64 = 8.0;

/// What is narrower in the mean, px, has too few pixels across to tell its widths apart. Broader ink was drawn if its lines hold so
/// much of it; by the second rule most of it, and what is short is about as wide all along: a body has legs, a bottle a neck. What is
/// long, and as wide all along as one line, is a pen's, however much of it is of short ones; and all of it, where it is as long as a grid.
const BROAD_PX: f64 = 10.0;
const HALF: f64 = 0.5;
const MOSTLY: f64 = 0.7;
const PARTLY: f64 = 0.15;
const NETWORK: f64 = 24.0;
const EVENLY: f64 = 0.45;

/// Whether four fifths of the ink are wider than one fifth by this share at most.
fn is_even_all_along(graph: &Graph, share: f64) -> bool {
    let at = |share| graph.radius_under(share);
    at(80) - at(20) <= share * at(50)
}

/// What the branches of a patch are together.
#[derive(Clone, Debug, Default)]
pub(crate) struct Reading {
    /// The lines among them, from the narrowest.
    pub(crate) lines: Vec<Reach>,
    /// Twice the largest distance to paper, px.
    pub(crate) widest: f64,
    /// How many times as long its skeleton is as the ink is wide in the mean.
    pub(crate) long: f64,
    /// The width that three quarters of its skeleton are under, px.
    pub(crate) usual: f64,
    /// Whether it has pixels enough across to tell its widths apart.
    pub(crate) is_broad: bool,
    /// Whether its lines together are far longer than it is wide: those of a pen, or of limbs.
    pub(crate) many_lines: bool,
    /// Whether it may be what one pen drew: it is narrow, or its lines hold most of it, and what is short is about as wide all along.
    pub(crate) is_even: bool,
    /// Whether its ink was drawn line by line, though some of it may be filled.
    pub(crate) is_drawn: bool,
    /// Whether it is short and swells towards its middle: a crescent.
    pub(crate) is_lens: bool,
}

impl Reading {
    /// Of a patch of so many pixels and its graph.
    pub(crate) fn of(graph: &Graph, area: usize) -> Self {
        let (widest, usual) = (2.0 * graph.widest(), 2.0 * graph.radius_under(75));
        let length = graph.length();
        let mean_width = area as f64 / length.max(1.0);
        let (long, bulky) = (length / mean_width, widest / mean_width);
        let is_broad = mean_width >= BROAD_PX;
        let reaches = graph.branches.iter().flat_map(|branch| Reach::all(graph, branch));
        let mut lines: Vec<Reach> = reaches.filter(Reach::is_line).collect();
        let is_lens = is_lens(graph, lines.iter().any(|line| line.stick));
        if is_lens || is_blob(graph) {
            return Self { widest, long, usual, is_broad, is_even: true, is_lens, ..Self::default() };
        }
        lines.sort_by(|a, b| a.width.total_cmp(&b.width));
        let together: f64 = lines.iter().map(|line| line.length).sum();
        // the share of the ink that the lines hold
        let inked = lines.iter().map(|line| line.length * line.width).sum::<f64>() / area as f64;
        let is_long = long >= LONG_LINE;
        let is_held = inked >= MOSTLY && (is_long || is_even_all_along(graph, EVENLY));
        // a grid and an arrow's head are of short lines
        let is_network = long >= NETWORK || is_long && inked >= PARTLY;
        let is_penned = is_network && is_even_all_along(graph, EVEN);
        let is_even = !is_broad || is_held || is_penned;
        let many_lines = together >= MANY_WIDTHS * widest;
        let is_drawn = many_lines && (!is_broad || inked >= HALF)
            || DRAWN.iter().any(|&(least, most)| long >= least && bulky <= most)
                && !tapers_all_along(graph)
                && is_even;
        Self { lines, widest, long, usual, is_broad, many_lines, is_even, is_drawn, is_lens }
    }

    /// The usual width of its lines, px; 0 of none.
    pub(crate) fn pen(&self) -> f64 {
        pen_of(&self.lines)
    }

    /// The width of its thicker lines: what nine tenths of the lines' length are under, or three quarters of all, px.
    pub(crate) fn wide_pen(&self) -> f64 {
        width_under(&self.lines, 0.9, |line| line.length).max(self.usual)
    }

    /// The usual width of the sticks of a shape: lines that are even, or so long that a pen drew them, and narrow beside it. `None` if
    /// it has as many other narrow lines: limbs.
    pub(crate) fn stick_pen(&self) -> Option<f64> {
        let narrow = self.lines.iter().filter(|line| line.width * STICK < self.widest);
        let is_stick = |line: &Reach| line.stick || line.length >= PEN_LONG * line.width;
        let (sticks, limbs): (Vec<Reach>, Vec<Reach>) = narrow.partition(|line| is_stick(line));
        let length = |lines: &[Reach]| lines.iter().map(|line| line.length).sum::<f64>();
        (length(&sticks) > LIMBS * length(&limbs)).then(|| pen_of(&sticks))
    }
}

/// A patch of ink with its skeleton and what that says of it.
pub(crate) struct Patch {
    pub(crate) region: Region,
    pub(crate) graph: Graph,
    pub(crate) reading: Reading,
}

impl Patch {
    pub(crate) fn new((region, graph): (Region, Graph)) -> Self {
        let reading = Reading::of(&graph, region.area());
        Self { region, graph, reading }
    }
}

/// A crescent, an oval, a drop: one way through, less than so many times as long as it is wide. Its last quarters are at most this share
/// as wide in the mean as its middle half, and where they begin it is half as wide as anywhere: a pen's dash is as wide all along, a
/// brush's stroke longer, a disc with sticks suddenly narrow. A drop is shorter, half as wide at one end as at the other, and has no
/// stick.
const LENS_LONG: f64 = 6.5;
const LENS_TAPERS: f64 = 0.78;
const LENS_HALFWAY: f64 = 0.45;
const DROP_LONG: f64 = 3.5;
const DROP_TAPERS: f64 = 0.5;
/// And so much narrower that it is no pixel's doing, px.
const LENS_PX: f64 = 0.3;

fn is_lens(graph: &Graph, has_stick: bool) -> bool {
    let [branch] = &graph.branches[..] else { return false };
    let (radii, count) = (&branch.radii, branch.radii.len());
    let quarter = count / 4;
    if quarter == 0 || branch.ring {
        return false;
    }
    let mean = |from: usize, to: usize| radii[from..to].iter().sum::<f64>() / (to - from) as f64;
    let (first, middle, last) =
        (mean(0, quarter), mean(quarter, count - quarter), mean(count - quarter, count));
    let long = branch.length() / (2.0 * graph.widest());
    let (narrow, wide) = (first.min(last), first.max(last));
    let halfway = radii[quarter].min(radii[count - 1 - quarter]);
    let is_pointed = wide <= LENS_TAPERS * middle - LENS_PX && halfway >= LENS_HALFWAY * graph.widest();
    let is_drop = !has_stick && long < DROP_LONG && narrow <= DROP_TAPERS * wide - LENS_PX;
    is_drop || long < LENS_LONG && is_pointed
}

fn sorted(values: &[f64]) -> Vec<f64> {
    let mut values = values.to_vec();
    values.sort_unstable_by(f64::total_cmp);
    values
}

/// The usual width of lines that are sorted by width, px; 0 of none. Each counts as often as it is wide into its length:
/// a way round a hole may be longer than the one line beside it, and is hardly longer than wide.
pub(crate) fn pen_of(lines: &[Reach]) -> f64 {
    width_under(lines, 0.5, |line| line.length / line.width.max(1.0))
}

/// The width that this share of the weight of these lines, sorted by width, is under, px; 0 of none.
fn width_under(lines: &[Reach], share: f64, weight: impl Fn(&Reach) -> f64) -> f64 {
    let wanted = share * lines.iter().map(&weight).sum::<f64>();
    let mut passed = 0.0;
    let found = lines.iter().find(|line| {
        passed += weight(line);
        passed >= wanted
    });
    found.map_or(0.0, |line| line.width)
}

/// Whether ink is hardly longer than wide, or goes round holes that are smaller than it is wide.
fn is_blob(graph: &Graph) -> bool {
    let width = |share| 2.0 * graph.radius_under(share);
    let least = match graph.rounds() {
        0 => return false,
        // squares whose holes are as wide as their sides; of more, each shares two of its sides with others
        rounds @ 1..=2 => LONG_ROUND * rounds as f64 * width(75),
        rounds => 4.0 * (rounds + 1) as f64 * width(50),
    };
    graph.length() < least
}

#[cfg(test)]
mod tests {
    use super::*;
    use tracelight_stroke::Point;

    /// What a branch of such half widths, a pixel apart, is by itself.
    fn of(radii: Vec<f64>) -> Reading {
        let points: Vec<Point> = (0..radii.len()).map(|k| Point::new(k as f64, 0.0)).collect();
        let area = radii.iter().map(|r| 2.0 * r).sum::<f64>() as usize;
        let branch = Branch { points, radii, nodes: [None; 2], ring: false, turns: Vec::new() };
        Reading::of(&Graph { nodes: Vec::new(), branches: vec![branch] }, area)
    }

    #[test]
    fn a_brushs_stroke_is_drawn_however_it_swells_and_tapers() {
        let swelling = (0..120).map(|k| 1.0 + 4.0 * (f64::from(k) / 120.0 * std::f64::consts::PI).sin());
        let reading = of(swelling.collect());
        assert!(reading.is_drawn && reading.lines.len() == 1, "{reading:?}");
    }

    #[test]
    fn a_fat_pens_short_stroke_is_drawn_and_a_disc_is_not() {
        assert!(of(vec![8.0; 60]).is_drawn);
        let disc = (0..40).map(|k| (20.0 * f64::from(k + 1)).min(40.0 - f64::from(k)).max(1.0));
        assert!(!of(disc.collect()).is_drawn);
    }

    #[test]
    fn a_lollipops_stick_is_a_line_and_its_disc_is_none() {
        let disc = (0..20).map(|k| 20.0 - (f64::from(k) - 10.0).abs().min(19.0) + 1.0);
        let reading = of(disc.chain(std::iter::repeat_n(2.0, 60)).collect());
        assert_eq!(reading.lines.len(), 1);
        assert!((reading.stick_pen().unwrap() - 4.0).abs() < 0.1 && !reading.is_drawn, "{reading:?}");
    }

    #[test]
    fn a_leg_that_grows_wider_slowly_is_no_stick() {
        let leg = (0..60).map(|_| 3.0).chain((0..60).map(|k| 3.0 + 0.2 * f64::from(k)));
        assert_eq!(of(leg.chain(std::iter::repeat_n(15.0, 20)).collect()).stick_pen(), None);
    }
}
