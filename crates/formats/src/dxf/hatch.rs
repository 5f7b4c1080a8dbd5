//! HATCH and MPOLYGON: the edges of an area, and the lines of its pattern.

use tracelight_stroke::{Affine, Path, Point, Vec2};

use super::curves::{moved, unit_arc, world_from_plane};
use super::groups::{Group, Record};
use super::pattern::{self, Family};
use super::polyline::{through, vertices};
use super::skipped::Skipped;
use super::spline;
use crate::FormatError;
use crate::pen::polyline;

/// Flags of an edge: a polyline, and the box round a text that is left out.
const POLYLINE: i64 = 2;
const TEXT_BOX: i64 = 8;

/// The edges, and the pattern if that is asked for by the crossings that are left for it; `None` for a hatch without
/// edges.
///
/// # Errors
/// A value that is no number, a spline that makes no sense.
pub(super) fn paths(
    record: &Record,
    patterns: &mut Option<usize>,
    skipped: &mut Skipped,
) -> Result<Option<Vec<Path>>, FormatError> {
    let loops = loops(record)?;
    if loops.is_empty() {
        return Ok(None);
    }
    let place = world_from_plane(record, record.number_or(30, 0.0)?)?;
    let is_solid = record.whole_or(70, 0)? == 1;
    let mut lines = Vec::new();
    if let (Some(left), false) = (patterns, is_solid) {
        match pattern::lines(&loops, &families(record)?, left) {
            Some(found) => lines = found,
            None => skipped.too_dense += 1,
        }
    }
    Ok(Some(loops.iter().chain(&lines).map(|path| moved(path, place)).collect()))
}

/// The edges in the hatch's plane.
fn loops(record: &Record) -> Result<Vec<Path>, FormatError> {
    // what follows the last edge begins with the hatch's style
    let end = record.groups.iter().position(|g| g.code == 75).unwrap_or(record.groups.len());
    let groups = &record.groups[..end];
    let begins: Vec<usize> = (0..groups.len()).filter(|&i| groups[i].code == 92).collect();
    let mut loops = Vec::new();
    for (i, &begin) in begins.iter().enumerate() {
        let own = &groups[begin..begins.get(i + 1).copied().unwrap_or(groups.len())];
        let flags = own[0].whole()?;
        match flags {
            _ if flags & TEXT_BOX != 0 => {}
            _ if flags & POLYLINE != 0 => loops.extend(course(own)?),
            _ => loops.extend(chained(edges(record, own)?)),
        }
    }
    Ok(loops)
}

/// An edge of vertices and bulges.
fn course(groups: &[Group]) -> Result<Option<Path>, FormatError> {
    // an area's edge is closed, whatever its flag says
    Ok(through(&vertices(groups)?, true))
}

/// The pieces of an edge, each as it stands.
fn edges(record: &Record, groups: &[Group]) -> Result<Vec<Path>, FormatError> {
    let begins: Vec<usize> = (0..groups.len()).filter(|&i| groups[i].code == 72).collect();
    let mut paths = Vec::new();
    for (i, &begin) in begins.iter().enumerate() {
        let own = &groups[begin..begins.get(i + 1).copied().unwrap_or(groups.len())];
        let own = Record { kind: record.kind, groups: own.to_vec(), at: record.at };
        paths.extend(match own.whole_or(72, 0)? {
            1 => polyline(&[own.point(10)?, own.point(11)?], false),
            2 => Some(arc(&own)?),
            3 => Some(ellipse(&own)?),
            4 => edge_spline(&own)?,
            _ => None,
        });
    }
    Ok(paths)
}

/// The angles of an arc, anticlockwise; those of a clockwise one are measured clockwise.
fn angles(edge: &Record) -> Result<[f64; 2], FormatError> {
    let [from, to] = [edge.number_or(50, 0.0)?, edge.number_or(51, 360.0)?].map(f64::to_radians);
    Ok(if edge.whole_or(73, 1)? == 0 { [-to, -from] } else { [from, to] })
}

fn arc(edge: &Record) -> Result<Path, FormatError> {
    let [from, to] = angles(edge)?;
    let place = Affine::translate(edge.point(10)?.to_vec2()) * Affine::scale(edge.number_or(40, 0.0)?.abs());
    Ok(moved(&unit_arc(from, to), place))
}

fn ellipse(edge: &Record) -> Result<Path, FormatError> {
    let (centre, major) = (edge.point(10)?, edge.point(11)?.to_vec2());
    let minor = Vec2::new(-major.y, major.x) * edge.number_or(40, 1.0)?;
    let [from, to] = angles(edge)?;
    let place = Affine::new([major.x, major.y, minor.x, minor.y, centre.x, centre.y]);
    Ok(moved(&unit_arc(from, to), place))
}

/// A spline as an edge: its codes are a SPLINE's, but for the degree and the weights.
fn edge_spline(edge: &Record) -> Result<Option<Path>, FormatError> {
    let as_spline = |group: &Group<'_>| match group.code {
        94 => Some(71),
        42 => Some(41),
        10 | 20 | 11 | 21 | 12 | 22 | 13 | 23 | 40 => Some(group.code),
        _ => None,
    };
    let mut groups = Vec::new();
    for group in &edge.groups {
        groups.extend(as_spline(group).map(|code| Group { code, ..*group }));
    }
    spline::path(&Record { kind: edge.kind, groups, at: edge.at })
}

/// Edges that follow each other as one path, whichever way round each is.
fn chained(edges: Vec<Path>) -> Vec<Path> {
    const NEAR: f64 = 1e-6;
    let points = || edges.iter().flat_map(|e| [e.start(), e.end()]);
    let size = points().zip(points().skip(1)).map(|(a, b)| a.distance(b)).fold(0.0, f64::max);
    let near = |a: Point, b: Point| a.distance(b) <= NEAR * size;
    let mut chains: Vec<Path> = Vec::new();
    let mut rest = edges.into_iter().peekable();
    while let Some(edge) = rest.next() {
        if edge.is_closed() {
            chains.push(edge);
            continue;
        }
        // the first one goes towards the second
        let ahead = rest.peek().map(|next| [next.start(), next.end()]);
        let turn = ahead.is_some_and(|ends| {
            let reaches = |p: Point| ends.iter().any(|&end| near(p, end));
            !reaches(edge.end()) && reaches(edge.start())
        });
        let mut chain = if turn { edge.reversed() } else { edge };
        while let Some(next) = rest.next_if(|next| {
            !next.is_closed() && (near(next.start(), chain.end()) || near(next.end(), chain.end()))
        }) {
            let next = if near(next.start(), chain.end()) { next } else { next.reversed() };
            next.elements().iter().for_each(|&element| chain.push(element));
            if near(chain.end(), chain.start()) {
                break;
            }
        }
        if near(chain.end(), chain.start()) {
            chain.close();
        }
        chains.push(chain);
    }
    chains
}

/// The families of lines of the pattern, as the file has them: scaled and turned.
fn families(record: &Record) -> Result<Vec<Family>, FormatError> {
    let begin = record.groups.iter().position(|g| g.code == 78).unwrap_or(record.groups.len());
    let mut families: Vec<Family> = Vec::new();
    for group in &record.groups[begin..] {
        match (group.code, families.last_mut()) {
            (53, _) => families.push(Family::at_angle(group.number()?.to_radians())),
            (43, Some(family)) => family.base.x = group.number()?,
            (44, Some(family)) => family.base.y = group.number()?,
            (45, Some(family)) => family.offset.x = group.number()?,
            (46, Some(family)) => family.offset.y = group.number()?,
            (49, Some(family)) => family.dashes.push(group.number()?),
            (98, _) => break,
            _ => {}
        }
    }
    Ok(families)
}
