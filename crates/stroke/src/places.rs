//! Places of a drawing that somebody may want to have marked.

use std::collections::HashMap;
use std::sync::Arc;

use kurbo::Point;

use crate::path::turn_rad;
use crate::{Colour, Drawing, Element, Entity, Path, Piece, Stroke};

/// Entities of a DXF whose lines may show a point.
const POINTS: [&str; 2] = ["POINT", "INSERT"];

/// Entities of drawing files whose ends and corners nobody marks: letters, patterns and measures.
const WITHOUT: [&str; 12] = [
    "TEXT",
    "MTEXT",
    "ATTRIB",
    "text",
    "HATCH",
    "MPOLYGON",
    "DIMENSION",
    "ARC_DIMENSION",
    "LARGE_RADIAL_DIMENSION",
    "ACAD_TABLE",
    "TOLERANCE",
    "LEADER",
];

/// What a place is. Where several are in one place, the first of these.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum PlaceKind {
    /// A point that the drawing file has.
    Point,
    /// Where a block is inserted.
    Block,
    /// The centre of a circle or an arc.
    Centre,
    /// A corner of a stroke.
    Corner,
    /// An end of an open stroke.
    End,
}

impl PlaceKind {
    /// Every kind.
    pub const ALL: [Self; 5] = [Self::Point, Self::Block, Self::Centre, Self::Corner, Self::End];

    /// Name of the kind.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Point => "point",
            Self::Block => "block",
            Self::Centre => "centre",
            Self::Corner => "corner",
            Self::End => "end",
        }
    }
}

/// A place of a drawing that somebody may want to have marked.
#[derive(Clone, Debug, PartialEq)]
pub struct Place {
    /// Where.
    pub at: Point,
    /// What is there.
    pub kind: PlaceKind,
    /// Name of the block that is inserted there.
    pub block: Option<Arc<str>>,
    /// Name of the layer that it lies on, where the drawing has layers.
    pub layer: Option<Arc<str>>,
    /// Colour that it has, where the drawing has colours.
    pub colour: Option<Colour>,
    /// What of a drawing file it comes from, where it comes from one.
    pub entity: Option<Arc<Entity>>,
}

impl Place {
    fn of(stroke: &Stroke, kind: PlaceKind, at: Point) -> Self {
        let Stroke { layer, colour, entity, .. } = stroke;
        Self { at, kind, block: None, layer: layer.clone(), colour: *colour, entity: entity.clone() }
    }

    /// Returns the place elsewhere.
    pub fn moved(&self, at: Point) -> Self {
        Self { at, ..self.clone() }
    }
}

/// Centres, corners and ends of a drawing's strokes, stroke by stroke. Corners bend by `corner_rad` or more. A stroke of a drawing file has the centres of
/// all its arcs; any other that of a whole circle alone, since what of a picture is an arc is chance. Letters, hatches and dimensions have none. A line of a point or
/// a block with one of the `known` points at its middle only shows it, and has no ends.
pub fn places(drawing: &Drawing, known: &[Place], corner_rad: f64) -> Vec<Place> {
    let points = known.iter().filter(|place| place.kind == PlaceKind::Point);
    let shown = Cells::of(points.map(|place| place.at), 1e-6 * size(drawing));
    let is_of = |stroke: &Stroke, kinds: &[&str]| {
        stroke.entity.as_ref().is_some_and(|entity| kinds.contains(&&*entity.kind))
    };
    let is_shown = |stroke: &Stroke| match stroke.path.elements() {
        [Element::Line { to }] if is_of(stroke, &POINTS) => shown.has_near(stroke.path.start().midpoint(*to)),
        _ => false,
    };
    let has_places = |stroke: &&Stroke| !is_shown(stroke) && !is_of(stroke, &WITHOUT);
    let mut found = Vec::new();
    for stroke in drawing.strokes.iter().filter(has_places) {
        let mut add = |kind, at| found.push(Place::of(stroke, kind, at));
        let path = &stroke.path;
        let centres = path.elements().iter().filter_map(|element| match element {
            Element::Arc { centre, .. } => Some(*centre),
            _ => None,
        });
        if stroke.entity.is_some() || is_circle(path) {
            centres.for_each(|centre| add(PlaceKind::Centre, centre));
        }
        if !path.is_closed() {
            add(PlaceKind::End, path.start());
        }
        let mut before = path.pieces().last().filter(|_| path.is_closed());
        for piece in path.pieces() {
            let turns = |before: Piece| turn_rad(before.end_tangent(), piece.start_tangent());
            if before.is_some_and(|before| turns(before) >= corner_rad) {
                add(PlaceKind::Corner, piece.from);
            }
            before = Some(piece);
        }
        if !path.is_closed() {
            add(PlaceKind::End, path.end());
        }
    }
    found
}

/// Whether a path is one whole circle.
fn is_circle(path: &Path) -> bool {
    let mut arcs = path.pieces().map(|piece| match piece.element {
        Element::Arc { centre, .. } => Some((centre, piece.from.distance(centre))),
        _ => None,
    });
    let Some(Some((centre, radius))) = arcs.next() else { return false };
    path.is_closed() && arcs.all(|arc| arc.is_some_and(|(other, _)| other.distance(centre) < 1e-3 * radius))
}

fn size(drawing: &Drawing) -> f64 {
    crate::extent(drawing).map_or(1.0, |bounds| bounds.width().max(bounds.height()))
}

/// Places that are at least so far from each other, in their order: of those that are nearer, the first kind stays.
pub fn places_apart(places: Vec<Place>, least: f64) -> Vec<Place> {
    let mut by_kind: Vec<usize> = (0..places.len()).collect();
    by_kind.sort_by_key(|&number| (places[number].kind, number));
    let mut cells = Cells::of([].into_iter(), least);
    let mut stays = vec![false; places.len()];
    for number in by_kind {
        let at = places[number].at;
        stays[number] = !cells.has_near(at);
        if stays[number] {
            cells.add(at);
        }
    }
    places.into_iter().zip(stays).filter_map(|(place, stays)| stays.then_some(place)).collect()
}

/// Points by the cells of a grid.
struct Cells {
    side: f64,
    points: HashMap<(i64, i64), Vec<Point>>,
}

impl Cells {
    fn of(points: impl Iterator<Item = Point>, side: f64) -> Self {
        let mut cells = Self { side: side.max(f64::MIN_POSITIVE), points: HashMap::new() };
        points.for_each(|point| cells.add(point));
        cells
    }

    fn cell(&self, point: Point) -> (i64, i64) {
        ((point.x / self.side).floor() as i64, (point.y / self.side).floor() as i64)
    }

    fn add(&mut self, point: Point) {
        self.points.entry(self.cell(point)).or_default().push(point);
    }

    /// Whether one is nearer than a side.
    fn has_near(&self, point: Point) -> bool {
        let (x, y) = self.cell(point);
        let near = (-1..=1).flat_map(|i| (-1..=1).map(move |j| (x.saturating_add(i), y.saturating_add(j))));
        near.filter_map(|cell| self.points.get(&cell)).flatten().any(|own| own.distance(point) < self.side)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn polyline(points: &[(f64, f64)], closed: bool) -> Stroke {
        let points: Vec<Point> = points.iter().copied().map(Point::from).collect();
        Stroke::new(Path::polyline(&points, closed).unwrap())
    }

    fn arc(start: (f64, f64), centre: (f64, f64), sweep: f64, closed: bool) -> Path {
        let mut path = Path::new(start.into());
        path.push(Element::Arc { centre: centre.into(), sweep });
        if closed {
            path.close();
        }
        path
    }

    fn found(strokes: Vec<Stroke>, known: &[Place]) -> Vec<(PlaceKind, f64, f64)> {
        let all = places(&Drawing { strokes }, known, 0.4);
        all.iter().map(|place| (place.kind, place.at.x, place.at.y)).collect()
    }

    fn known(kind: PlaceKind, at: (f64, f64)) -> Place {
        Place { kind, ..Place::of(&polyline(&[(0.0, 0.0), (1.0, 0.0)], false), kind, at.into()) }
    }

    #[test]
    fn corners_ends_and_centres_are_found() {
        use PlaceKind::{Centre, Corner, End};
        // a right angle, and a bend of 0.1 rad that is none
        let open = polyline(&[(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (9.0, 20.0)], false);
        assert_eq!(found(vec![open], &[]), [(End, 0.0, 0.0), (Corner, 10.0, 0.0), (End, 9.0, 20.0)]);
        let square = polyline(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)], true);
        assert_eq!(found(vec![square], &[]).len(), 4);
        let circle = Stroke::new(arc((2.0, 0.0), (1.0, 0.0), std::f64::consts::TAU, true));
        assert_eq!(found(vec![circle], &[]), [(Centre, 1.0, 0.0)]);
        let part = Stroke::new(arc((2.0, 0.0), (1.0, 0.0), 1.0, false));
        assert!(found(vec![part.clone()], &[]).iter().all(|(kind, ..)| *kind == End), "chance in a picture");
        let entity = Entity { kind: "ARC".into(), id: None, line: None, more: 0 };
        let drawn = Stroke { entity: Some(Arc::new(entity)), ..part };
        assert_eq!(found(vec![drawn], &[])[0], (Centre, 1.0, 0.0));
    }

    #[test]
    fn a_line_that_shows_a_point_has_no_ends() {
        let line = polyline(&[(9.0, 5.0), (11.0, 5.0)], false);
        assert_eq!(
            found(vec![line.clone()], &[known(PlaceKind::Point, (10.0, 5.0))]).len(),
            2,
            "a line of its own"
        );
        let entity = |kind: &str| Some(Arc::new(Entity { kind: kind.into(), id: None, line: None, more: 0 }));
        assert_eq!(found(vec![Stroke { entity: entity("MTEXT"), ..line.clone() }], &[]), []);
        let dash = Stroke { entity: entity("POINT"), ..line };
        assert_eq!(found(vec![dash.clone()], &[known(PlaceKind::Point, (10.0, 5.0))]), []);
        assert_eq!(found(vec![dash], &[known(PlaceKind::Block, (10.0, 5.0))]).len(), 2);
    }

    #[test]
    fn of_places_that_are_one_the_first_kind_stays() {
        use PlaceKind::{Block, Corner, End};
        let all = [(End, 0.0), (Corner, 1e-4), (Block, 5.0), (End, 5.0005), (End, 5.002)];
        let all = all.map(|(kind, x)| known(kind, (x, 0.0))).to_vec();
        let left: Vec<_> = places_apart(all, 1e-3).iter().map(|place| (place.kind, place.at.x)).collect();
        assert_eq!(left, [(Corner, 1e-4), (Block, 5.0), (End, 5.002)]);
    }
}
