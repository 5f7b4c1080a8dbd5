mod corners;
mod head;
mod markers;
mod ruler;
mod sheet;

use clap::{Args, Subcommand};
use tracelight_task::{Failure, Stop};

use crate::cli::answer::{Answer, Voice};

/// Calibrate camera and head: scale, lens and position of the camera; position of the head
#[derive(Args, Debug)]
pub(crate) struct CalibrateArgs {
    #[command(subcommand)]
    action: CalibrateAction,
}

impl CalibrateArgs {
    pub(crate) const fn voice(&self) -> Voice {
        match &self.action {
            CalibrateAction::Corners(args) => args.voice,
            CalibrateAction::Head(args) => args.voice,
            CalibrateAction::Lens(args) => args.voice,
            CalibrateAction::Markers(args) => args.voice,
            CalibrateAction::Ruler(args) => args.voice,
            CalibrateAction::Sheet(args) => args.voice,
        }
    }
}

#[derive(Subcommand, Debug)]
enum CalibrateAction {
    Sheet(sheet::SheetArgs),
    Corners(corners::CornersArgs),
    Head(Box<head::HeadArgs>),
    Markers(markers::MarkersArgs),
    Lens(markers::LensArgs),
    Ruler(ruler::RulerArgs),
}

pub(crate) fn run(args: &CalibrateArgs, stop: &Stop) -> Result<Answer, Failure> {
    match &args.action {
        CalibrateAction::Corners(args) => corners::run(args),
        CalibrateAction::Head(args) => head::run(args, stop),
        CalibrateAction::Lens(args) => markers::lens(args),
        CalibrateAction::Markers(args) => markers::run(args, stop),
        CalibrateAction::Ruler(args) => ruler::run(args),
        CalibrateAction::Sheet(args) => sheet::run(args),
    }
}
