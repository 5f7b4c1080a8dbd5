//! Strokes on the target to a plan: order, then time.

use tracelight_sim::{Standing, first_standing};
use tracelight_stroke::{
    Drawing, OrderOptions, Ordered, Point, Travel, order, order_by_layer, reading_order,
};
use tracelight_task::Failure;
use tracelight_trajectory::{LitSpeed, Plan, TravelTime, plan, plan_waiting};

use crate::driving::{Driving, REACHED};
use crate::hopeless;
use crate::ordering::{OrderBy, Sequence};
use crate::placed::Placed;
use crate::reach::check_reach;
use crate::refused::refused;
use crate::spread::{May, Spread, spread};

/// A drawing in order, and in time.
#[derive(Clone, Debug)]
pub struct Schedule {
    /// Its strokes, in order.
    pub ordered: Ordered,
    /// When what of them is drawn.
    pub plan: Plan,
    /// What the user should know of it: one sentence each.
    pub notes: Vec<String>,
}

/// Shares of what a plan may use that light is spread by, one after the other: what comes of it is timed a little differently.
const SHARES: [f64; 3] = [0.97, 0.8, 0.6];

/// Orders and times a drawing. Every stroke must be in reach before any work goes into its order.
///
/// # Errors
/// What cannot be reached, or not at the speed asked for.
pub fn schedule(placed: &Placed, driving: &Driving) -> Result<Schedule, Failure> {
    check_reach(placed, driving)?;
    hopeless::check(&placed.drawing, driving)?;
    if !placed.points.is_empty() {
        // in the order that they have; no speed is reached on lines that short
        return schedule_as_it_is(placed.drawing.clone(), driving);
    }
    let may = match driving.order.sequence {
        Sequence::Free => May::PutOff,
        _ => May::Cut,
    };
    let schedule = timed(ordered(placed, driving), Some(may), driving)?;
    check_speed(&schedule.plan, driving)?;
    Ok(schedule)
}

/// Times the rest of a drawing that was ordered and began to be drawn, in the order that it has.
///
/// # Errors
/// As of [`schedule`], but that no speed is too fast for it: its longest stroke may be drawn.
pub fn schedule_rest(drawing: Drawing, driving: &Driving) -> Result<Schedule, Failure> {
    in_its_order(drawing, Some(May::Cut), driving)
}

/// Times the rest of a drawing that was ordered and began to be drawn, each of its strokes whole and by its number; where its light would stand it is dark before.
///
/// # Errors
/// As of [`schedule_rest`].
pub fn schedule_whole(drawing: Drawing, driving: &Driving) -> Result<Schedule, Failure> {
    in_its_order(drawing, Some(May::Rest), driving)
}

/// Times strokes in the order that they have, and none of them in parts: what knows them by their numbers goes on doing so.
///
/// # Errors
/// As of [`schedule_rest`]; `standing-light` where the light would stand.
pub fn schedule_as_it_is(drawing: Drawing, driving: &Driving) -> Result<Schedule, Failure> {
    in_its_order(drawing, None, driving)
}

fn in_its_order(drawing: Drawing, may: Option<May>, driving: &Driving) -> Result<Schedule, Failure> {
    let cost = TravelTime::new(&driving.machine, &driving.request);
    timed(Ordered::as_it_is(drawing, start_of(driving), &cost), may, driving)
}

/// Times strokes. Where the light would stand it is spread in time, if that is enough.
fn timed(ordered: Ordered, may: Option<May>, driving: &Driving) -> Result<Schedule, Failure> {
    let plan = plan(&ordered.drawing, &driving.machine, &driving.request).map_err(refused)?;
    let Some(stands) = first_standing(&driving.rig, &plan) else {
        return Ok(Schedule { ordered, plan, notes: Vec::new() });
    };
    // what passes all its strokes at speed begins none of them from rest
    let may_rest = driving.request.lit_speed != LitSpeed::Exact;
    for (share, may) in SHARES.into_iter().filter_map(|share| Some((share, may?))) {
        let Some(Spread { drawing, waits, cut, parts }) =
            spread((&ordered.drawing, &plan), &driving.rig, share, may)
        else {
            break;
        };
        if !waits.is_empty() && !may_rest {
            break;
        }
        // one that lasts too long so would have to be drawn faster or larger in any case
        let Ok(spread) = plan_waiting(&drawing, &waits, &driving.machine, &driving.request) else { break };
        if first_standing(&driving.rig, &spread).is_some() {
            continue;
        }
        let cost = TravelTime::new(&driving.machine, &driving.request);
        let notes = vec![spread_words(
            (cut, parts),
            may == May::PutOff && drawing.strokes.len() > 1,
            waits.iter().map(|wait| wait.time_s).sum(),
            (spread.duration_s() - plan.duration_s()).max(0.0),
        )];
        let ordered = Ordered {
            lower_bound: ordered.lower_bound,
            ..Ordered::as_it_is(drawing, start_of(driving), &cost)
        };
        return Ok(Schedule { ordered, plan: spread, notes });
    }
    Err(standing_light(&stands, driving))
}

/// Words for light that was spread, and what that takes.
fn spread_words((cut, parts): (usize, usize), are_put_off: bool, dark_s: f64, longer_s: f64) -> String {
    let done: Vec<String> = [
        are_put_off.then(|| "strokes that lie close together are drawn at different times".to_owned()),
        (cut > 0).then(|| {
            format!(
                "{} drawn in {parts} parts",
                if cut == 1 { "1 stroke is".to_owned() } else { format!("{cut} strokes are") }
            )
        }),
        (dark_s > 0.0).then(|| format!("it is dark for {dark_s:.1} s in between")),
    ]
    .into_iter()
    .flatten()
    .collect();
    format!("so that the light stands nowhere for too long, {}: {longer_s:.1} s more in all", done.join(", "))
}

/// Where the beam falls at rest.
fn start_of(driving: &Driving) -> Point {
    driving.machine.geometry.spot(&driving.pose, Default::default()).unwrap_or(Point::ORIGIN)
}

/// A drawing's strokes in the order that is asked for, from where the beam falls at rest.
fn ordered(placed: &Placed, driving: &Driving) -> Ordered {
    let start = start_of(driving);
    match driving.order.by {
        OrderBy::Time => {
            by_cost(placed, driving, start, &TravelTime::new(&driving.machine, &driving.request))
        }
        OrderBy::Distance => by_cost(placed, driving, start, &|a: Point, b: Point| a.distance(b)),
    }
}

fn by_cost(placed: &Placed, driving: &Driving, start: Point, cost: &impl Travel) -> Ordered {
    let options = OrderOptions { effort: driving.order.effort, seed: 0 };
    match driving.order.sequence {
        Sequence::Free => order(&placed.drawing, start, options, cost),
        Sequence::Layers => order_by_layer(&placed.drawing, start, options, cost),
        Sequence::Reading => reading_order(&placed.drawing, start, cost),
    }
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
    first_standing(&driving.rig, plan).map_or(Ok(()), |stands| Err(standing_light(&stands, driving)))
}

fn standing_light(stands: &Standing, driving: &Driving) -> Failure {
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
    Failure::failed("standing-light", message)
}
