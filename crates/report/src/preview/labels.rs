//! Numbers of strokes, each beside its start where nothing else is drawn.

use std::collections::HashMap;
use std::fmt::Write;

use tracelight_chart::Theme;
use tracelight_maths::{cos, hypot, sin};
use tracelight_trajectory::{Plan, PlanPoint};

use super::frame::Frame;
use super::ways::Passed;

/// More strokes than this go without a number beside their start.
const NUMBERED: usize = 60;
/// Height of the letters and of a number, width of a digit, units.
const LETTERS: f64 = 18.0;
const HIGH: f64 = 16.0;
const DIGIT: f64 = 12.0;
/// Side of the cells in which what is drawn is counted.
const CELL: f64 = 4.0;
/// From a start to the nearer edge of its number, the nearest first; from the third on a line leads there.
const AWAY: [f64; 5] = [7.0, 12.0, 20.0, 34.0, 52.0];
const LED_FROM: f64 = 20.0;
const WAYS: usize = 16;
/// What a cell of the lit way, one of the dark way and a number below another cost.
const LIT: f64 = 10.0;
const DARK: f64 = 1.0;
const OVERLAP: f64 = 1e4;

/// A rectangle by its middle and half its size.
#[derive(Clone, Copy)]
struct Room {
    middle: (f64, f64),
    half: (f64, f64),
}

impl Room {
    fn overlaps(&self, other: &Self) -> bool {
        (self.middle.0 - other.middle.0).abs() < self.half.0 + other.half.0
            && (self.middle.1 - other.middle.1).abs() < self.half.1 + other.half.1
    }
}

/// What is drawn already: how dear each cell is.
struct Drawn(HashMap<(i64, i64), f64>);

impl Drawn {
    fn new(plan: &Plan, frame: &Frame, arrows: &[Passed]) -> Self {
        let mut cells = HashMap::new();
        let mut mark = |at: (f64, f64), cost: f64| {
            let cell: &mut f64 = cells.entry(cell(at)).or_default();
            *cell = cell.max(cost);
        };
        for p in &plan.points {
            mark(frame.at(p.spot), if p.lit { LIT } else { DARK });
        }
        for arrow in arrows {
            for (dx, dy) in [(0.0, 0.0), (CELL, CELL), (-CELL, CELL), (CELL, -CELL), (-CELL, -CELL)] {
                mark((arrow.at.0 + dx, arrow.at.1 + dy), LIT);
            }
        }
        Self(cells)
    }

    fn cost(&self, room: &Room) -> f64 {
        let (low, high) = (
            cell((room.middle.0 - room.half.0, room.middle.1 - room.half.1)),
            cell((room.middle.0 + room.half.0, room.middle.1 + room.half.1)),
        );
        let rows = (low.1..=high.1).flat_map(|y| (low.0..=high.0).map(move |x| (x, y)));
        rows.filter_map(|at| self.0.get(&at)).sum()
    }
}

fn cell((x, y): (f64, f64)) -> (i64, i64) {
    ((x / CELL).floor() as i64, (y / CELL).floor() as i64)
}

/// Each stroke's number at its start.
pub(super) fn numbers(svg: &mut String, plan: &Plan, frame: &Frame, arrows: &[Passed]) {
    // corners that are passed in the dark part a stroke: it has one number all the same
    let mut starts: Vec<&PlanPoint> = plan.points.iter().filter(|p| p.lit).collect();
    starts.dedup_by_key(|p| p.stroke);
    if starts.len() > NUMBERED {
        return;
    }
    let drawn = Drawn::new(plan, frame, arrows);
    // no number covers the dot of another
    let mut taken: Vec<Room> =
        starts.iter().map(|p| Room { middle: frame.at(p.spot), half: (5.0, 5.0) }).collect();
    for p in starts {
        let from = frame.at(p.spot);
        let number = p.stroke.map_or(0, |s| s + 1).to_string();
        let room = free(from, number.len(), &drawn, &taken);
        taken.push(room);
        write(svg, from, &room, &number);
    }
}

/// The room for a number that costs least.
fn free(from: (f64, f64), digits: usize, drawn: &Drawn, taken: &[Room]) -> Room {
    let half = (0.5 * DIGIT * digits as f64, 0.5 * HIGH);
    let mut best = (f64::INFINITY, Room { middle: from, half });
    for away in AWAY {
        for way in 0..WAYS {
            // upwards to the right first
            let angle = std::f64::consts::TAU * (way as f64 / WAYS as f64 - 0.125);
            let (u, v) = (cos(angle), sin(angle));
            let middle = (from.0 + u * (away + half.0), from.1 + v * (away + half.1));
            let room = Room { middle, half };
            let covers = taken.iter().filter(|other| room.overlaps(other)).count();
            let cost = drawn.cost(&room) + OVERLAP * covers as f64 + 0.3 * away;
            if cost < best.0 - 1e-9 {
                best = (cost, room);
            }
        }
    }
    best.1
}

fn write(svg: &mut String, from: (f64, f64), room: &Room, number: &str) {
    let (x, y) = room.middle;
    let gap = hypot((x - from.0).abs() - room.half.0, (y - from.1).abs() - room.half.1);
    if gap >= LED_FROM {
        let share = 1.0 - 0.9 * HIGH / hypot(x - from.0, y - from.1).max(HIGH);
        let (u, v) = (from.0 + share * (x - from.0), from.1 + share * (y - from.1));
        let soft = Theme::Light.soft();
        // writing to a String cannot fail
        let _ = writeln!(
            svg,
            r#"<path d="M{:.1} {:.1}L{u:.1} {v:.1}" stroke="{soft}" stroke-width="1"/>"#,
            from.0, from.1
        );
    }
    let _ = writeln!(
        svg,
        r#"<circle cx="{:.1}" cy="{:.1}" r="4"/><text x="{x:.1}" y="{:.1}" text-anchor="middle" font-size="{LETTERS}" stroke="{}" stroke-width="4" paint-order="stroke">{number}</text>"#,
        from.0,
        from.1,
        y + 0.36 * LETTERS,
        Theme::Light.ground()
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_stands_where_nothing_is_drawn() {
        let line = (0..400).map(|i| (cell((f64::from(i), 100.0)), LIT));
        let drawn = Drawn(line.collect());
        let mut taken = Vec::new();
        for k in 0..12 {
            let room = free((200.0 + f64::from(k), 100.0), 2, &drawn, &taken);
            assert!(!taken.iter().any(|other: &Room| room.overlaps(other)), "number {k}");
            assert!(drawn.cost(&room) == 0.0, "number {k} on the line");
            taken.push(room);
        }
    }
}
