//! LWPOLYLINE and POLYLINE: lines and arcs from vertex to vertex, and meshes of vertices.

use tracelight_stroke::{Affine, Element, Path, Point};

use super::curves::{moved, world_from_plane};
use super::groups::{Group, Record};
use super::look::Look;
use super::mesh::{edges, grid};
use crate::FormatError;
use crate::circular::{arc_between, sweep_of_bulge};
use crate::pen::Pen;

/// A point and the bulge of the way on from it.
pub(super) type Vertex = (Point, f64);

/// Vertices and bulges, as a LWPOLYLINE and the edge of a hatch have them.
///
/// # Errors
/// A value that is no number.
pub(super) fn vertices(groups: &[Group]) -> Result<Vec<Vertex>, FormatError> {
    let mut vertices: Vec<Vertex> = Vec::new();
    for group in groups.iter().filter(|g| matches!(g.code, 10 | 20 | 42)) {
        let value = group.number()?;
        match (group.code, vertices.last_mut()) {
            (10, _) => vertices.push((Point::new(value, 0.0), 0.0)),
            (20, Some(last)) => last.0.y = value,
            (42, Some(last)) => last.1 = value,
            _ => {}
        }
    }
    Ok(vertices)
}

/// The path of a LWPOLYLINE.
///
/// # Errors
/// A value that is no number.
pub(super) fn light(record: &Record) -> Result<Option<Path>, FormatError> {
    let vertices = vertices(&record.groups)?;
    let is_closed = record.whole_or(70, 0)? & 1 != 0;
    let place = world_from_plane(record, record.number_or(38, 0.0)?)?;
    Ok(through(&vertices, is_closed).map(|path| moved(&path, place)))
}

/// Lines and arcs from vertex to vertex.
pub(super) fn through(vertices: &[Vertex], is_closed: bool) -> Option<Path> {
    let (&(first, _), rest) = vertices.split_first()?;
    let mut pen = Pen::new(first);
    let back = is_closed.then_some(first);
    let ends = rest.iter().map(|v| v.0).chain(back);
    for (&(from, bulge), to) in vertices.iter().zip(ends) {
        pen.push(match bulge {
            0.0 => Element::Line { to },
            _ => arc_between(from, to, sweep_of_bulge(bulge)),
        });
    }
    pen.finish(is_closed)
}

/// A POLYLINE, its vertices taken one after another.
pub(super) struct Polyline {
    form: Form,
    vertices: Vec<Vertex>,
    /// Corners of each face, counted from 1; negative where the edge that begins there is invisible.
    faces: Vec<Vec<i64>>,
    place: Affine,
    pub(super) look: Look,
}

#[derive(Clone, Copy)]
enum Form {
    Course {
        is_closed: bool,
    },
    /// Rows and columns, and whether each of them is closed.
    Grid {
        size: [usize; 2],
        is_closed: [bool; 2],
    },
    Faces,
}

impl Polyline {
    /// Flag of one that is closed; of a mesh, along its columns.
    const CLOSED: i64 = 1;
    /// Flag of a mesh that is smoothed.
    const SMOOTH: i64 = 4;
    /// Flag of one in space, whose points are the world's.
    const IN_SPACE: i64 = 8;
    /// Flag of a mesh of rows and columns.
    const GRID: i64 = 16;
    /// Flag of a mesh that is closed along its rows.
    const ROWS_CLOSED: i64 = 32;
    /// Flag of a mesh of faces.
    const FACES: i64 = 64;
    /// Flag of a VERTEX that only shapes the spline and is not on it.
    const FRAME: i64 = 16;
    /// Flag of a VERTEX that is a face, unless it is a point of a mesh too.
    const FACE: i64 = 128;

    /// What a record POLYLINE says of the vertices that follow.
    ///
    /// # Errors
    /// A value that is no number.
    pub(super) fn of(record: &Record, look: Look) -> Result<Self, FormatError> {
        let flags = record.whole_or(70, 0)?;
        let has = |flag: i64| flags & flag != 0;
        let place = match has(Self::IN_SPACE | Self::GRID | Self::FACES) {
            false => world_from_plane(record, record.number_or(30, 0.0)?)?,
            true => Affine::IDENTITY,
        };
        let form = if has(Self::FACES) {
            Form::Faces
        } else if has(Self::GRID) {
            let codes = if has(Self::SMOOTH) { [73, 74] } else { [71, 72] };
            let size = |code: i32| record.whole_or(code, 0).map(|n| usize::try_from(n).unwrap_or(0));
            Form::Grid {
                size: [size(codes[0])?, size(codes[1])?],
                is_closed: [has(Self::CLOSED), has(Self::ROWS_CLOSED)],
            }
        } else {
            Form::Course { is_closed: has(Self::CLOSED) }
        };
        Ok(Self { form, vertices: Vec::new(), faces: Vec::new(), place, look })
    }

    /// Takes a VERTEX.
    ///
    /// # Errors
    /// A value that is no number.
    pub(super) fn take(&mut self, vertex: &Record) -> Result<(), FormatError> {
        let flags = vertex.whole_or(70, 0)?;
        if matches!(self.form, Form::Faces) && flags & Self::FACE != 0 && flags & Self::FACES == 0 {
            let corners = (71..=74).map(|code| vertex.whole_or(code, 0)).collect::<Result<Vec<_>, _>>()?;
            self.faces.push(corners.into_iter().filter(|&corner| corner != 0).collect());
        } else if flags & Self::FRAME == 0 {
            self.vertices.push((vertex.point(10)?, vertex.number_or(42, 0.0)?));
        }
        Ok(())
    }

    /// What its vertices make, in the world.
    pub(super) fn paths(&self) -> Vec<Path> {
        let points = || self.vertices.iter().map(|v| v.0).collect::<Vec<Point>>();
        match self.form {
            Form::Course { is_closed } => {
                through(&self.vertices, is_closed).map(|path| moved(&path, self.place)).into_iter().collect()
            }
            Form::Grid { size, is_closed } => grid(&points(), size, is_closed),
            Form::Faces => edges(&points(), self.faces.iter().map(Vec::as_slice)),
        }
    }
}
