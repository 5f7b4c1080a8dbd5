//! Where light fell along the lines of a plan.

#![allow(dead_code, reason = "each test takes what it needs")]

use std::collections::HashMap;

use tracelight_stroke::Point;
use tracelight_trajectory::Plan;

/// Places on the lines that are looked at, m apart.
const STEP_M: f64 = 5e-5;
/// Side of the squares by which places are found, m; further than that light is not from its line.
const CELL_M: f64 = 2e-3;

/// Places along the lines of a plan, found by where they are.
pub(crate) struct Lines {
    /// Each with the tick of the plan.
    places: Vec<(Point, u32)>,
    cells: HashMap<(i64, i64), Vec<usize>>,
}

fn cell(p: Point) -> (i64, i64) {
    ((p.x / CELL_M).floor() as i64, (p.y / CELL_M).floor() as i64)
}

impl Lines {
    pub(crate) fn of(plan: &Plan) -> Self {
        let mut places: Vec<(Point, u32)> = Vec::new();
        let lit =
            (0_u32..).zip(plan.points.windows(2)).filter(|(_, pair)| pair.iter().all(|point| point.lit));
        for (tick, pair) in lit {
            let (from, to) = (pair[0].spot, pair[1].spot);
            let steps = (from.distance(to) / STEP_M).ceil();
            for place in (0..steps as usize).map(|k| from.lerp(to, k as f64 / steps)) {
                // where it is slow, ticks are nearer to each other
                if places.last().is_none_or(|(last, _)| last.distance(place) >= 0.9 * STEP_M) {
                    places.push((place, tick));
                }
            }
        }
        let mut cells: HashMap<_, Vec<usize>> = HashMap::new();
        for (number, (place, _)) in places.iter().enumerate() {
            cells.entry(cell(*place)).or_default().push(number);
        }
        Self { places, cells }
    }

    pub(crate) fn len(&self) -> usize {
        self.places.len()
    }

    /// At which tick of the plan a place is lit.
    pub(crate) fn tick(&self, place: usize) -> u32 {
        self.places[place].1
    }

    /// Which places light passed as near as that, m.
    pub(crate) fn passed(&self, lit: &[[Point; 2]], near_m: f64) -> Vec<bool> {
        let mut passed = vec![false; self.places.len()];
        for &[from, to] in lit {
            let way = to - from;
            let length_m = way.hypot();
            let (x, y) = cell(from.midpoint(to));
            let near = (-1..=1).flat_map(|dx| (-1..=1).map(move |dy| (x + dx, y + dy)));
            for &number in near.filter_map(|at| self.cells.get(&at)).flatten() {
                let off = self.places[number].0 - from;
                let along_m = off.dot(way) / length_m.max(1e-9);
                let is_beside = (-STEP_M..=length_m + STEP_M).contains(&along_m);
                passed[number] |= is_beside && (off - way * (along_m / length_m.max(1e-9))).hypot() < near_m;
            }
        }
        passed
    }
}

/// Longest row of places of that kind, mm.
pub(crate) fn longest_mm(places: impl Iterator<Item = bool>) -> f64 {
    let (mut row, mut longest) = (0_u32, 0);
    for is in places {
        row = if is { row + 1 } else { 0 };
        longest = longest.max(row);
    }
    f64::from(longest) * STEP_M * 1e3
}
