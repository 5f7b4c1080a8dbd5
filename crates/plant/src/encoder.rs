use tracelight_maths::sin;
use tracelight_rig::Measurement;
use tracelight_rig::wire::{LAST_STAMP, STAMPS_A_TICK};

/// Number of edges after which a quadrature encoder's misplacements repeat.
const PHASES: usize = 4;

/// One incremental encoder: count k is seen between its lower edge at (k − ½) and its upper at (k + ½) counts,
/// each edge misplaced by a four-phase table.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Encoder {
    count_rad: f64,
    edge_stamps: bool,
    edge_error_counts: [f64; PHASES],
    /// The disc's axis beside the joint's: amplitude in counts, and the angle at which it reads right.
    eccentricity: (f64, f64),
    slip: Slip,
    /// Share of edges the counter misses.
    lost_share: f64,
    dice: oorandom::Rand32,
    count: i32,
    /// Edges it missed, upwards less downwards.
    missed: i32,
    edge_age_ticks: Option<f32>,
}

/// A disc that slips on its shaft: from one angle of its joint on it turns by a share of what the joint turns.
#[derive(Clone, Copy, Debug)]
struct Slip {
    joint_rad: f64,
    /// Where the disc stood then.
    disc_rad: f64,
    share: f64,
}

impl Slip {
    const NONE: Self = Self { joint_rad: 0.0, disc_rad: 0.0, share: 1.0 };

    /// Where the disc stands, rad; that of [`Slip::NONE`] to the bit where its joint does.
    fn disc_rad(&self, joint_rad: f64) -> f64 {
        self.disc_rad + self.share * (joint_rad - self.joint_rad)
    }
}

impl Encoder {
    /// Homed: the count is that of `angle_rad`.
    pub(crate) fn new(
        count_rad: f64,
        edge_stamps: bool,
        edge_error_counts: [f64; PHASES],
        angle_rad: f64,
    ) -> Self {
        let count = (angle_rad / count_rad + 0.5).floor() as i32;
        Self {
            count_rad,
            edge_stamps,
            edge_error_counts,
            eccentricity: (0.0, angle_rad),
            slip: Slip::NONE,
            lost_share: 0.0,
            dice: oorandom::Rand32::new(0),
            count,
            missed: 0,
            edge_age_ticks: None,
        }
    }

    /// Adds an eccentric disc: amplitude in counts, direction in rad; the reading is correct at the homing position.
    pub(crate) fn eccentric(mut self, counts: f64, direction_rad: f64) -> Self {
        self.eccentricity = (counts, direction_rad);
        self
    }

    /// Adds a counter that misses this share of all edges.
    pub(crate) fn missing(mut self, share: f64, seed: u64) -> Self {
        self.lost_share = share;
        self.dice = oorandom::Rand32::new(seed);
        self
    }

    /// The disc slips on its shaft from this angle of the joint on: it turns by that share of what the joint turns.
    pub(crate) fn slips(&mut self, angle_rad: f64, share: f64) {
        // one that slips already stands elsewhere than its joint
        self.slip = Slip { joint_rad: angle_rad, disc_rad: self.slip.disc_rad(angle_rad), share };
    }

    /// What the disc makes of an angle, rad.
    fn on_disc(&self, angle_rad: f64) -> f64 {
        let angle_rad = self.slip.disc_rad(angle_rad);
        let (counts, direction) = self.eccentricity;
        if counts == 0.0 {
            return angle_rad;
        }
        angle_rad + counts * self.count_rad * (sin(angle_rad + direction) - sin(direction))
    }

    /// Whether the counter misses an edge.
    fn misses(&mut self) -> bool {
        self.lost_share > 0.0 && f64::from(self.dice.rand_float()) < self.lost_share
    }

    /// Angle of the edge below count `k`, rad.
    fn lower_edge_rad(&self, k: i32) -> f64 {
        let phase = k.rem_euclid(PHASES as i32) as usize;
        (f64::from(k) - 0.5 + self.edge_error_counts[phase]) * self.count_rad
    }

    /// Forgets the last tick's edge.
    pub(crate) fn begin_tick(&mut self) {
        self.edge_age_ticks = None;
    }

    /// Follows the joint from one angle to the next within a substep. `end_age_ticks` is how long before the
    /// tick's end the substep ends, `length_ticks` how long it is. Every edge is told: the count after it, and its age at the tick's end, ticks.
    #[inline]
    pub(crate) fn follow(
        &mut self,
        (from_rad, to_rad): (f64, f64),
        (end_age_ticks, length_ticks): (f64, f64),
        mut seen: impl FnMut(i32, f64),
    ) {
        const MOST_COUNTS: f64 = 1e3;
        let (from_rad, to_rad) = (self.on_disc(from_rad), self.on_disc(to_rad));
        let way = (to_rad - from_rad).abs();
        if !way.is_finite() || way > MOST_COUNTS * self.count_rad {
            // no joint does that: equations gone wrong are not followed edge by edge
            self.count = (to_rad / self.count_rad + 0.5).floor() as i32;
            return;
        }
        let age = |edge_rad: f64| {
            let left = (to_rad - edge_rad) / (to_rad - from_rad);
            end_age_ticks + left.clamp(0.0, 1.0) * length_ticks
        };
        while to_rad >= self.lower_edge_rad(self.count + 1) {
            self.count += 1;
            self.missed += i32::from(self.misses());
            let age = age(self.lower_edge_rad(self.count));
            self.stamp(age);
            seen(self.count - self.missed, age);
        }
        while to_rad < self.lower_edge_rad(self.count) {
            let age = age(self.lower_edge_rad(self.count));
            self.count -= 1;
            self.missed -= i32::from(self.misses());
            self.stamp(age);
            seen(self.count - self.missed, age);
        }
    }

    fn stamp(&mut self, age: f64) {
        if self.edge_stamps {
            // a stamp is a counter's value: these are what a wire carries, and finer than any timer's
            let most = f64::from(STAMPS_A_TICK);
            let steps = (age * most).floor().clamp(0.0, LAST_STAMP.into());
            self.edge_age_ticks = Some((steps / most) as f32);
        }
    }

    pub(crate) fn measurement(&self) -> Measurement {
        Measurement { count: self.count - self.missed, edge_age_ticks: self.edge_age_ticks }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_edge_is_stamped_when_it_is_crossed() {
        let mut encoder = Encoder::new(1.0, true, [0.0; 4], 0.0);
        encoder.begin_tick();
        encoder.follow((0.0, 1.0), (0.5, 0.5), |count, age| assert_eq!((count, age), (1, 0.75))); // crosses 0.5 halfway through the first half of the tick
        assert_eq!(encoder.measurement(), Measurement { count: 1, edge_age_ticks: Some(0.75) });
        encoder.begin_tick();
        encoder.follow((1.0, 0.4), (0.0, 1.0), |count, _| assert_eq!(count, 0)); // back over it
        assert_eq!(encoder.measurement().count, 0);
        encoder.begin_tick();
        encoder.follow((0.4, 0.3), (0.0, 1.0), |_, _| unreachable!());
        assert_eq!(encoder.measurement().edge_age_ticks, None);
    }

    #[test]
    fn misplaced_edges_move_the_count() {
        let encoder = |angle| {
            let mut e = Encoder::new(1.0, false, [0.0, 0.2, 0.0, 0.0], 0.0);
            e.follow((0.0, angle), (0.0, 1.0), |_, _| {});
            e.measurement()
        };
        assert_eq!(encoder(0.6).count, 0);
        assert_eq!(encoder(0.8), Measurement { count: 1, edge_age_ticks: None });
    }
}
