//! A plan that is drawn again and again.

use tracelight_session::{Again, Job, Repeated};
use tracelight_trajectory::Plan;

use crate::config::RigConfig;
use crate::run::job_of;
use crate::standing::wait_between;

/// Returns a job that draws a plan once, and then one that begins and ends where the first one ends, again and again.
///
/// `None` where the light of that would stand, however long it waits between.
pub fn looped_job(rig: &RigConfig, (what, once, again): (Repeated, &Plan, &Plan), dry: bool) -> Option<Job> {
    let wait_ticks = wait_between(rig, &again.segments)?;
    let Job { segments, strokes, .. } = job_of(again, dry);
    Some(Job { again: Some(Again { what, segments, strokes, wait_ticks }), ..job_of(once, dry) })
}
