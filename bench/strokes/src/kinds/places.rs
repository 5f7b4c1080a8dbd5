use tracelight_stroke::{Path, Point, Vec2};

use crate::shapes::polyline;

/// Points and normals at even steps along a path.
pub(super) struct Places(Vec<(Point, Vec2)>);

impl Places {
    pub(super) fn along(path: &Path, steps: usize) -> Self {
        let points = path.flatten(0.005);
        let length: f64 = points.windows(2).map(|w| w[0].distance(w[1])).sum();
        let step = length / steps as f64;
        let (mut places, mut walked) = (Vec::new(), 0.0);
        for pair in points.windows(2) {
            let piece = pair[0].distance(pair[1]);
            let way = (pair[1] - pair[0]) / piece.max(1e-12);
            while places.len() as f64 * step <= walked + piece {
                let at = pair[0] + way * (places.len() as f64 * step - walked);
                places.push((at, Vec2::new(-way.y, way.x)));
            }
            walked += piece;
        }
        Self(places)
    }

    /// The part from one share of the length to another, round again where it is beyond the end, each place moved by what `aside` says
    /// of its share and of the normal there.
    pub(super) fn moved(
        &self,
        (from, to): (f64, f64),
        closed: bool,
        aside: impl Fn(f64, Vec2) -> Vec2,
    ) -> Path {
        let last = self.0.len() - 1;
        let index = |share: f64| (share * last as f64).round() as usize;
        let at = |i: usize| {
            let (place, normal) = self.0[if i > last { (i - last) % last } else { i }];
            place + aside(i as f64 / last as f64, normal)
        };
        polyline(&(index(from)..index(to) + usize::from(!closed)).map(at).collect::<Vec<_>>(), closed)
    }
}
