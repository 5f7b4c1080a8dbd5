//! Assigns speed along a path: the set speed, reduced where the motors require it.
//!
//! With s the place on the path, v = ṡ and u = s̈, every motor's torque is τ = a·u + b·v² + d·v + c: inertia, inertia
//! and centrifugal forces of the bend, viscous friction, and gravity with Coulomb friction. So at each place and speed
//! the limits leave a range of u ([`limits`]), and two passes over the places find the fastest way through
//! ([`passes`]). A [`law`] makes it a motion over time.

pub(crate) mod along;
mod law;
mod limits;
mod passes;
mod smooth;

use tracelight_aim::JointPath;
use tracelight_rig::{Joint, PanTilt};

use along::Along;
pub(crate) use law::TimeLaw;
pub(crate) use limits::AlongLimits;
pub use limits::PathSample;
use passes::Speeds;
pub use smooth::limits::JointLimits;
pub use smooth::{Smooth, SmoothError, retime_smooth};

use crate::error::PlanError;
use crate::machine::Machine;
use crate::motion::JointMotion;

/// The fastest motion along a path.
#[derive(Clone, Debug)]
pub struct Retimed {
    samples: Vec<PathSample>,
    speeds: Speeds,
}

/// The fastest motion along sampled places that keeps to the motors' torque with all friction, to joint speeds and
/// accelerations, and to each sample's cap, from rest to rest. Between samples the acceleration is linear over s; the
/// limits hold at the samples, and between them but for what the path bends within a cell.
///
/// There must be three samples at least, and at each of them a joint that moves or a cap above zero. Two samples may
/// share a place where the path's curvature jumps. Where a joint turns round between two samples, a
/// place is put in, since friction jumps there.
///
/// # Errors
/// [`PlanError::TooWeak`] where a motor cannot start its joint.
pub fn retime(machine: &Machine, samples: &[PathSample]) -> Result<Retimed, PlanError> {
    Retimed::new(machine, samples.to_vec(), [0.0, 0.0])
}

/// The highest speed that can be kept along all of the samples, without any acceleration along the path, and the
/// number of the sample that bounds it; caps count too.
pub(crate) fn steady_speed(machine: &Machine, samples: &[PathSample]) -> (f64, usize) {
    let mut slowest = (f64::INFINITY, 0);
    for (i, sample) in samples.iter().enumerate() {
        let ways = sample.joints.first.map(|first| if first < 0.0 { -1.0 } else { 1.0 });
        let speed =
            limits::Place::new(machine, sample).rows::<{ limits::OF_JOINTS }>(machine, ways).steady_most();
        if speed < slowest.0 {
            slowest = (speed, i);
        }
    }
    slowest
}

/// Up to which w a motion along the path with ṡ = w·v and s̈ = w²·u keeps to the motors' torque and the joints' speeds
/// and accelerations at a place.
pub(crate) fn most_pace(machine: &Machine, sample: &PathSample, v: f64, u: f64) -> f64 {
    limits::Place::new(machine, sample).most_pace(machine, v, u)
}

impl Retimed {
    /// With the highest speeds at both ends.
    pub(crate) fn new(
        machine: &Machine,
        samples: Vec<PathSample>,
        ends: [f64; 2],
    ) -> Result<Self, PlanError> {
        Self::within(machine, samples, ends, None)
    }

    /// With bounds on the acceleration along the path too.
    pub(crate) fn within(
        machine: &Machine,
        samples: Vec<PathSample>,
        ends: [f64; 2],
        along: Option<&AlongLimits>,
    ) -> Result<Self, PlanError> {
        let samples = with_turning_places(samples);
        let speeds = passes::fastest(machine, &samples, ends, along)?;
        Ok(Self { samples, speeds })
    }

    /// How long it takes, s.
    pub fn duration_s(&self) -> f64 {
        let cell = |(i, &u): (usize, &[f64; 2])| {
            let h = self.samples[i + 1].s - self.samples[i].s;
            if h > 0.0 { law::crossing_s(h, [self.speeds.v[i], self.speeds.v[i + 1]], u) } else { 0.0 }
        };
        self.speeds.u.iter().enumerate().map(cell).sum()
    }

    /// The places of the motion: the samples, and where joints turn round.
    pub fn samples(&self) -> &[PathSample] {
        &self.samples
    }

    /// ds/dt at every place.
    pub fn speeds(&self) -> &[f64] {
        &self.speeds.v
    }

    /// d²s/dt² at both ends of every stretch between two places.
    pub fn accelerations(&self) -> &[[f64; 2]] {
        &self.speeds.u
    }

    /// The motion over time, rounded over `ramp_s`.
    pub(crate) fn law(&self, ramp_s: f64) -> TimeLaw {
        let s: Vec<f64> = self.samples.iter().map(|sample| sample.s).collect();
        TimeLaw::new(&s, &self.speeds, ramp_s)
    }
}

/// Where places are put in around a turning place, as shares of the cell it lies in. A joint's torque there bounds the
/// acceleration along the path by a number that goes with 1/q′: from one place to the next it should not do more than
/// double.
const AROUND: [f64; 11] = [-1.4, -0.85, -0.5, -0.28, -0.14, 0.0, 0.14, 0.28, 0.5, 0.85, 1.4];

/// No place is put in nearer to another than this share of a cell; turning places themselves are, for friction jumps
/// there.
const APART: f64 = 0.04;
const TURNING_APART: f64 = 1e-9;

/// The samples, and more wherever a joint turns round between two of them.
fn with_turning_places(samples: Vec<PathSample>) -> Vec<PathSample> {
    let turns = |pair: &[PathSample], j: Joint| pair[0].joints.first[j] * pair[1].joints.first[j] < 0.0;
    // where, and whether it is the turning place itself
    let mut wanted: Vec<(f64, bool)> = Vec::new();
    for pair in samples.windows(2) {
        for joint in Joint::BOTH.into_iter().filter(|&j| turns(pair, j)) {
            let (at, h) = (turning_share(pair, joint), pair[1].s - pair[0].s);
            wanted.extend(AROUND.map(|share| (pair[0].s + h * (at + share), share == 0.0)));
        }
    }
    if wanted.is_empty() {
        return samples;
    }
    wanted.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut wanted = wanted.into_iter().peekable();
    let mut all: Vec<PathSample> = Vec::with_capacity(samples.len() + wanted.len());
    for pair in samples.windows(2) {
        let (from, to) = (pair[0].s, pair[1].s);
        all.push(pair[0]);
        let mut last = from;
        while let Some((s, is_turning)) = wanted.next_if(|&(s, _)| s < to) {
            let apart = if is_turning { TURNING_APART } else { APART } * (to - from);
            if s > last + apart && s < to - apart {
                all.push(between(pair, (s - from) / (to - from)));
                last = s;
            }
        }
    }
    all.extend(samples.last());
    all
}

/// Where between two samples a joint's q′ is zero, as a share of the way: the root of the cubic through q′ and q″.
fn turning_share(pair: &[PathSample], j: Joint) -> f64 {
    let up = pair[1].joints.first[j] > 0.0;
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if (between(pair, middle).joints.first[j] > 0.0) == up { high = middle } else { low = middle }
    }
    0.5 * (low + high)
}

/// A place between two samples: q′ on the cubic through q′ and q″ at both.
fn between(pair: &[PathSample], t: f64) -> PathSample {
    let (a, b) = (&pair[0], &pair[1]);
    let h = b.s - a.s;
    let rise = 3.0 * t * t - 2.0 * t * t * t;
    let first = |j: Joint| {
        let (from, to) = (a.joints.first[j], b.joints.first[j]);
        let bent = (a.joints.second[j] * (1.0 - t) - b.joints.second[j] * t) * t * (1.0 - t) * h;
        from + (to - from) * rise + bent
    };
    let second = |j: Joint| {
        let (from, to) = (a.joints.first[j], b.joints.first[j]);
        let (bend, bend_to) = (a.joints.second[j], b.joints.second[j]);
        (to - from) / h * 6.0 * t * (1.0 - t)
            + bend * (1.0 - 4.0 * t + 3.0 * t * t)
            + bend_to * (3.0 * t * t - 2.0 * t)
    };
    let angle = |j: Joint| {
        let (from, to) = (a.joints.angle_rad[j], b.joints.angle_rad[j]);
        let [out, into] = [a, b].map(|sample| sample.joints.first[j] * h);
        from + (to - from) * rise + (out * (1.0 - t) - into * t) * t * (1.0 - t)
    };
    PathSample {
        s: a.s + t * h,
        joints: JointPath {
            angle_rad: PanTilt::from_fn(angle),
            first: PanTilt::from_fn(first),
            second: PanTilt::from_fn(second),
        },
        cap: a.cap.min(b.cap),
    }
}

/// Joint motion of a spot that moves along a path: q̇ = q′ṡ, q̈ = q″ṡ² + q′s̈.
pub(crate) fn chain(joints: &JointPath, along: &Along) -> PanTilt<JointMotion> {
    PanTilt::from_fn(|j| JointMotion {
        position_rad: joints.angle_rad[j],
        velocity_rad_s: joints.first[j] * along.v,
        acceleration_rad_s2: joints.second[j] * along.v * along.v + joints.first[j] * along.a,
    })
}
