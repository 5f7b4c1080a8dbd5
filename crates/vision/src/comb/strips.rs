//! Finds where thin dark lines cross narrow strips of a plane.

use tracelight_image::Plane;

use super::paper::Paper;

/// Strips beside those at the two borders.
const INNER: usize = 32;
/// Share of a rule's length that one strip averages over: at 5° a rule moves by a pixel and a half of 1280 within it.
const WIDTH: f64 = 1.0 / 80.0;
/// The outer strips begin this share of the length from the border: scanned sheets end as far inside, drawings further.
const INSET: f64 = 1.0 / 250.0;
/// Widest rule, as a share of the side across them and at least, px.
const WIDEST: f64 = 1.0 / 60.0;
const LEAST_WIDEST: usize = 5;
/// A ridge stands out by at least so many levels, and so many deviations of a strip's noise.
const LEAST_CONTRAST: f64 = 4.0;
const DEVIATIONS: f64 = 6.0;

/// Lines of one strip nearer than this are one, px.
const SAME_PX: f64 = 3.0;

/// A thin dark line where it crosses a strip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Peak {
    /// The middle, px across the rules, from the first pixel's centre.
    pub(super) at: f64,
    /// How much darker it is than what is on both sides, levels.
    pub(super) contrast: f64,
}

/// The thin lines of one strip, in order.
#[derive(Clone, Debug)]
pub(super) struct Strip {
    /// Its middle, px along the rules, from the first pixel's centre.
    pub(super) at: f64,
    pub(super) peaks: Vec<Peak>,
    /// Where the sheet begins and ends, px across the rules; nowhere where the end is before the beginning.
    pub(super) sheet: (f64, f64),
}

impl Strip {
    /// Whether there is paper.
    pub(super) fn has(&self, across: f64) -> bool {
        self.sheet.0 <= across && across <= self.sheet.1
    }

    /// The line nearest to a place, at most `reach` px from it, among those for which this says so.
    pub(super) fn nearest(&self, across: f64, reach: f64, is_one: impl Fn(&Peak) -> bool) -> Option<Peak> {
        let off = |peak: &Peak| (peak.at - across).abs();
        let near = self.peaks.iter().filter(|peak| off(peak) <= reach && is_one(peak));
        near.min_by(|a, b| off(a).total_cmp(&off(b))).copied()
    }
}

/// Strips across rules of one direction; the first and the last lie at the borders.
#[derive(Clone, Debug)]
pub(super) struct Strips<'a> {
    /// Pixels along the rules.
    pub(super) length: usize,
    /// Pixels across them.
    pub(super) breadth: usize,
    /// Where the sheet is.
    pub(super) paper: Paper<'a>,
    pub(super) strips: Vec<Strip>,
}

impl<'a> Strips<'a> {
    /// Across level rules of a sheet. `noise` is a pixel's deviation, levels.
    pub(super) fn of_level(dark: &Plane<u8>, noise: f64, paper: Paper<'a>) -> Self {
        let ranges = ranges(dark.width);
        let mut sums = vec![vec![0.0_f32; dark.height]; ranges.len()];
        for (sums, &(from, to)) in sums.iter_mut().zip(&ranges) {
            for (y, sum) in sums.iter_mut().enumerate() {
                *sum = dark.row(y)[from..to].iter().map(|&v| u32::from(v)).sum::<u32>() as f32;
            }
        }
        Self::of(&sums, &ranges, (dark.width, dark.height), noise, paper)
    }

    /// Across upright rules.
    pub(super) fn of_upright(dark: &Plane<u8>, noise: f64, paper: Paper<'a>) -> Self {
        let ranges = ranges(dark.height);
        let sum = |&(from, to): &(usize, usize)| {
            let mut sum = vec![0_u16; dark.width];
            for y in from..to.min(from + MOST_SUMMED) {
                sum.iter_mut().zip(dark.row(y)).for_each(|(sum, &level)| *sum += u16::from(level));
            }
            sum.into_iter().map(f32::from).collect()
        };
        let sums: Vec<Vec<f32>> = ranges.iter().map(sum).collect();
        Self::of(&sums, &ranges, (dark.height, dark.width), noise, paper)
    }

    fn of(
        sums: &[Vec<f32>],
        ranges: &[(usize, usize)],
        (length, breadth): (usize, usize),
        noise: f64,
        paper: Paper<'a>,
    ) -> Self {
        let widest = ((WIDEST * breadth as f64) as usize).max(LEAST_WIDEST);
        let strip = |(sum, &(from, to)): (&Vec<f32>, &(usize, usize))| {
            let count = (to - from).min(MOST_SUMMED) as f64;
            let least = LEAST_CONTRAST.max(DEVIATIONS * noise / count.sqrt());
            let peaks = peaks(&ridges(sum, widest), least * count, 1.0 / count);
            // all of the strip is paper there
            let ((first, last), (other_first, other_last)) =
                (paper.across(from, breadth), paper.across(to - 1, breadth));
            let sheet = (first.max(other_first), last.min(other_last));
            Strip { at: 0.5 * (from + to - 1) as f64, peaks, sheet }
        };
        let strips = sums.iter().zip(ranges).map(strip).collect();
        Self { length, breadth, paper, strips }
    }

    /// With the lines that cross the same strips elsewhere, of two in one place the stronger: where rules were taken off, a line
    /// across them may be gone as well.
    pub(super) fn with(mut self, others: &Self) -> Self {
        for (strip, others) in self.strips.iter_mut().zip(&others.strips) {
            let mut all: Vec<Peak> = strip.peaks.iter().chain(&others.peaks).copied().collect();
            all.sort_unstable_by(|a, b| a.at.total_cmp(&b.at));
            strip.peaks.clear();
            for peak in all {
                match strip.peaks.last_mut() {
                    Some(last) if peak.at - last.at < SAME_PX => {
                        if peak.contrast > last.contrast {
                            *last = peak;
                        }
                    }
                    _ => strip.peaks.push(peak),
                }
            }
        }
        self
    }

    /// Without the lines for which this says so; by strip and place.
    pub(super) fn without(mut self, is_one: impl Fn(usize, f64) -> bool) -> Self {
        for (number, strip) in self.strips.iter_mut().enumerate() {
            strip.peaks.retain(|peak| !is_one(number, peak.at));
        }
        self
    }

    /// Whether most strips are crossed by at least so many lines.
    pub(super) fn are_crossed_by(&self, count: usize) -> bool {
        let crossed = self.strips.iter().filter(|strip| strip.peaks.len() >= count).count();
        2 * crossed > self.strips.len()
    }
}

/// As many levels of a byte have room in a sum of two.
const MOST_SUMMED: usize = 256;

/// Of so many pixels along a rule how many are in one strip.
pub(super) fn wide(length: usize) -> usize {
    ((WIDTH * length as f64) as usize).clamp(3, MOST_SUMMED)
}

/// From where to where each strip reaches.
fn ranges(length: usize) -> Vec<(usize, usize)> {
    let wide = wide(length);
    let inset = (INSET * length as f64) as usize;
    let inner = |k: usize| ((2 * k + 1) * length / (2 * INNER)).saturating_sub(wide / 2).min(length - wide);
    let from = std::iter::once(inset).chain((0..INNER).map(inner)).chain([length - inset - wide]);
    from.map(|from| (from, from + wide)).collect()
}

/// By how much each value is over the least ones up to `reach` before and behind it, whichever is more.
fn ridges(sums: &[f32], reach: usize) -> Vec<f32> {
    let beyond = std::iter::repeat_n(f32::MAX, reach);
    let least = least_of(beyond.clone().chain(sums.iter().copied()).chain(beyond).collect(), reach);
    let over = |(i, &sum): (usize, &f32)| (sum - least[i].max(least[i + reach + 1])).max(0.0);
    sums.iter().enumerate().map(over).collect()
}

/// The least of so many values from each on.
fn least_of(mut values: Vec<f32>, count: usize) -> Vec<f32> {
    let mut covered = 1;
    while covered < count {
        let step = covered.min(count - covered);
        // into new ones, many at once; the last few have nothing behind them
        let mut least: Vec<f32> =
            values.iter().zip(&values[step..]).map(|(&a, &b)| if b < a { b } else { a }).collect();
        least.extend_from_slice(&values[values.len() - step..]);
        values = least;
        covered += step;
    }
    values
}

/// Ridges of at least so much, their contrast scaled.
fn peaks(ridges: &[f32], least: f64, scale: f64) -> Vec<Peak> {
    let least = least as f32;
    let mut found = Vec::new();
    let mut from = 0;
    while let Some(start) = ridges[from..].iter().position(|&v| v >= least) {
        let start = from + start;
        let len = ridges[start..].iter().position(|&v| v < least).unwrap_or(ridges.len() - start);
        let run = &ridges[start..start + len];
        let highest = run.iter().copied().fold(0.0, f32::max);
        let (mut sum, mut moment) = (0.0, 0.0);
        for (k, &v) in run.iter().enumerate().filter(|(_, v)| **v >= 0.5 * highest) {
            (sum, moment) = (sum + f64::from(v), moment + f64::from(v) * (start + k) as f64);
        }
        found.push(Peak { at: moment / sum, contrast: scale * f64::from(highest) });
        from = start + len;
    }
    found
}
