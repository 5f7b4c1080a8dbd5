//! Pixel noise: estimate and reduction.

use crate::levels::{Counts, percentile};
use crate::plane::Plane;

/// Residual noise after 0, 1 or 2 passes of [`smoothed`]: root of the sum of squared weights of the repeated binomial mean.
pub const SMOOTHED: [f64; 3] = [1.0, 3.0 / 8.0, 35.0 / 128.0];

/// Standard deviation of the pixel noise, levels: the mask of Immerkær, "Fast noise variance estimation" (1996),
/// which is blind to flat places and slopes, with the median instead of the mean, which is blind to lines too; of about
/// `sampled` pixels.
pub fn noise(plane: &Plane<u8>, sampled: usize) -> f64 {
    const TIMES: f64 = 6.0; // the mask's gain on white noise
    const MEDIAN: f64 = 0.6745; // of |x| for a standard normal x
    let mut counts = Counts::default();
    let (mut seconds, mut responses) = (vec![0i16; plane.width], vec![0u8; plane.width.saturating_sub(2)]);
    let every = (plane.values.len() / sampled).max(1);
    for y in (1..plane.height - 1).step_by(every) {
        let [above, here, below] = [y - 1, y, y + 1].map(|y| plane.row(y));
        // 1 −2 1 down the columns, and of those the same along the row
        let threes = above.iter().zip(here).zip(below);
        let second = |((a, h), b): ((&u8, &u8), &u8)| i16::from(*a) + i16::from(*b) - 2 * i16::from(*h);
        seconds.iter_mut().zip(threes).for_each(|(out, three)| *out = second(three));
        let threes = seconds.iter().zip(&seconds[1..]).zip(&seconds[2..]);
        let response = |((a, h), b): ((&i16, &i16), &i16)| (a + b - 2 * h).unsigned_abs().min(255) as u8;
        responses.iter_mut().zip(threes).for_each(|(out, three)| *out = response(three));
        counts.add(&responses);
    }
    percentile(&counts.sum(), 0.5) / (TIMES * MEDIAN)
}

/// The binomial mean of 3 × 3 pixels: noise falls to 3/8.
pub fn smoothed(plane: &Plane<u8>) -> Plane<u8> {
    let (w, h) = (plane.width, plane.height);
    let mut out = Plane::filled(w, h, 0);
    // sums of columns of three, with one more at either end, which repeats the border
    let mut columns = vec![0u16; w + 2];
    for y in 0..h {
        let [above, here, below] = [y.saturating_sub(1), y, (y + 1).min(h - 1)].map(|y| plane.row(y));
        let threes = above.iter().zip(here).zip(below);
        columns[1..=w]
            .iter_mut()
            .zip(threes)
            .for_each(|(c, ((a, b), d))| *c = u16::from(*a) + 2 * u16::from(*b) + u16::from(*d));
        (columns[0], columns[w + 1]) = (columns[1], columns[w]);
        let (left, right) = (&columns[..w], &columns[2..]);
        for (((v, l), c), r) in out.row_mut(y).iter_mut().zip(left).zip(&columns[1..=w]).zip(right) {
            *v = ((l + 2 * c + r + 8) / 16) as u8;
        }
    }
    out
}
