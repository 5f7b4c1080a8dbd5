//! Detects a pencil that turns at a line's end and returns beside it.

use tracelight_image::Plane;

use super::place::{is_beside, places, ways};
use super::sketch::{APART_PENS, ENDS, Sketch};
use crate::near::Near;
use crate::row::Row;

/// The rows of which those that turn back beside themselves end where they turn.
pub(super) fn folded(dark: &Plane<u8>, rows: Vec<Row>, pen: f64) -> Vec<Row> {
    rows.into_iter().flat_map(|row| fold(dark, &row, pen).unwrap_or_else(|| vec![row])).collect()
}

/// A row that is parted where it turns back, if what goes and what comes back are passes of one line.
fn fold(dark: &Plane<u8>, row: &Row, pen: f64) -> Option<Vec<Row>> {
    turns(row, APART_PENS * pen).into_iter().find_map(|turn| {
        let part = |from: usize, to: usize| Row { points: row.points[from..=to].to_vec(), ..row.clone() };
        let mut parts = vec![
            Row { free: [row.free[0], true], ..part(0, turn) },
            Row { free: [true, row.free[1]], ..part(turn, row.points.len() - 1) },
        ];
        let run = Sketch::of(dark, &parts, pen).runs().into_iter().find(|run| !run.stays)?;
        run.merge(dark, &mut parts, APART_PENS * pen);
        parts.retain(|part| part.points.len() > 1);
        Some(parts)
    })
}

/// Where an open row turns back so sharply that it is beside itself before and behind.
fn turns(row: &Row, apart: f64) -> Vec<usize> {
    if row.closed || row.dot || row.points.len() < 3 {
        return Vec::new();
    }
    let way = ways(&row.points);
    let near = Near::of(places(0, row).map(|place| (row.points[place.number], place)), apart);
    // (how far it is from a place to the one beside it, the place between)
    let mut pairs: Vec<(f64, usize)> = Vec::new();
    for place in places(0, row) {
        let at = row.points[place.number];
        let beside = near.around(at).filter(|(p, q)| is_beside((at, place.way), (*p, q.way)));
        let round = beside.map(|(_, q)| (way[q.number] - way[place.number], (q.number + place.number) / 2));
        pairs.extend(round.filter(|(round, _)| (apart..2.0 * ENDS * apart).contains(round)));
    }
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut found: Vec<usize> = Vec::new();
    for (_, turn) in pairs {
        if found.iter().all(|&known| (way[known] - way[turn]).abs() > ENDS * apart) {
            found.push(turn);
        }
    }
    found
}
