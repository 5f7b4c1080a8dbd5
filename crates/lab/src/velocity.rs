use tracelight_rig::{Joint, PanTilt, TICK_F64_S};
use tracelight_sim::{ObserverName, RigConfig, Run, replay};

/// How far an observer's velocity and acceleration are from the truth while light is on, both joints together.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct VelocityError {
    /// Root mean square, rad/s.
    pub velocity_rms_rad_s: f64,
    /// Largest, rad/s.
    pub velocity_max_rad_s: f64,
    /// Root mean square, rad/s².
    pub acceleration_rms_rad_s2: f64,
}

/// Highest velocity and acceleration of a joint, either way.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Peaks {
    /// rad/s.
    pub velocity_rad_s: f64,
    /// rad/s².
    pub acceleration_rad_s2: f64,
}

impl Peaks {
    /// The higher of both, each by itself.
    fn or_higher(self, other: Self) -> Self {
        Self {
            velocity_rad_s: self.velocity_rad_s.max(other.velocity_rad_s),
            acceleration_rad_s2: self.acceleration_rad_s2.max(other.acceleration_rad_s2),
        }
    }

    fn of(velocity_rad_s: f64, acceleration_rad_s2: f64) -> Self {
        Self { velocity_rad_s: velocity_rad_s.abs(), acceleration_rad_s2: acceleration_rad_s2.abs() }
    }
}

/// Ticks over which the true acceleration is taken: over one it would be that of a single substep's friction.
const ACCELERATION_TICKS: usize = 5;

/// Plays a run to an observer and compares with the truth. `interval_ticks` is for those that have an interval.
pub fn velocity_error(
    rig: &RigConfig,
    run: &Run,
    observer: ObserverName,
    interval_ticks: usize,
) -> VelocityError {
    let believed = replay(rig, &run.ticks, observer.config(interval_ticks));
    let reach = ACCELERATION_TICKS;
    let mut error = VelocityError::default();
    let (mut velocity, mut acceleration, mut count) = (0.0, 0.0, 0.0);
    let inner = run.ticks.len().saturating_sub(2 * reach);
    let all = run.ticks.iter().zip(&believed).enumerate().skip(reach).take(inner);
    for (k, (tick, believed)) in all.filter(|(_, (tick, _))| tick.light) {
        for joint in Joint::BOTH {
            let is = believed[joint];
            let off = f64::from(is.velocity_rad_s) - tick.rate_rad_s[joint];
            let off2 = f64::from(is.acceleration_rad_s2) - true_acceleration(run, k, joint);
            velocity += off * off;
            acceleration += off2 * off2;
            count += 1.0;
            error.velocity_max_rad_s = error.velocity_max_rad_s.max(off.abs());
        }
    }
    error.velocity_rms_rad_s = (velocity / f64::max(count, 1.0)).sqrt();
    error.acceleration_rms_rad_s2 = (acceleration / f64::max(count, 1.0)).sqrt();
    error
}

/// Over the ticks about this one, rad/s².
fn true_acceleration(run: &Run, tick: usize, joint: Joint) -> f64 {
    let (from, to) = (tick - ACCELERATION_TICKS, tick + ACCELERATION_TICKS);
    let change = run.ticks[to].rate_rad_s[joint] - run.ticks[from].rate_rad_s[joint];
    change / ((to - from) as f64 * TICK_F64_S)
}

/// Highest rates of the joints that an observer saw in a run.
pub fn peaks_seen(
    rig: &RigConfig,
    run: &Run,
    observer: ObserverName,
    interval_ticks: usize,
) -> PanTilt<Peaks> {
    let believed = replay(rig, &run.ticks, observer.config(interval_ticks));
    highest(believed.iter().map(|joints| {
        joints.map(|is| Peaks::of(f64::from(is.velocity_rad_s), f64::from(is.acceleration_rad_s2)))
    }))
}

/// What they truly were.
pub fn peaks(run: &Run) -> PanTilt<Peaks> {
    let reach = ACCELERATION_TICKS;
    let inner = reach..run.ticks.len().saturating_sub(reach);
    highest(
        inner.map(|k| {
            PanTilt::from_fn(|j| Peaks::of(run.ticks[k].rate_rad_s[j], true_acceleration(run, k, j)))
        }),
    )
}

/// The highest of all.
pub fn highest(all: impl Iterator<Item = PanTilt<Peaks>>) -> PanTilt<Peaks> {
    all.fold(PanTilt::default(), |so_far, next| PanTilt::from_fn(|j| so_far[j].or_higher(next[j])))
}
