//! Places of a drawing, each marked on the target by a cross.

use std::f64::consts::TAU;
use std::str::FromStr;

use tracelight_stroke::{
    Drawing, Element, Path, Place, PlaceKind, Point, Stroke, Vec2, by_layer, places, places_apart,
};
use tracelight_task::{Failure, counted};
use tracelight_units::{LENGTHS, parse};

use crate::no_go::{KeptDark, LeftOut};
use crate::sketch::Sketch;

/// Places that are nearer to each other are one, m: a carpenter's pencil is as wide.
const APART_M: f64 = 1e-3;

/// Points that differ in height by less are one row, m.
const ROW_M: f64 = 0.01;

/// Shortest and longest cross, m.
const CROSS_M: (f64, f64) = (4e-3, 1.0);

/// Most points of a job: somebody goes to each of them.
const MOST: usize = 2000;

/// Which places of a drawing are marked, and how.
#[derive(Clone, Debug, PartialEq)]
pub struct Points {
    /// Of these kinds; of every kind where none is named.
    pub kinds: Vec<PlaceKind>,
    /// How.
    pub mark: PointMark,
    /// One after the other as the drawing has them, not layer by layer and row by row.
    pub as_told: bool,
    /// Bends of at least this angle are corners, rad.
    pub corner_rad: f64,
}

/// Kinds of places as people write them: `all`, or names with commas between.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TypedKinds(pub Vec<PlaceKind>);

impl FromStr for TypedKinds {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if text.trim().eq_ignore_ascii_case("all") {
            return Ok(Self::default());
        }
        let names = || PlaceKind::ALL.map(PlaceKind::name).join(", ");
        let kind = |word: &str| {
            let word = word.trim().to_lowercase();
            let one = word.strip_suffix('s').unwrap_or(&word);
            let found = PlaceKind::ALL.into_iter().find(|kind| kind.name() == one);
            found.ok_or_else(|| format!("{word:?} is no kind of point: give all, or some of {}", names()))
        };
        text.split(',').map(kind).collect::<Result<_, _>>().map(Self)
    }
}

/// What marks a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PointMark {
    /// A cross, so long, m.
    Cross(f64),
    /// A dot: a ring so small that it is one, for light that stands still is dimmed.
    Dot,
}

/// Radius of the ring that is a dot, m.
const DOT_M: f64 = 1e-3;

impl Default for PointMark {
    /// A cross of 20 mm.
    fn default() -> Self {
        Self::Cross(0.02)
    }
}

impl FromStr for PointMark {
    type Err = String;

    /// Such as `20mm`, or `dot`.
    fn from_str(text: &str) -> Result<Self, String> {
        let (least, most) = CROSS_M;
        if text.trim().eq_ignore_ascii_case("dot") {
            return Ok(Self::Dot);
        }
        match parse(text, LENGTHS).map_err(|e| format!("{e}; or dot"))? {
            length if (least..=most).contains(&length) => Ok(Self::Cross(length)),
            _ => Err(format!("a cross of {text} is not between {:.0} mm and {most:.0} m long", 1e3 * least)),
        }
    }
}

/// Where the head goes, for scripts: a place on the target by its number from 0 of so many.
#[must_use]
pub fn point_json(place: &Place, (number, of): (u32, u32)) -> serde_json::Value {
    let mm = |m: f64| (1e6 * m).round() / 1e3;
    serde_json::json!({
        "event": "point",
        "point": number + 1,
        "points": of,
        "kind": place.kind.name(),
        "block": place.block.as_deref(),
        "layer": place.layer.as_deref(),
        "x_mm": mm(place.at.x),
        "y_mm": mm(place.at.y),
    })
}

/// Where the head goes, in words.
#[must_use]
pub fn point_words(place: &Place, (number, of): (u32, u32)) -> String {
    let name =
        |before: &str, name: Option<&str>| name.map_or_else(String::new, |name| format!("{before}{name}"));
    format!(
        "point {} of {of}: {}{}{}, at {:.3}, {:.3} m",
        number + 1,
        place.kind.name(),
        name(" ", place.block.as_deref()),
        name(" of layer ", place.layer.as_deref()),
        place.at.x,
        place.at.y
    )
}

/// The lines that mark places on the target.
pub(crate) struct Marked {
    pub(crate) points: Vec<Place>,
    pub(crate) drawing: Drawing,
    /// What of them is left out, where light keeps out of something.
    pub(crate) left_out: Option<LeftOut>,
    /// What the user should know.
    pub(crate) notes: Vec<String>,
}

/// Marks the places of a sketch, layer by layer as the drawing has them, each layer's row by row. `map` says where on the target a place of the sheet is; light
/// keeps out of what is `dark`.
///
/// # Errors
/// `no-points` where there is none, or none that may be lit; `too-many-points`; `align` for one beyond the horizon.
pub(crate) fn marked(
    sketch: &Sketch,
    asked: &Points,
    map: &dyn Fn(Point) -> Option<Point>,
    dark: &KeptDark,
) -> Result<Marked, Failure> {
    let found = places(&sketch.drawing, &sketch.places, asked.corner_rad);
    let all = sketch.places.iter().chain(&found);
    let wanted = all.clone().filter(|place| asked.kinds.is_empty() || asked.kinds.contains(&place.kind));
    let on_target = wanted.map(|place| map(place.at).map(|at| place.moved(at))).collect::<Option<Vec<_>>>();
    let beyond = || Failure::usage("align", "--align: the marks put a point beyond the horizon of the wall");
    let on_target = on_target.ok_or_else(beyond)?;
    // what somebody tells twice is meant twice
    let points = if asked.as_told { on_target } else { places_apart(on_target, APART_M) };
    if points.is_empty() {
        let kinds: Vec<_> = asked.kinds.iter().map(|kind| kind.name()).collect();
        let message = match all.clone().next().is_none() {
            true => "--points: the drawing has no point, block, centre, corner or end".to_owned(),
            false => {
                format!("--points={}: there is none; the drawing has {}", kinds.join(","), kinds_of(all))
            }
        };
        return Err(Failure::failed("no-points", message));
    }
    if points.len() > MOST {
        let message = format!(
            "--points: the drawing has {} of them ({}), and at most {MOST} are gone to: name the kinds, such as --points=centre,corner, or a --layer",
            points.len(),
            kinds_of(points.iter())
        );
        return Err(Failure::failed("too-many-points", message));
    }
    let kinds = kinds_of(points.iter());
    let count = counted(points.len(), "point");
    let mut notes =
        vec![if kinds == count { format!("marks {count}") } else { format!("marks {count}: {kinds}") }];
    let points = if asked.as_told { points } else { in_order(points) };
    let marked = points.into_iter().map(|place| (asked.mark.strokes(&place), place));
    let is_clear =
        |(strokes, _): &(Vec<Stroke>, Place)| strokes.iter().all(|stroke| dark.is_clear(&stroke.path));
    let (clear, dropped): (Vec<_>, Vec<_>) = marked.partition(is_clear);
    let (strokes, points): (Vec<_>, Vec<_>) = clear.into_iter().unzip();
    if strokes.is_empty() {
        let message = "all points lie in what --no-go keeps dark, or too near to it: keep less dark, or make their crosses smaller (--mark)";
        return Err(Failure::failed("no-points", message));
    }
    if !dropped.is_empty() {
        notes.push(format!("{} left out, in what --no-go keeps dark", counted(dropped.len(), "point")));
    }
    let dropped = Drawing { strokes: dropped.into_iter().flat_map(|(strokes, _)| strokes).collect() };
    let left_out = (!dark.is_empty()).then(|| LeftOut {
        strokes: dropped.strokes.len(),
        length_m: dropped.length(1e-6),
        ..dark.nothing_left_out()
    });
    let drawing = Drawing { strokes: strokes.concat() };
    Ok(Marked { points, drawing, left_out, notes })
}

/// How many there are of which kind, in words.
fn kinds_of<'a>(places: impl Iterator<Item = &'a Place> + Clone) -> String {
    let count = |kind: PlaceKind| places.clone().filter(|place| place.kind == kind).count();
    let some = PlaceKind::ALL.into_iter().map(|kind| (kind, count(kind))).filter(|(_, count)| *count > 0);
    some.map(|(kind, count)| counted(count, kind.name())).collect::<Vec<_>>().join(", ")
}

/// Layer by layer as they come first, each row by row.
fn in_order(points: Vec<Place>) -> Vec<Place> {
    by_layer(points, |place| place.layer.clone()).into_iter().flat_map(rows).collect()
}

/// Row by row from the top, each from the left.
fn rows(mut points: Vec<Place>) -> Vec<Place> {
    points.sort_by(|a, b| b.at.y.total_cmp(&a.at.y));
    let mut rows: Vec<Vec<Place>> = Vec::new();
    for place in points {
        match rows.last_mut().filter(|row| row.first().is_some_and(|first| first.at.y - place.at.y < ROW_M)) {
            Some(row) => row.push(place),
            None => rows.push(vec![place]),
        }
    }
    rows.iter_mut().for_each(|row| row.sort_by(|a, b| a.at.x.total_cmp(&b.at.x)));
    rows.concat()
}

impl PointMark {
    /// Two lines that cross there, or a ring round it.
    fn strokes(self, place: &Place) -> Vec<Stroke> {
        let stroke = |path| {
            let Place { layer, colour, entity, .. } = place;
            Stroke { layer: layer.clone(), colour: *colour, entity: entity.clone(), ..Stroke::new(path) }
        };
        let line = |half: Vec2| {
            let mut path = Path::new(place.at - half);
            path.push(Element::Line { to: place.at + half });
            stroke(path)
        };
        match self {
            Self::Cross(length) => {
                vec![line(Vec2::new(0.5 * length, 0.0)), line(Vec2::new(0.0, -0.5 * length))]
            }
            Self::Dot => {
                let mut ring = Path::new(place.at + Vec2::new(DOT_M, 0.0));
                ring.push(Element::Arc { centre: place.at, sweep: TAU });
                ring.close();
                vec![stroke(ring)]
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use tracelight_stroke::extent;

    use super::*;

    fn place(layer: &str, x: f64, y: f64) -> Place {
        let (kind, layer) = (PlaceKind::Corner, Some(Arc::from(layer)));
        Place { at: Point::new(x, y), kind, block: None, layer, colour: None, entity: None }
    }

    #[test]
    fn points_are_read_layer_by_layer_and_row_by_row() {
        let points =
            [("b", 0.3, 0.0), ("a", 0.0, 1.0), ("b", 0.0, 0.002), ("b", 0.1, 0.5), ("a", 0.5, 1.001)];
        let sorted = in_order(points.map(|(layer, x, y)| place(layer, x, y)).to_vec());
        let found: Vec<_> = sorted.iter().map(|p| (p.layer.as_deref().unwrap(), p.at.x)).collect();
        assert_eq!(found, [("b", 0.1), ("b", 0.0), ("b", 0.3), ("a", 0.0), ("a", 0.5)]);
    }

    #[test]
    fn rows_are_read_also_where_columns_stand_further_apart() {
        let grid = (0..9).map(|k| place("a", 0.7 * f64::from(k % 3), 0.2 * f64::from(k / 3)));
        let found: Vec<_> = in_order(grid.collect()).iter().map(|p| (p.at.x, p.at.y)).collect();
        let wanted = [2, 1, 0]
            .into_iter()
            .flat_map(|row| [0, 1, 2].map(|column| (0.7 * f64::from(column), 0.2 * f64::from(row))));
        assert_eq!(found, wanted.collect::<Vec<_>>());
    }

    #[test]
    fn marks_are_typed_with_a_unit_and_bounds() {
        assert_eq!("3cm".parse(), Ok(PointMark::Cross(0.03)));
        assert_eq!("Dot".parse(), Ok(PointMark::Dot));
        let refused = |text: &str| text.parse::<PointMark>().unwrap_err();
        assert!(refused("1mm").contains("between 4 mm and 1 m"), "{}", refused("1mm"));
        assert!(refused("20").contains("no unit"));
    }

    #[test]
    fn kinds_are_typed_by_their_names() {
        assert_eq!("all".parse(), Ok(TypedKinds(vec![])));
        let two = TypedKinds(vec![PlaceKind::Block, PlaceKind::Centre]);
        assert_eq!("blocks, Centre".parse(), Ok(two));
        let refused = "block,door".parse::<TypedKinds>().unwrap_err();
        assert!(
            refused.contains("\"door\"") && refused.contains("point, block, centre, corner, end"),
            "{refused}"
        );
    }

    #[test]
    fn a_mark_is_about_its_place() {
        let place = place("a", 1.0, 2.0);
        for mark in [PointMark::default(), PointMark::Dot] {
            let strokes = Drawing { strokes: mark.strokes(&place) };
            assert!(extent(&strokes).unwrap().center().distance(place.at) < 1e-12);
            assert!(strokes.strokes.iter().all(|stroke| stroke.layer == place.layer));
        }
    }
}
