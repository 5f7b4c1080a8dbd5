//! Faces and meshes: their edges, seen from above.

use std::collections::HashSet;

use tracelight_stroke::{Path, Point};

use super::curves::{moved, world_from_plane};
use super::groups::Record;
use crate::FormatError;
use crate::pen::polyline;

/// The outline of a SOLID or TRACE, whose third and fourth corner are crossed.
///
/// # Errors
/// A corner that is no number.
pub(super) fn solid(record: &Record) -> Result<Option<Path>, FormatError> {
    let third = record.point(12)?;
    let fourth = if record.has(13) { record.point(13)? } else { third };
    let corners = [record.point(10)?, record.point(11)?, fourth, third];
    let place = world_from_plane(record, record.number_or(30, 0.0)?)?;
    Ok(polyline(&corners, true).map(|path| moved(&path, place)))
}

/// The edges of a 3DFACE that are not marked as invisible.
///
/// # Errors
/// A corner or flag that is no number.
pub(super) fn face(record: &Record) -> Result<Vec<Path>, FormatError> {
    let third = record.point(12)?;
    let fourth = if record.has(13) { record.point(13)? } else { third };
    let corners = [record.point(10)?, record.point(11)?, third, fourth];
    let invisible = record.whole_or(70, 0)?;
    let signed = |i: i64| if invisible >> (i - 1) & 1 != 0 { -i } else { i };
    if invisible & 15 == 0 {
        return Ok(polyline(&corners, true).into_iter().collect());
    }
    Ok(edges(&corners, std::iter::once([1, 2, 3, 4].map(signed).as_slice())))
}

/// The rows and columns of a mesh, `size` of them, each closed or not: the columns' closing first.
pub(super) fn grid(points: &[Point], [rows, columns]: [usize; 2], is_closed: [bool; 2]) -> Vec<Path> {
    // a mesh that is not complete is drawn as far as it goes
    let rows = rows.min(points.len().checked_div(columns).unwrap_or(0));
    if rows == 0 {
        return Vec::new();
    }
    let row = |i: usize| points[i * columns..(i + 1) * columns].to_vec();
    let column = |j: usize| (0..rows).map(|i| points[i * columns + j]).collect::<Vec<_>>();
    let along_rows = (0..rows).filter_map(|i| polyline(&row(i), is_closed[1]));
    let along_columns = (0..columns).filter_map(|j| polyline(&column(j), is_closed[0]));
    along_rows.chain(along_columns).collect()
}

/// Each edge of faces once, as seen from above. Corners are counted from 1, and negative where the edge that begins
/// there is invisible.
pub(super) fn edges<'f>(points: &[Point], faces: impl Iterator<Item = &'f [i64]>) -> Vec<Path> {
    let corner =
        |index: i64| points.get(usize::try_from(index.unsigned_abs()).ok()?.checked_sub(1)?).copied();
    let key = |p: Point| (p.x.to_bits(), p.y.to_bits());
    let mut seen = HashSet::new();
    let mut paths = Vec::new();
    for face in faces {
        for (i, &from) in face.iter().enumerate() {
            let to = face[(i + 1) % face.len()];
            let (Some(a), Some(b)) = (corner(from), corner(to)) else { continue };
            let edge = (key(a).min(key(b)), key(a).max(key(b)));
            if from > 0 && a != b && seen.insert(edge) {
                paths.extend(Path::polyline(&[a, b], false));
            }
        }
    }
    paths
}

/// The edges of a MESH as it is before it is smoothed.
///
/// # Errors
/// A value that is no number.
pub(super) fn mesh(record: &Record) -> Result<Vec<Path>, FormatError> {
    let points = record.points(10)?;
    let begin = record.groups.iter().position(|g| g.code == 93).map_or(record.groups.len(), |i| i + 1);
    let list = record.groups[begin..].iter().take_while(|g| g.code == 90);
    let list = list.map(|g| g.whole()).collect::<Result<Vec<_>, _>>()?;
    let mut faces: Vec<Vec<i64>> = Vec::new();
    let mut rest = list.as_slice();
    while let Some((&count, after)) = rest.split_first() {
        let count = usize::try_from(count).unwrap_or(0).min(after.len());
        let (own, after) = after.split_at(count);
        faces.push(own.iter().filter(|&&i| i >= 0).map(|&i| i.saturating_add(1)).collect());
        rest = after;
    }
    Ok(edges(&points, faces.iter().map(Vec::as_slice)))
}
