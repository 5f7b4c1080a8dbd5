use super::bounds::Bounds;
use super::phases::Phases;
use crate::move_point::MovePoint;

/// Of all motions that turn one speed and acceleration into another in a given time, those that get furthest.
///
/// They raise the acceleration to a peak, lower it to a trough and raise it to its end, always at full jerk; peak and
/// trough are held where they are at their bounds, and the highest speed once it is reached. For a jerk J, peak p,
/// trough −b, start a and end e of the acceleration and rests t₂ at the peak and t₄ at the trough, the speed asked for
/// is reached where
///
/// p² − b² + J(p t₂ − b t₄) = K, with K = J(v₁ − v₀) − (e² − a²)/2.
///
/// All of them are told apart by q = J T + a − e = 2(p + b) + J(t₂ + t₄), which is the time T but for scale and offset:
/// with nothing held, p + b = q/2 and p − b = 2K/q; with the peak held at A, (A + b)² = A q − K. K is taken as positive:
/// else the motion is looked at backwards in time.
#[derive(Clone, Copy, Debug)]
pub(super) struct Furthest {
    jerk: f64,
    /// Bounds of the peak and of the trough, both positive.
    peak_most: f64,
    trough_most: f64,
    speed_most: f64,
    from: Ends,
    to: Ends,
    k: f64,
    backwards: bool,
    edges: Edges,
    /// Where these motions begin, and a stretch of q within which there are none.
    pub(super) start: Shape,
    pub(super) gap: Option<(Shape, Shape)>,
    /// Where the highest speed is reached.
    cruise: Shape,
}

/// Speed and acceleration at an end.
#[derive(Clone, Copy, Debug)]
struct Ends {
    v: f64,
    a: f64,
}

/// Where what is held changes, in q: the peak below `free` and above `free_until`, if `peak_first`, else the trough;
/// both above `both`.
#[derive(Clone, Copy, Debug)]
struct Edges {
    free: f64,
    free_until: f64,
    both: f64,
    peak_first: bool,
}

/// One of the motions.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shape {
    pub(super) q: f64,
    peak: f64,
    /// How far the trough is below zero.
    trough: f64,
    peak_held: f64,
    trough_held: f64,
    cruise: f64,
}

impl Furthest {
    pub(super) fn new(from: &MovePoint, to: &MovePoint, bounds: &Bounds) -> Self {
        let ends = |p: &MovePoint| Ends { v: p.velocity, a: p.acceleration };
        let (from, to) = (ends(from), ends(to));
        let [down, up] = bounds.acceleration;
        let k = bounds.jerk * (to.v - from.v) - 0.5 * (to.a * to.a - from.a * from.a);
        let backwards = k < 0.0;
        let mirrored = |end: Ends| Ends { v: end.v, a: -end.a };
        let (from, to) = if backwards { (mirrored(to), mirrored(from)) } else { (from, to) };
        let (peak_most, trough_most) = if backwards { (-down, up) } else { (up, -down) };
        let nothing = Shape { q: 0.0, peak: 0.0, trough: 0.0, peak_held: 0.0, trough_held: 0.0, cruise: 0.0 };
        let mut family = Self {
            jerk: bounds.jerk,
            peak_most,
            trough_most,
            speed_most: bounds.velocity[1],
            from,
            to,
            k: k.abs(),
            backwards,
            edges: Edges::of(k.abs(), peak_most, trough_most),
            start: nothing,
            gap: None,
            cruise: nothing,
        };
        family.cruise = family.at_full_speed();
        (family.start, family.gap) = family.starts();
        family
    }

    /// How long a motion takes, s.
    pub(super) fn duration_s(&self, q: f64) -> f64 {
        (q + self.to.a - self.from.a) / self.jerk
    }

    pub(super) fn q_of(&self, duration_s: f64) -> f64 {
        self.jerk * duration_s + self.from.a - self.to.a
    }

    /// A motion that leaves nothing held, but for the trough if it would be too deep, with its peak given.
    fn with_peak(&self, peak: f64, trough: f64) -> Shape {
        let d = self.trough_most;
        let (trough, q) = if trough <= d {
            (trough, 2.0 * (peak + trough))
        } else {
            (d, ((peak + d) * (peak + d) - self.k) / d)
        };
        let held = (q - 2.0 * (peak + trough)) / self.jerk;
        Shape { q, peak, trough, peak_held: 0.0, trough_held: held, cruise: 0.0 }
    }

    /// The shortest motion, and the gap if there is one.
    ///
    /// The shortest rises to a peak and falls to its end, if the peak that takes is above where it comes from; else it
    /// falls at once and rises. Where both ends speed up there may be motions of the first kind whose trough is above
    /// zero, and none between these and those of the second: whoever speeds up gains speed by waiting.
    fn starts(&self) -> (Shape, Option<(Shape, Shape)>) {
        let (a, e, k) = (self.from.a, self.to.a, self.k);
        let spare = a * a - k;
        let root = spare.max(0.0).sqrt();
        let falls_at_once = a > 0.0 && spare > 0.0;
        let deep = || self.with_peak(a, root);
        if falls_at_once && e.abs() < root {
            return (deep(), None);
        }
        let peak = (k + e * e).sqrt();
        let start = if peak <= self.peak_most {
            // peak + trough = K / (peak − trough), whichever does not cancel
            let depth = if e > 0.0 { k / (peak + e) } else { peak - e };
            Shape { q: 2.0 * depth, peak, trough: -e, peak_held: 0.0, trough_held: 0.0, cruise: 0.0 }
        } else {
            let most = self.peak_most;
            let q = ((most - e) * (most - e) + k) / most;
            let held = (q - 2.0 * (most - e)) / self.jerk;
            Shape { q, peak: most, trough: -e, peak_held: held, trough_held: 0.0, cruise: 0.0 }
        };
        if !(falls_at_once && e > 0.0) {
            return (start, None);
        }
        let shallow = Shape {
            q: 2.0 * k / (a + root),
            peak: a,
            trough: -root,
            peak_held: 0.0,
            trough_held: 0.0,
            cruise: 0.0,
        };
        (start, Some((shallow, deep())))
    }

    /// The motion that just reaches the highest speed.
    fn at_full_speed(&self) -> Shape {
        let lacking = |end: Ends| (self.jerk * (self.speed_most - end.v) + 0.5 * end.a * end.a).max(0.0);
        let held = |square: f64, most: f64| {
            let over = square - most * most;
            if over > 0.0 { (most, over / (self.jerk * most)) } else { (square.sqrt(), 0.0) }
        };
        let (peak, peak_held) = held(lacking(self.from), self.peak_most);
        let (trough, trough_held) = held(lacking(self.to), self.trough_most);
        let q = 2.0 * (peak + trough) + self.jerk * (peak_held + trough_held);
        Shape { q, peak, trough, peak_held, trough_held, cruise: 0.0 }
    }

    /// The motion of a given q.
    pub(super) fn shape(&self, q: f64) -> Shape {
        if q >= self.cruise.q {
            return Shape { q, cruise: (q - self.cruise.q) / self.jerk, ..self.cruise };
        }
        if q <= self.start.q {
            return self.start;
        }
        let (a, d, k, edges) = (self.peak_most, self.trough_most, self.k, &self.edges);
        if q >= edges.both {
            let held = (q - 2.0 * (a + d)) / self.jerk;
            // p t₂ − b t₄ is what K asks for
            let uneven = (k + d * d - a * a) / self.jerk;
            let peak_held = (uneven + d * held) / (a + d);
            let trough_held = held - peak_held;
            return Shape { q, peak: a, trough: d, peak_held, trough_held, cruise: 0.0 };
        }
        if q < edges.free || (q > edges.free_until && edges.peak_first) {
            let trough = (a * q - k).max(0.0).sqrt() - a;
            let peak_held = (q - 2.0 * (a + trough)) / self.jerk;
            return Shape { q, peak: a, trough, peak_held, trough_held: 0.0, cruise: 0.0 };
        }
        if q > edges.free_until {
            let peak = (k + d * q).sqrt() - d;
            let trough_held = (q - 2.0 * (peak + d)) / self.jerk;
            return Shape { q, peak, trough: d, peak_held: 0.0, trough_held, cruise: 0.0 };
        }
        let sum = 0.5 * q;
        let difference = if sum > 0.0 { k / sum } else { 0.0 };
        let (peak, trough) = (0.5 * (sum + difference), 0.5 * (sum - difference));
        Shape { q, peak, trough, peak_held: 0.0, trough_held: 0.0, cruise: 0.0 }
    }

    /// How far a motion gets, and how much further per second of longer duration.
    ///
    /// The latter is the Hamiltonian: the speed at the end of the peak, and half the fall that follows times the peak.
    pub(super) fn reach(&self, shape: &Shape) -> (f64, f64) {
        let Shape { peak: p, trough: b, peak_held, trough_held, cruise, .. } = *shape;
        let (from, to, r) = (self.from, self.to, 1.0 / self.jerk);
        let (t1, t3, t5) = ((p - from.a) * r, (p + b) * r, (to.a + b) * r);
        let v1 = from.v + 0.5 * (p + from.a) * t1;
        let v2 = v1 + p * peak_held;
        let v4 = to.v - 0.5 * (to.a - b) * t5;
        let rise = t1 * (from.v + t1 * (2.0 * from.a + p) / 6.0) + peak_held * (v1 + 0.5 * p * peak_held);
        let fall = t3 * (v2 + t3 * (2.0 * p - b) / 6.0);
        let end = t5 * (to.v - t5 * (2.0 * to.a - b) / 6.0) + trough_held * (v4 + 0.5 * b * trough_held);
        let distance = rise + fall + end + self.cruise_m(cruise);
        let slope = if cruise > 0.0 { self.speed_most } else { v2 + 0.5 * p * t3 };
        (distance, slope)
    }

    fn cruise_m(&self, time: f64) -> f64 {
        if time > 0.0 { time * self.speed_most } else { 0.0 }
    }

    /// Of the motions longer than `from`, which gets less far than `target`, the shortest that gets there, up to `until`.
    pub(super) fn first_to_reach(&self, target: f64, from: f64, until: f64) -> Option<f64> {
        let slope = |q: f64| self.reach(&self.shape(q)).1;
        let mut from = from;
        // a range that is next to none may end a rounding error before it begins
        let until = until.max(from);
        // The slope falls, then rises: distance may have a top and a bottom. It only rises where the trough is below zero.
        if from * from < 4.0 * self.k {
            let bottom = self.least_slope().clamp(from, until);
            if slope(bottom) < 0.0 {
                if slope(from) > 0.0 {
                    let top = bisect(from, bottom, |q| slope(q) > 0.0);
                    if self.reach(&self.shape(top)).0 >= target {
                        return Some(self.crossing(target, from, top));
                    }
                }
                from = bottom;
            }
        }
        // one crossing is left: it is looked for from the far end, where formulas are simple
        let (cruising, both) = (self.cruise.q.max(from), self.edges.both.max(from));
        let missing = |q: f64| {
            let (distance, slope) = self.reach(&self.shape(q));
            (target - distance, slope)
        };
        let mut high = until;
        if cruising < high {
            let (missing, _) = missing(cruising);
            if missing >= 0.0 {
                let q = cruising + self.jerk * missing / self.speed_most;
                return (q <= until).then_some(q);
            }
            high = cruising;
        } else if missing(until).0 > 0.0 {
            return None;
        }
        if both < high {
            let (missing, slope) = missing(both);
            if missing >= 0.0 {
                // with both held, the slope is linear
                let bend = self.peak_most * self.trough_most / (self.peak_most + self.trough_most);
                let root = (slope * slope + 2.0 * bend * missing).max(0.0).sqrt();
                let by = if slope > 0.0 { 2.0 * missing / (slope + root) } else { (root - slope) / bend };
                return Some((both + self.jerk * by).min(high));
            }
            high = both;
        }
        Some(self.crossing(target, from, high))
    }

    /// Where distance grows slowest with time.
    fn least_slope(&self) -> f64 {
        let (a, k) = (self.peak_most, self.k);
        let held = (0.5625 * a * a + k) / a;
        if held < self.edges.free {
            held
        } else {
            // (peak + trough)⁴ = K²/3
            (2.0 * (k / 3f64.sqrt()).sqrt()).max(self.edges.free)
        }
    }

    /// Where the distance passes `target`, between a motion that does not get there and one that does.
    fn crossing(&self, target: f64, from: f64, to: f64) -> f64 {
        let (mut low, mut high, mut q) = (from, to, to);
        for _ in 0..80 {
            let (distance, slope) = self.reach(&self.shape(q));
            let over = distance - target;
            if over >= 0.0 {
                high = q
            } else {
                low = q
            }
            let step = over * self.jerk / slope;
            let next = q - step;
            let newton = next > low && next < high;
            let next = if newton { next } else { 0.5 * (low + high) };
            if (next - q).abs() <= 1e-15 * self.peak_most || high - low <= f64::EPSILON * high {
                return next;
            }
            q = next;
        }
        high
    }

    /// The motion as stretches of constant jerk.
    pub(super) fn phases(&self, shape: &Shape) -> Phases {
        let Shape { peak, trough, peak_held, trough_held, cruise, .. } = *shape;
        let (j, r, from, to) = (self.jerk, 1.0 / self.jerk, self.from.a, self.to.a);
        // time, jerk, acceleration at the start and at the end
        let top = if cruise > 0.0 { 0.0 } else { -trough };
        let all = [
            ((peak - from) * r, j, from, peak),
            (peak_held, 0.0, peak, peak),
            ((peak - top) * r, -j, peak, top),
            (cruise, 0.0, 0.0, 0.0),
            ((trough + top) * r, -j, top, -trough),
            (trough_held, 0.0, -trough, -trough),
            ((to + trough) * r, j, -trough, to),
        ];
        let mut phases = Phases::default();
        if self.backwards {
            all.iter().rev().for_each(|&(time, jerk, _, end)| phases.push(time, jerk, -end));
        } else {
            all.iter().for_each(|&(time, jerk, start, _)| phases.push(time, jerk, start));
        }
        phases
    }
}

impl Edges {
    fn of(k: f64, a: f64, d: f64) -> Self {
        let below = a * a - k;
        let peak_held_throughout = below < 0.0;
        let depth = below.max(0.0).sqrt();
        let peak_first = peak_held_throughout || depth <= d;
        let free = if peak_held_throughout { f64::NEG_INFINITY } else { 2.0 * k / (a + depth) };
        let free_until = if peak_held_throughout {
            f64::NEG_INFINITY
        } else if peak_first {
            2.0 * (a + depth)
        } else {
            2.0 * ((k + d * d).sqrt() + d)
        };
        let both = if peak_first { ((a + d) * (a + d) + k) / a } else { ((a + d) * (a + d) - k) / d };
        Self { free, free_until, both, peak_first }
    }
}

/// The end of the stretch from `low` on where `holds`, which it does not at `high`.
fn bisect(mut low: f64, mut high: f64, holds: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if holds(middle) { low = middle } else { high = middle }
    }
    low
}
