//! Which speeds to give a board so that its moves last as long as they should.
//!
//! A board speeds up and slows down within each move, at its own acceleration, from the speed of the move before to that of the next. A move whose speed
//! were its length over its time would last longer than that wherever speeds change. So each gets the speed at which the board needs just its time: it is
//! solved forwards while the plan speeds up, from how fast the move before was, and backwards while it slows down.

use tracelight_maths::hypot;
use tracelight_rig::PanTilt;

use crate::moves::Item;

/// Ticks in a second.
const TICKS_A_S: f64 = 1000.0;

/// What the axes of a board can do, in its units.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pace {
    /// Units of a step.
    pub(crate) units: PanTilt<f64>,
    /// Highest speed, units/s.
    pub(crate) rates: PanTilt<f64>,
    /// Highest acceleration, units/s².
    pub(crate) accelerations: PanTilt<f64>,
}

/// A move as a board sees it.
#[derive(Clone, Copy, Debug)]
struct Along {
    length: f64,
    time_s: f64,
    acceleration: f64,
    most: f64,
    /// Speeds of the plan at its ends.
    speeds: (f64, f64),
}

impl Along {
    /// The plan becomes no slower along it.
    fn speeds_up(&self) -> bool {
        self.speeds.1 >= self.speeds.0
    }

    /// The speed at which it lasts as long as it should if the speed at one of its ends is `end` and that at the other its own.
    fn from(&self, end: f64) -> f64 {
        let &Self { length, time_s, acceleration: a, most, .. } = self;
        let mean = length / time_s;
        if length <= end * time_s {
            return mean.min(most);
        }
        // length = v t − (v − end)² / 2a
        let reach = a * time_s;
        let left = reach * reach - 2.0 * a * (length - end * time_s);
        let speed = if left > 0.0 { end + reach - left.sqrt() } else { end + reach };
        speed.max(mean).min(most)
    }
}

impl Pace {
    fn along(&self, item: &Item) -> Along {
        let by = PanTilt::from_fn(|j| item.by[j] as f64 * self.units[j]);
        let length = hypot(by.pan, by.tilt);
        let speed = |rate: &PanTilt<f64>| {
            let of = PanTilt::from_fn(|j| rate[j] * self.units[j] * TICKS_A_S);
            hypot(of.pan, of.tilt)
        };
        // as a board does it: no axis is asked for more than it can
        let most = |limit: &PanTilt<f64>| {
            let of = |by: f64, limit: f64| if by == 0.0 { f64::INFINITY } else { limit * length / by.abs() };
            of(by.pan, limit.pan).min(of(by.tilt, limit.tilt))
        };
        Along {
            length,
            time_s: f64::from(item.ticks) / TICKS_A_S,
            acceleration: most(&self.accelerations),
            most: most(&self.rates),
            speeds: (speed(&item.rates.0), speed(&item.rates.1)),
        }
    }

    /// The speed of a move, units/s, behind one of speed `before` (0 from rest), and before those that follow.
    pub(crate) fn speed<'a>(&self, before: f64, front: &Item, behind: impl Iterator<Item = &'a Item>) -> f64 {
        let front = self.along(front);
        if front.speeds_up() {
            return front.from(before);
        }
        // those that slow down with it, and how fast it is at their end
        let (mut slower, mut end) = (Vec::new(), None);
        for item in behind {
            if item.is_rest() {
                end = Some(0.0);
                break;
            }
            let along = self.along(item);
            if along.speeds_up() {
                end = Some(along.speeds.0);
                break;
            }
            slower.push(along);
        }
        let planned = slower.last().unwrap_or(&front).speeds.1;
        let end = slower.iter().rev().fold(end.unwrap_or(planned), |end, along| along.from(end));
        front.from(end)
    }

    /// The word of a move's feed in inverse time, 1/min.
    pub(crate) fn inverse_time(&self, item: &Item, speed: f64) -> f64 {
        const MINUTE_S: f64 = 60.0;
        MINUTE_S * speed / self.along(item).length
    }
}
