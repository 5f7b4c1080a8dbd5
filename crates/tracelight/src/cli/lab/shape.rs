use clap::Args;
use tracelight_pipeline::{
    Driving, OrderBy, Placing, Tracing, check_speed, place, refused, schedule, sketch,
};
use tracelight_stroke::{Drawing, Effort, Element, Path, Point, Stroke};
use tracelight_task::Failure;
use tracelight_trajectory::{Plan, plan};

use crate::cli::driving::DrivingArgs;
use crate::cli::laws::LawArgs;
use crate::named;

/// Radius of the circle, m.
const RADIUS_M: f64 = 0.25;
/// The level line: half its length and its height above the head, m.
const HALF_LENGTH_M: f64 = 0.3;
const HEIGHT_M: f64 = 0.15;

/// What is drawn on the bench, and how.
#[derive(Args, Clone, Debug)]
pub(super) struct ShapeArgs {
    /// What is drawn: a circle of 0.25 m radius; a level line of 0.6 m, 0.15 m above the head; or a picture or drawing
    #[arg(long, value_name = "circle|line|PICTURE", default_value = "circle")]
    pub(super) shape: String,
    /// Whether the encoders stamp their edges with the time [default: as the rig does]
    #[arg(long, value_name = "on|off", value_parser = switch)]
    edge_stamps: Option<bool>,
    #[command(flatten)]
    law: LawArgs,
    #[command(flatten)]
    driving: DrivingArgs,
}

pub(super) fn switch(text: &str) -> Result<bool, String> {
    match text {
        "on" => Ok(true),
        "off" => Ok(false),
        _ => Err(format!("{text} is neither on nor off")),
    }
}

impl ShapeArgs {
    /// The rig as it was named.
    pub(super) fn rig(&self) -> &str {
        &self.driving.rig
    }

    /// The rig and what is asked of it.
    pub(super) fn resolve(&self) -> Result<Driving, Failure> {
        let mut driving = self.driving.resolve()?;
        self.law.apply(&mut driving.rig);
        if let Some(stamps) = self.edge_stamps {
            driving.rig.model.encoder.edge_stamps = stamps;
            driving.rig.truth.model.encoder.edge_stamps = stamps;
        }
        Ok(driving)
    }

    /// The shape as a plan.
    pub(super) fn plan(&self, driving: &Driving) -> Result<Plan, Failure> {
        let path = match self.shape.as_str() {
            "circle" => circle(),
            "line" => level_line(),
            picture => return plan_picture(picture, driving),
        };
        let drawing = Drawing { strokes: vec![Stroke::new(path)] };
        let plan = plan(&drawing, &driving.machine, &driving.request).map_err(refused)?;
        check_speed(&plan, driving)?;
        Ok(plan)
    }
}

fn circle() -> Path {
    let mut path = Path::new(Point::new(RADIUS_M, 0.0));
    path.push(Element::Arc { centre: Point::ORIGIN, sweep: std::f64::consts::TAU });
    path.close();
    path
}

fn level_line() -> Path {
    let mut path = Path::new(Point::new(-HALF_LENGTH_M, HEIGHT_M));
    path.push(Element::Line { to: Point::new(HALF_LENGTH_M, HEIGHT_M) });
    path
}

fn plan_picture(name: &str, driving: &Driving) -> Result<Plan, Failure> {
    let placing = Placing::default();
    let sketch = sketch(name, named::picture(name)?, &Tracing::default(), &placing)?;
    let placed = place(&sketch, &placing);
    Ok(schedule(&placed, driving, OrderBy::default(), Effort::Normal)?.plan)
}
