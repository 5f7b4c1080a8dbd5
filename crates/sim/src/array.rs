use tracelight_maths::powi;
use tracelight_rig::{Joint, PanTilt};
use tracelight_trajectory::JointMotion;

/// Where the joints are to be, row by row: the 2006 report's array `[t angle1 angle2]`.
#[derive(Clone, Debug, PartialEq)]
pub struct MotionArray {
    times_s: Vec<f64>,
    angles_rad: PanTilt<Vec<f64>>,
    /// Accelerations at the rows, rad/s²; none where rows are joined by lines.
    bends: Option<PanTilt<Vec<f64>>>,
}

/// What joins the rows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Between {
    /// The smoothest curve through them all that begins and ends at rest.
    #[default]
    Spline,
    /// Lines, as Simulink does: the speed jumps at each row.
    Lines,
}

/// Why rows are no motion.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum ArrayError {
    /// Fewer than two.
    #[error("a motion has two rows at least")]
    TooShort,
    /// Time stands or goes back.
    #[error("row {row}: its time, {time_s} s, does not come after the row before, by a microsecond at least")]
    NotAfter {
        /// Counted from 1.
        row: usize,
        /// Its time.
        time_s: f64,
    },
    /// Not a number.
    #[error("row {row} has what is no number")]
    NoNumber {
        /// Counted from 1.
        row: usize,
    },
}

impl MotionArray {
    /// Smallest time between rows, s: a microsecond, less rounding.
    pub const CLOSEST_S: f64 = 0.999e-6;

    /// From times, s, and angles, rad; the first row is the start, at whatever time.
    pub fn new(rows: &[(f64, PanTilt<f64>)], between: Between) -> Result<Self, ArrayError> {
        let Some(&(begun_s, _)) = rows.first().filter(|_| rows.len() > 1) else {
            return Err(ArrayError::TooShort);
        };
        for (number, (time_s, angles)) in rows.iter().enumerate() {
            if ![*time_s, angles.pan, angles.tilt].iter().all(|value| value.is_finite()) {
                return Err(ArrayError::NoNumber { row: number + 1 });
            }
            if number > 0 && *time_s < rows[number - 1].0 + Self::CLOSEST_S {
                return Err(ArrayError::NotAfter { row: number + 1, time_s: *time_s });
            }
        }
        let times_s: Vec<f64> = rows.iter().map(|(time_s, _)| time_s - begun_s).collect();
        let angles_rad = PanTilt::from_fn(|j| rows.iter().map(|(_, angles)| angles[j]).collect::<Vec<_>>());
        let bends = match between {
            Between::Spline => Some(PanTilt::from_fn(|j| bends(&times_s, &angles_rad[j]))),
            Between::Lines => None,
        };
        Ok(Self { times_s, angles_rad, bends })
    }

    /// A random one: from rest at zero, within `reach_rad` of it, a new place every second, or four of them at least, and back.
    pub fn random(seed: u64, length_s: f64, reach_rad: PanTilt<f64>) -> Result<Self, ArrayError> {
        let mut dice = oorandom::Rand64::new(u128::from(seed));
        let places = (length_s.round() as usize).max(4);
        // where there is less time from place to place, they are nearer, so that accelerations stay what they are
        let nearer = powi(length_s / places as f64, 2).min(1.0);
        let rows: Vec<_> = (0..=places)
            .map(|place| {
                let mut signed = |reach: f64| nearer * reach * (2.0 * dice.rand_float() - 1.0);
                let drawn = PanTilt::new(signed(reach_rad.pan), signed(reach_rad.tilt));
                let at_end = place == 0 || place == places;
                (length_s * place as f64 / places as f64, if at_end { PanTilt::default() } else { drawn })
            })
            .collect();
        Self::new(&rows, Between::Spline)
    }

    /// How long it takes, s.
    pub fn length_s(&self) -> f64 {
        self.times_s.last().copied().unwrap_or_default()
    }

    /// Where it begins, rad.
    pub fn start_rad(&self) -> PanTilt<f64> {
        PanTilt::from_fn(|j| self.angles_rad[j].first().copied().unwrap_or_default())
    }

    /// Where the joints are to be then; after its end, and before its start, at rest.
    pub fn at(&self, time_s: f64) -> PanTilt<JointMotion> {
        let last = self.times_s.len() - 1;
        let after = self.times_s.partition_point(|t| *t <= time_s);
        PanTilt::from_fn(|j| match after {
            0 => JointMotion::at_rest(self.angles_rad[j][0]),
            _ if after > last => JointMotion::at_rest(self.angles_rad[j][last]),
            _ => self.within(j, after - 1, time_s),
        })
    }

    /// Between a row and the next: the cubic that has both angles and both bends (de Boor, *A Practical Guide to Splines*, ch. IV).
    fn within(&self, joint: Joint, row: usize, time_s: f64) -> JointMotion {
        let (t, q) = (&self.times_s, &self.angles_rad[joint]);
        let width = t[row + 1] - t[row];
        let slope = (q[row + 1] - q[row]) / width;
        let (from, to) = self.bends.as_ref().map_or((0.0, 0.0), |b| (b[joint][row], b[joint][row + 1]));
        let (since, left) = (time_s - t[row], t[row + 1] - time_s);
        JointMotion {
            position_rad: q[row] + slope * since
                - since * left / 6.0 * (from * (1.0 + left / width) + to * (1.0 + since / width)),
            velocity_rad_s: slope
                + (to * (3.0 * since * since / width - width) - from * (3.0 * left * left / width - width))
                    / 6.0,
            acceleration_rad_s2: (from * left + to * since) / width,
        }
    }
}

/// Second derivatives of the cubic spline that rests at its ends (de Boor, ch. IV, "complete"): a tridiagonal system, larger on its
/// diagonal, so elimination needs no pivots.
fn bends(t: &[f64], q: &[f64]) -> Vec<f64> {
    let last = t.len() - 1;
    let width = |i: usize| t[i + 1] - t[i];
    let slope = |i: usize| (q[i + 1] - q[i]) / width(i);
    let (mut upper, mut bend) = (vec![0.0; last + 1], vec![0.0; last + 1]);
    for i in 0..=last {
        let (before, into) = if i > 0 { (width(i - 1), slope(i - 1)) } else { (0.0, 0.0) };
        let (after, out) = if i < last { (width(i), slope(i)) } else { (0.0, 0.0) };
        let (above, known) = if i > 0 { (upper[i - 1], bend[i - 1]) } else { (0.0, 0.0) };
        let pivot = 2.0 * (before + after) - before * above;
        upper[i] = after / pivot;
        bend[i] = (6.0 * (out - into) - before * known) / pivot;
    }
    for i in (0..last).rev() {
        bend[i] -= upper[i] * bend[i + 1];
    }
    bend
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sine(between: Between) -> MotionArray {
        let row = |k: i32| {
            let t = 0.05 * f64::from(k);
            (3.0 + t, PanTilt::new((2.0 * t).sin(), 0.1 * t))
        };
        MotionArray::new(&(0..=100).map(row).collect::<Vec<_>>(), between).unwrap()
    }

    #[test]
    fn a_spline_has_the_speed_and_the_acceleration_of_what_it_goes_through() {
        let array = sine(Between::Spline);
        assert!((array.length_s() - 5.0).abs() < 1e-12);
        for k in 10..90 {
            let t = 0.05 * f64::from(k) + 0.021;
            let JointMotion { position_rad, velocity_rad_s, acceleration_rad_s2 } = array.at(t).pan;
            assert!((position_rad - (2.0 * t).sin()).abs() < 1e-6);
            assert!((velocity_rad_s - 2.0 * (2.0 * t).cos()).abs() < 2e-4);
            assert!((acceleration_rad_s2 + 4.0 * (2.0 * t).sin()).abs() < 2e-2);
            // what begins at rest is a line a few rows on
            assert!((array.at(t).tilt.velocity_rad_s - 0.1).abs() < 1e-6);
        }
    }

    #[test]
    fn its_derivatives_are_those_of_its_places() {
        const STEP: f64 = 1e-6;
        for between in [Between::Spline, Between::Lines] {
            let array = sine(between);
            for t in [0.013, 0.77, 2.481, 4.99] {
                let [before, at, after] = [t - STEP, t, t + STEP].map(|t| array.at(t).pan);
                let slope = (after.position_rad - before.position_rad) / (2.0 * STEP);
                assert!((slope - at.velocity_rad_s).abs() < 1e-8, "{slope} {at:?}");
                let bend = (after.velocity_rad_s - before.velocity_rad_s) / (2.0 * STEP);
                assert!((bend - at.acceleration_rad_s2).abs() < 1e-6, "{bend} {at:?}");
            }
        }
    }

    #[test]
    fn it_begins_and_ends_at_rest() {
        let array = sine(Between::Spline);
        for t in [0.0, 5.0 - 1e-12] {
            let PanTilt { pan, tilt } = array.at(t);
            assert!(pan.velocity_rad_s.abs() < 1e-9 && tilt.velocity_rad_s.abs() < 1e-9, "{pan:?} {tilt:?}");
        }
        let random = MotionArray::random(1, 10.0, PanTilt::new(0.3, 0.2)).unwrap();
        assert_eq!(random.at(0.0).map(|motion| motion.position_rad), PanTilt::default());
        assert!(random != MotionArray::random(2, 10.0, PanTilt::new(0.3, 0.2)).unwrap());
    }

    #[test]
    fn beyond_its_ends_it_rests() {
        let array = sine(Between::Lines);
        assert_eq!(array.at(-1.0).pan, JointMotion::at_rest(0.0));
        assert_eq!(array.at(9.0).pan, JointMotion::at_rest(10.0_f64.sin()));
    }

    #[test]
    fn rows_that_are_no_motion_are_named() {
        let at = |t: f64| (t, PanTilt::new(0.0, 0.0));
        let refused = |rows: &[(f64, PanTilt<f64>)]| MotionArray::new(rows, Between::Spline).unwrap_err();
        assert_eq!(refused(&[at(0.0)]), ArrayError::TooShort);
        assert_eq!(refused(&[at(0.0), at(1.0), at(1.0)]), ArrayError::NotAfter { row: 3, time_s: 1.0 });
        assert_eq!(refused(&[at(0.0), at(f64::NAN)]), ArrayError::NoNumber { row: 2 });
    }
}
