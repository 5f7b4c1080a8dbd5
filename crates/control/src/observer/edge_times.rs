use tracelight_rig::{Measurement, TICK_S};

use super::config::LONGEST_INTERVAL_TICKS;
use super::past::Past;
use crate::estimate::Estimate;
use crate::limit::within;

/// Edges gained, over the time between the first of them and the last: the M/T method (Ohmae et al., *A
/// Microprocessor-Controlled High-Accuracy Wide-Range Speed Regulator for Motor Drives*, IEEE Trans. Ind. Electron.
/// 29, 1982).
///
/// As exact as the edges are placed and stamped, whatever the speed; without stamps an edge is taken to have come in the
/// middle of its tick. Where the interval holds no edge the last velocity stays, but never more than would have
/// brought another edge by now.
#[derive(Clone, Copy, Debug)]
pub(super) struct EdgeTimes {
    count: i32,
    /// The last edge as each tick knew it.
    edges: Past<Edge>,
    /// Counts a tick.
    rates: Past<f32>,
    interval: usize,
}

/// An edge and when it came.
#[derive(Clone, Copy, Debug)]
struct Edge {
    /// Twice its place in counts: edges lie halfway between.
    halves: i32,
    age_ticks: f32,
}

impl EdgeTimes {
    pub(super) fn at_rest(count: i32, interval_ticks: usize) -> Self {
        // long ago, in the middle of the count: the first real edge makes no speed of it
        let edge = Edge { halves: count.wrapping_mul(2), age_ticks: 1e6 };
        Self {
            count,
            edges: Past::constant(edge),
            rates: Past::constant(0.0),
            interval: interval_ticks.clamp(1, LONGEST_INTERVAL_TICKS),
        }
    }

    pub(super) fn tick(&mut self, measured: &Measurement) {
        let moved = measured.count.wrapping_sub(self.count);
        self.count = measured.count;
        let last = self.edges.ago(0);
        let edge = if moved == 0 {
            Edge { age_ticks: last.age_ticks + 1.0, ..last }
        } else {
            // the last edge crossed is the one on the side it came from; unstamped, in the last of the tick's parts
            let halves = measured.count.wrapping_mul(2).wrapping_sub(moved.signum());
            let age = measured.edge_age_ticks.unwrap_or(0.5 / moved.unsigned_abs() as f32);
            Edge { halves, age_ticks: age }
        };
        self.edges.push(edge);
        self.rates.push(self.rate(&edge));
    }

    fn rate(&self, edge: &Edge) -> f32 {
        let base = self.edges.ago(self.interval);
        let gained = 0.5 * edge.halves.wrapping_sub(base.halves) as f32;
        let time = base.age_ticks + self.interval as f32 - edge.age_ticks;
        let rate = if time > 1e-3 { gained / time } else { self.rates.ago(0) };
        within(rate, 1.0 / edge.age_ticks.max(1e-9))
    }

    pub(super) fn estimate(&self, count_rad: f32) -> Estimate {
        let (edge, rate) = (self.edges.ago(0), self.rates.ago(0));
        let since = rate * edge.age_ticks;
        let from_centre = 0.5 * edge.halves.wrapping_sub(self.count.wrapping_mul(2)) as f32 + since;
        let change = (rate - self.rates.ago(self.interval)) / self.interval as f32;
        Estimate {
            position_rad: (self.count as f32 + within(from_centre, 0.5)) * count_rad,
            velocity_rad_s: rate * count_rad / TICK_S,
            acceleration_rad_s2: change * count_rad / (TICK_S * TICK_S),
            ..Estimate::default()
        }
    }
}
