//! What is drawn again and again.

use tracelight_pipeline::{Driving, Schedule, schedule_as_it_is};
use tracelight_session::{Again, Job, Repeated, StrokeTicks};
use tracelight_sim::{looped_job, slowest_speed};
use tracelight_stroke::{Drawing, Path, Place, Stroke};
use tracelight_task::Failure;
use tracelight_trajectory::{Plan, plan_from};

/// What is drawn again and again: a stroke, the mark of a point, or a frame.
pub(crate) struct Item {
    /// Its number in the whole drawing, from 0.
    pub(crate) number: u32,
    strokes: Vec<Stroke>,
    what: Repeated,
    /// The point that it marks.
    pub(crate) point: Option<Place>,
}

impl Item {
    /// Every stroke of a drawing, or every mark of its points, of which the first has this number.
    pub(crate) fn all(drawing: &Drawing, points: &[Place], first: u32) -> Vec<Self> {
        if points.is_empty() {
            let each = |stroke: &Stroke| stroke.along(there_and_back(&stroke.path));
            let item = |(number, stroke)| Self {
                number,
                strokes: vec![each(stroke)],
                what: Repeated::Stroke,
                point: None,
            };
            return (first..).zip(&drawing.strokes).map(item).collect();
        }
        let of_one = (drawing.strokes.len() / points.len()).max(1);
        let marks = (first..).zip(drawing.strokes.chunks(of_one).zip(points));
        let item = |(number, (strokes, point)): (u32, (&[Stroke], &Place))| Self {
            number,
            strokes: strokes.to_vec(),
            what: Repeated::Point,
            point: Some(point.clone()),
        };
        marks.map(item).collect()
    }

    /// A drawing as one.
    pub(crate) fn frame(drawing: Drawing) -> Self {
        Self { number: 0, strokes: drawing.strokes, what: Repeated::Frame, point: None }
    }

    /// As messages call it.
    pub(crate) const fn word(&self) -> &'static str {
        match self.what {
            Repeated::Stroke => "stroke",
            Repeated::Point => "point",
            Repeated::Frame => "frame",
        }
    }
}

/// An item to be drawn again and again.
pub(crate) struct Looped {
    pub(crate) strokes: Vec<Stroke>,
    /// From zero to it, once.
    pub(crate) once: Plan,
    /// From its end, again and again.
    pub(crate) again: Plan,
    pub(crate) job: Job,
}

/// There along a stroke and back, where it is open: it ends where it begins.
fn there_and_back(path: &Path) -> Path {
    if path.is_closed() {
        return path.clone();
    }
    let mut both = path.clone();
    path.reversed().elements().iter().for_each(|&element| both.push(element));
    both
}

/// All strokes of an item as one: its number is that of what is drawn.
fn as_one(strokes: &[StrokeTicks]) -> Vec<StrokeTicks> {
    let ends = strokes.first().zip(strokes.last());
    ends.map(|(first, last)| StrokeTicks { start: first.start, end: last.end }).into_iter().collect()
}

impl Looped {
    /// Plans it, one of so many: once from zero, and again and again from there.
    ///
    /// # Errors
    /// Why it cannot be drawn so.
    pub(crate) fn of(item: &Item, of: u32, driving: &Driving, dry: bool) -> Result<Self, Failure> {
        let drawing = Drawing { strokes: item.strokes.clone() };
        let Schedule { plan: once, .. } = schedule_as_it_is(drawing.clone(), driving)?;
        let end = once.points.last().map(|point| point.joints.map(|joint| joint.position_rad));
        let again = plan_from(&drawing, &driving.machine, &driving.request, end.unwrap_or_default())
            .map_err(tracelight_pipeline::refused)?;
        let looped = looped_job(&driving.rig, (item.what, &once, &again), dry).ok_or_else(|| stands(item))?;
        let slowest = |plan: &Plan| if dry { 0.0 } else { slowest_speed(&driving.rig, plan) };
        let job = Job {
            slowest: slowest(&once).max(slowest(&again)),
            first: item.number,
            of,
            strokes: as_one(&looped.strokes),
            again: looped.again.map(|again| Again { strokes: as_one(&again.strokes), ..again }),
            ..looped
        };
        Ok(Self { strokes: drawing.strokes, once, again, job })
    }
}

fn stands(item: &Item) -> Failure {
    let way_out = match item.what {
        Repeated::Stroke => "draw it larger (--width), or without --step",
        Repeated::Point => "mark it by a larger cross (--mark)",
        Repeated::Frame => "draw larger (--width)",
    };
    let message = format!(
        "{} {} is so short that its light would stand, drawn again and again: {way_out}",
        item.word(),
        item.number + 1
    );
    Failure::failed("standing-light", message)
}
