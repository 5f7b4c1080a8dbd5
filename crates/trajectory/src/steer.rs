//! Time-optimal, jerk-limited moves between arbitrary states, with several joints synchronized.
//!
//! A joint's move from one speed and acceleration to another in a given time T can cover any distance between two
//! bounds, and no other: all constraints are linear, so what can be done is convex. The bound on either side is reached
//! at full jerk ([`furthest`]). The fastest move is the shortest T whose bounds enclose the distance asked for; it lies
//! on one of them. A joint that has to take longer, for another one to keep up, mixes the two motions at the bounds in
//! proportion: every mixture keeps to every limit, so the step that makes joints wait for each other cannot fail.
//!
//! After Kröger & Wahl, "Online trajectory generation", IEEE T-RO 2010, and Berscheid & Kröger, "Jerk-limited real-time
//! trajectory generation with arbitrary target states", RSS 2021, who enumerate profiles and solve their polynomials;
//! the bounds and the mixture are our own.

pub(crate) mod bounds;
mod furthest;
mod phases;

use bounds::Bounds;
use furthest::{Furthest, Shape};
use phases::{Phases, brake};

use crate::move_point::MovePoint;

/// Why there is no such move. Joints are counted from 0.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum SteerError {
    /// A number that is none, infinite, or of the wrong sign.
    #[error("joint {joint}: {what} is {value}; it must be {asked}")]
    Number {
        /// Which joint.
        joint: usize,
        /// Which number.
        what: &'static str,
        /// Its value.
        value: f64,
        /// What it must be.
        asked: &'static str,
    },
    /// The move would have to leave the limits to arrive as asked.
    #[error("joint {joint}: it is to arrive with {what} {value}, beyond its bound {bound}; arrive slower")]
    Target {
        /// Which joint.
        joint: usize,
        /// What is beyond its bound.
        what: &'static str,
        /// Its value, unit/s or unit/s².
        value: f64,
        /// The bound.
        bound: f64,
    },
}

/// A move of `N` joints that all arrive at the same time.
#[derive(Clone, Copy, Debug)]
pub struct Steered<const N: usize> {
    joints: [JointMove; N],
    duration_s: f64,
}

/// The fastest move of `N` joints from one state to another, all arriving together.
///
/// A start outside the limits is brought back inside on the shortest way first; the end must be inside them, and such
/// that it can be reached from inside.
///
/// # Errors
/// [`SteerError`] names the joint, the number and its bound.
pub fn steer<const N: usize>(
    from: &[MovePoint; N],
    to: &[MovePoint; N],
    bounds: &[Bounds; N],
) -> Result<Steered<N>, SteerError> {
    steer_no_faster(from, to, bounds, 0.0)
}

/// Finds the fastest move of at least `at_least_s`.
///
/// The move may take longer than asked: a fast start cannot wait for an arbitrary time.
///
/// # Errors
/// As [`steer`].
pub fn steer_no_faster<const N: usize>(
    from: &[MovePoint; N],
    to: &[MovePoint; N],
    bounds: &[Bounds; N],
    at_least_s: f64,
) -> Result<Steered<N>, SteerError> {
    for joint in 0..N {
        check(joint, &from[joint], &to[joint], &bounds[joint])?;
    }
    let mut problems: [Problem; N] =
        core::array::from_fn(|joint| Problem::new(&from[joint], &to[joint], &bounds[joint]));
    let mut choices = [Choice { duration_s: 0.0, upper: None, lower: None, share: 0.0 }; N];
    let mut duration_s = None;
    // A joint that is made to wait may have to wait longer still, and then others with it. Each of them has at most
    // three stretches of time it cannot do.
    for _ in 0..8 * N.max(1) {
        let mut longest: f64 = duration_s.unwrap_or(at_least_s);
        for (problem, choice) in problems.iter_mut().zip(&mut choices) {
            if choice.duration_s < longest || duration_s.is_none() {
                *choice = problem.first_from(longest);
            }
            longest = choice.duration_s.max(longest);
        }
        if duration_s == Some(longest) {
            break;
        }
        duration_s = Some(longest);
    }
    let duration_s = duration_s.unwrap_or(at_least_s);
    let joints = core::array::from_fn(|joint| problems[joint].chosen(&choices[joint]));
    Ok(Steered { joints, duration_s })
}

impl<const N: usize> Steered<N> {
    /// Length of the move, s.
    pub const fn duration_s(&self) -> f64 {
        self.duration_s
    }

    /// Where all joints are at time `t_s`; before the start at the start, after the end at the end.
    pub fn at(&self, t_s: f64) -> [MovePoint; N] {
        core::array::from_fn(|joint| {
            let way = &self.joints[joint];
            if t_s >= self.duration_s {
                way.to
            } else if t_s <= 0.0 {
                way.from
            } else {
                way.at(t_s)
            }
        })
    }

    /// The times between which each joint's jerk is constant, in order, with the start and the end.
    pub fn breaks_s(&self, joint: usize) -> Vec<f64> {
        let way = &self.joints[joint];
        let mut breaks = vec![0.0, self.duration_s];
        let mut add = |start: f64, phases: &Phases| {
            let ends = phases.times_s().scan(start, |t, time| {
                *t += time;
                Some(*t)
            });
            breaks.extend(ends.filter(|t| *t < self.duration_s));
        };
        add(0.0, &way.brake);
        add(way.brake_s, &way.upper);
        add(way.brake_s, &way.lower);
        breaks.sort_by(f64::total_cmp);
        breaks.dedup();
        breaks
    }
}

/// One joint's move: back within the limits, then two motions mixed.
#[derive(Clone, Copy, Debug)]
struct JointMove {
    from: MovePoint,
    to: MovePoint,
    brake: Phases,
    brake_s: f64,
    upper: Phases,
    lower: Phases,
    /// Of the upper motion.
    share: f64,
}

impl JointMove {
    fn at(&self, t_s: f64) -> MovePoint {
        if t_s < self.brake_s {
            return self.brake.at(&self.from, t_s);
        }
        let from = if self.brake_s > 0.0 { self.brake.at(&self.from, self.brake_s) } else { self.from };
        let t = t_s - self.brake_s;
        if self.share >= 1.0 {
            return self.upper.at(&from, t);
        }
        let lower = self.lower.at(&from, t);
        if self.share <= 0.0 {
            return lower;
        }
        let upper = self.upper.at(&from, t);
        let mix = |a: f64, b: f64| b + self.share * (a - b);
        MovePoint {
            position: mix(upper.position, lower.position),
            velocity: mix(upper.velocity, lower.velocity),
            acceleration: mix(upper.acceleration, lower.acceleration),
        }
    }
}

/// One joint's problem, within its limits from the start.
struct Problem {
    from: MovePoint,
    to: MovePoint,
    brake: Phases,
    brake_s: f64,
    /// Where it is after the braking.
    inside: MovePoint,
    bounds: Bounds,
    upper: Option<Furthest>,
    /// Of the same problem looked at in a mirror.
    lower: Option<Furthest>,
}

/// A joint's duration, braking included, and its motion: that at the upper bound of the distance, that at the lower, or
/// a share of the former with the rest of the latter.
#[derive(Clone, Copy)]
struct Choice {
    duration_s: f64,
    upper: Option<Shape>,
    lower: Option<Shape>,
    share: f64,
}

impl Problem {
    fn new(from: &MovePoint, to: &MovePoint, bounds: &Bounds) -> Self {
        let brake = brake(from, bounds);
        let brake_s = brake.duration_s();
        let inside = if brake_s > 0.0 { brake.at(from, brake_s) } else { *from };
        Self { from: *from, to: *to, brake, brake_s, inside, bounds: *bounds, upper: None, lower: None }
    }

    fn upper(&mut self) -> &Furthest {
        self.upper.get_or_insert_with(|| Furthest::new(&self.inside, &self.to, &self.bounds))
    }

    fn lower(&mut self) -> &Furthest {
        self.lower.get_or_insert_with(|| {
            Furthest::new(&self.inside.mirrored(), &self.to.mirrored(), &self.bounds.mirrored())
        })
    }

    fn side(&mut self, is_upper: bool) -> &Furthest {
        if is_upper { self.upper() } else { self.lower() }
    }

    /// The shortest move that takes `at_least_s`.
    fn first_from(&mut self, at_least_s: f64) -> Choice {
        let at_least = at_least_s - self.brake_s;
        let distance = self.to.position - self.inside.position;
        // at its start a family's distance is the only one, so either tells on which side the target lies
        let guess = distance >= 0.0;
        let any = self.side(guess);
        let (start, gap) = (any.start, any.gap);
        let ranges = match gap {
            None => [Some((start, f64::INFINITY)), None],
            Some((end, next)) => {
                let end_s = any.duration_s(end.q);
                [Some((start, end_s)), Some((next, f64::INFINITY))]
            }
        };
        for (start, end_s) in ranges.into_iter().flatten() {
            if let Some(choice) = self.within(distance, guess, &start, end_s, at_least) {
                return choice;
            }
        }
        // not reached: the last range has no end, and its distance none either
        Choice { duration_s: f64::INFINITY, upper: Some(start), lower: None, share: 1.0 }
    }

    /// Searches one gap-free range of durations, which begins with `start` on the side `guess`.
    fn within(
        &mut self,
        distance: f64,
        guess: bool,
        start: &Shape,
        end_s: f64,
        at_least: f64,
    ) -> Option<Choice> {
        let any = self.side(guess);
        let start_s = any.duration_s(start.q);
        if at_least > end_s {
            return None;
        }
        if at_least <= start_s {
            let towards = if guess { distance } else { -distance };
            let beyond = towards - any.reach(start).0;
            if beyond == 0.0 {
                return Some(self.choice(guess, *start, start_s));
            }
            return self.at_bound(distance, (beyond > 0.0) == guess, start_s, end_s);
        }
        let up = self.upper();
        let upper = up.shape(up.q_of(at_least));
        let most = up.reach(&upper).0;
        if distance > most {
            return self.at_bound(distance, true, at_least, end_s);
        }
        let down = self.lower();
        let lower = down.shape(down.q_of(at_least));
        let least = -down.reach(&lower).0;
        if distance < least {
            return self.at_bound(distance, false, at_least, end_s);
        }
        let share = if most > least { ((distance - least) / (most - least)).clamp(0.0, 1.0) } else { 1.0 };
        let duration_s = at_least + self.brake_s;
        Some(Choice { duration_s, upper: Some(upper), lower: Some(lower), share })
    }

    /// The shortest move from `from_s` on that gets as far as asked on one side.
    fn at_bound(&mut self, distance: f64, is_upper: bool, from_s: f64, end_s: f64) -> Option<Choice> {
        let family = self.side(is_upper);
        let towards = if is_upper { distance } else { -distance };
        // the start of a range may lie a rounding error before the family's own
        let from = family.q_of(from_s);
        let until = if end_s.is_finite() { family.q_of(end_s) } else { f64::INFINITY };
        let q = family.first_to_reach(towards, from, until)?;
        let (shape, duration) = (family.shape(q), family.duration_s(q));
        Some(self.choice(is_upper, shape, duration))
    }

    fn choice(&self, is_upper: bool, shape: Shape, duration: f64) -> Choice {
        let duration_s = duration + self.brake_s;
        let (upper, lower) = if is_upper { (Some(shape), None) } else { (None, Some(shape)) };
        Choice { duration_s, upper, lower, share: if is_upper { 1.0 } else { 0.0 } }
    }

    fn chosen(&self, choice: &Choice) -> JointMove {
        let phases = |family: &Option<Furthest>, shape: &Option<Shape>| match (family, shape) {
            (Some(family), Some(shape)) => family.phases(shape),
            _ => Phases::default(),
        };
        JointMove {
            from: self.from,
            to: self.to,
            brake: self.brake,
            brake_s: self.brake_s,
            upper: phases(&self.upper, &choice.upper),
            lower: phases(&self.lower, &choice.lower).mirrored(),
            share: choice.share,
        }
    }
}

fn check(joint: usize, from: &MovePoint, to: &MovePoint, bounds: &Bounds) -> Result<(), SteerError> {
    let number = |what, value: f64, fine: bool, asked| {
        if fine { Ok(()) } else { Err(SteerError::Number { joint, what, value, asked }) }
    };
    for (what, point) in [("the start", from), ("the end", to)] {
        for value in [point.position, point.velocity, point.acceleration] {
            number(what, value, value.is_finite(), "finite")?;
        }
    }
    let [v, a] = [bounds.velocity, bounds.acceleration];
    for (what, value) in [
        ("the highest velocity", v[1]),
        ("the highest acceleration", a[1]),
        ("the highest jerk", bounds.jerk),
    ] {
        number(what, value, value > 0.0 && value.is_finite(), "above zero and finite")?;
    }
    for (what, value) in [("the least velocity", v[0]), ("the least acceleration", a[0])] {
        number(what, value, value < 0.0 && value.is_finite(), "below zero and finite")?;
    }
    // speed on arrival, and where it comes from while the acceleration is built up
    let before = to.velocity - 0.5 * to.acceleration * to.acceleration.abs() / bounds.jerk;
    for (what, value, [least, most]) in [
        ("acceleration", to.acceleration, a),
        ("velocity", to.velocity, v),
        ("a velocity just before of", before, v),
    ] {
        let bound = value.clamp(least, most);
        if value != bound {
            return Err(SteerError::Target { joint, what, value, bound });
        }
    }
    Ok(())
}
