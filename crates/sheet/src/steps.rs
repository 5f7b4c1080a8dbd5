//! Steps of brightness along the rows of a picture whose lines are taken out.

use tracelight_image::Plane;

/// A step from paper to table is at least so many levels, and this share of the brighter side.
const LEAST_LEVELS: i16 = 10;
const LEAST_SHARE: f64 = 0.07;
/// It is none where by this share of it levels go on to rise, or to fall, to both sides.
const GOES_ON: f64 = 0.4;
/// The levels on either side of a step are taken so far from it, px.
const BESIDE: usize = 3;

/// A step in a row.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Step {
    /// Where, px from the row's beginning.
    pub(crate) at: f32,
    /// Whether it is brighter behind it.
    pub(crate) rises: bool,
}

/// Of each row the steps that are no sides of lines.
pub(crate) fn of_rows(plane: &Plane<u8>) -> Vec<Vec<Step>> {
    let mut row = vec![0; plane.width];
    (0..plane.height)
        .map(|y| {
            medians(plane.row(y), &mut row);
            of_row(&row)
        })
        .collect()
}

/// A picture without what is narrower than three pixels.
pub(crate) fn without_lines(plane: &Plane<u8>) -> Plane<u8> {
    let along = |plane: &Plane<u8>| {
        let mut out = plane.clone();
        (0..plane.height).for_each(|y| medians(plane.row(y), out.row_mut(y)));
        out
    };
    along(&along(plane).transposed()).transposed()
}

/// The medians of five pixels each; the two at either end are those of the five nearest.
fn medians(levels: &[u8], out: &mut [u8]) {
    let (Some(fives), Some(inner)) = (levels.len().checked_sub(4), out.get_mut(2..)) else {
        out.copy_from_slice(levels);
        return;
    };
    // side by side, so that many are done at once
    let [a, b, c, d, e] = [0, 1, 2, 3, 4].map(|k| &levels[k..k + fives]);
    for (k, out) in inner[..fives].iter_mut().enumerate() {
        *out = median([a[k], b[k], c[k], d[k], e[k]]);
    }
    let last = out.len() - 1;
    let (first, end) = (out[2], out[last - 2]);
    out[..2].fill(first);
    out[last - 1..].fill(end);
}

/// Of five, by exchanges.
fn median([a, b, c, d, e]: [u8; 5]) -> u8 {
    let sorted = |a: u8, b: u8| (a.min(b), a.max(b));
    let (a, b) = sorted(a, b);
    let (d, e) = sorted(d, e);
    // the least and the greatest of the pairs are not the median
    let (low, high) = (a.max(d), b.min(e));
    let (low, high) = sorted(low, high);
    low.max(high.min(c))
}

fn of_row(levels: &[u8]) -> Vec<Step> {
    let mut steps = Vec::new();
    let last = levels.len() - 1;
    let level = |i: usize| i16::from(levels[i.min(last)]);
    let across = |i: usize| level(i + BESIDE - 1) - level(i.saturating_sub(BESIDE));
    let mut i = 1;
    while i < levels.len() {
        // most of a row is even
        if i % EVEN == 1 && is_even(&levels[i.saturating_sub(BESIDE)..(i + EVEN + BESIDE).min(levels.len())])
        {
            i += EVEN;
            continue;
        }
        let step = across(i);
        let brighter = level(i + BESIDE - 1).max(level(i.saturating_sub(BESIDE)));
        // where light falls off it goes on to either side, as far as is seen
        let next = [i.checked_sub(2 * BESIDE), Some(i + 2 * BESIDE)];
        let on = next.into_iter().flatten().filter(|i| (BESIDE..=last + 1 - BESIDE).contains(i));
        let least = on.map(|i| across(i) * step.signum()).min().unwrap_or(0);
        let is_slope = least > (GOES_ON * f64::from(step.abs())) as i16;
        if step.abs() < LEAST_LEVELS.max((LEAST_SHARE * f64::from(brighter)) as i16) || is_slope {
            i += 1;
            continue;
        }
        // one step: as long as it goes on the same way, its middle weighed by what it rises from pixel to pixel
        let rises = step > 0;
        let from = i.saturating_sub(BESIDE);
        let goes_on = |to: usize| (across(to) > 0) == rises && across(to).abs() >= step.abs() / 2;
        let mut to = i;
        while to < levels.len() && goes_on(to) && to < i + 2 * BESIDE {
            to += 1;
        }
        let (mut sum, mut weight) = (0.0, 0.0);
        for k in from..(to + BESIDE).min(last) {
            let rise = f32::from((level(k + 1) - level(k)) * if rises { 1 } else { -1 }).max(0.0);
            (sum, weight) = (sum + rise * (k + 1) as f32, weight + rise);
        }
        if weight > 0.0 {
            steps.push(Step { at: sum / weight, rises });
        }
        i = to.max(i + 1);
    }
    steps
}

/// Pixels that are looked at together.
const EVEN: usize = 32;

/// Whether no two of some levels make a step.
fn is_even(levels: &[u8]) -> bool {
    let least = levels.iter().fold(255, |a, &b| a.min(b));
    let most = levels.iter().fold(0, |a, &b| a.max(b));
    i16::from(most - least) < LEAST_LEVELS
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn five_have_their_median() {
        for k in 0..3125_u32 {
            let five = [0, 1, 2, 3, 4].map(|i| (k / 5_u32.pow(i) % 5) as u8);
            let mut sorted = five;
            sorted.sort_unstable();
            assert_eq!(median(five), sorted[2], "{five:?}");
        }
    }

    #[test]
    fn a_step_is_found_where_it_is_and_a_line_is_none() {
        let mut row = vec![60; 100];
        row[40..].fill(220);
        row[70..72].fill(30);
        let plane = Plane { width: 100, height: 1, values: row };
        let steps = of_rows(&plane).remove(0);
        assert!(matches!(steps[..], [Step { at, rises: true }] if (at - 40.0).abs() < 0.5), "{steps:?}");
    }
}
