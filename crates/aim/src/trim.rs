use nalgebra::{SMatrix, SVector};
use tracelight_maths::powi;
use tracelight_rig::{Joint, PanTilt};
use tracelight_stroke::Vec2;

use crate::{Alignment, SeenSpot};

/// Number of what is estimated: an offset and a scale a joint, and how late images and their last rows are.
const STATES: usize = 6;

/// How far joints are beyond what their encoders say.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Correction {
    /// With the encoder at zero, rad.
    pub offset_rad: PanTilt<f64>,
    /// More for each radian.
    pub scale: PanTilt<f64>,
}

impl Correction {
    /// How far a joint truly is beyond where its encoder has it, rad.
    pub fn at(&self, joint: Joint, angle_rad: f64) -> f64 {
        self.offset_rad[joint] + self.scale[joint] * angle_rad
    }

    /// Those of joints, rad.
    pub fn apply(&self, angle_rad: PanTilt<f64>) -> PanTilt<f64> {
        PanTilt::from_fn(|j| angle_rad[j] + self.at(j, angle_rad[j]))
    }
}

/// How sure one is of a head and a camera's clock when a job begins: standard deviations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrimBelief {
    /// Of each joint's offset, rad.
    pub offset_rad: f64,
    /// Of each joint's scale.
    pub scale: f64,
    /// Of how late images are, s.
    pub late_s: f64,
    /// Of how much later their last row is, s.
    pub readout_s: f64,
    /// Of either coordinate of a spot for reasons that no estimate will ever know, m: speckle, a lens that is not quite what is believed of it.
    pub own_m: f64,
}

impl TrimBelief {
    /// Prior for a head just located from spots with this scatter, m, root mean square of their distance.
    pub fn found(scatter_m: f64) -> Self {
        let own_m = LEAST_OWN_M.max(scatter_m / std::f64::consts::SQRT_2);
        Self { offset_rad: 3e-4, scale: 1e-3, late_s: 2e-3, readout_s: 2e-3, own_m }
    }

    /// Prior for a head located another day, before a camera with unknown stamps; `pixel_m` is the size of its pixels on the wall.
    pub fn known(pixel_m: f64) -> Self {
        let own_m = LEAST_OWN_M.max(0.15 * pixel_m);
        Self { offset_rad: 1e-3, scale: 2e-3, late_s: 2e-2, readout_s: 1e-2, own_m }
    }
}

/// By how much, in √(1 s), what is estimated wanders: what grows warm turns by a milliradian in some tens of seconds.
const WANDERS: [f64; STATES] = [1.5e-4, 1.5e-4, 4e-4, 4e-4, 1e-4, 0.0];
/// Least of [`TrimBelief::own_m`]: uneven discs, play.
const LEAST_OWN_M: f64 = 1.5e-4;
/// By how much an image's stamp trembles, s.
const STAMP_S: f64 = 1e-3;
/// Over so long an encoder's edges tell where a joint is between them, s: who passes one in that time is known to a share of a count.
const EDGES_S: f64 = 0.02;

/// Slow errors of a head, estimated from spots while it draws.
///
/// A Kalman filter (Bar-Shalom, Li & Kirubarajan, *Estimation with Applications to Tracking and Navigation*, §5.2) whose states wander. What
/// is measured is where a spot is seen against where the encoders had the joints *when it was*: how late an image comes matters not, and
/// what is sent to the rig for it does not come back as a measurement. There is no loop that could swing.
#[derive(Clone, Debug)]
pub struct Trim {
    head: Alignment,
    count_rad: f64,
    own_m: f64,
    state: SVector<f64, STATES>,
    covariance: SMatrix<f64, STATES, STATES>,
}

/// How far a spot is from where it was awaited.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surprise {
    /// Vector from the expected to the measured spot, m.
    pub off: Vec2,
    /// Its length in standard deviations.
    pub deviations: f64,
}

/// A measurement, linearized.
struct Seen {
    off: Vec2,
    by: SMatrix<f64, 2, STATES>,
    noise: SMatrix<f64, 2, 2>,
}

impl Trim {
    /// Of a head that was found so, whose encoders have counts of that width, rad.
    pub fn new(head: Alignment, belief: &TrimBelief, count_rad: f64) -> Self {
        let TrimBelief { offset_rad: o, scale: s, late_s, readout_s, own_m } = *belief;
        let variances = SVector::from([o, o, s, s, late_s, readout_s].map(|d| d * d));
        Self {
            head,
            count_rad,
            own_m,
            state: SVector::zeros(),
            covariance: SMatrix::from_diagonal(&variances),
        }
    }

    /// So many seconds pass.
    pub fn age(&mut self, time_s: f64) {
        let grown = SVector::from(WANDERS.map(|w| w * w * time_s));
        self.covariance += SMatrix::from_diagonal(&grown);
    }

    /// What joints are beyond their encoders.
    pub fn correction(&self) -> Correction {
        let x = &self.state;
        Correction { offset_rad: PanTilt::new(x[0], x[1]), scale: PanTilt::new(x[2], x[3]) }
    }

    /// Estimated error of an image's time, s, at a relative height: 0 in its first row, 1 in the last.
    pub fn late_s(&self, down: f64) -> f64 {
        self.state[4] + down * self.state[5]
    }

    /// Compares a spot with its prediction; `None` if the beam misses the target.
    pub fn surprise(&self, spot: &SeenSpot) -> Option<Surprise> {
        let seen = self.seen(spot)?;
        let spread = seen.by * self.covariance * seen.by.transpose() + seen.noise;
        let off = SVector::from([seen.off.x, seen.off.y]);
        let square = off.dot(&(spread.try_inverse()? * off));
        Some(Surprise { off: seen.off, deviations: square.max(0.0).sqrt() })
    }

    /// Learns from a spot.
    pub fn learn(&mut self, spot: &SeenSpot) {
        let Some(seen) = self.seen(spot) else { return };
        let across = self.covariance * seen.by.transpose();
        let spread = seen.by * across + seen.noise;
        let Some(inverse) = spread.try_inverse() else { return };
        let gain = across * inverse;
        self.state += gain * SVector::from([seen.off.x, seen.off.y]);
        // Joseph's form keeps it a covariance
        let left = SMatrix::<f64, STATES, STATES>::identity() - gain * seen.by;
        self.covariance = left * self.covariance * left.transpose() + gain * seen.noise * gain.transpose();
    }

    fn angle(&self, spot: &SeenSpot) -> PanTilt<f64> {
        let later_s = self.late_s(spot.down);
        let then = PanTilt::from_fn(|j| spot.angle_rad[j] + later_s * spot.rate_rad_s[j]);
        self.correction().apply(then)
    }

    /// Standard deviation of where a joint is for what its encoder says, rad: at rest anywhere within a count.
    fn unread_rad(&self, rate_rad_s: f64) -> f64 {
        let counts = rate_rad_s * EDGES_S / self.count_rad;
        self.count_rad / (12.0 * (1.0 + counts * counts)).sqrt()
    }

    fn seen(&self, spot: &SeenSpot) -> Option<Seen> {
        let angle = self.angle(spot);
        let at = self.head.geometry.spot(&self.head.pose, angle)?;
        let [p, t] = self.head.geometry.jacobian(&self.head.pose, angle)?;
        let moves = p * spot.rate_rad_s.pan + t * spot.rate_rad_s.tilt;
        let columns = [p, t, p * spot.angle_rad.pan, t * spot.angle_rad.tilt, moves, moves * spot.down];
        let mut by = SMatrix::<f64, 2, STATES>::zeros();
        for (k, column) in columns.into_iter().enumerate() {
            (by[(0, k)], by[(1, k)]) = (column.x, column.y);
        }
        let own = powi(spot.deviation_m, 2) + self.own_m * self.own_m;
        let along = moves * STAMP_S;
        let mut noise = SMatrix::<f64, 2, 2>::identity() * own;
        for along in
            [along, p * self.unread_rad(spot.rate_rad_s.pan), t * self.unread_rad(spot.rate_rad_s.tilt)]
        {
            let along = SVector::from([along.x, along.y]);
            noise += along * along.transpose();
        }
        Some(Seen { off: spot.at - at, by, noise })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{HeadGeometry, HeadPose};

    fn head() -> Alignment {
        let geometry = HeadGeometry::centred(PanTilt::new((-1.5, 1.5), (-1.5, 1.5)));
        Alignment { geometry, pose: HeadPose::square_on(0.9144), late_s: 0.0, readout_s: 0.0 }
    }

    /// A spot on its way round a circle of 0.25 m, seen through joints that are off, and `late_s` after its stamp.
    fn spot(time_s: f64, true_error: &Correction, late_s: f64) -> SeenSpot {
        let at = |t: f64| PanTilt::new(0.27 * t.sin(), 0.27 * t.cos());
        let rate = PanTilt::new(0.27 * time_s.cos(), -0.27 * time_s.sin());
        let down = 0.5 + 0.4 * time_s.cos();
        let true_rad = true_error.apply(at(time_s + late_s));
        let head = head();
        let noise = Vec2::new((917.0 * time_s).sin(), (1231.0 * time_s).cos()) * 1e-4;
        SeenSpot {
            angle_rad: at(time_s),
            rate_rad_s: rate,
            down,
            at: head.geometry.spot(&head.pose, true_rad).unwrap() + noise,
            deviation_m: 1e-4,
        }
    }

    #[test]
    fn offsets_scales_and_lateness_are_told_apart() {
        let truth = Correction { offset_rad: PanTilt::new(8e-4, -5e-4), scale: PanTilt::new(-1e-3, 2e-3) };
        let mut trim = Trim::new(head(), &TrimBelief::known(1e-3), 1.5e-3);
        for k in 0..300 {
            trim.age(1.0 / 15.0);
            trim.learn(&spot(f64::from(k) / 15.0, &truth, 0.012));
        }
        let found = trim.correction();
        for j in Joint::BOTH {
            assert!((found.offset_rad[j] - truth.offset_rad[j]).abs() < 1e-4, "{found:?}");
            assert!((found.scale[j] - truth.scale[j]).abs() < 4e-4, "{found:?}");
        }
        assert!((trim.state[4] + 0.5 * trim.state[5] - 0.012).abs() < 1e-3, "{}", trim.state);
    }

    #[test]
    fn a_scale_that_drifts_is_followed() {
        // half a percent in half a minute, seen 15 times a second
        let mut trim = Trim::new(head(), &TrimBelief::found(1e-4), 1.5e-3);
        let mut most = 0.0_f64;
        for k in 0..450 {
            let time_s = f64::from(k) / 15.0;
            let scale = 0.005 * time_s / 30.0;
            let truth = Correction { scale: PanTilt::new(scale, scale), ..Correction::default() };
            let seen = spot(time_s, &truth, 0.0);
            let Surprise { off, deviations } = trim.surprise(&seen).unwrap();
            if k > 15 {
                most = most.max(off.hypot());
            }
            assert!(deviations < 4.0, "{k}");
            trim.age(1.0 / 15.0);
            trim.learn(&seen);
        }
        assert!(most < 4e-4, "{most}");
    }

    #[test]
    fn a_bump_surprises_and_a_stamp_that_trembles_does_not() {
        let mut trim = Trim::new(head(), &TrimBelief::found(1e-4), 1.5e-3);
        let none = Correction::default();
        for k in 0..100 {
            trim.age(1.0 / 15.0);
            trim.learn(&spot(f64::from(k) / 15.0, &none, 0.0));
        }
        let deviations = |seen: &SeenSpot| trim.surprise(seen).unwrap().deviations;
        assert!(deviations(&spot(7.0, &none, 0.0)) < 2.0);
        assert!(deviations(&spot(7.0, &none, 0.002)) < 4.0);
        let bumped = Correction { offset_rad: PanTilt::new(5e-3, 0.0), ..none };
        assert!(deviations(&spot(7.0, &bumped, 0.0)) > 8.0);
    }
}
