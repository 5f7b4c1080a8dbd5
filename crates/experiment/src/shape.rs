//! What is drawn on the bench: a circle, a level line, or a picture.

use std::f64::consts::TAU;

use tracelight_picture::Source;
use tracelight_pipeline::{Driving, Placed, Placing, Tracing, check_speed, place, refused, schedule, sketch};
use tracelight_stroke::{Drawing, Element, Path, Point, Stroke};
use tracelight_task::Failure;
use tracelight_trajectory::{Plan, plan};

/// What is drawn.
#[derive(Clone, Debug)]
pub enum Shape {
    /// A circle of 0.25 m radius about the target's centre.
    Circle,
    /// A level line of 0.6 m, 0.15 m above the target's centre.
    Line,
    /// A picture or a drawing, as large as it truly is, or 24 in wide.
    Picture {
        /// What it is called.
        name: String,
        /// What is in it.
        source: Box<Source>,
    },
}

/// A shape on the target, to be planned for any rig.
pub(crate) enum OnTarget {
    /// A stroke, drawn as it is.
    Path(Path),
    /// Strokes, to be put in order.
    Picture(Box<Placed>),
}

/// Radius of the circle, m.
const RADIUS_M: f64 = 0.25;
/// The level line: half its length and its height above the head, m.
const HALF_LENGTH_M: f64 = 0.3;
const HEIGHT_M: f64 = 0.15;

impl Shape {
    /// What it is called.
    pub(crate) fn name(&self) -> &str {
        match self {
            Self::Circle => "circle",
            Self::Line => "line",
            Self::Picture { name, .. } => name,
        }
    }

    /// On the target; a picture is traced.
    pub(crate) fn on_target(self) -> Result<OnTarget, Failure> {
        Ok(match self {
            Self::Circle => OnTarget::Path(circle()),
            Self::Line => OnTarget::Path(level_line()),
            Self::Picture { name, source } => {
                let placing = Placing::default();
                let sketch = sketch(&name, *source, &Tracing::default(), &placing)?;
                OnTarget::Picture(Box::new(place(&sketch, &placing)?))
            }
        })
    }
}

impl OnTarget {
    /// As a plan.
    pub(crate) fn plan(&self, driving: &Driving) -> Result<Plan, Failure> {
        match self {
            Self::Path(path) => {
                let drawing = Drawing { strokes: vec![Stroke::new(path.clone())] };
                let plan = plan(&drawing, &driving.machine, &driving.request).map_err(refused)?;
                check_speed(&plan, driving)?;
                Ok(plan)
            }
            Self::Picture(placed) => Ok(schedule(placed, driving)?.plan),
        }
    }
}

fn circle() -> Path {
    let mut path = Path::new(Point::new(RADIUS_M, 0.0));
    path.push(Element::Arc { centre: Point::ORIGIN, sweep: TAU });
    path.close();
    path
}

fn level_line() -> Path {
    let mut path = Path::new(Point::new(-HALF_LENGTH_M, HEIGHT_M));
    path.push(Element::Line { to: Point::new(HALF_LENGTH_M, HEIGHT_M) });
    path
}
