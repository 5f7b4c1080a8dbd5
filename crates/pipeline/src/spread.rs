//! Light that would stand is spread in time: strokes where it would are drawn later, in parts, or after a dark rest.
//!
//! A plan tells when each stroke is lit and where. Along it a head's light budget is looked after, stroke by stroke. Where it is spent within one, the stroke is cut
//! shortly before and the rest is put off, until so much has leaked that it may be drawn; in the end, or where the order is not to change, it is dark for a while.
//! What comes out is a drawing like any other, to be planned anew.

use std::collections::VecDeque;

use tracelight_rig::TICK_F64_S;
use tracelight_sim::{LightAhead, RigConfig};
use tracelight_stroke::{Drawing, Measured, Stroke};
use tracelight_trajectory::{Plan, PlanPoint, Wait};

/// Before the light would stand a stroke is cut so early, ticks: its end takes some, and the plan that comes of it is another one.
const EARLY_TICKS: usize = 40;
/// A stop of the spot is as good a place to cut, so long before that, ticks.
const STOP_TICKS: usize = 250;
/// No part of a stroke that was cut is shorter, ticks and m: less is drawn with the rest.
const LEAST_TICKS: usize = 60;
const LEAST_M: f64 = 5e-4;
/// Between two strokes it is dark for so long at least, ticks.
const LINK_TICKS: u32 = 60;
/// How long it may be dark before one stroke, ticks: a place whose budget is spent has leaked all of it by then. And by which steps that is found.
const MOST_WAIT: u32 = 12_000;
const WAIT_STEP: u32 = 100;
/// Of the strokes that were put off so many are looked at before each of the others.
const LOOKED_AT: usize = 12;
/// More parts are no drawing any more.
const MOST_PARTS: usize = 20_000;
/// Nor is it one that is dark for longer by its rests, ticks: half an hour.
const MOST_DARK: u32 = 1_800_000;

/// A drawing whose light is spread, and where it is dark for how long.
#[derive(Clone, Debug)]
pub(crate) struct Spread {
    pub(crate) drawing: Drawing,
    pub(crate) waits: Vec<Wait>,
    /// Strokes that were cut, and in how many parts.
    pub(crate) cut: usize,
    pub(crate) parts: usize,
}

/// A part of a stroke: between lengths along its path, m, with its ticks.
#[derive(Clone, Copy)]
struct Part<'a> {
    stroke: usize,
    from_m: f64,
    to_m: f64,
    points: &'a [PlanPoint],
}

/// What of a stroke is drawn at a time.
struct Step<'a> {
    part: Part<'a>,
    wait: u32,
}

/// What may be done with strokes so that their light stands nowhere; dark rests before them may always be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum May {
    /// They are drawn later, and in parts.
    PutOff,
    /// They are drawn in parts, in their order.
    Cut,
    /// Each is drawn whole, in their order.
    Rest,
}

/// Spreads the light of a drawing that was planned in its order, with a share of what a plan may use. `None` where a spot stands by itself, or what comes out
/// would be no drawing any more.
pub(crate) fn spread(
    (drawing, plan): (&Drawing, &Plan),
    rig: &RigConfig,
    share: f64,
    may: May,
) -> Option<Spread> {
    let mut course =
        Course { ahead: LightAhead::new(rig, share), steps: Vec::new(), cuts: may != May::Rest, dark: 0 };
    let mut later: VecDeque<Part<'_>> = VecDeque::new();
    for part in whole_strokes(drawing, plan) {
        for at in (0..later.len().min(LOOKED_AT)).rev() {
            if course.takes(&later[at]) {
                later.remove(at);
            }
        }
        let mut rest = part;
        while let Some(left) = course.begin(&rest) {
            if course.is_too_long() {
                return None;
            }
            rest = left;
            if may == May::PutOff {
                later.push_back(rest);
                break;
            }
            rest = course.after_rest(&rest)?;
            if rest.points.is_empty() {
                break;
            }
        }
    }
    while let Some(part) = later.pop_front() {
        if course.is_too_long() {
            return None;
        }
        if course.takes(&part) {
            continue;
        }
        // another one may need no rest
        if let Some(at) = (0..later.len().min(LOOKED_AT)).find(|&at| course.takes(&later[at])) {
            later.remove(at);
            later.push_front(part);
            continue;
        }
        let left = course.after_rest(&part)?;
        if !left.points.is_empty() {
            later.push_front(left);
        }
    }
    course.drawn(drawing)
}

/// Strokes that follow each other, and the light that they have left behind.
struct Course<'a> {
    ahead: LightAhead,
    steps: Vec<Step<'a>>,
    /// Whether strokes may be cut.
    cuts: bool,
    /// How long it is dark by its rests in all, ticks.
    dark: u32,
}

impl<'a> Course<'a> {
    /// What is left behind after a dark wait and all of a part; the tick at which it would stand where there is one.
    fn tried(&self, part: &Part<'_>, wait: u32) -> Result<LightAhead, usize> {
        let mut ahead = self.ahead.clone();
        ahead.wait(LINK_TICKS + wait);
        match ahead.pass(part.points) {
            None => Ok(ahead),
            Some(tick) => Err(tick),
        }
    }

    /// Whether it is no drawing any more: in too many parts, or dark for longer than any job lasts.
    fn is_too_long(&self) -> bool {
        self.steps.len() > MOST_PARTS || self.dark > MOST_DARK
    }

    fn push(&mut self, part: Part<'a>, wait: u32, ahead: LightAhead) {
        self.ahead = ahead;
        self.dark += wait;
        self.steps.push(Step { part, wait });
    }

    /// Draws a part now if all of it may be; whether it does.
    fn takes(&mut self, part: &Part<'a>) -> bool {
        self.tried(part, 0).map(|ahead| self.push(*part, 0, ahead)).is_ok()
    }

    /// Draws as much of a part as may be now; what is left of it, if anything.
    fn begin(&mut self, part: &Part<'a>) -> Option<Part<'a>> {
        let tick = match self.tried(part, 0) {
            Ok(ahead) => {
                self.push(*part, 0, ahead);
                return None;
            }
            Err(tick) => tick,
        };
        let Some((first, left)) = part.cut_before(tick).filter(|_| self.cuts) else { return Some(*part) };
        match self.tried(&first, 0) {
            Ok(ahead) => self.push(first, 0, ahead),
            Err(_) => return Some(*part),
        }
        Some(left)
    }

    /// Draws a part after a dark rest, the shortest after which all of it may be drawn, or else as much as may be after the longest; what is left of it, without
    /// ticks where nothing is. `None` where nothing of it may be drawn.
    fn after_rest(&mut self, part: &Part<'a>) -> Option<Part<'a>> {
        let (first, left) = match self.tried(part, MOST_WAIT) {
            Ok(_) => (*part, Part { points: &[], ..*part }),
            Err(tick) => part.cut_before(tick).filter(|_| self.cuts)?,
        };
        let (mut least, mut most) = (0, MOST_WAIT / WAIT_STEP);
        while most - least > 1 {
            let middle = u32::midpoint(least, most);
            if self.tried(&first, middle * WAIT_STEP).is_ok() {
                most = middle;
            } else {
                least = middle;
            }
        }
        let wait = most * WAIT_STEP;
        let ahead = self.tried(&first, wait).ok()?;
        self.push(first, wait, ahead);
        Some(left)
    }

    /// The strokes as they follow each other now.
    fn drawn(self, drawing: &Drawing) -> Option<Spread> {
        let mut counts = vec![0_usize; drawing.strokes.len()];
        let mut waits = Vec::new();
        let mut strokes: Vec<Stroke> = Vec::new();
        for Step { part, wait } in &self.steps {
            let of = drawing.strokes.get(part.stroke)?;
            counts[part.stroke] += 1;
            if *wait > 0 {
                waits.push(Wait { stroke: strokes.len(), time_s: f64::from(*wait) * TICK_F64_S });
            }
            let path = match part.is_whole() {
                true => vec![of.path.clone()],
                false => Measured::of(&of.path, 1e-7).stretches(&[[part.from_m, part.to_m]]),
            };
            strokes.extend(path.into_iter().map(|path| of.along(path)));
        }
        let cut = counts.iter().filter(|&&count| count > 1);
        Some(Spread { cut: cut.clone().count(), parts: cut.sum(), drawing: Drawing { strokes }, waits })
    }
}

impl<'a> Part<'a> {
    /// Whether it is all of its stroke.
    fn is_whole(&self) -> bool {
        self.from_m == 0.0 && self.to_m == f64::INFINITY
    }

    /// Both sides of a cut some time before a tick of it, where the spot stops if it does; `None` where one of them would be too short.
    fn cut_before(&self, tick: usize) -> Option<(Self, Self)> {
        let early = tick.checked_sub(EARLY_TICKS)?.min(self.points.len().checked_sub(LEAST_TICKS)?);
        // neither side is a mere dot
        let (mut at, mut after_m) = (early, lit_m(self.points.get(early..)?));
        while after_m < LEAST_M {
            at = at.checked_sub(1)?;
            after_m += lit_m(self.points.get(at..at + 2)?);
        }
        let is_still = |point: &PlanPoint| {
            let joints = &point.joints;
            joints.pan.velocity_rad_s == 0.0 && joints.tilt.velocity_rad_s == 0.0
        };
        let stops = (at.saturating_sub(STOP_TICKS)..at).rev();
        let stop =
            stops.into_iter().find(|&at| at >= LEAST_TICKS && self.points.get(at).is_some_and(is_still));
        let (before, after) = self.points.split_at_checked(stop.unwrap_or(at))?;
        let before_m = lit_m(before);
        if before_m < LEAST_M || before.len() < LEAST_TICKS {
            return None;
        }
        let at_m = self.from_m + before_m;
        Some((Self { to_m: at_m, points: before, ..*self }, Self { from_m: at_m, points: after, ..*self }))
    }
}

/// How far lit ticks go, m.
fn lit_m(points: &[PlanPoint]) -> f64 {
    points
        .windows(2)
        .filter(|pair| pair[1].lit && pair[0].lit)
        .map(|pair| pair[0].spot.distance(pair[1].spot))
        .sum()
}

/// Every stroke of a plan, with its ticks from its first light to its last.
fn whole_strokes<'a>(drawing: &Drawing, plan: &'a Plan) -> impl Iterator<Item = Part<'a>> {
    let mut ticks = plan.lit_ticks();
    ticks.resize(drawing.strokes.len(), None);
    ticks.into_iter().enumerate().map(|(stroke, lit)| {
        let points = lit.and_then(|[first, last]| plan.points.get(first as usize..=last as usize));
        Part { stroke, from_m: 0.0, to_m: f64::INFINITY, points: points.unwrap_or_default() }
    })
}

#[cfg(test)]
mod tests {
    use tracelight_aim::HeadPose;
    use tracelight_sim::{first_standing, slowest_speed};
    use tracelight_stroke::{Affine, Element, Path, Point};

    use super::*;
    use crate::driving::{Asked, Driving, request_of};
    use crate::ordering::Sequence;
    use crate::placed::Placed;
    use crate::schedule::{Schedule, schedule, schedule_as_it_is, schedule_rest, schedule_whole};

    fn driving() -> Driving {
        let rig = RigConfig::report();
        let request = request_of(&rig);
        Driving::new(rig, HeadPose::square_on(0.9144), request, Asked::default())
    }

    fn planned(strokes: Vec<Stroke>, driving: &Driving) -> Result<Schedule, tracelight_task::Failure> {
        let placed = Placed::of(Drawing { strokes }, (0.6, 0.4), Affine::IDENTITY);
        let schedule = schedule(&placed, driving)?;
        assert_eq!(first_standing(&driving.rig, &schedule.plan), None);
        Ok(schedule)
    }

    fn line(points: &[(f64, f64)]) -> Stroke {
        let points: Vec<Point> = points.iter().copied().map(Point::from).collect();
        Stroke::new(Path::polyline(&points, false).unwrap())
    }

    /// Lines to and fro across some millimetres, as in a shaded eye.
    fn scribble(turns: u32) -> Stroke {
        let side = |n: u32| if n.is_multiple_of(2) { -2e-3 } else { 2e-3 };
        line(&(0..turns).map(|n| (side(n), 1e-4 * f64::from(n))).collect::<Vec<_>>())
    }

    fn far(n: u32) -> Stroke {
        let y = 0.02 * f64::from(n) - 0.2;
        line(&[(0.1, y), (0.3, y)])
    }

    fn length_m(strokes: &[Stroke]) -> f64 {
        strokes.iter().map(|stroke| stroke.path.length(1e-9)).sum()
    }

    #[test]
    fn what_lies_close_together_is_drawn_at_different_times() {
        let short = (0..28).map(|n| line(&[(-2e-3, 1e-4 * f64::from(n)), (2e-3, 1e-4 * f64::from(n))]));
        let strokes: Vec<Stroke> = short.chain((0..24).map(far)).collect();
        let Schedule { ordered, notes, .. } = planned(strokes.clone(), &driving()).unwrap();
        assert_eq!(ordered.drawing.strokes.len(), strokes.len(), "none of them has to be cut");
        assert!((length_m(&ordered.drawing.strokes) - length_m(&strokes)).abs() < 1e-9);
        assert!(notes[0].contains("at different times:"), "{notes:?}");
        // they were put off until others were drawn
        let is_short = |stroke: &Stroke| stroke.path.start().x < 0.05;
        let turns =
            ordered.drawing.strokes.windows(2).filter(|pair| is_short(&pair[0]) != is_short(&pair[1]));
        assert!(turns.count() > 1);
    }

    #[test]
    fn a_stroke_that_stays_in_one_place_is_cut_and_nothing_of_it_is_lost() {
        let strokes = vec![scribble(60)];
        let Schedule { ordered, plan, notes } = planned(strokes.clone(), &driving()).unwrap();
        let parts = &ordered.drawing.strokes;
        assert!(parts.len() > 1 && notes[0].contains("it is dark for"), "{notes:?}");
        assert!((length_m(parts) - length_m(&strokes)).abs() < 1e-7);
        for pair in parts.windows(2) {
            assert!(pair[0].path.end().distance(pair[1].path.start()) < 1e-7);
        }
        // what is planned draws all of them, and is dark for as long as is said
        assert_eq!(plan.lit_ticks().iter().flatten().count(), parts.len());
        let dark_s: f64 =
            notes[0].split("dark for ").nth(1).unwrap().split(' ').next().unwrap().parse().unwrap();
        assert!(plan.duration_s() - plan.lit_s() > dark_s - 0.1);
    }

    #[test]
    fn what_was_spread_is_not_slowed_so_far_that_its_light_stands() {
        let driving = driving();
        let Schedule { plan, .. } = planned(vec![scribble(60)], &driving).unwrap();
        let slowest = slowest_speed(&driving.rig, &plan);
        assert!((0.5..=1.0).contains(&slowest), "{slowest}");
        // a line is drawn at any speed
        let Schedule { plan, .. } = planned(vec![far(0)], &driving).unwrap();
        assert_eq!(slowest_speed(&driving.rig, &plan), 0.0);
    }

    #[test]
    fn layers_stay_in_their_order() {
        let on = |stroke: Stroke, layer: &str| Stroke { layer: Some(layer.into()), ..stroke };
        let strokes = [on(scribble(60), "first"), on(far(0), "second"), on(far(1), "second")].to_vec();
        let mut driving = driving();
        driving.order.sequence = Sequence::Layers;
        let Schedule { ordered, .. } = planned(strokes, &driving).unwrap();
        let names: Vec<_> =
            ordered.drawing.strokes.iter().map(|stroke| stroke.layer.clone().unwrap()).collect();
        assert!(names.is_sorted() && names.len() > 3, "{names:?}");
    }

    #[test]
    fn strokes_that_are_known_by_their_numbers_are_not_cut() {
        let driving = driving();
        let drawing = Drawing { strokes: vec![scribble(60)] };
        let refused = schedule_as_it_is(drawing.clone(), &driving).map(|_| ()).unwrap_err();
        assert_eq!(refused.code, "standing-light");
        let parts = schedule_rest(drawing, &driving).unwrap().ordered.drawing.strokes;
        assert!(parts.len() > 1);
        // what is left of what was cut is planned again as it is, with its rests
        let rest = Drawing { strokes: parts[1..].to_vec() };
        let again = schedule_rest(rest.clone(), &driving).unwrap();
        assert_eq!(first_standing(&driving.rig, &again.plan), None);
        assert!((length_m(&again.ordered.drawing.strokes) - length_m(&rest.strokes)).abs() < 1e-7);
        // whole, each by its number, it rests as well
        let whole = schedule_whole(rest.clone(), &driving).unwrap();
        assert_eq!(first_standing(&driving.rig, &whole.plan), None);
        assert_eq!(whole.ordered.drawing.strokes.len(), rest.strokes.len());
        assert!(whole.notes[0].contains("long, it is dark for"), "{:?}", whole.notes);
        // and what no rest helps is refused
        let refused =
            schedule_whole(Drawing { strokes: vec![scribble(60)] }, &driving).map(|_| ()).unwrap_err();
        assert_eq!(refused.code, "standing-light");
    }

    #[test]
    fn what_never_begins_from_rest_cannot_wait() {
        let mut driving = driving();
        driving.request.lit_speed = tracelight_trajectory::LitSpeed::Exact;
        // round and round without a corner
        let mut circle = Path::new(Point::new(3e-3, 0.0));
        for _ in 0..80 {
            circle.push(Element::Arc { centre: Point::ORIGIN, sweep: std::f64::consts::TAU });
        }
        let refused = planned(vec![Stroke::new(circle)], &driving).map(|_| ()).unwrap_err();
        assert_eq!(refused.code, "standing-light", "{}", refused.message);
    }
}
