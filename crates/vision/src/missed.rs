//! How much of the pen's ink no stroke follows.

use tracelight_stroke::Stroke;

use crate::distance::to_paper;
use crate::plane::Plane;
use crate::region::Region;

/// How far ink may lie from its stroke, pen widths: half of one is its edge, the rest the blots of junctions.
const NEAR_PENS: f64 = 1.2;
/// The same for hair lines, px.
const LEAST_PX: f64 = 3.0;

/// Share of the regions' pixels that lie further from every stroke than the pen reaches, 0 to 1. Pixels nearer to
/// the image's border than that count as followed.
pub(crate) fn share(regions: &[&Region], strokes: &[Stroke], width: usize, height: usize) -> f64 {
    // the strokes are the paper, and all the rest is ink, as far as distances go
    let mut plane = Plane::filled(width, height, 1u8);
    for stroke in strokes {
        let points = stroke.path.flatten(0.25);
        for pair in points.windows(2) {
            let steps = pair[0].distance(pair[1]).ceil().max(1.0) as usize;
            for k in 0..=steps {
                let p = pair[0].lerp(pair[1], k as f64 / steps as f64);
                let (x, y) = (p.x.max(0.0) as usize, p.y.max(0.0) as usize);
                plane.values[y.min(height - 1) * width + x.min(width - 1)] = 0;
            }
        }
    }
    let pen = strokes.iter().filter_map(|s| s.pen).fold(0.0, f64::max);
    let near = (NEAR_PENS * pen).max(LEAST_PX) as f32;
    let distance = to_paper(&plane);
    let far = |r: &&Region| r.pixels(width).filter(|&i| distance.values[i] > near).count();
    let missed: usize = regions.iter().map(far).sum();
    let all: usize = regions.iter().map(|r| r.area()).sum();
    missed as f64 / (all as f64).max(1.0)
}
