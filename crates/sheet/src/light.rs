//! The paper's brightness everywhere, also under the ink: uneven light divided out.
//!
//! The image is cut into tiles; the brightness of a tile's paper is a high percentile of its levels. A smooth
//! surface is laid on the tiles from above (asymmetric least squares, after Eilers, "A perfect smoother", 2003, in
//! the plane: tiles below the surface hardly count). A tile far below it is all ink and takes its neighbours'
//! ratio to the surface instead of its own. Unlike a morphological closing this needs no window larger than the
//! largest patch of ink.

use tracelight_image::levels::percentile;
use tracelight_image::smooth::smoothed;
use tracelight_image::{Plane, solve};
use tracelight_maths::{exp, ln};

use crate::shadow;
use crate::two_tones::TwoTones;

/// Tiles along the shorter side.
const TILES: usize = 24;
/// Smallest tile, px.
const LEAST_TILE: usize = 8;
/// Share of a tile's pixels below its paper's brightness: a pen covers less than the rest.
const PERCENTILE: f64 = 0.85;
/// A tile below this share of the surface is ink: paper in a shadow keeps more, ink rarely that much.
const INK_RATIO: f64 = 0.7;
/// A tile below this share of its neighbours is partly ink.
const DIP: f64 = 0.95;
/// Dimmest paper that is believed, levels: below, division would only enlarge noise.
const DIMMEST: f64 = 12.0;

/// Rounds in which the surface is laid on the tiles, at most.
const ROUNDS: usize = 12;
/// A surface that moves by less than this in a round has settled: a fifth of a level of 255, as a logarithm.
const SETTLED: f64 = 8e-4;

/// Brightness of the paper at the tiles' centres.
#[derive(Clone, Debug)]
pub struct Paper {
    tile: usize,
    levels: Plane<f64>,
    /// Of every pixel, where there are shadows.
    shaded: Option<Plane<u8>>,
}

impl Paper {
    /// As bright everywhere.
    fn even(level: u8) -> Self {
        let level = f64::from(level).max(DIMMEST);
        Self { tile: 1, levels: Plane::filled(1, 1, level), shaded: None }
    }

    /// Of an image with light paper and of such levels, of which beside a sheet more may be `seen` than paper. It may have hard
    /// edges if `sheets` lie in it, or if it looks as if shadows had.
    pub fn of(image: &Plane<u8>, levels: &[u32; 256], seen: &Plane<u8>, sheets: bool) -> Self {
        if let Some(tones) = TwoTones::of(levels).filter(|_| !sheets) {
            return Self::even(tones.bright);
        }
        let tile = (image.width.min(image.height) / TILES).max(LEAST_TILE);
        let bright = tile_levels(image, tile);
        let surface = Surface::over(&bright);
        let ratio = Plane {
            values: bright.values.iter().zip(surface.on(&bright)).map(|(b, s)| b / s).collect(),
            ..bright.clone()
        };
        let even = filled_in(&ratio, &reached(&bright, &ratio));
        let levels =
            even.values.iter().zip(surface.on(&even)).map(|(r, s)| (r * s).clamp(DIMMEST, 255.0)).collect();
        let levels = Plane { values: levels, ..even };
        let has_shadows = sheets || shadow::is_cast(&bright) || shadow::is_soft(&ratio);
        let shaded = has_shadows.then(|| shaded(seen, tile, &surface.on(&bright).collect::<Vec<_>>()));
        Self { tile, levels, shaded }
    }

    /// Whether shadows fall on it: what is left of their edges looks like a pale line.
    pub fn has_shadows(&self) -> bool {
        self.shaded.is_some()
    }

    /// Darkest and brightest paper, levels.
    pub fn range(&self) -> (f64, f64) {
        let fold = |f: fn(f64, f64) -> f64, from| self.levels.values.iter().copied().fold(from, f);
        (fold(f64::min, 255.0), fold(f64::max, 0.0))
    }

    /// How much light the ink takes: 0 is paper, 255 total darkness.
    ///
    /// A level v on paper p leaves 255 (1 − v/p). 255/p is interpolated along the row with 11 bits behind the point
    /// (the dimmest paper's, 21, needs 5 before it), so that a pixel is one 16-bit product.
    pub fn darkness(&self, image: &Plane<u8>) -> Plane<u8> {
        if let Some(paper) = &self.shaded {
            return below(image, paper);
        }
        let mut dark = Plane::filled(image.width, image.height, 0);
        let mut gains = vec![0u16; image.width];
        // over an eighth of a tile paper changes by less than a level
        let rows = (self.tile / 8).max(1);
        for y in 0..image.height {
            if y % rows == 0 {
                self.gains_at(y + rows / 2, &mut gains);
            }
            for ((out, &level), &gain) in dark.row_mut(y).iter_mut().zip(image.row(y)).zip(&gains) {
                let lit = ((u32::from(u16::from(level) << 8) * u32::from(gain)) >> 16) as u16;
                *out = 255 - (lit.saturating_add(HALF) >> (GAIN_BITS - 8)).min(255) as u8;
            }
        }
        dark
    }

    /// What a level is multiplied with along pixel row `y`.
    fn gains_at(&self, y: usize, gains: &mut [u16]) {
        let (low, high, share) = self.between(y.min(self.tile * self.levels.height), self.levels.height);
        let rows = self.levels.row(low).iter().zip(self.levels.row(high));
        let one = f64::from(1 << GAIN_BITS) * 255.0;
        let across: Vec<i32> = rows.map(|(l, h)| (one / (l + (h - l) * f64::from(share))) as i32).collect();
        let tile = self.tile as i32;
        // pixels left of the first tile's centre and right of the last one's have that tile's gain
        let last = across.len() - 1;
        let half = self.tile / 2;
        gains.iter_mut().take(half).for_each(|gain| *gain = across[0] as u16);
        for k in 0..=last {
            let from = (half + k * self.tile).min(gains.len());
            let to = if k == last { gains.len() } else { (from + self.tile).min(gains.len()) };
            let (here, next) = (across[k], across[(k + 1).min(last)]);
            let step = ((next - here) << 8) / tile;
            let mut at = (here << 8) + step / 2;
            for gain in &mut gains[from..to] {
                *gain = (at >> 8) as u16;
                at += step;
            }
        }
    }

    /// The two of `tiles` centres a pixel lies between, and how far along.
    fn between(&self, pixel: usize, tiles: usize) -> (usize, usize, f32) {
        let at = ((pixel as f32 + 0.5) / self.tile as f32 - 0.5).clamp(0.0, (tiles - 1) as f32);
        let low = at as usize;
        (low, (low + 1).min(tiles - 1), at - low as f32)
    }
}

/// How much darker each pixel is than its own paper.
fn below(image: &Plane<u8>, paper: &Plane<u8>) -> Plane<u8> {
    let gain = |p: usize| 255.0 / (p as f32).max(DIMMEST as f32);
    let gains: Vec<f32> = (0..256).map(gain).collect();
    let dark = |(&v, &p): (&u8, &u8)| (255.5 - f32::from(v) * gains[usize::from(p)]).clamp(0.0, 255.0) as u8;
    Plane { values: image.values.iter().zip(&paper.values).map(dark).collect(), ..*image }
}

/// The paper of every pixel of a picture with hard shadows, `expected` by tile.
fn shaded(image: &Plane<u8>, tile: usize, expected: &[f64]) -> Plane<u8> {
    // twice a tile is wider than any pen
    let side = 2 * tile + 1;
    shadow::paper(&smoothed(&smoothed(image)), side, tile, expected, |closed| {
        // what is ink in the closed picture, filled, takes the paper next to it
        let levels = tile_levels(closed, tile);
        let ratio = levels.values.iter().zip(expected).map(|(l, e)| l / e);
        let paper: Vec<bool> =
            levels.values.iter().zip(expected).map(|(&l, &e)| !shadow::is_ink(l, e)).collect();
        let ratio = Plane { values: ratio.collect(), ..levels };
        let near = |i: usize| around(&ratio, &paper, i, 3) * expected[i];
        Plane { values: (0..expected.len()).map(near).collect(), ..ratio }
    })
}

/// Bits behind the point of a gain.
const GAIN_BITS: u32 = 11;
/// Half a level at the precision of a product, to round.
const HALF: u16 = 1 << (GAIN_BITS - 9);

/// The percentile of each tile; tiles at the right and lower border may be cut.
fn tile_levels(image: &Plane<u8>, tile: usize) -> Plane<f64> {
    let (width, height) = (image.width.div_ceil(tile), image.height.div_ceil(tile));
    let mut levels = Plane::filled(width, height, 0.0);
    // 7 rows of 30 pixels of a tile tell its paper to a level or two
    let (down, along) = ((tile / 7).max(1), (tile / 30).max(1));
    for ty in 0..height {
        for tx in 0..width {
            let mut histogram = [0u32; 256];
            for y in (ty * tile..((ty + 1) * tile).min(image.height)).step_by(down) {
                let row = &image.row(y)[tx * tile..((tx + 1) * tile).min(image.width)];
                row.chunks(along).for_each(|levels| histogram[usize::from(levels[0])] += 1);
            }
            levels.values[ty * width + tx] = percentile(&histogram, PERCENTILE).max(DIMMEST);
        }
    }
    levels
}

/// A quadratic surface of log-brightness over the tiles, in coordinates from −1 to 1; nowhere brighter than the brightest of them.
struct Surface {
    of: [f64; 6],
    brightest: f64,
}

impl Surface {
    fn over(bright: &Plane<f64>) -> Self {
        let logs: Vec<f64> = bright.values.iter().map(|b| ln(*b)).collect();
        let bases: Vec<[f64; 6]> = (0..logs.len()).map(|i| basis(bright, i)).collect();
        let brightest = logs.iter().copied().fold(f64::MIN, f64::max);
        let mut surface = Self { of: [brightest, 0.0, 0.0, 0.0, 0.0, 0.0], brightest };
        for _ in 0..ROUNDS {
            let before = surface.of;
            surface.of = surface.nearer(&bases, &logs);
            let moved = surface.of.iter().zip(before).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            if moved < SETTLED {
                break;
            }
        }
        surface
    }

    /// One round of asymmetric least squares: a tile below the surface counts the less the further it is below.
    fn nearer(&self, bases: &[[f64; 6]], logs: &[f64]) -> [f64; 6] {
        let mut normal = [[0.0; 7]; 6];
        for (basis, &log) in bases.iter().zip(logs) {
            let below = ((self.log_at(basis) - log) * (1.0 / 0.08)).max(0.0);
            let weight = 1.0 + below * below;
            let weight = 1.0 / (weight * weight);
            for (k, row) in normal.iter_mut().enumerate() {
                let a = weight * basis[k];
                row[..=k].iter_mut().zip(basis).for_each(|(cell, b)| *cell += a * b);
                row[6] += a * log;
            }
        }
        // the matrix is symmetric
        (0..6).for_each(|k| (k + 1..6).for_each(|m| normal[k][m] = normal[m][k]));
        // a hundredth of a tile's weight against bends and slopes that no paper calls for
        let ridge = 0.01 * logs.len() as f64;
        (1..6).for_each(|k| normal[k][k] += 0.1 * ridge);
        solve::linear(normal).unwrap_or(self.of)
    }

    fn log_at(&self, basis: &[f64; 6]) -> f64 {
        self.of.iter().zip(basis).map(|(c, b)| c * b).sum()
    }

    fn on<'a, T>(&'a self, tiles: &'a Plane<T>) -> impl Iterator<Item = f64> + 'a
    where
        T: Copy + Default,
    {
        let log = |i: usize| self.log_at(&basis(tiles, i)).min(self.brightest);
        (0..tiles.values.len()).map(move |i| exp(log(i)))
    }
}

fn basis<T>(tiles: &Plane<T>, i: usize) -> [f64; 6] {
    let along = |k: usize, n: usize| if n > 1 { 2.0 * k as f64 / (n - 1) as f64 - 1.0 } else { 0.0 };
    let (x, y) = (along(i % tiles.width, tiles.width), along(i / tiles.width, tiles.height));
    [1.0, x, y, x * x, x * y, y * y]
}

/// Light changes by less than this from tile to tile, as a ratio: from one side to the other it falls to a third over
/// some forty tiles, and twice as steeply towards a lens's corners. What ink covers begins with a step.
const GENTLE: f64 = 0.93;

/// The tiles that are reached from paper at the picture's border without a step.
fn reached(bright: &Plane<f64>, ratio: &Plane<f64>) -> Vec<bool> {
    let mut seen = vec![false; bright.values.len()];
    for i in (0..seen.len()).filter(|&i| bright.is_at_border(i)) {
        if !seen[i] && ratio.values[i] >= INK_RATIO {
            shadow::flooded(bright, i, GENTLE, &mut seen);
        }
    }
    seen
}

/// Paper has at least this share of the surface's brightness, however gently it fades: what is shaded down to less was
/// meant.
const LEAST_PAPER: f64 = 0.5;

/// Ratios of brightness to surface, with those of ink replaced by their neighbours'. What is not `reached` from the
/// border and darker than what is near it was filled in, however pale; unless nothing is reached, on a dark table.
fn filled_in(ratio: &Plane<f64>, reached: &[bool]) -> Plane<f64> {
    let on_table = !reached.contains(&true);
    let is_paper = |i: usize| {
        let level = ratio.values[i];
        let even = || on_table || level >= GENTLE * around(ratio, reached, i, 3);
        (reached[i] && level >= LEAST_PAPER) || (level >= INK_RATIO && even())
    };
    let mut paper: Vec<bool> = (0..reached.len()).map(is_paper).collect();
    let dips: Vec<bool> =
        (0..paper.len()).map(|i| ratio.values[i] < DIP * around(ratio, &paper, i, 2)).collect();
    paper.iter_mut().zip(dips).for_each(|(p, dip)| *p &= !dip);
    let fill = |i: usize| {
        let reach = if paper[i] { 1 } else { 3 };
        around(ratio, &paper, i, reach)
    };
    Plane { values: (0..paper.len()).map(fill).collect(), ..*ratio }
}

/// Mean of the paper's ratios up to `reach` tiles away; 1 (the surface itself) where there is none.
fn around(ratio: &Plane<f64>, paper: &[bool], i: usize, reach: usize) -> f64 {
    let (x, y) = (i % ratio.width, i / ratio.width);
    let (mut sum, mut weight) = (0.02, 0.02);
    for ny in y.saturating_sub(reach)..(y + reach + 1).min(ratio.height) {
        for nx in x.saturating_sub(reach)..(x + reach + 1).min(ratio.width) {
            let k = ny * ratio.width + nx;
            if paper[k] {
                let near = 1.0 / (1.0 + (nx.abs_diff(x).pow(2) + ny.abs_diff(y).pow(2)) as f64);
                (sum, weight) = (sum + near * ratio.values[k], weight + near);
            }
        }
    }
    sum / weight
}

#[cfg(test)]
mod tests {
    use tracelight_image::levels::sampled_histogram;

    use super::*;

    #[test]
    fn light_from_one_side_and_a_large_filled_shape_leave_even_paper() {
        let paper = |x: usize| 240.0 - 160.0 * x as f64 / 640.0;
        let ink = |x: usize, y: usize| (x as f64 - 330.0).hypot(y as f64 - 240.0) < 160.0;
        let level = |i: usize| {
            let (x, y) = (i % 640, i / 640);
            (paper(x) * if ink(x, y) { 0.12 } else { 1.0 }) as u8
        };
        let image = Plane { width: 640, height: 480, values: (0..640 * 480).map(level).collect() };
        let dark = Paper::of(&image, &sampled_histogram(&image), &image, false).darkness(&image);
        let (mut palest, mut darkest) = (255, 0);
        for (i, &d) in dark.values.iter().enumerate() {
            match ink(i % 640, i / 640) {
                true => palest = palest.min(d),
                false => darkest = darkest.max(d),
            }
        }
        assert!(darkest < 15 && palest > 215, "paper up to {darkest}, ink from {palest}");
    }
}
