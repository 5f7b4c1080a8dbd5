mod corners;
mod head;
mod look;
mod markers;
mod ruler;
mod sheet;

use clap::{Args, Subcommand};
use serde_json::Value;
use tracelight_task::{Failure, Stop, Task};

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
            CalibrateAction::Look(args) => args.voice,
            CalibrateAction::Markers(args) => args.voice,
            CalibrateAction::Ruler(args) => args.voice,
            CalibrateAction::Sheet(args) => args.voice,
            CalibrateAction::Show(args) => args.voice,
        }
    }
}

#[derive(Subcommand, Debug)]
enum CalibrateAction {
    Sheet(sheet::SheetArgs),
    Look(Box<look::LookArgs>),
    Corners(corners::CornersArgs),
    Head(Box<head::HeadArgs>),
    Markers(markers::MarkersArgs),
    Lens(markers::LensArgs),
    Ruler(ruler::RulerArgs),
    Show(look::ShowArgs),
}

pub(crate) fn run(args: &CalibrateArgs, task: Task<'_>) -> Result<Answer, Failure> {
    let stop = task.stop;
    match &args.action {
        CalibrateAction::Corners(args) => corners::run(args),
        CalibrateAction::Head(args) => head::run(args, task),
        CalibrateAction::Lens(args) => markers::lens(args),
        CalibrateAction::Look(args) => look::run(args, stop),
        CalibrateAction::Markers(args) => markers::run(args, stop),
        CalibrateAction::Ruler(args) => ruler::run(args),
        CalibrateAction::Sheet(args) => sheet::run(args),
        CalibrateAction::Show(args) => look::show(args),
    }
}

/// Looks through the camera of `calibrate look`, one image after the other, as JPEG and in figures, until `each` wants no more.
///
/// # Errors
/// What the camera fails with; of another command `usage`.
pub(crate) fn watch(
    args: &CalibrateArgs,
    stop: &Stop,
    each: &mut dyn FnMut(Vec<u8>, Value) -> bool,
) -> Result<(), Failure> {
    match &args.action {
        CalibrateAction::Look(args) => look::watch(args, stop, each),
        _ => Err(Failure::usage("usage", "only calibrate look shows one image after the other")),
    }
}
