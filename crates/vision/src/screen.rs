//! Detects pictures of a computer's screen.
//!
//! What programs show on a screen is panes, bars, buttons and fields: even to the last level, and parted exactly along rows and columns.
//! What they write comes again pixel by pixel. No hand draws like that, and no camera sees it.

use std::collections::HashMap;

use tracelight_image::levels::{percentile, sampled_blocks, sampled_histogram};
use tracelight_image::threshold::over;
use tracelight_image::{Grey, Plane, Region, Run, regions};

use crate::{VisionError, coarse};

/// So many tones with so much edge, shorter sides of the picture, are a screen's; of 270 icons and pictures that programs drew 3 % have
/// as much, of 230 drawings, plans and sketches none.
const TONES: usize = 4;
const LEAST_EDGE: f64 = 2.0;
/// So many kinds of letters that come again are a program's, if they are this share of the ink: half of it for each tone that is parted
/// from others besides paper and ink. Of 1130 made-up drawings and 230 real ones none has as much.
const KINDS: usize = 6;
const LEAST_WRITTEN: f64 = 0.12;

/// A screen shows so many patches of ink at least; pictures made of a few squares are drawings.
const LEAST_PATCHES: usize = 24;
/// So many of its pixels at least are of one level with their neighbours; of a camera's a few are. About so many are looked at.
const LEAST_EVEN: f64 = 0.4;
const SAMPLED: usize = 50_000;

/// An edge is as long as this share of the picture's shorter side, and so many pixels.
const SHORTEST: usize = 40;
const SHORTEST_PX: usize = 24;
/// Areas are even for so many rows, have so many levels between them, and so few rows in which one turns into the other.
const DEEP: usize = 3;
const APART: u8 = 3;
const BETWEEN: usize = 2;
/// An edge goes on as a curve where, so far behind its end, the same levels lie so far above and below it.
const AHEAD: usize = 12;
const BESIDE: usize = 4;
/// Levels nearer than this to each other are one tone; more of them are shades.
const ONE_TONE: u8 = 2;
/// A tone has so much edge, shorter sides of the picture.
const LEAST_OF_TONE: f64 = 0.05;

/// Letters are so high, px, and at most this share of the picture's shorter side or so many px; not wider than this for the highest, and
/// have so many pixels. They come again so many times.
const LOWEST: usize = 4;
const HIGHEST: usize = 20;
const HIGHEST_PX: usize = 40;
const WIDEST: f64 = 1.5;
const LEAST_PX: usize = 8;
const AGAIN: usize = 3;
/// Less than this share of the pixels are specks.
const SPECKS: f64 = 0.002;

/// Refuses what shows a screen; so many patches of ink are in it.
pub(crate) fn check(picture: &Grey, patches: usize) -> Result<(), VisionError> {
    let plane = picture.plane();
    // a picture so large that its pixels are averaged is no screen's
    if patches < LEAST_PATCHES || coarse::reduction(picture) > 1 || evenness(plane) < LEAST_EVEN {
        return Ok(());
    }
    let (tones, edge) = tones(plane);
    let told = |(kinds, written): (usize, f64)| VisionError::Screenshot {
        tones,
        kinds,
        written_percent: 100.0 * written,
    };
    if tones >= TONES && edge >= LEAST_EDGE {
        return Err(told((0, 0.0)));
    }
    let letters = repeated(plane);
    let least = LEAST_WRITTEN / (1 << tones.saturating_sub(1)) as f64;
    let is_written = letters.0 >= KINDS && letters.1 >= least;
    if is_written { Err(told(letters)) } else { Ok(()) }
}

/// Which share of the pixels are of their right neighbour's level.
fn evenness(plane: &Plane<u8>) -> f64 {
    let same = |levels: &[u8]| levels.windows(2).filter(|pair| pair[0] == pair[1]).count();
    let counted =
        sampled_blocks(plane, SAMPLED).map(|(.., levels)| (same(levels), levels.len().saturating_sub(1)));
    let (same, all) = counted.fold((0, 0), |sum, block| (sum.0 + block.0, sum.1 + block.1));
    same as f64 / all.max(1) as f64
}

/// How many different letters come again pixel by pixel, and which share of the ink they are: of what differs from the most frequent
/// level by more than half of the most.
fn repeated(plane: &Plane<u8>) -> (usize, f64) {
    let levels = sampled_histogram(plane);
    let paper = (0..=u8::MAX).max_by_key(|&level| levels[usize::from(level)]).unwrap_or(0);
    let mut darkness = plane.clone();
    darkness.values.iter_mut().for_each(|level| *level = level.abs_diff(paper));
    let most = percentile(&sampled_histogram(&darkness), 1.0 - SPECKS);
    let regions = regions(&over(&darkness, (0.5 * most) as u8));
    let highest = (plane.width.min(plane.height) / HIGHEST).max(HIGHEST_PX);
    let mut found: HashMap<Vec<Run>, usize> = HashMap::new();
    for letter in regions.iter().filter_map(|region| as_letter(region, highest)) {
        *found.entry(letter).or_default() += 1;
    }
    found.retain(|_, &mut times| times >= AGAIN);
    let area = |(runs, times): (&Vec<Run>, &usize)| times * runs.iter().map(Run::length).sum::<usize>();
    let written: usize = found.iter().map(area).sum();
    let ink: usize = regions.iter().map(Region::area).sum();
    (found.len(), written as f64 / ink.max(1) as f64)
}

/// Where a patch's pixels lie in its bounding box; `None` where it is too large or too small for a letter.
fn as_letter(region: &Region, highest: usize) -> Option<Vec<Run>> {
    // most regions of a picture of lines are far too large: no need to look at all of their runs
    let height = region.runs.last()?.y - region.runs.first()?.y + 1;
    if !(LOWEST..=highest).contains(&(height as usize)) {
        return None;
    }
    let (columns, rows) = region.bounds(0, (usize::MAX, usize::MAX))?;
    if columns.len() as f64 > WIDEST * highest as f64 || region.area() < LEAST_PX {
        return None;
    }
    Some(region.seen_from(columns.start, rows.start).runs)
}

/// How many tones of a picture are parted exactly along rows and columns, and how long their edges are, shorter sides of the picture.
fn tones(picture: &Plane<u8>) -> (usize, f64) {
    let side = picture.width.min(picture.height);
    let shortest = (side / SHORTEST).max(SHORTEST_PX);
    let mut edges = straight_edges(picture, shortest);
    edges.extend(straight_edges(&picture.transposed(), shortest));
    let mut along = [0; 256];
    for edge in &edges {
        edge.levels.iter().for_each(|&level| along[usize::from(level)] += edge.length);
    }
    let length: usize = edges.iter().map(|edge| edge.length).sum();
    (count_tones(&along, (LEAST_OF_TONE * side as f64) as usize), length as f64 / side as f64)
}

/// Groups of levels, none of them wider than a tone, with at least so much edge.
fn count_tones(along: &[usize; 256], least: usize) -> usize {
    let mut groups: Vec<(u8, u8, usize)> = Vec::new();
    for (level, &length) in (0..=u8::MAX).zip(along).filter(|(_, length)| **length > 0) {
        match groups.last_mut() {
            Some((_, last, sum)) if level - *last <= ONE_TONE => (*last, *sum) = (level, *sum + length),
            _ => groups.push((level, level, length)),
        }
    }
    groups.iter().filter(|(first, last, sum)| last - first <= ONE_TONE && *sum >= least).count()
}

/// A straight edge along a row, between two even areas.
struct Edge {
    /// Of the area above, and of the one below.
    levels: [u8; 2],
    /// Px.
    length: usize,
}

/// Pixels `from..to` of a row, all of this level.
#[derive(Clone, Copy)]
struct Even {
    from: usize,
    to: usize,
    level: u8,
}

impl Even {
    /// What two have in common, if it is long enough.
    fn common(self, other: Self, shortest: usize) -> Option<(usize, usize)> {
        let (from, to) = (self.from.max(other.from), self.to.min(other.to));
        (from + shortest <= to).then_some((from, to))
    }
}

/// The edges along rows that part two even areas and are not pieces of a curve or a slant.
fn straight_edges(plane: &Plane<u8>, shortest: usize) -> Vec<Edge> {
    let rows: Vec<Vec<Even>> = (0..plane.height).map(|y| even_runs(plane.row(y), shortest)).collect();
    let deep: Vec<Vec<Even>> = rows.windows(DEEP).map(|rows| in_all(rows, shortest)).collect();
    let mut edges = Vec::new();
    for between in 0..=BETWEEN {
        for (y, (above, below)) in deep.iter().zip(deep.iter().skip(DEEP + between)).enumerate() {
            for (a, b) in pairs(above, below) {
                let Some((from, to)) = a.common(b, shortest) else { continue };
                let border = Border { above: y + DEEP - 1, between, levels: [a.level, b.level] };
                if a.level.abs_diff(b.level) >= APART && border.is_straight(plane, from, to) {
                    edges.push(Edge { levels: border.levels, length: to - from });
                }
            }
        }
    }
    edges
}

/// What lies above and below each other in two rows.
fn pairs<'a>(above: &'a [Even], below: &'a [Even]) -> impl Iterator<Item = (Even, Even)> + 'a {
    above.iter().flat_map(move |&a| {
        let first = below.partition_point(|b| b.to <= a.from);
        below[first..].iter().take_while(move |b| b.from < a.to).map(move |&b| (a, b))
    })
}

/// What is even, and of one level, in each of some rows.
fn in_all(rows: &[Vec<Even>], shortest: usize) -> Vec<Even> {
    let (first, rest) = rows.split_first().map_or((Vec::new(), rows), |(first, rest)| (first.clone(), rest));
    rest.iter().fold(first, |kept, row| {
        let same = pairs(&kept, row).filter(|(a, b)| a.level == b.level);
        same.filter_map(|(a, b)| a.common(b, shortest).map(|(from, to)| Even { from, to, level: a.level }))
            .collect()
    })
}

/// The runs of one level in a row that are at least so long: each of them covers one of the pieces of half that length.
fn even_runs(row: &[u8], shortest: usize) -> Vec<Even> {
    let piece = shortest / 2;
    let mut runs: Vec<Even> = Vec::new();
    for start in (0..row.len()).step_by(piece) {
        let Some(levels) = row.get(start..start + piece) else { break };
        let done = runs.last().is_some_and(|run| start < run.to);
        if done || levels[1..] != levels[..piece - 1] {
            continue;
        }
        let level = levels[0];
        let from = start - row[..start].iter().rev().take_while(|&&v| v == level).count();
        let to = start + row[start..].iter().take_while(|&&v| v == level).count();
        if to - from >= shortest {
            runs.push(Even { from, to, level });
        }
    }
    runs
}

/// Where two even areas may meet.
struct Border {
    /// The last row of the upper one.
    above: usize,
    /// Rows between them.
    between: usize,
    /// The upper one's, and the lower one's.
    levels: [u8; 2],
}

impl Border {
    /// Whether they meet there, and it ends where one of them does: what goes on further up or down is a curve or a slant.
    fn is_straight(&self, plane: &Plane<u8>, from: usize, to: usize) -> bool {
        let [upper, lower] = self.levels;
        let below = self.above + self.between + 1;
        let at = |row: usize, x: usize| plane.row(row)[x];
        // the rows between are none of the areas': with fewer between them it is the same border
        let middle = usize::midpoint(from, to);
        let is_between =
            self.between == 0 || at(self.above + 1, middle) != upper && at(below - 1, middle) != lower;
        let is_near = |row: Option<usize>, x: usize, level: u8| {
            row.filter(|&row| row < plane.height).is_none_or(|row| at(row, x).abs_diff(level) <= 1)
        };
        let goes_on = |x: usize| {
            let is_same = at(self.above, x) == upper && at(below, x) == lower;
            !is_same
                && is_near(self.above.checked_sub(BESIDE), x, upper)
                && is_near(Some(below + BESIDE), x, lower)
        };
        let before = from.checked_sub(1 + AHEAD);
        let behind = Some(to + AHEAD).filter(|&x| x < plane.width);
        is_between && !before.into_iter().chain(behind).any(goes_on)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::options::{Mode, Options};
    use crate::trace;

    const SIZE: (usize, usize) = (640, 400);

    /// A picture of this paper with rectangles of these levels: left, top, width, height.
    fn panes(paper: u8, panes: &[([usize; 4], u8)]) -> Plane<u8> {
        let mut plane = Plane::filled(SIZE.0, SIZE.1, paper);
        for &([left, top, width, height], level) in panes {
            (top..top + height).for_each(|y| plane.row_mut(y)[left..left + width].fill(level));
        }
        plane
    }

    /// A bar, a column, a pane and a button.
    const WINDOW: [([usize; 4], u8); 4] = [
        ([0, 0, 640, 40], 60),
        ([0, 40, 160, 360], 230),
        ([200, 80, 400, 200], 245),
        ([480, 320, 120, 40], 120),
    ];

    /// Letters of two strokes each, of so many kinds, in lines from row `top` on: of the same pixels wherever they come again.
    fn write(plane: &mut Plane<u8>, kinds: usize, top: usize) {
        for (line, y) in (top..SIZE.1 - 20).step_by(20).enumerate() {
            for (n, x) in (12..SIZE.0 - 20).step_by(11).enumerate() {
                let kind = (n * 7 + line * 3) % kinds;
                (0..10).for_each(|dy| plane.row_mut(y + dy)[x..x + 2].fill(0));
                plane.row_mut(y + kind % 10)[x..x + 3 + kind / 5].fill(0);
            }
        }
    }

    fn told(plane: Plane<u8>, options: &Options) -> Result<(), VisionError> {
        trace(&Grey::of_part(plane), options).map(|_| ())
    }

    #[test]
    fn a_window_with_panes_and_names_is_a_screen_and_traced_only_by_force() {
        let options = Options::default();
        let window = || {
            let mut window = panes(255, &WINDOW);
            write(&mut window, 30, 360);
            window
        };
        let refused = told(window(), &options).unwrap_err();
        let VisionError::Screenshot { tones, kinds, .. } = refused else { panic!("{refused}") };
        assert_eq!((tones, kinds), (5, 0));
        assert!(refused.to_string().contains("--force"), "{refused}");
        assert!(told(window(), &Options { force: true, ..options }).is_ok());
        assert!(told(window(), &Options { mode: Mode::Outline, ..options }).is_ok());
        // a picture that is put together from a few squares is a drawing
        assert!(told(panes(255, &WINDOW), &options).is_ok());
    }

    #[test]
    fn a_page_of_type_is_a_screen_and_a_plan_with_some_of_it_is_none() {
        let mut page = panes(255, &[]);
        write(&mut page, 30, 20);
        let refused = told(page, &Options::default()).unwrap_err();
        assert!(matches!(refused, VisionError::Screenshot { kinds: 20.., .. }), "{refused}");
        // thick walls, a grey floor, and a line of letters
        let rooms = [
            ([40, 40, 560, 12], 0),
            ([40, 340, 560, 12], 0),
            ([40, 40, 12, 312], 0),
            ([588, 40, 12, 312], 0),
        ];
        let mut plan = panes(255, &[&[([52, 52, 300, 288], 200)], &rooms[..]].concat());
        write(&mut plan, 5, 360);
        assert_eq!(told(plan, &Options::default()), Ok(()));
    }

    #[test]
    fn tones_of_curves_slants_and_shades_are_not_counted() {
        let mut discs = Plane::filled(SIZE.0, SIZE.1, 255);
        let mut slants = discs.clone();
        let mut shades = discs.clone();
        for (y, x) in (0..SIZE.1).flat_map(|y| (0..SIZE.0).map(move |x| (y, x))) {
            let off = (x as f64 - 320.0).hypot(y as f64 - 200.0);
            discs.row_mut(y)[x] = [20, 60, 100, 140, 255][((off / 45.0) as usize).min(4)];
            slants.row_mut(y)[x] = [20, 60, 100, 140, 255][(y + x / 60) / 90 % 5];
            shades.row_mut(y)[x] = (100 + (y / 4) % 2 * 60 + y / 8) as u8;
        }
        assert_eq!([discs, slants, shades].map(|plane| tones(&plane).0), [0; 3]);
        // blurred by a camera they are none either
        let blurred = tracelight_image::smooth::smoothed(&panes(255, &WINDOW));
        assert!(tones(&blurred).0 >= TONES, "one row between two areas is still an edge");
        assert_eq!(
            tones(&tracelight_image::smooth::smoothed(&tracelight_image::smooth::smoothed(&blurred))).0,
            0
        );
    }

    #[test]
    fn a_run_is_found_wherever_it_begins() {
        for from in 0..30 {
            let mut row = [0, 9].repeat(50);
            row[from..from + 24].fill(7);
            let runs: Vec<_> = even_runs(&row, 24).iter().map(|run| (run.from, run.to, run.level)).collect();
            assert_eq!(runs, [(from, from + 24, 7)]);
        }
    }
}
