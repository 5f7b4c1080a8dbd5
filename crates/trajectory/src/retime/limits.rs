use tracelight_aim::JointPath;
use tracelight_rig::{Joint, PanTilt};

use crate::machine::Machine;

/// A place on a path: arc length (or any other parameter), joint angles and their derivatives by it, and the highest
/// speed wanted there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathSample {
    /// The parameter, m when it is arc length; the unit of speeds follows.
    pub s: f64,
    /// Angles and derivatives.
    pub joints: JointPath,
    /// Highest ds/dt.
    pub cap: f64,
}

/// Bounds on the acceleration along a path, unit/s².
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct AlongLimits {
    pub(crate) acceleration: f64,
    pub(crate) deceleration: f64,
}

/// A joint's torque on a path, τ = a·s̈ + b·ṡ² + c, friction left out, and the way it moves.
#[derive(Clone, Copy, Debug)]
struct JointTorque {
    a: f64,
    b: f64,
    c: f64,
    first: f64,
    second: f64,
}

/// What moving along the path at one place takes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    torque: PanTilt<JointTorque>,
    /// Bound on ṡ from speeds.
    speed_most: f64,
}

impl Place {
    pub(super) fn new(machine: &Machine, sample: &PathSample) -> Self {
        let JointPath { angle_rad, first, second } = sample.joints;
        let (mass, swing) = machine.lumped.mass_and_bias(angle_rad.tilt, first);
        let gravity = machine.lumped.gravity(angle_rad.tilt);
        let (along, bent) = (mass.times(first), mass.times(second));
        let mut speed_most = sample.cap;
        for j in Joint::BOTH {
            let rate = first[j].abs();
            if rate * speed_most > machine.speed_limit_rad_s[j] {
                speed_most = machine.speed_limit_rad_s[j] / rate;
            }
        }
        let torque = PanTilt::from_fn(|j| JointTorque {
            a: along[j],
            b: bent[j] + swing[j] - gravity[j],
            c: gravity[j],
            first: first[j],
            second: second[j],
        });
        Self { torque, speed_most }
    }

    /// The limits while the joints turn the given ways (+1 or −1).
    pub(super) fn rows<const N: usize>(&self, machine: &Machine, ways: PanTilt<f64>) -> Rows<N> {
        let mut rows = Rows { rows: [Row::FREE; N], count: 0, speed_most: self.speed_most };
        for j in Joint::BOTH {
            let JointTorque { a, b, c, first, second } = self.torque[j];
            let friction = &machine.friction[j];
            let (viscous, coulomb) = match ways[j] > 0.0 {
                true => (friction.viscous_pos, friction.coulomb_pos_nm),
                false => (friction.viscous_neg, friction.coulomb_neg_nm),
            };
            let torque = machine.usable_nm(j);
            rows.push([a, b, viscous * first, c + coulomb], torque);
            let wish = machine.acceleration_limit_rad_s2[j];
            if wish.is_finite() {
                rows.push([first, second, 0.0, 0.0], wish);
            }
        }
        rows.speed_most = rows.speed_most.min(rows.compatible());
        rows
    }

    /// A motion along the path with ṡ = w·v and s̈ = w²·u: up to which w it keeps to all limits but the cap.
    pub(super) fn most_pace(&self, machine: &Machine, v: f64, u: f64) -> f64 {
        let mut most = f64::INFINITY;
        for j in Joint::BOTH {
            let JointTorque { a, b, c, first, second } = self.torque[j];
            let friction = &machine.friction[j];
            let (viscous, coulomb) = match first {
                way if way > 0.0 => (friction.viscous_pos, friction.coulomb_pos_nm),
                way if way < 0.0 => (friction.viscous_neg, friction.coulomb_neg_nm),
                _ => (0.0, 0.0),
            };
            let torque = machine.usable_nm(j);
            let (square, linear, still) = (a * u + b * v * v, viscous * first * v, c + coulomb);
            most = most.min(first_root(square, linear, still - torque));
            most = most.min(first_root(-square, -linear, -still - torque));
            let acceleration = (first * u + second * v * v).abs();
            most = most.min((machine.acceleration_limit_rad_s2[j] / acceleration).sqrt());
            most = most.min(machine.speed_limit_rad_s[j] / (first * v).abs());
        }
        most
    }

    /// Torque that standing still and starting off the given way takes, N m.
    pub(super) fn starting_nm(&self, machine: &Machine, joint: Joint, way: f64) -> f64 {
        let friction = &machine.friction[joint];
        let coulomb = if way > 0.0 { friction.coulomb_pos_nm } else { friction.coulomb_neg_nm };
        self.torque[joint].c + coulomb
    }
}

/// |a·u + b·v² + d·v + c| ≤ most, solved for the acceleration: u lies within `reach` of m·v² + e·v + n.
#[derive(Clone, Copy, Debug)]
struct Row {
    m: f64,
    e: f64,
    n: f64,
    reach: f64,
}

impl Row {
    const FREE: Row = Row { m: 0.0, e: 0.0, n: 0.0, reach: f64::INFINITY };

    fn middle(&self, v: f64) -> f64 {
        (self.m * v + self.e) * v + self.n
    }
}

/// Rows of the joints: torque and acceleration of both.
pub(super) const OF_JOINTS: usize = 4;

/// All limits at one place: on the acceleration u = s̈ at a speed v = ṡ, and on the speed itself. There is room for `N` of
/// them, [`OF_JOINTS`] or one more: the passes are as fast as memory lets them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rows<const N: usize> {
    rows: [Row; N],
    count: usize,
    pub(super) speed_most: f64,
}

impl<const N: usize> Rows<N> {
    /// Adds |a·u + b·v² + d·v + c| ≤ most.
    fn push(&mut self, [a, b, d, c]: [f64; 4], most: f64) {
        // where a joint does not move along the path, as where it turns round, only the speed is bounded
        const STILL: f64 = 1e-9;
        if a.abs() <= STILL * b.abs() {
            let bound = first_root(b, d, c - most).min(first_root(-b, -d, -c - most));
            self.speed_most = self.speed_most.min(bound);
            return;
        }
        let inverse = 1.0 / a;
        self.rows[self.count] =
            Row { m: -b * inverse, e: -d * inverse, n: -c * inverse, reach: most * inverse.abs() };
        self.count += 1;
    }

    /// Bounds the acceleration along the path itself.
    pub(super) fn bound_along(&mut self, limits: &AlongLimits) {
        let AlongLimits { acceleration, deceleration } = *limits;
        let (n, reach) = (0.5 * (acceleration - deceleration), 0.5 * (acceleration + deceleration));
        self.rows[self.count] = Row { m: 0.0, e: 0.0, n, reach };
        self.count += 1;
        self.speed_most = self.speed_most.min(self.compatible());
    }

    fn each(&self) -> &[Row] {
        &self.rows[..self.count]
    }

    /// Least and largest acceleration at speed `v`.
    pub(super) fn range(&self, v: f64) -> (f64, f64) {
        self.each().iter().fold((f64::NEG_INFINITY, f64::INFINITY), |(low, high), row| {
            let middle = row.middle(v);
            (low.max(middle - row.reach), high.min(middle + row.reach))
        })
    }

    /// The speed up to which no acceleration keeps to all limits.
    pub(super) fn steady_most(&self) -> f64 {
        let either = |row: &Row| {
            first_root(row.m, row.e, row.n - row.reach).min(first_root(-row.m, -row.e, -row.n - row.reach))
        };
        self.each().iter().map(either).fold(self.speed_most, f64::min)
    }

    /// The speed up to which some acceleration keeps to all limits.
    fn compatible(&self) -> f64 {
        let mut most = f64::INFINITY;
        for (i, low) in self.each().iter().enumerate() {
            for (k, high) in self.each().iter().enumerate() {
                if i != k {
                    let least = low.n - low.reach - high.n - high.reach;
                    most = most.min(first_root(low.m - high.m, low.e - high.e, least));
                }
            }
        }
        most
    }

    /// The speed up to which 0 ≤ v² + h·u ≤ z for some allowed u: where limits press hard on a moving joint the motion
    /// would come to rest within h, and below.
    pub(super) fn slowest_ends_below(&self, h: f64, z: f64) -> f64 {
        let below = |row: &Row| first_root(1.0 + h * row.m, h * row.e, h * (row.n - row.reach) - z);
        let above = |row: &Row| first_root(-1.0 - h * row.m, -h * row.e, -h * (row.n + row.reach));
        self.each().iter().map(|row| below(row).min(above(row))).fold(self.speed_most, f64::min)
    }

    /// The speed up to which v² − h·u ≤ z for some allowed u.
    pub(super) fn fastest_comes_from(&self, h: f64, z: f64) -> f64 {
        let root = |row: &Row| first_root(1.0 - h * row.m, -h * row.e, -h * (row.n + row.reach) - z);
        self.each().iter().map(root).fold(self.speed_most, f64::min)
    }

    /// The largest v² − h·u for a speed up to `most`.
    pub(super) fn most_before(&self, h: f64, most: f64) -> f64 {
        self.before(h, self.best_before(h, most))
    }

    /// The highest speed up to `most` with v² − h·u ≥ z for some allowed u, if there is one.
    pub(super) fn fastest_after(&self, h: f64, z: f64, most: f64) -> f64 {
        if self.before(h, most) >= z {
            return most;
        }
        let (mut low, mut high) = (self.best_before(h, most), most);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if self.before(h, middle) >= z { low = middle } else { high = middle }
        }
        low
    }

    /// The largest v² − h·u at a speed.
    fn before(&self, h: f64, v: f64) -> f64 {
        v * v - h * self.range(v).0
    }

    /// The speed up to `most` where v² − h·u is largest. It grows with v but where a joint hardly moves, and there the
    /// largest is found by thirds: v² less the largest of curves bent upwards has one top.
    fn best_before(&self, h: f64, most: f64) -> f64 {
        if self.before(h, (1.0 - 1e-6) * most) <= self.before(h, most) {
            return most;
        }
        let (mut from, mut to) = (0.0, most);
        for _ in 0..60 {
            let (a, b) = (from + (to - from) / 3.0, to - (to - from) / 3.0);
            if self.before(h, a) < self.before(h, b) { from = a } else { to = b }
        }
        0.5 * (from + to)
    }
}

/// Where a v² + b v + c, below zero at v = 0, first comes up to it: 0 if it is not below, ∞ if it never does.
fn first_root(a: f64, b: f64, c: f64) -> f64 {
    if c >= 0.0 {
        return 0.0;
    }
    let square = b * b - 4.0 * a * c;
    if square < 0.0 {
        return f64::INFINITY;
    }
    let below = b + square.sqrt();
    // the usual formula times its conjugate: nothing cancels where b is positive, and a may be zero
    if below > 0.0 && b >= 0.0 {
        -2.0 * c / below
    } else if a > 0.0 {
        (square.sqrt() - b) / (2.0 * a)
    } else {
        f64::INFINITY
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_root_is_where_the_curve_first_reaches_zero() {
        let mut dice = oorandom::Rand64::new(3);
        let mut draw = || 4.0 * dice.rand_float() - 2.0;
        for _ in 0..10_000 {
            let (a, b, c) = (draw(), draw(), -draw().abs() - 1e-3);
            let curve = |v: f64| (a * v + b) * v + c;
            let root = first_root(a, b, c);
            let until = root.min(50.0);
            assert!((0..100).all(|i| curve(0.0099 * f64::from(i) * until) < 1e-9), "{a} {b} {c}: {root}");
            assert!(
                !root.is_finite() || curve(root).abs() < 1e-6 * (1.0 + root * root),
                "{a} {b} {c}: {root}"
            );
        }
    }
}
