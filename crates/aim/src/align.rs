//! Estimates a head's pose and geometry from spots in camera images.

use nalgebra::DMatrix;
use tracelight_maths::powi;
use tracelight_rig::PanTilt;
use tracelight_stroke::{Point, Vec2};

use crate::head::HeadGeometry;
use crate::least_squares::{Normal, Problem, solve};
use crate::pose::HeadPose;

/// A lit spot as the encoders and a camera have it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeenSpot {
    /// Joint angles by the encoders at the assumed time of the image, rad.
    pub angle_rad: PanTilt<f64>,
    /// How fast they changed, rad/s.
    pub rate_rad_s: PanTilt<f64>,
    /// How far down the image the spot is: 0 in its first row, 1 in the last.
    pub down: f64,
    /// Where it is seen on the target, m.
    pub at: Point,
    /// Standard deviation of either coordinate, m.
    pub deviation_m: f64,
}

/// How a head stands, how it is built, and how a camera's clock relates to its encoders'.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Alignment {
    /// How it is built.
    pub geometry: HeadGeometry,
    /// Where it stands.
    pub pose: HeadPose,
    /// Delay of the images relative to the spots' angles, s.
    pub late_s: f64,
    /// Readout time of an image, from its first to its last row, s.
    pub readout_s: f64,
}

/// Prior of an alignment: most likely values and standard deviations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AlignmentBelief {
    /// The likeliest.
    pub alignment: Alignment,
    /// Of each coordinate of where it stands, m.
    pub place_m: f64,
    /// Of each of its angles, rad.
    pub turn_rad: f64,
    /// Of where the beam leaves, m.
    pub offset_m: f64,
    /// Of where the beam points, and of the tilt encoder's zero, rad.
    pub beam_rad: f64,
    /// Of the axes' skew, rad.
    pub skew_rad: f64,
    /// Of how late images are, s.
    pub late_s: f64,
    /// Of how much later the last row is, s.
    pub readout_s: f64,
}

/// Number of what is solved for.
const PARAMETERS: usize = 13;
/// Fewest spots that tell it.
const FEWEST: usize = 8;
/// Furthest that spots are seen from where the head as found would have them, root mean square in their deviations.
const MOST_MISFIT: f64 = 5.0;

/// Why a head can not be found.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum AlignError {
    /// Too few spots.
    #[error("{spots} spots were seen, at least {FEWEST} are needed to tell how a head stands")]
    TooFew {
        /// How many there are.
        spots: usize,
    },
    /// Nothing fits.
    #[error("the {spots} spots fit no head: the nearest is off by {:.1} mm rms; is the wall flat, and did camera and head stay where they are?", 1e3 * .rms_m)]
    NoFit {
        /// How many there are.
        spots: usize,
        /// How far the best is off, m.
        rms_m: f64,
    },
}

/// Result of an alignment.
#[derive(Clone, Debug)]
pub struct Aligned {
    /// The likeliest.
    pub alignment: Alignment,
    /// How far spots are seen from where it has them, root mean square, m.
    pub rms_m: f64,
    /// Number of spots seen.
    pub spots: usize,
    /// Number of outliers, which have little weight.
    pub outliers: usize,
    covariance: DMatrix<f64>,
}

impl Aligned {
    /// Expected error of the spot's position, root mean square, m; `None` if the beam misses the target.
    pub fn deviation_m(&self, angle_rad: PanTilt<f64>) -> Option<f64> {
        let still = SeenSpot {
            angle_rad,
            rate_rad_s: PanTilt::default(),
            down: 0.0,
            at: Point::ORIGIN,
            deviation_m: 1.0,
        };
        let (_, by) = self.alignment.derivatives(&still)?;
        let mut variance = 0.0;
        for i in 0..PARAMETERS {
            for j in 0..PARAMETERS {
                variance += by[i].dot(by[j]) * self.covariance[(i, j)];
            }
        }
        Some(variance.max(0.0).sqrt())
    }
}

impl Alignment {
    /// Where a spot should be seen, m.
    pub fn told(&self, seen: &SeenSpot) -> Option<Point> {
        let later_s = self.late_s + seen.down * self.readout_s;
        let angle = PanTilt::from_fn(|joint| seen.angle_rad[joint] + later_s * seen.rate_rad_s[joint]);
        self.geometry.spot(&self.pose, angle)
    }

    fn parameters(&self) -> [f64; PARAMETERS] {
        let (HeadPose { distance_m, right_m, up_m, yaw_rad, pitch_rad, roll_rad }, built) =
            (self.pose, &self.geometry);
        let ([_, left, up], [points_left, points_down]) = (built.laser_offset_m, built.beam_off_rad);
        let stands = [distance_m, right_m, up_m, yaw_rad, pitch_rad, roll_rad];
        let is_built = [left, up, points_left, points_down, built.axis_skew_rad];
        let mut all = [0.0; PARAMETERS];
        let values = stands.iter().chain(&is_built).chain([&self.late_s, &self.readout_s]);
        all.iter_mut().zip(values).for_each(|(slot, value)| *slot = *value);
        all
    }

    /// Returns the alignment with other parameters. The beam's origin along the beam is not observable.
    fn with(&self, p: [f64; PARAMETERS]) -> Self {
        let [
            distance_m,
            right_m,
            up_m,
            yaw_rad,
            pitch_rad,
            roll_rad,
            left,
            up,
            l,
            d,
            axis_skew_rad,
            late_s,
            readout_s,
        ] = p;
        let laser_offset_m = [self.geometry.laser_offset_m[0], left, up];
        Self {
            geometry: HeadGeometry {
                laser_offset_m,
                beam_off_rad: [l, d],
                axis_skew_rad,
                range_rad: self.geometry.range_rad,
            },
            pose: HeadPose { distance_m, right_m, up_m, yaw_rad, pitch_rad, roll_rad },
            late_s,
            readout_s,
        }
    }

    /// Where a spot should be seen, and the derivatives of that: central differences, whose error is next to nothing beside a millimetre.
    fn derivatives(&self, seen: &SeenSpot) -> Option<(Point, [Vec2; PARAMETERS])> {
        const STEP: f64 = 1e-6;
        let own = self.parameters();
        let mut by = [Vec2::ZERO; PARAMETERS];
        for (k, slot) in by.iter_mut().enumerate() {
            let told = |step: f64| {
                let mut moved = own;
                moved[k] += step;
                self.with(moved).told(seen)
            };
            *slot = (told(STEP)? - told(-STEP)?) / (2.0 * STEP);
        }
        Some((self.told(seen)?, by))
    }
}

impl AlignmentBelief {
    /// Prior for a head set up by eye and built to its dimensions: a few centimetres and degrees.
    pub const fn by_eye(geometry: HeadGeometry, pose: HeadPose) -> Self {
        Self {
            alignment: Alignment { geometry, pose, late_s: 0.0, readout_s: 0.0 },
            place_m: 0.05,
            turn_rad: 0.1,
            offset_m: 0.005,
            beam_rad: 0.03,
            skew_rad: 0.01,
            late_s: 0.02,
            readout_s: 0.02,
        }
    }

    fn deviations(&self) -> [f64; PARAMETERS] {
        let (m, rad) = (self.place_m, self.turn_rad);
        let (offset, beam) = (self.offset_m, self.beam_rad);
        [m, m, m, rad, rad, rad, offset, offset, beam, beam, self.skew_rad, self.late_s, self.readout_s]
    }
}

/// Estimates a head by least squares from spots and a prior; outliers have little weight. The pose determines the zero of the pan encoder, the
/// direction of the beam that of the tilt encoder.
///
/// # Errors
/// See [`AlignError`].
pub fn align(belief: &AlignmentBelief, spots: &[SeenSpot]) -> Result<Aligned, AlignError> {
    if spots.len() < FEWEST {
        return Err(AlignError::TooFew { spots: spots.len() });
    }
    let no_fit = |rms_m: f64| AlignError::NoFit { spots: spots.len(), rms_m };
    let mut found = belief.alignment;
    let mut normal = None;
    // from far off every spot would count as lost: first they are trusted little, then as they are
    for coarser in [300.0, 30.0, 3.0, 1.0] {
        let fit = Fit { belief, spots, coarser };
        let (next, told) = solve(&fit, found, MOST_STEPS).ok_or(no_fit(f64::INFINITY))?;
        (found, normal) = (next, Some(told));
    }
    let off = |spot: &SeenSpot| found.told(spot).map_or(f64::INFINITY, |told| told.distance(spot.at));
    // of two coordinates
    let times = |spot: &SeenSpot| off(spot) / (std::f64::consts::SQRT_2 * spot.deviation_m);
    let good: Vec<&SeenSpot> = spots.iter().filter(|spot| times(spot) < LOST).collect();
    let mean = |of: &dyn Fn(&SeenSpot) -> f64| {
        (good.iter().map(|spot| powi(of(spot), 2)).sum::<f64>() / good.len().max(1) as f64).sqrt()
    };
    let rms_m = mean(&off);
    let misfit = mean(&times);
    if 2 * good.len() < spots.len() || misfit > MOST_MISFIT {
        let all = spots.iter().map(|spot| powi(off(spot), 2)).sum::<f64>() / spots.len() as f64;
        return Err(no_fit(all.sqrt()));
    }
    let covariance = normal.and_then(|normal: Normal| normal.covariance()).ok_or(no_fit(rms_m))?;
    // what scatters more than was told is known less well
    let covariance = covariance * powi(misfit.max(1.0), 2);
    Ok(Aligned {
        alignment: found,
        rms_m,
        spots: spots.len(),
        outliers: spots.len() - good.len(),
        covariance,
    })
}

/// Most steps of one fit.
const MOST_STEPS: usize = 50;
/// From how many deviations on a spot is something else.
const LOST: f64 = 10.0;

struct Fit<'a> {
    belief: &'a AlignmentBelief,
    spots: &'a [SeenSpot],
    /// By how much less spots are trusted than they could be.
    coarser: f64,
}

impl Problem for Fit<'_> {
    type State = Alignment;

    fn normal(&self, state: &Alignment) -> Option<Normal> {
        let mut normal = Normal::zero(PARAMETERS);
        for spot in self.spots {
            let (told, by) = state.derivatives(spot)?;
            let (off, scale) = (spot.at - told, 1.0 / (self.coarser * spot.deviation_m));
            normal.add(off.x * scale, by.iter().map(|d| d.x * scale).enumerate());
            normal.add(off.y * scale, by.iter().map(|d| d.y * scale).enumerate());
        }
        let (likely, now) = (self.belief.alignment.parameters(), state.parameters());
        for (k, deviation) in self.belief.deviations().into_iter().enumerate() {
            normal.add_belief((likely[k] - now[k]) / deviation, std::iter::once((k, 1.0 / deviation)));
        }
        Some(normal)
    }

    fn stepped(&self, state: &Alignment, step: &[f64]) -> Alignment {
        let own = state.parameters();
        state.with(std::array::from_fn(|k| own[k] + step[k]))
    }
}

#[cfg(test)]
mod tests;
