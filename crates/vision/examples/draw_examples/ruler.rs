use tracelight_stroke::{Path, Point};

use super::{canvas::Canvas, figures::polygon, sheet::Sheet};

/// Size of the two pictures, pixels.
const SIZE: [usize; 2] = [320, 240];

/// Scale of the two pictures, pixels an inch.
const INCH: f64 = 12.0;

/// Half the width of the ruler, pixels: it is 1⅔ inch wide.
const HALF_WIDTH: f64 = 10.0;

/// A twelve-inch ruler on a wall, two tapes across it four inches apart.
pub(crate) struct Ruler {
    /// Name of the files.
    pub(crate) name: &'static str,
    /// Whether it hangs upright.
    upright: bool,
    /// Its first end along itself, and its middle across, pixels.
    at: [f64; 2],
    /// Middle of the first tape along the ruler, pixels.
    tape: f64,
}

/// Upright and level.
pub(crate) const RULERS: [Ruler; 2] = [
    Ruler { name: "ruler-upright", upright: true, at: [47.3, 161.2], tape: 95.3 },
    Ruler { name: "ruler-level", upright: false, at: [86.6, 117.4], tape: 134.6 },
];

impl Ruler {
    /// Middles of the two tapes.
    pub(crate) fn marks(&self) -> [Point; 2] {
        [self.tape, self.tape + 4.0 * INCH].map(|along| self.point(along, 0.0))
    }

    /// The picture as a PNG file.
    pub(crate) fn png(&self) -> Result<Vec<u8>, png::EncodingError> {
        let mut ink = Canvas::new(SIZE);
        self.shade(&mut ink, &[self.bar([-4.0, 12.0 * INCH + 4.0], [-HALF_WIDTH, HALF_WIDTH])], 0.13);
        self.shade(&mut ink, &self.ticks(), 0.22);
        let tapes = [0.0, 4.0 * INCH].map(|further| {
            let middle = self.tape + further - self.at[0];
            self.bar([middle - 4.0, middle + 4.0], [-19.0, 19.0])
        });
        self.shade(&mut ink, &tapes, 1.0);
        Sheet::WALL.png(&ink)
    }

    /// Lays shapes over what is there, so dark (1: as dark as tape).
    fn shade(&self, ink: &mut Canvas, shapes: &[Path], dark: f64) {
        let mut layer = Canvas::new(SIZE);
        layer.fill(&shapes.iter().collect::<Vec<_>>());
        for (below, share) in ink.coverage.iter_mut().zip(layer.coverage) {
            *below += (dark - *below).max(0.0) * share.min(1.0);
        }
    }

    /// One every quarter inch from the ruler's edge.
    fn ticks(&self) -> Vec<Path> {
        let tick = |quarter: u32| {
            let along = f64::from(quarter) * INCH / 4.0;
            // longest at inches, then halves, then quarters
            let long = [8.0, 3.5, 5.5, 3.5][quarter as usize % 4];
            self.bar([along - 0.4, along + 0.4], [-HALF_WIDTH, long - HALF_WIDTH])
        };
        (0..=48).map(tick).collect()
    }

    /// A rectangle along and across the ruler.
    fn bar(&self, [from, to]: [f64; 2], [low, high]: [f64; 2]) -> Path {
        let corner = |along: f64, across| self.point(self.at[0] + along, across).into();
        polygon(&[corner(from, low), corner(to, low), corner(to, high), corner(from, high)])
    }

    fn point(&self, along: f64, across: f64) -> Point {
        let across = self.at[1] + across;
        if self.upright { Point::new(across, along) } else { Point::new(along, across) }
    }
}
