//! Strokes on the target to a plan: order, then time.

use tracelight_sim::first_standing;
use tracelight_stroke::{Effort, OrderOptions, Ordered, Point, order};
use tracelight_task::Failure;
use tracelight_trajectory::{Plan, TravelTime, plan};

use crate::driving::{Driving, REACHED};
use crate::hopeless;
use crate::placed::Placed;
use crate::reach::check_reach;
use crate::refused::refused;

/// What the order is to save.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum OrderBy {
    /// Seconds of dark moves.
    #[default]
    Time,
    /// Metres of dark moves.
    Distance,
}

/// A drawing in order, and in time.
#[derive(Clone, Debug)]
pub struct Schedule {
    /// Its strokes, in order.
    pub ordered: Ordered,
    /// When what of them is drawn.
    pub plan: Plan,
}

/// Orders and times a drawing. Every stroke must be in reach before any work goes into its order.
///
/// # Errors
/// What cannot be reached, or not at the speed asked for.
pub fn schedule(
    placed: &Placed,
    driving: &Driving,
    by: OrderBy,
    effort: Effort,
) -> Result<Schedule, Failure> {
    check_reach(placed, driving)?;
    hopeless::check(&placed.drawing, driving)?;
    let start = driving.machine.geometry.spot(&driving.pose, Default::default()).unwrap_or(Point::ORIGIN);
    let options = OrderOptions { effort, seed: 0 };
    let ordered = match by {
        OrderBy::Time => {
            order(&placed.drawing, start, options, &TravelTime::new(&driving.machine, &driving.request))
        }
        OrderBy::Distance => order(&placed.drawing, start, options, &|a: Point, b: Point| a.distance(b)),
    };
    let plan = plan(&ordered.drawing, &driving.machine, &driving.request).map_err(refused)?;
    check_speed(&plan, driving)?;
    check_standing(&plan, driving)?;
    Ok(Schedule { ordered, plan })
}

/// A speed that is asked for and reached nowhere is refused; slowing down here and there is no error.
///
/// # Errors
/// `speed-unreachable`.
pub fn check_speed(plan: &Plan, driving: &Driving) -> Result<(), Failure> {
    let (asked, best) = (plan.set_speed_m_s, plan.top_speed_m_s());
    if !driving.asked.speed || best >= REACHED * asked {
        return Ok(());
    }
    let message = format!(
        "--speed {asked:.4} m/s is reached nowhere on this drawing: its lines are too short or too bent for these \
         motors; the best possible is {best:.4} m/s ({:.3} ft/s)",
        best / 0.3048
    );
    Err(Failure::failed("speed-unreachable", message))
}

/// A plan whose light would stand in one place for too long is refused before anything is lit: the rig would be dark there.
///
/// # Errors
/// `standing-light`.
pub fn check_standing(plan: &Plan, driving: &Driving) -> Result<(), Failure> {
    let Some(stands) = first_standing(&driving.rig, plan) else { return Ok(()) };
    let stroke = stands.stroke.map_or_else(String::new, |stroke| format!(" of stroke {}", stroke + 1));
    let light = &driving.rig.light;
    let message = format!(
        "the light would stand: {:.2} s within {:.0} mm of ({:.3}, {:.3}) m{stroke}, and {:.2} s are planned at most, since a laser of {} mW \
         may stand {} s in one place; draw faster (--speed) or larger (--width), or, if eyes are safe from it, set laser.power \
         and safety.standing in the rig file",
        stands.stands_s,
        1e3 * stands.about_rad * driving.pose.distance_m,
        stands.spot.x,
        stands.spot.y,
        stands.most_s,
        1e3 * light.power_w,
        light.standing_s,
    );
    Err(Failure::failed("standing-light", message))
}
