//! How long any disc of 1 mm on the wall was lit, by brute force.

use std::collections::HashMap;

use tracelight_stroke::Point;

/// Radius of the discs that are asked about, m,
const RADIUS_M: f64 = 1e-3;
/// and how far apart those lie that are counted. Each of them is larger by so much that it holds any that lies between.
const STEP_M: f64 = 0.25e-3;

/// Lit ticks in excess of a tenth of the time in any window that ends now, of each disc.
pub(crate) struct Discs {
    held: HashMap<(i32, i32), (f64, u32)>,
    most: (f64, Point),
}

impl Discs {
    pub(crate) fn new() -> Self {
        Self { held: HashMap::new(), most: (0.0, Point::ORIGIN) }
    }

    /// Light in a tick; they come in order.
    pub(crate) fn light(&mut self, tick: u32, spot: Point) {
        let reach = RADIUS_M + STEP_M * std::f64::consts::FRAC_1_SQRT_2;
        let number = |m: f64| (m / STEP_M).round() as i32;
        let steps = (reach / STEP_M).ceil() as i32;
        for row in -steps..=steps {
            for column in -steps..=steps {
                let key = (number(spot.x) + column, number(spot.y) + row);
                let centre = Point::new(f64::from(key.0) * STEP_M, f64::from(key.1) * STEP_M);
                if centre.distance(spot) > reach {
                    continue;
                }
                let (held, last) = self.held.entry(key).or_insert((0.0, tick));
                // what was in excess of a window's tenth, or a window that begins now
                *held = (*held - 0.1 * f64::from(tick - *last)).max(0.0) + 1.0;
                *last = tick;
                if *held - 0.1 > self.most.0 {
                    self.most = (*held - 0.1, centre);
                }
            }
        }
    }

    /// Most of it, ticks, and where: L − W / 10 for any L lit ticks of any W.
    pub(crate) fn most(&self) -> (f64, Point) {
        self.most
    }
}
