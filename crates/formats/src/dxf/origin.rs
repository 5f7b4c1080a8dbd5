//! Which entity of the file something is, so that it can be found there again.

use tracelight_stroke::Entity;

use super::groups::{At, Record};

/// Kinds of entities that are drawn.
const KINDS: [&str; 29] = [
    "LINE",
    "LWPOLYLINE",
    "POLYLINE",
    "ARC",
    "CIRCLE",
    "ELLIPSE",
    "SPLINE",
    "HELIX",
    "SOLID",
    "TRACE",
    "3DFACE",
    "MESH",
    "LEADER",
    "MULTILEADER",
    "MLEADER",
    "MLINE",
    "HATCH",
    "MPOLYGON",
    "INSERT",
    "DIMENSION",
    "ARC_DIMENSION",
    "LARGE_RADIAL_DIMENSION",
    "ACAD_TABLE",
    "TEXT",
    "MTEXT",
    "ATTRIB",
    "POINT",
    "SHAPE",
    "TOLERANCE",
];

/// An entity by its kind, handle and place in the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(super) struct Origin {
    kind: &'static str,
    handle: Option<u64>,
    line: Option<u32>,
}

impl Origin {
    /// The entity of a record.
    pub(super) fn of(record: &Record) -> Self {
        let kind = KINDS.iter().find(|kind| kind.as_bytes() == record.kind).copied().unwrap_or("entity");
        let line = match record.at {
            At::Line(line) => Some(line),
            At::Byte(_) => None,
        };
        Self {
            kind,
            handle: u64::from_str_radix(&record.text(5), 16).ok().filter(|&handle| handle > 0),
            line,
        }
    }

    /// The line of the file that it begins at, of one that is text.
    pub(super) const fn line(self) -> Option<u32> {
        self.line
    }

    /// Whether it is a block drawn in place, and no picture of a dimension or table.
    pub(super) fn is_insert(self) -> bool {
        self.kind == "INSERT"
    }

    /// As strokes say it, with so many more that are one stroke with it.
    pub(super) fn entity(self, more: usize) -> Entity {
        let id = self.handle.map(|handle| format!("{handle:X}").into());
        Entity { kind: self.kind.into(), id, line: self.line, more }
    }
}
