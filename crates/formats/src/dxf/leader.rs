//! LEADER, MULTILEADER and MLINE: lines that follow others.

use tracelight_stroke::{Path, Point, Vec2};

use super::groups::Record;
use super::skipped::Skipped;
use super::spline;
use crate::FormatError;
use crate::pen::polyline;

/// The line of a LEADER, straight or smooth, without its arrow.
///
/// # Errors
/// A point that is no number.
pub(super) fn leader(record: &Record) -> Result<Option<Path>, FormatError> {
    let points = record.points(10)?;
    Ok(match record.whole_or(72, 0)? {
        1 => spline::through(points, [Vec2::ZERO; 2], false),
        _ => polyline(&points, false),
    })
}

/// The lines of a MULTILEADER, each with the landing that all lead to, without arrows. Its text is counted.
///
/// # Errors
/// A point that is no number.
pub(super) fn multileader(record: &Record, skipped: &mut Skipped) -> Result<Vec<Path>, FormatError> {
    let mut found = Branches::default();
    for group in &record.groups {
        match (group.code, group.bytes()) {
            (302, b"LEADER{") => found.place = Place::Branch,
            (304, b"LEADER_LINE{") => {
                found.place = Place::Line;
                found.lines.push(Vec::new());
            }
            (305, b"}") => found.place = Place::Branch,
            (303, b"}") => found.end_branch(),
            (304, text) if !text.is_empty() => skipped.count(b"MULTILEADER text"),
            (10 | 20 | 11 | 21 | 40, _) => found.number(group.code, group.number()?),
            _ => {}
        }
    }
    Ok(found.paths)
}

/// Where in a MULTILEADER's groups the reader is.
#[derive(Clone, Copy, Default, PartialEq)]
enum Place {
    #[default]
    Outside,
    Branch,
    Line,
}

#[derive(Default)]
struct Branches {
    place: Place,
    /// Where the lines of the branch end.
    end: Option<Point>,
    /// Direction of the landing from there, and its length.
    landing: (Vec2, f64),
    lines: Vec<Vec<Point>>,
    paths: Vec<Path>,
}

impl Branches {
    fn number(&mut self, code: i32, value: f64) {
        match (self.place, code) {
            (Place::Branch, 10) => self.end = Some(Point::new(value, 0.0)),
            (Place::Branch, 20) => self.end.iter_mut().for_each(|end| end.y = value),
            (Place::Branch, 11) => self.landing.0.x = value,
            (Place::Branch, 21) => self.landing.0.y = value,
            (Place::Branch, 40) => self.landing.1 = value,
            (Place::Line, 10) => {
                self.lines.iter_mut().last().into_iter().for_each(|line| line.push(Point::new(value, 0.0)))
            }
            (Place::Line, 20) => {
                let last = self.lines.iter_mut().last().and_then(|line| line.last_mut());
                last.into_iter().for_each(|point| point.y = value);
            }
            _ => {}
        }
    }

    fn end_branch(&mut self) {
        let (direction, length) = std::mem::take(&mut self.landing);
        let end = self.end.take();
        let landing = end.map(|end| end + direction * length);
        for (i, mut line) in std::mem::take(&mut self.lines).into_iter().enumerate() {
            line.extend(end);
            // the first line takes the landing, the others end where it begins
            line.extend(landing.filter(|_| i == 0));
            self.paths.extend(polyline(&line, false));
        }
        self.place = Place::Outside;
    }
}

/// The lines of an MLINE, without caps and without the cuts that were made in it.
///
/// # Errors
/// A value that is no number.
pub(super) fn multiline(record: &Record) -> Result<Vec<Path>, FormatError> {
    const CLOSED: i64 = 2;
    let is_closed = record.whole_or(71, 0)? & CLOSED != 0;
    let mut vertices: Vec<(Point, Vec2, Vec<f64>)> = Vec::new();
    let mut is_first = false;
    for group in &record.groups {
        match (group.code, vertices.last_mut()) {
            (11, _) => vertices.push((Point::new(group.number()?, 0.0), Vec2::ZERO, Vec::new())),
            (21, Some(vertex)) => vertex.0.y = group.number()?,
            (13, Some(vertex)) => vertex.1.x = group.number()?,
            (23, Some(vertex)) => vertex.1.y = group.number()?,
            (74, _) => is_first = true,
            // the first parameter of each line is its distance along the mitre; others are cuts
            (41, Some(vertex)) if is_first => {
                vertex.2.push(group.number()?);
                is_first = false;
            }
            _ => {}
        }
    }
    const MOST_LINES: usize = 16; // AutoCAD's own bound
    let lines = vertices.iter().map(|v| v.2.len()).max().unwrap_or(0).min(MOST_LINES);
    let at = |i: usize| {
        let own =
            vertices.iter().filter_map(move |(point, mitre, along)| Some(*point + *mitre * *along.get(i)?));
        own.collect::<Vec<_>>()
    };
    Ok((0..lines).filter_map(|i| polyline(&at(i), is_closed)).collect())
}
