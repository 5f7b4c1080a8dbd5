//! Decides between dark lines on light paper and light ones on dark.

use tracelight_image::Plane;
use tracelight_image::levels::percentile;
use tracelight_image::median::median;
use tracelight_image::smooth::noise;
use tracelight_sheet::TwoTones;

/// A fall and a rise of brightness count from this share of the picture's range on.
const STEP: f64 = 0.22;
/// Less than this share of the pixels may be dust, and does not count in the range; unless that leaves less than so many
/// levels: then there is hardly any ink, and only less than [`SPECK`] of them is left out.
const DUST: f64 = 0.0005;
const LEAST_RANGE: f64 = 32.0;
const SPECK: f64 = 0.000_05;
/// And from this many times the noise's deviation on: along a row of thousands of pixels it spans eight.
const NOISE: f64 = 9.0;
/// Lines are thinner than this share of the picture's shorter side.
const THIN: usize = 30;
/// About so many pixels are looked at along rows, and as many along columns.
const SAMPLED: usize = 130_000;
/// So many more thin runs of one kind are no chance.
const SURE: i64 = 8;
/// Nor is this share more: side by side, n dark lines have n − 1 light gaps between them.
const SURE_SHARE: f64 = 0.04;

/// A row through a line falls and rises once. With fewer thin runs than this share of the turns the picture is one of
/// shapes, and its thin places are gaps as well as lines.
const SHAPES: i64 = 6;
/// No drawing's ink is a larger share of its picture, and of its border.
const MOST_INK: f64 = 0.6;
const INK_BORDER: f64 = 0.8;
/// In a picture of two tones, what this share of the border is, is its paper.
const BORDER: f64 = 0.9;
/// Where this share of the border is light it is paper, of which the rest may lie in a shadow.
const LIT: f64 = 0.3;
/// The border is looked at so many times as far inside as a line is wide: on one of these places there may be a frame.
const INSIDE: [usize; 3] = [0, 1, 2];

/// Whether the picture's lines are lighter than what they are drawn on.
///
/// Along rows and columns, what is thin and darker than both its neighbours is counted against what is thin and
/// lighter: lines are thin, and there is one more of them than of the gaps between. The edges of shapes, of shadows and
/// of the paper itself are neither. Where that says nothing, the picture is paper along its border, inside of what may be
/// a line there, of which most may lie in a shadow; of one of two tones always, if it is nearly all the same there. What is known to be
/// light paper is that.
pub(crate) fn is_light_on_dark(image: &Plane<u8>, levels: &[u32; 256], is_light_paper: bool) -> bool {
    let thin = (image.width.min(image.height) / THIN).max(4);
    // the share of the border so many times as far inside as a line is wide that is light
    let border = |times: usize, is_light: &dyn Fn(u8) -> bool| {
        let border = border_levels(image, times * thin);
        border.iter().filter(|&&level| is_light(level)).count() as f64 / border.len() as f64
    };
    if let Some(tones) = TwoTones::of(levels) {
        let share = median(&INSIDE.map(|times| border(times, &|level| tones.is_bright(level))));
        if share.max(1.0 - share) >= BORDER {
            return share < 0.5;
        }
    }
    let range = |share: f64| (percentile(levels, share), percentile(levels, 1.0 - share));
    let (low, high) = match range(DUST) {
        (low, high) if high - low < LEAST_RANGE => range(SPECK),
        range => range,
    };
    let least = NOISE * noise(image, SAMPLED / 2);
    let runs = Runs::of(image, thin, (STEP * (high - low)).max(least).clamp(2.0, 255.0) as u8);
    // light multiplies: a shadow on paper is nearer to its brightest than to its ink as a ratio
    let middle = (low.max(10.0) * high).sqrt();
    let light_border = border(1, &|level| f64::from(level.max(10)) >= middle);
    if !runs.are_sure() {
        // a shadow may lie on most of the paper, a dark board has no light border
        return light_border < LIT && !is_light_paper;
    }
    let light_ink = runs.light > runs.dark;
    let all: u32 = levels.iter().sum();
    let above: u32 = levels[middle as usize + 1..].iter().sum();
    let light = f64::from(above) / f64::from(all.max(1));
    let ink = |light: f64| if light_ink { light } else { 1.0 - light };
    // nothing but shapes, whose holes are thin: what is ink then would be most of the picture, its border too
    let contradicted = ink(light_border) > INK_BORDER && ink(light) > MOST_INK;
    light_ink != contradicted
}

/// Thin runs between two of the other kind, without single pixels, which are specks.
#[derive(Default)]
struct Runs {
    dark: i64,
    light: i64,
    /// Sharp falls and rises of the level.
    turns: i64,
}

impl Runs {
    fn of(image: &Plane<u8>, thin: usize, step: u8) -> Self {
        let mut runs = Self::default();
        let every = (image.values.len() / SAMPLED).max(1);
        for y in ((every / 2).min(image.height / 2)..image.height).step_by(every) {
            runs.along(image.row(y), step, thin);
        }
        let mut column = Vec::with_capacity(image.height);
        for x in ((every / 2).min(image.width / 2)..image.width).step_by(every) {
            column.clear();
            column.extend(image.values[x..].iter().step_by(image.width));
            runs.along(&column, step, thin);
        }
        runs
    }

    /// Follows a row from extreme to extreme: one is left behind when the level has moved away from it by `step`. What
    /// took longer than a line is thin is the light that changes, no edge.
    fn along(&mut self, levels: &[u8], step: u8, thin: usize) {
        let Some(&first) = levels.first() else { return };
        let mut way = Way { least: (first, 0), most: (first, 0), fell: None, rose: None, falling: None };
        for (block, levels) in levels.chunks(EVEN).enumerate() {
            let lowest = levels.iter().fold(255, |a, &b| a.min(b));
            let highest = levels.iter().fold(0, |a, &b| a.max(b));
            if way.turns_within(lowest, highest, step) {
                for (k, &level) in levels.iter().enumerate() {
                    self.follow(&mut way, block * EVEN + k, level, step, thin);
                }
            } else {
                way.pass(block * EVEN, levels, lowest, highest);
            }
        }
    }

    /// One level further.
    fn follow(&mut self, way: &mut Way, at: usize, level: u8, step: u8, thin: usize) {
        way.least = if level <= way.least.0 { (level, at) } else { way.least };
        way.most = if level >= way.most.0 { (level, at) } else { way.most };
        let is_thin = |start: Option<usize>| i64::from(start.is_some_and(|s| (2..=thin).contains(&(at - s))));
        if way.falling != Some(true) && way.most.0 - level >= step {
            self.light += is_thin(way.rose);
            self.turns += i64::from(at - way.most.1 <= thin);
            (way.falling, way.fell, way.least) = (Some(true), Some(at), (level, at));
        } else if way.falling != Some(false) && level - way.least.0 >= step {
            self.dark += is_thin(way.fell);
            self.turns += i64::from(at - way.least.1 <= thin);
            (way.falling, way.rose, way.most) = (Some(false), Some(at), (level, at));
        }
    }

    fn are_sure(&self) -> bool {
        let (more, all) = ((self.dark - self.light).abs(), self.dark + self.light);
        more >= SURE && more as f64 >= SURE_SHARE * all as f64 && all >= self.turns / SHAPES
    }
}

/// Levels that are looked at together: most of them are even paper.
const EVEN: usize = 32;

/// What is known on the way along a row.
struct Way {
    /// Level and place of the extremes since the last turn.
    least: (u8, usize),
    most: (u8, usize),
    /// Where the level last fell away from a peak and rose from a hollow.
    fell: Option<usize>,
    rose: Option<usize>,
    falling: Option<bool>,
}

impl Way {
    /// Whether levels from lowest to highest may turn the way, in whatever order they come.
    fn turns_within(&self, lowest: u8, highest: u8, step: u8) -> bool {
        let falls = self.falling != Some(true) && self.most.0.max(highest) - lowest >= step;
        let rises = self.falling != Some(false) && highest - self.least.0.min(lowest) >= step;
        falls || rises
    }

    /// Goes on over levels that do not turn it, the first of them at place `from`.
    fn pass(&mut self, from: usize, levels: &[u8], lowest: u8, highest: u8) {
        let last = |sought: u8| from + levels.iter().rposition(|&level| level == sought).unwrap_or(0);
        if lowest <= self.least.0 {
            self.least = (lowest, last(lowest));
        }
        if highest >= self.most.0 {
            self.most = (highest, last(highest));
        }
    }
}

/// The pixels so far inside the border: a line along it is thinner.
fn border_levels(image: &Plane<u8>, inside: usize) -> Vec<u8> {
    let inside = inside.min((image.width.min(image.height) - 1) / 2);
    let (right, last) = (image.width - 1 - inside, image.height - 1 - inside);
    let ends = [inside, last].map(|y| &image.row(y)[inside..=right]);
    let sides = (inside..=last).flat_map(|y| [image.row(y)[inside], image.row(y)[right]]);
    ends.into_iter().flatten().copied().chain(sides).collect()
}

#[cfg(test)]
mod tests {
    use tracelight_image::levels::sampled_histogram;

    use super::*;

    fn check(light_on_dark: bool, level: impl Fn(usize, usize) -> u8) {
        let image = |invert: bool| {
            let value = |i: usize| {
                let v = level(i % 320, i / 320);
                if invert { 255 - v } else { v }
            };
            Plane { width: 320, height: 240, values: (0..320 * 240).map(value).collect() }
        };
        let found = |image: Plane<u8>| is_light_on_dark(&image, &sampled_histogram(&image), false);
        assert_eq!(found(image(false)), light_on_dark);
        assert_eq!(found(image(true)), !light_on_dark, "inverted");
    }

    #[test]
    fn lines_are_found_beside_larger_things() {
        let line = |x: usize, y: usize| y.abs_diff(100 + x / 4) < 2 && (20..300).contains(&x);
        check(false, |x, y| if line(x, y) { 40 } else { 230 });
        // half in a shadow whose edge is level
        check(false, |x, y| {
            if line(x, y) {
                20
            } else if y < 121 {
                125
            } else {
                240
            }
        });
        // paper on a dark table, of wood
        let paper = |x: usize, y: usize| (30..290).contains(&x) && (25..215).contains(&y);
        let table = |x: usize, y: usize| if paper(x, y) { 220 } else { 24 + 3 * (y / 8 % 5) as u8 };
        check(false, |x, y| if line(x, y) { 30 } else { table(x, y) });
        // dense lines, wider than their gaps
        check(
            false,
            |x, y| if (60..200).contains(&x) && (40..200).contains(&y) && x % 9 < 6 { 30 } else { 230 },
        );
    }

    #[test]
    fn a_short_line_is_not_lost_in_what_jpeg_leaves_about_it() {
        let line = |x: usize, y: usize| (150..165).contains(&x) && (120..122).contains(&y);
        let about = |x: usize, y: usize| (144..176).contains(&x) && (112..136).contains(&y) && x % 5 < 2;
        check(false, |x, y| if line(x, y) { 20 } else { 236 + 8 * u8::from(about(x, y)) });
    }

    #[test]
    fn paper_that_lies_in_a_hard_shadow_for_the_most_part_is_light() {
        let lit = |x: usize, y: usize| if x + y > 380 { 1.0 } else { 0.52 };
        let paper =
            |x: usize, y: usize, ink: f64| (lit(x, y) * 228.0 * ink) as u8 + ((x * 7 + y * 3) % 3) as u8;
        let line = |x: usize, y: usize| y.abs_diff(100 + x / 4) < 2;
        for ink in [20..300, 20..40] {
            let level =
                |x: usize, y: usize| paper(x, y, if line(x, y) && ink.contains(&x) { 0.62 } else { 1.0 });
            let values = (0..320 * 240).map(|i| level(i % 320, i / 320)).collect();
            let image = Plane { width: 320, height: 240, values };
            assert!(!is_light_on_dark(&image, &sampled_histogram(&image), false), "{ink:?}");
        }
    }

    #[test]
    fn holes_in_shapes_are_no_light_lines() {
        let round = |x: usize, y: usize, cx: f64, cy: f64, r: f64| (x as f64 - cx).hypot(y as f64 - cy) < r;
        let shape = |x, y| {
            [(70.0, 70.0), (220.0, 90.0), (140.0, 180.0)].into_iter().any(|(cx, cy)| {
                let holes = [(-9.0, -6.0), (9.0, -6.0), (-9.0, 6.0), (9.0, 6.0)];
                let hole = || holes.into_iter().any(|(dx, dy)| round(x, y, cx + dx, cy + dy, 3.5));
                round(x, y, cx, cy, 22.0) && !hole()
            })
        };
        check(false, |x, y| if shape(x, y) { 30 } else { 230 });
    }

    #[test]
    fn a_shape_alone_is_told_from_its_paper_by_the_border() {
        check(false, |x, y| if (x as f64 - 160.0).hypot(y as f64 - 120.0) < 100.0 { 30 } else { 230 });
    }
}
