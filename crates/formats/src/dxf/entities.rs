//! Records to items: what each entity's groups mean.

use tracelight_maths::planar;
use tracelight_stroke::{Affine, Element, Path, Point, Vec2};

use super::curves::{has_length, moved, unit_arc, world_from_plane};
use super::groups::Record;
use super::scene::{Insert, Item, Layers, Look, Paint, Shape, Skipped};
use super::spline;
use super::text::Text;
use crate::FormatError;
use crate::circular::{arc_between, sweep_of_bulge};
use crate::pen::Pen;

/// Takes the entities of a block or of the model, one record after another.
#[derive(Default)]
pub(super) struct Entities {
    pub(super) items: Vec<Item>,
    /// Elements of the items so far.
    pub(super) elements: usize,
    /// A POLYLINE whose vertices follow.
    open: Option<Polyline>,
}

/// A point and the bulge of the way on from it.
type Vertex = (Point, f64);

struct Polyline {
    vertices: Vec<Vertex>,
    is_closed: bool,
    place: Affine,
    look: Look,
}

impl Entities {
    /// Takes one record; what is not drawn is counted.
    ///
    /// # Errors
    /// A value that cannot be meant.
    pub(super) fn take(
        &mut self,
        record: &Record,
        layers: &mut Layers,
        skipped: &mut Skipped,
    ) -> Result<(), FormatError> {
        if let (Some(open), b"VERTEX") = (&mut self.open, record.kind) {
            return open.take(record);
        }
        self.finish();
        match record.kind {
            b"SEQEND" | b"VERTEX" => return Ok(()),
            _ if record.whole_or(67, 0)? == 1 => skipped.in_paper_space += 1,
            _ if record.whole_or(60, 0)? == 1 => skipped.hidden += 1,
            _ => self.visible(record, layers, skipped)?,
        }
        Ok(())
    }

    /// Ends a POLYLINE that nobody ended.
    pub(super) fn finish(&mut self) {
        if let Some(open) = self.open.take() {
            self.push(open.path(), open.look);
        }
    }

    fn visible(
        &mut self,
        record: &Record,
        layers: &mut Layers,
        skipped: &mut Skipped,
    ) -> Result<(), FormatError> {
        let look = Look { layer: layers.numbered(&record.text(8)), paint: Paint::of(record)? };
        let path = match record.kind {
            b"LINE" => Path::polyline(&[record.point(10)?, record.point(11)?], false),
            b"LWPOLYLINE" => light_polyline(record)?,
            b"ARC" | b"CIRCLE" => Some(circle(record)?),
            b"ELLIPSE" => Some(ellipse(record)?),
            b"SPLINE" => spline::path(record)?,
            b"INSERT" => {
                self.items.push(Item::Insert(Box::new(insert(record, look)?)));
                return Ok(());
            }
            b"TEXT" | b"MTEXT" | b"ATTRIB" => {
                let text = Text::of(record, look)?.map(|text| Item::Text(Box::new(text)));
                self.elements += super::LEAST_ELEMENTS;
                self.items.extend(text);
                return Ok(());
            }
            b"POLYLINE" => {
                self.open = Polyline::of(record, look)?;
                if self.open.is_none() {
                    skipped.count(b"POLYLINE mesh");
                }
                return Ok(());
            }
            other => {
                skipped.count(other);
                return Ok(());
            }
        };
        self.push(path, look);
        Ok(())
    }

    fn push(&mut self, path: Option<Path>, look: Look) {
        if let Some(path) = path.filter(has_length) {
            self.elements += path.elements().len().max(super::LEAST_ELEMENTS);
            self.items.push(Item::Shape(Shape { path, look }));
        }
    }
}

/// An arc or a circle: a part of the unit circle, made larger and moved.
fn circle(record: &Record) -> Result<Path, FormatError> {
    let (centre, radius) = (record.point(10)?, record.number_or(40, 0.0)?);
    let angles = match record.kind {
        b"ARC" => [record.number_or(50, 0.0)?, record.number_or(51, 360.0)?].map(f64::to_radians),
        _ => [0.0, 0.0],
    };
    let place = world_from_plane(record, record.number_or(30, 0.0)?)?;
    let own = Affine::translate(centre.to_vec2()) * Affine::scale(radius.abs());
    Ok(moved(&unit_arc(angles[0], angles[1]), place * own))
}

/// An ellipse: a part of the unit circle under the map that makes its axes of the unit vectors. Its points are the
/// world's; its plane only says on which side the minor axis lies.
fn ellipse(record: &Record) -> Result<Path, FormatError> {
    let (centre, major) = (record.point(10)?.to_vec2(), record.point(11)?.to_vec2());
    let ratio = record.number_or(40, 1.0)?;
    let side = if record.number_or(230, 1.0)? < 0.0 { -1.0 } else { 1.0 };
    let minor = Vec2::new(-major.y, major.x) * (ratio * side);
    let arc = unit_arc(record.number_or(41, 0.0)?, record.number_or(42, std::f64::consts::TAU)?);
    Ok(moved(&arc, Affine::new([major.x, major.y, minor.x, minor.y, centre.x, centre.y])))
}

fn light_polyline(record: &Record) -> Result<Option<Path>, FormatError> {
    let mut vertices: Vec<Vertex> = Vec::new();
    for group in record.groups.iter().filter(|g| matches!(g.code, 10 | 20 | 42)) {
        let value = group.number()?;
        match (group.code, vertices.last_mut()) {
            (10, _) => vertices.push((Point::new(value, 0.0), 0.0)),
            (20, Some(last)) => last.0.y = value,
            (42, Some(last)) => last.1 = value,
            _ => {}
        }
    }
    let is_closed = record.whole_or(70, 0)? & 1 != 0;
    let place = world_from_plane(record, record.number_or(38, 0.0)?)?;
    Ok(through(&vertices, is_closed).map(|path| moved(&path, place)))
}

/// Lines and arcs from vertex to vertex.
fn through(vertices: &[Vertex], is_closed: bool) -> Option<Path> {
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

impl Polyline {
    /// Flags of a POLYLINE that is a mesh.
    const MESH: i64 = 16 | 64;
    /// Flag of one in space, whose points are the world's.
    const IN_SPACE: i64 = 8;
    /// Flag of a VERTEX that only shapes the spline and is not on it.
    const FRAME: i64 = 16;

    fn of(record: &Record, look: Look) -> Result<Option<Self>, FormatError> {
        let flags = record.whole_or(70, 0)?;
        let place = match flags & Self::IN_SPACE {
            0 => world_from_plane(record, record.number_or(30, 0.0)?)?,
            _ => Affine::IDENTITY,
        };
        let own = Self { vertices: Vec::new(), is_closed: flags & 1 != 0, place, look };
        Ok((flags & Self::MESH == 0).then_some(own))
    }

    fn take(&mut self, vertex: &Record) -> Result<(), FormatError> {
        if vertex.whole_or(70, 0)? & Self::FRAME == 0 {
            self.vertices.push((vertex.point(10)?, vertex.number_or(42, 0.0)?));
        }
        Ok(())
    }

    fn path(&self) -> Option<Path> {
        through(&self.vertices, self.is_closed).map(|path| moved(&path, self.place))
    }
}

fn insert(record: &Record, look: Look) -> Result<Insert, FormatError> {
    let scale = [record.number_or(41, 1.0)?, record.number_or(42, 1.0)?];
    let turn = planar::rotation(record.number_or(50, 0.0)?.to_radians());
    let world = world_from_plane(record, record.number_or(30, 0.0)?)?;
    let at = world * Affine::translate(record.point(10)?.to_vec2()) * turn;
    // spacings are measured along the turned axes, and are not scaled
    let step = |x: f64, y: f64| at * Point::new(x, y) - at * Point::ORIGIN;
    let count = |value: i64| u32::try_from(value.clamp(1, 1 << 20)).unwrap_or(1);
    Ok(Insert {
        block: record.key(2),
        place: at * Affine::scale_non_uniform(scale[0], scale[1]),
        steps: [step(record.number_or(44, 0.0)?, 0.0), step(0.0, record.number_or(45, 0.0)?)],
        columns: count(record.whole_or(70, 1)?),
        rows: count(record.whole_or(71, 1)?),
        look,
    })
}
