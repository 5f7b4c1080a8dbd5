use super::bounds::Bounds;
use crate::move_point::MovePoint;

/// Stretches of constant jerk, one after the other.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Phases {
    each: [Stretch; 7],
    count: usize,
}

/// A time of constant jerk. Its first acceleration is kept too: what rounding leaves of it would grow with the square of
/// a long time.
#[derive(Clone, Copy, Debug, Default)]
struct Stretch {
    time_s: f64,
    jerk: f64,
    acceleration: f64,
}

impl Phases {
    /// Appends a stretch, if it has a length.
    pub(super) fn push(&mut self, time_s: f64, jerk: f64, acceleration: f64) {
        if time_s > 0.0 && self.count < self.each.len() {
            self.each[self.count] = Stretch { time_s, jerk, acceleration };
            self.count += 1;
        }
    }

    pub(super) fn duration_s(&self) -> f64 {
        self.times_s().sum()
    }

    pub(super) fn times_s(&self) -> impl Iterator<Item = f64> {
        self.each[..self.count].iter().map(|stretch| stretch.time_s)
    }

    /// Negates the motion.
    pub(super) fn mirrored(mut self) -> Self {
        for stretch in &mut self.each {
            stretch.jerk = -stretch.jerk;
            stretch.acceleration = -stretch.acceleration;
        }
        self
    }

    /// Where a motion that starts at `from` is after `t_s`.
    pub(super) fn at(&self, from: &MovePoint, t_s: f64) -> MovePoint {
        let (mut point, mut left) = (*from, t_s);
        for stretch in &self.each[..self.count] {
            point.acceleration = stretch.acceleration;
            point = after(&point, left.min(stretch.time_s), stretch.jerk);
            left -= stretch.time_s;
            if left <= 0.0 {
                break;
            }
        }
        point
    }
}

/// Where a motion of constant jerk is after `t`.
pub(super) fn after(from: &MovePoint, t: f64, jerk: f64) -> MovePoint {
    let MovePoint { position, velocity, acceleration } = *from;
    MovePoint {
        position: position + t * (velocity + t * (0.5 * acceleration + t * jerk / 6.0)),
        velocity: velocity + t * (acceleration + 0.5 * t * jerk),
        acceleration: acceleration + t * jerk,
    }
}

/// The fastest way back to where speed and acceleration can be kept within bounds; nothing if they can already.
///
/// Acceleration first comes within its bounds. If the speed is too high, or will be before the acceleration is gone,
/// the acceleration is then lowered to its least, as long as speed can still be kept above its own least.
pub(super) fn brake(start: &MovePoint, bounds: &Bounds) -> Phases {
    let mut phases = Phases::default();
    let [least, most] = bounds.acceleration;
    let jerk = bounds.jerk;
    let mut now = *start;
    let outside = now.acceleration - now.acceleration.clamp(least, most);
    if outside != 0.0 {
        let (time, jerk) = (outside.abs() / jerk, -jerk * outside.signum());
        phases.push(time, jerk, now.acceleration);
        now = after(&now, time, jerk);
        now.acceleration = now.acceleration.clamp(least, most);
    }
    let up = Falling { v: now.velocity, a: now.acceleration, bounds: *bounds };
    let down = Falling { v: -now.velocity, a: -now.acceleration, bounds: bounds.mirrored() };
    for (falling, way) in [(up, 1.0), (down, -1.0)] {
        if let Some((lowering, holding)) = falling.until_kept() {
            phases.push(lowering, -way * jerk, now.acceleration);
            phases.push(holding, 0.0, if way > 0.0 { least } else { most });
            break;
        }
    }
    phases
}

/// Speed that is to come below its bound.
struct Falling {
    v: f64,
    a: f64,
    bounds: Bounds,
}

impl Falling {
    /// How long the acceleration is lowered and then held, s; `None` where speed keeps to its bound as it is.
    fn until_kept(&self) -> Option<(f64, f64)> {
        let Self { v, a, bounds } = self;
        let (jerk, [lowest, highest]) = (bounds.jerk, bounds.velocity);
        let coming = if *a > 0.0 { v + 0.5 * a * a / jerk } else { *v };
        if coming <= highest {
            return None;
        }
        // v + (a² − x²)/2J at acceleration x ≤ 0: down to the bound, or to where x must end for the lower one
        let top = v + 0.5 * a * a / jerk;
        let (for_highest, for_lowest) = (2.0 * jerk * (top - highest), jerk * (top - lowest));
        let (least, wanted) = (-bounds.acceleration[0], for_highest.min(for_lowest).max(0.0));
        let (depth, holding) = if wanted <= least * least {
            (wanted.sqrt(), 0.0)
        } else {
            let [over_highest, over_lowest] = [for_highest, for_lowest].map(|square| square - least * least);
            (least, (0.5 * over_highest).min(over_lowest) / (jerk * least))
        };
        let lowering = (a + depth).max(0.0) / jerk;
        (lowering > 0.0 || holding > 0.0).then_some((lowering, holding))
    }
}
