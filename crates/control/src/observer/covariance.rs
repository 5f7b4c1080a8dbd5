use tracelight_rig::TICK_S;

use crate::elementary::root;
use crate::limit::within;

/// Number of quantities a [`Kalman`](super::kalman::Kalman) filter estimates.
pub(super) const STATES: usize = 6;

/// What the places of a row and of a covariance stand for.
pub(super) const POSITION: usize = 0;
pub(super) const VELOCITY: usize = 1;
pub(super) const LOAD: usize = 2;
pub(super) const FRICTION: usize = 3;
pub(super) const BREAK_AWAY: usize = 4;
pub(super) const INERTIA: usize = 5;

/// One number a quantity.
pub(super) type Row = [f32; STATES];

/// What is further off than three standard deviations is a surprise.
pub(super) const DEVIATIONS_SQUARED: f32 = 9.0;

/// Symmetric covariance of the estimated quantities.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Covariance([Row; STATES]);

impl Covariance {
    /// Of quantities that know nothing of each other.
    pub(super) fn independent(deviations: &Row) -> Self {
        let mut covariance = Self::default();
        for (i, deviation) in deviations.iter().enumerate() {
            covariance.0[i][i] = deviation * deviation;
        }
        covariance
    }

    /// P ← F P Fᵀ + Q, where the new velocity depends on everything by `velocity_row`, the position advances by the mean of
    /// old and new velocity, and the rest stays; Q is diagonal.
    #[inline]
    pub(super) fn predict(&mut self, velocity_row: &Row, noise: &Row) {
        let p = &mut self.0;
        let row = velocity_row;
        // the place changes no velocity
        let mut velocity = p[VELOCITY].map(|entry| row[VELOCITY] * entry);
        for k in LOAD..STATES {
            for i in 0..STATES {
                velocity[i] += row[k] * p[k][i];
            }
        }
        let mut position = [0.0; STATES];
        for i in 0..STATES {
            position[i] = p[POSITION][i] + 0.5 * TICK_S * (p[VELOCITY][i] + velocity[i]);
        }
        let (mut vv, mut pv) = (row[VELOCITY] * velocity[VELOCITY], row[VELOCITY] * position[VELOCITY]);
        for k in LOAD..STATES {
            vv += row[k] * velocity[k];
            pv += row[k] * position[k];
        }
        let pp = position[POSITION] + 0.5 * TICK_S * (position[VELOCITY] + pv);
        (velocity[POSITION], velocity[VELOCITY]) = (pv, vv);
        (position[POSITION], position[VELOCITY]) = (pp, pv);
        for i in 0..STATES {
            (p[i][POSITION], p[i][VELOCITY]) = (position[i], velocity[i]);
        }
        (p[POSITION], p[VELOCITY]) = (position, velocity);
        for (i, variance) in noise.iter().enumerate() {
            p[i][i] += variance;
        }
    }

    /// Makes room for a surprise: an innovation beyond three standard deviations says that something happens which
    /// the model does not know (a push, a stall), so position, velocity and load are made uncertain until three fit
    /// (fading memory; Xia et al., *Adaptive fading Kalman filter*, Automatica 1994). What a head is made of stays: a
    /// push says nothing of it.
    pub(super) fn expect(&mut self, innovation: f32, age_s: f32, variance: f32) {
        const MOST: f32 = 1e4;
        // a radian: what is further off is no surprise but a lost joint, and must not make the numbers run out
        const FURTHEST: f32 = 1.0;
        let own = self.variance_of_place(age_s);
        let needed = (innovation * innovation / DEVIATIONS_SQUARED - variance).min(FURTHEST);
        if needed > own && own > 0.0 {
            let by = root((needed / own).min(MOST));
            for (i, line) in self.0.iter_mut().enumerate() {
                for (j, entry) in line.iter_mut().enumerate() {
                    *entry *= if i <= LOAD { by } else { 1.0 } * if j <= LOAD { by } else { 1.0 };
                }
            }
        }
    }

    /// Lets the load be as much as that.
    pub(super) fn suspect_load(&mut self, load_nm: f32) {
        self.0[LOAD][LOAD] = self.0[LOAD][LOAD].max(load_nm * load_nm);
    }

    /// Of where the joint was `age_s` ago.
    pub(super) fn variance_of_place(&self, age_s: f32) -> f32 {
        let p = &self.0;
        let (pp, pv, vv) = (p[POSITION][POSITION], p[POSITION][VELOCITY], p[VELOCITY][VELOCITY]);
        pp - 2.0 * age_s * pv + age_s * age_s * vv
    }

    /// Standard deviation of load and friction together, whichever way the joint turns, N m.
    pub(super) fn deviation_of_torque(&self) -> f32 {
        let p = &self.0;
        root(p[LOAD][LOAD] + p[FRICTION][FRICTION] + 2.0 * p[LOAD][FRICTION].abs())
    }

    /// Gains for a measurement of where the joint was `age_s` ago (H = [1 −age 0 …]), and P after it, in Joseph's form,
    /// (I − KH) P (I − KH)ᵀ + K R Kᵀ, which is a covariance whatever the gain. While the joint is `pushed` nothing is
    /// learned of what the head is made of: its gains are zero, its uncertainty stays (a consider filter; Schmidt 1966).
    pub(super) fn update(&mut self, age_s: f32, variance: f32, pushed: bool) -> Row {
        let seen = self.0.map(|line| line[POSITION] - age_s * line[VELOCITY]);
        let innovation = seen[POSITION] - age_s * seen[VELOCITY] + variance;
        let mut gain = seen.map(|entry| entry / innovation);
        for entry in gain.iter_mut().skip(LOAD + 1) {
            *entry = if pushed { 0.0 } else { *entry };
        }
        self.change(|i, j, entry| {
            let (both, crossed) = (gain[i] * gain[j], gain[i] * seen[j] + seen[i] * gain[j]);
            entry + (innovation * both - crossed)
        });
        self.keep_sound();
        gain
    }

    /// Rounding must not make a variance negative, nor two quantities know more of each other than they can.
    fn keep_sound(&mut self) {
        const MOST: f32 = 0.9999;
        let mut deviations = [0.0; STATES];
        for (i, deviation) in deviations.iter_mut().enumerate() {
            self.0[i][i] = self.0[i][i].max(0.0);
            *deviation = root(self.0[i][i]);
        }
        self.change(
            |i, j, entry| {
                if i == j { entry } else { within(entry, MOST * deviations[i] * deviations[j]) }
            },
        );
    }

    /// Changes each entry and the one across the diagonal, which is the same, at once.
    #[inline]
    fn change(&mut self, to: impl Fn(usize, usize, f32) -> f32) {
        for i in 0..STATES {
            for j in 0..=i {
                let entry = to(i, j, self.0[i][j]);
                (self.0[i][j], self.0[j][i]) = (entry, entry);
            }
        }
    }
}
