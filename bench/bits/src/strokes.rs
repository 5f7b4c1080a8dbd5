use tracelight_rig::{PanTilt, Segment};

/// Ticks of a move from rest to rest.
const LENGTH: u16 = 500;
/// How far ahead moves are handed over, ticks.
const AHEAD: u32 = 2_000;

/// Moves between places that a seeded generator draws, every other one lit.
#[derive(Default)]
pub(crate) struct Strokes {
    number: u32,
    seed: u32,
    at: PanTilt<f32>,
    last: Option<Segment>,
    again: bool,
    /// The moves are as long and as fast as the head can: a count a tick and more.
    far: bool,
}

/// How much further and longer far moves are.
const FAR: (f32, u16) = (6.0, 2);

impl Strokes {
    pub(crate) fn far() -> Self {
        Self { far: true, ..Self::default() }
    }

    const fn length(&self) -> u16 {
        if self.far { LENGTH * FAR.1 } else { LENGTH }
    }

    /// The next move, if it is time for it.
    pub(crate) fn due(&mut self, tick: u32) -> Option<Segment> {
        if self.again {
            self.again = false;
            return self.last;
        }
        let start_tick = self.number * u32::from(self.length());
        if start_tick > tick + AHEAD {
            return None;
        }
        let to = match (self.far, self.number % 2) {
            // there and back, both joints at once
            (true, 0) => PanTilt::new(0.1 * FAR.0, 0.1 * FAR.0),
            (true, _) => PanTilt::new(-0.1 * FAR.0, -0.1 * FAR.0),
            (false, _) => PanTilt::new(self.draw(), self.draw()),
        };
        let ticks = self.length();
        let coefficients = PanTilt::from_fn(|j| minimum_jerk(self.at[j], to[j], ticks));
        self.at = to;
        let gate = self.number % 2 == 1;
        self.number += 1;
        self.last = Some(Segment {
            start_tick,
            ticks,
            coefficients,
            tolerance_rad: PanTilt::new(3.3e-3, 3.3e-3),
            gate,
            rate_limit: tracelight_rig::RateLimit::PLANNED,
        });
        self.last
    }

    /// The move that was handed out last was not taken.
    pub(crate) const fn put_back(&mut self) {
        self.again = true;
    }

    /// Even in ±0.1 rad (Numerical Recipes' `ranqd1`).
    fn draw(&mut self) -> f32 {
        self.seed = self.seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (self.seed >> 8) as f32 / 8_388_608.0 * 0.1 - 0.1
    }
}

/// 10 s³ − 15 s⁴ + 6 s⁵ of the way.
fn minimum_jerk(from: f32, to: f32, ticks: u16) -> [f32; 6] {
    let n = f32::from(ticks);
    let way = to - from;
    let cube = n * n * n;
    [from, 0.0, 0.0, 10.0 * way / cube, -15.0 * way / (cube * n), 6.0 * way / (cube * n * n)]
}
