use clap::Args;
use tracelight_experiment::shape::Shape;
use tracelight_pipeline::Driving;
use tracelight_task::Failure;

use super::rig::SetArgs;
use crate::cli::driving::DrivingArgs;
use crate::named;
use tracelight_flags::LawArgs;

/// What is drawn on the bench, and how.
#[derive(Args, Clone, Debug)]
pub(super) struct ShapeArgs {
    /// What is drawn: a circle of 0.25 m radius; a level line of 0.6 m, 0.15 m above the head; or a picture or drawing
    #[arg(long, value_name = "circle|line|PICTURE", default_value = "circle")]
    shape: String,
    /// Whether the encoders stamp their edges with the time [default: as the rig does]
    #[arg(long, value_name = "on|off", value_parser = switch)]
    edge_stamps: Option<bool>,
    #[command(flatten)]
    law: LawArgs,
    #[command(flatten)]
    driving: DrivingArgs,
    #[command(flatten)]
    set: SetArgs,
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

    /// Refuses to save where that cannot be.
    pub(super) fn may_save(&self, save: bool) -> Result<(), Failure> {
        self.set.may_save(&self.driving.rig, save)
    }

    /// The rig and what is asked of it.
    pub(super) fn driving(&self) -> Result<Driving, Failure> {
        let rig = self.set.on(named::rig(&self.driving.rig)?)?;
        let mut driving = self.driving.resolve_on(rig);
        self.law.apply(&mut driving.rig)?;
        if let Some(stamps) = self.edge_stamps {
            driving.rig.model.encoder.edge_stamps = stamps;
            driving.rig.truth.model.encoder.edge_stamps = stamps;
        }
        Ok(driving)
    }

    /// What is drawn.
    pub(super) fn shape(&self) -> Result<Shape, Failure> {
        Ok(match self.shape.as_str() {
            "circle" => Shape::Circle,
            "line" => Shape::Line,
            path => Shape::Picture { name: path.to_owned(), source: Box::new(named::picture(path)?) },
        })
    }
}
