use super::plane::Plane;

/// A plastered wall: how much light each place sends back, about one.
pub(super) struct Wall {
    relief: Plane,
    mottle: Plane,
}

/// The mottling is so smooth that a sixteenth of the size holds it.
const MOTTLE_LEVEL: u32 = 4;

impl Wall {
    /// The same wall for the same size, always.
    pub(super) fn new(width: usize, height: usize) -> Self {
        let reduced = |level: u32| (width.div_ceil(1 << level), height.div_ceil(1 << level));
        let noise = |level: u32, seed: u32, across: f32, down: f32| {
            let (w, h) = reduced(level);
            Plane::noise(w, h, seed).blurred(across, down).normalized()
        };
        let sand = noise(0, 1, 0.9, 0.9);
        let trowel = noise(1, 2, 7.0, 3.2); // strokes of the float: longer than high
        let waves = noise(3, 3, 3.0, 3.0);
        let mut height_map = sand;
        for (y, row) in height_map.values.chunks_exact_mut(width).enumerate() {
            for (x, h) in row.iter_mut().enumerate() {
                let (u, v) = (x as f32 + 0.5, y as f32 + 0.5);
                *h = 0.075 * *h + 0.62 * trowel.sample(u, v, 1) + 1.2 * waves.sample(u, v, 3);
            }
        }
        Self { relief: lit_from_the_upper_left(&height_map), mottle: noise(MOTTLE_LEVEL, 4, 4.0, 3.0) }
    }

    /// Reflectance at a pixel.
    pub(super) fn at(&self, x: usize, y: usize) -> f32 {
        let mottle = self.mottle.sample(x as f32, y as f32, MOTTLE_LEVEL);
        (1.0 + 0.85 * self.relief.row(y)[x] + 0.06 * mottle).clamp(0.45, 1.6)
    }
}

/// Slope of a height map towards a grazing lamp at the upper left.
fn lit_from_the_upper_left(map: &Plane) -> Plane {
    let mut out = Plane::dark(map.width, map.height);
    for (y, row) in out.values.chunks_exact_mut(map.width).enumerate() {
        let (here, above) = (map.row(y), map.row(y.saturating_sub(1)));
        for (x, slope) in row.iter_mut().enumerate() {
            let left = here[x.saturating_sub(1)];
            *slope = here[x] - 0.5 * (left + above[x]);
        }
    }
    out
}
