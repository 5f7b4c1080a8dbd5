//! Records to items: what each entity's groups mean.

use tracelight_maths::planar;
use tracelight_stroke::{Affine, Path, Point, Vec2};

use super::curves::{has_length, moved, unit_arc, world_from_plane};
use super::groups::Record;
use super::hatch;
use super::leader;
use super::linetype::Lines;
use super::look::{Layers, Look, Shape};
use super::mesh;
use super::polyline::{self, Polyline};
use super::scene::{Dot, Insert, Item};
use super::skipped::Skipped;
use super::spline;
use super::text::Text;
use crate::FormatError;

/// Takes the entities of a block or of a space, one record after another.
#[derive(Default)]
pub(super) struct Entities {
    pub(super) items: Vec<Item>,
    /// Elements of the items so far.
    pub(super) elements: usize,
    /// A POLYLINE whose vertices follow.
    open: Option<Polyline>,
}

/// What entities refer to, and what is asked of them.
pub(super) struct Around<'a> {
    pub(super) layers: &'a mut Layers,
    pub(super) lines: &'a mut Lines,
    pub(super) skipped: &'a mut Skipped,
    /// Crossings that are left for the patterns of hatches, if these are asked for.
    pub(super) patterns: &'a mut Option<usize>,
}

impl Entities {
    /// Takes one record; what is not drawn is counted.
    ///
    /// # Errors
    /// A value that cannot be meant.
    pub(super) fn take(&mut self, record: &Record, around: &mut Around) -> Result<(), FormatError> {
        if let (Some(open), b"VERTEX") = (&mut self.open, record.kind) {
            return open.take(record);
        }
        self.finish(around.skipped);
        match record.kind {
            b"SEQEND" | b"VERTEX" | b"VIEWPORT" => return Ok(()),
            _ if record.whole_or(60, 0)? == 1 => around.skipped.hidden += 1,
            _ => self.visible(record, around)?,
        }
        Ok(())
    }

    /// Ends a POLYLINE that nobody ended.
    pub(super) fn finish(&mut self, skipped: &mut Skipped) {
        if let Some(open) = self.open.take() {
            self.push(open.paths(), open.look, skipped);
        }
    }

    fn visible(&mut self, record: &Record, around: &mut Around) -> Result<(), FormatError> {
        let look = Look::of(record, around.layers, around.lines)?;
        let paths = match record.kind {
            b"LINE" => one(Path::polyline(&[record.point(10)?, record.point(11)?], false)),
            b"LWPOLYLINE" => one(polyline::light(record)?),
            b"ARC" | b"CIRCLE" => vec![circle(record)?],
            b"ELLIPSE" => vec![ellipse(record)?],
            b"SPLINE" => one(spline::path(record)?),
            b"HELIX" => one(helix(record)?),
            b"SOLID" | b"TRACE" => one(mesh::solid(record)?),
            b"3DFACE" => mesh::face(record)?,
            b"MESH" => mesh::mesh(record)?,
            b"LEADER" => one(leader::leader(record)?),
            b"MULTILEADER" | b"MLEADER" => leader::multileader(record, around.skipped)?,
            b"MLINE" => leader::multiline(record)?,
            b"HATCH" | b"MPOLYGON" => match hatch::paths(record, around.patterns, around.skipped)? {
                Some(paths) => paths,
                None => {
                    around.skipped.count(record.kind);
                    return Ok(());
                }
            },
            b"POLYLINE" => {
                self.open = Some(Polyline::of(record, look)?);
                return Ok(());
            }
            _ => return self.other(record, look, around.skipped),
        };
        self.push(paths, look, around.skipped);
        Ok(())
    }

    /// What is no path.
    fn other(&mut self, record: &Record, look: Look, skipped: &mut Skipped) -> Result<(), FormatError> {
        let has_block = !record.key(2).is_empty();
        let item = match record.kind {
            b"INSERT" => Item::Insert(Box::new(insert(record, look)?)),
            b"DIMENSION" | b"ARC_DIMENSION" | b"LARGE_RADIAL_DIMENSION" if has_block => {
                Item::Insert(Box::new(picture(record, look, record.point(12)?)?))
            }
            b"ACAD_TABLE" if has_block => Item::Insert(Box::new(picture(record, look, record.point(10)?)?)),
            b"TEXT" | b"MTEXT" | b"ATTRIB" => {
                let Some(text) = Text::of(record, look)? else { return Ok(()) };
                self.elements += super::LEAST_ELEMENTS;
                Item::Text(Box::new(text))
            }
            b"POINT" if record.key(8) == "defpoints" => {
                skipped.unprinted += 1;
                return Ok(());
            }
            b"POINT" => Item::Dot(Dot { at: record.point(10)?, look }),
            kind => {
                skipped.count(kind);
                return Ok(());
            }
        };
        self.items.push(item);
        Ok(())
    }

    fn push(&mut self, paths: Vec<Path>, look: Look, skipped: &mut Skipped) {
        let before = self.items.len();
        for path in paths.into_iter().filter(has_length) {
            self.elements += path.elements().len().max(super::LEAST_ELEMENTS);
            self.items.push(Item::Shape(Shape { path, look }));
        }
        if self.items.len() == before {
            skipped.without_length += 1;
        }
    }
}

fn one(path: Option<Path>) -> Vec<Path> {
    path.into_iter().collect()
}

/// A helix by the spline that stands before its axis.
fn helix(record: &Record) -> Result<Option<Path>, FormatError> {
    let spline =
        record.groups.split(|g| g.code == 100 && g.bytes() == b"AcDbHelix").next().unwrap_or_default();
    spline::path(&Record { kind: record.kind, groups: spline.to_vec(), at: record.at })
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
        name: record.text(2).into(),
        place: at * Affine::scale_non_uniform(scale[0], scale[1]),
        steps: [step(record.number_or(44, 0.0)?, 0.0), step(0.0, record.number_or(45, 0.0)?)],
        columns: count(record.whole_or(70, 1)?),
        rows: count(record.whole_or(71, 1)?),
        look,
    })
}

/// The block that holds the picture of a dimension or a table, drawn as it is.
fn picture(record: &Record, look: Look, to: Point) -> Result<Insert, FormatError> {
    let world = world_from_plane(record, 0.0)?;
    Ok(Insert {
        block: record.key(2),
        name: record.text(2).into(),
        place: world * Affine::translate(to.to_vec2()),
        steps: [Vec2::ZERO; 2],
        columns: 1,
        rows: 1,
        look,
    })
}
