//! Pages of markers taken off an image of a wall: what is about them is carried on smoothly where they are.

use tracelight_aim::{Board, Camera, PlacedPage};
use tracelight_picture::Raster;
use tracelight_pipeline::Paper;
use tracelight_stroke::Point;

use crate::board::printed_m;
use crate::wall::SeenWall;

/// How far a page is taken to reach beyond its paper, m: paper casts shadows.
const EDGE_M: f64 = 0.008;

/// The image as if no pages were there.
pub(crate) fn without_pages(pixels: &Raster, wall: &SeenWall) -> Raster {
    let (width, height) = (pixels.width() as usize, pixels.height() as usize);
    let mut known = vec![true; width * height];
    for page in &wall.pages {
        let Some(corners) = corners(page, &wall.camera.camera) else { continue };
        for (y, row) in known.chunks_exact_mut(width).enumerate() {
            let Some((left, right)) = crossed(&corners, y as f64 + 0.5) else { continue };
            let column = |x: f64| x.clamp(0.0, width as f64) as usize;
            row[column(left.floor())..column(right.ceil())].fill(false);
        }
    }
    let filled = Level::of(pixels, &known).filled();
    let levels = |p: [f32; 4]| [p[0], p[1], p[2]].map(|v| v.round() as u8);
    let rgb = pixels.rgb().chunks_exact(3).zip(&known).zip(&filled.pixels);
    let rgb = rgb
        .flat_map(|((own, known), found)| if *known { [own[0], own[1], own[2]] } else { levels(*found) })
        .collect();
    Raster::new(pixels.width(), pixels.height(), rgb).unwrap_or_else(|| pixels.clone())
}

/// Where the corners of a page's paper are seen, px.
fn corners(page: &PlacedPage, camera: &Camera) -> Option<[Point; 4]> {
    let board = Board::ALL.get(page.board)?;
    let place = page.place();
    let ([left, right], [below, above]) = printed_m(board, &[Paper::A4, Paper::LETTER]);
    let corner = |x: f64, y: f64| camera.pixel(place * Point::new(x, y));
    Some([
        corner(left - EDGE_M, above + EDGE_M)?,
        corner(right + EDGE_M, above + EDGE_M)?,
        corner(right + EDGE_M, below - EDGE_M)?,
        corner(left - EDGE_M, below - EDGE_M)?,
    ])
}

/// From where to where a level line crosses a convex figure.
fn crossed(corners: &[Point; 4], y: f64) -> Option<(f64, f64)> {
    let mut found: Option<(f64, f64)> = None;
    for k in 0..4 {
        let (a, b) = (corners[k], corners[(k + 1) % 4]);
        if (a.y <= y) != (b.y <= y) {
            let x = a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y);
            found = Some(found.map_or((x, x), |(low, high)| (low.min(x), high.max(x))));
        }
    }
    found
}

/// A picture and how much is known of each of its pixels: three colours, and 0 to 1.
struct Level {
    width: usize,
    height: usize,
    pixels: Vec<[f32; 4]>,
}

impl Level {
    fn of(raster: &Raster, known: &[bool]) -> Self {
        let pixel = |(p, known): (&[u8], &bool)| {
            [f32::from(p[0]), f32::from(p[1]), f32::from(p[2]), f32::from(u8::from(*known))]
        };
        let pixels = raster.rgb().chunks_exact(3).zip(known).map(pixel).collect();
        Self { width: raster.width() as usize, height: raster.height() as usize, pixels }
    }

    /// What is not known from what is, from ever coarser pictures (pull and push: Gortler et al., *The lumigraph*, 1996, §3.5).
    fn filled(self) -> Self {
        if self.width.min(self.height) < 2 {
            return self;
        }
        let coarse = self.halved().filled();
        let mut own = self;
        for i in 0..own.pixels.len() {
            let known = own.pixels[i][3];
            if known < 1.0 {
                let from = coarse.between((i % own.width) as f32, (i / own.width) as f32);
                let mixed = |c: usize| known * own.pixels[i][c] + (1.0 - known) * from[c];
                own.pixels[i] = [mixed(0), mixed(1), mixed(2), known.max(from[3])];
            }
        }
        own
    }

    /// Half as wide and as high, the last column and row carried on.
    fn halved(&self) -> Self {
        let (width, height) = (self.width.div_ceil(2), self.height.div_ceil(2));
        let mean = |i: usize| {
            let (x, y) = (2 * (i % width), 2 * (i / width));
            let mut sum = [0.0_f32; 4];
            for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
                let p =
                    self.pixels[(y + dy).min(self.height - 1) * self.width + (x + dx).min(self.width - 1)];
                (0..3).for_each(|c| sum[c] += p[3] * p[c]);
                sum[3] += p[3];
            }
            let share = if sum[3] > 0.0 { 1.0 / sum[3] } else { 0.0 };
            [share * sum[0], share * sum[1], share * sum[2], sum[3].min(1.0)]
        };
        Self { width, height, pixels: (0..width * height).map(mean).collect() }
    }

    /// What is at a place of a picture twice as large, between pixels evenly.
    fn between(&self, x: f32, y: f32) -> [f32; 4] {
        let along = |v: f32, n: usize| {
            let v = (0.5 * v - 0.25).clamp(0.0, (n - 1) as f32);
            let low = (v as usize).min(n.saturating_sub(2));
            (low, (low + 1).min(n - 1), v - low as f32)
        };
        let ((x0, x1, fx), (y0, y1, fy)) = (along(x, self.width), along(y, self.height));
        let at = |x: usize, y: usize| self.pixels[y * self.width + x];
        let (a, b, c, d) = (at(x0, y0), at(x1, y0), at(x0, y1), at(x1, y1));
        std::array::from_fn(|k| {
            let (upper, lower) = (a[k] + fx * (b[k] - a[k]), c[k] + fx * (d[k] - c[k]));
            upper + fy * (lower - upper)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_known_is_carried_on_smoothly() {
        // a slope of light, and a hole in it
        let light = |x: usize, y: usize| 60.0 + 1.0 * x as f32 + 0.5 * y as f32;
        let (width, height) = (97, 61);
        let rgb: Vec<u8> =
            (0..width * height).flat_map(|i| [light(i % width, i / width).round() as u8; 3]).collect();
        let known: Vec<bool> = (0..width * height)
            .map(|i| !((40..60).contains(&(i % width)) && (20..40).contains(&(i / width))))
            .collect();
        let filled = Level::of(&Raster::new(width as u32, height as u32, rgb).unwrap(), &known).filled();
        let mut steps = 0.0_f32;
        for (i, _) in known.iter().enumerate().filter(|(_, known)| !**known) {
            let (x, y, found) = (i % width, i / width, filled.pixels[i][0]);
            assert!((found - light(x, y)).abs() < 9.0, "{x} {y}: {found}");
            steps = steps.max((found - filled.pixels[i - 1][0]).abs());
        }
        assert!(steps < 6.0, "a step of {steps}");
    }

    #[test]
    fn a_line_crosses_a_page_from_side_to_side() {
        let corners = [(0.0, 0.0), (10.0, 2.0), (12.0, 12.0), (1.0, 10.0)].map(Point::from);
        let (left, right) = crossed(&corners, 5.0).unwrap();
        assert!((left - 0.5).abs() < 1e-9 && (right - 10.6).abs() < 1e-9, "{left} {right}");
        assert_eq!(crossed(&corners, 13.0), None);
    }
}
