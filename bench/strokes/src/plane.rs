use tracelight_stroke::Point;

/// Values of pixels, row by row.
pub(crate) struct Plane {
    pub(crate) width: usize,
    pub(crate) height: usize,
    pub(crate) values: Vec<f32>,
}

impl Plane {
    pub(crate) fn filled(width: usize, height: usize, value: f32) -> Self {
        Self { width, height, values: vec![value; width * height] }
    }

    /// Calls `each` with the value of each pixel whose centre may be within `reach` of the box of two points.
    pub(crate) fn around(&mut self, a: Point, b: Point, reach: f64, mut each: impl FnMut(Point, &mut f32)) {
        let range = |a: f64, b: f64, size: usize| {
            let low = (a.min(b) - reach - 0.5).floor().max(0.0) as usize;
            low..((a.max(b) + reach + 0.5).ceil().max(0.0) as usize).min(size)
        };
        let columns = range(a.x, b.x, self.width);
        for y in range(a.y, b.y, self.height) {
            let row = &mut self.values[y * self.width..][..self.width];
            for x in columns.clone() {
                each(Point::new(x as f64 + 0.5, y as f64 + 0.5), &mut row[x]);
            }
        }
    }

    /// Makes each value no less than the other plane's.
    pub(crate) fn at_least(&mut self, other: &Self) {
        self.values.iter_mut().zip(&other.values).for_each(|(v, o)| *v = v.max(*o));
    }
}

/// Gaussian, σ in px, cut at 3.5 σ.
pub(crate) fn blur(plane: &mut Plane, sigma: f64) {
    if sigma <= 0.0 {
        return;
    }
    let reach = (3.5 * sigma).ceil() as usize;
    let weight = |i: usize| (-0.5 * ((i as f64 - reach as f64) / sigma).powi(2)).exp();
    let weights: Vec<f64> = (0..=2 * reach).map(weight).collect();
    let sum: f64 = weights.iter().sum();
    let weights: Vec<f32> = weights.iter().map(|w| (w / sum) as f32).collect();
    let (width, height) = (plane.width, plane.height);
    let mut padded = vec![0.0; width + 2 * reach];
    for row in plane.values.chunks_exact_mut(width) {
        padded[..reach].fill(row[0]);
        padded[reach..reach + width].copy_from_slice(row);
        padded[reach + width..].fill(row[width - 1]);
        let seen = padded.windows(weights.len());
        row.iter_mut()
            .zip(seen)
            .for_each(|(v, around)| *v = around.iter().zip(&weights).map(|(a, w)| a * w).sum());
    }
    let mut out = vec![0.0_f32; width * height];
    for (y, row) in out.chunks_exact_mut(width).enumerate() {
        for (k, weight) in weights.iter().enumerate() {
            let from = (y + k).saturating_sub(reach).min(height - 1);
            let other = &plane.values[from * width..][..width];
            row.iter_mut().zip(other).for_each(|(v, o)| *v += weight * o);
        }
    }
    plane.values = out;
}
