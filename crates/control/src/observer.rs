//! Position, velocity and unexplained torque of both joints from counts and edge stamps.
//!
//! A Kalman filter a joint whose predictor knows the head's equations with friction that sticks (the set-valued
//! Coulomb law), and whose measurements are what an incremental encoder really says: *at this instant the joint was
//! exactly on this edge* (an edge with its age), and *now it is somewhere within this count* (an interval). Plain
//! differences of counts say little here: one count in one tick is 1.5 rad/s.
//!
//! Angles are kept relative to the centre of the present count, so that `f32` resolves nanoradians.

use tracelight_rig::{Joint, Measurement, PanTilt, TICK_S};

use crate::limit::within;
use crate::model::Terms;
use crate::{AxisConfig, Config};

/// Symmetric 3×3 covariance of (position, velocity, torque).
#[derive(Clone, Copy, Debug, Default)]
struct Covariance {
    pp: f32,
    pv: f32,
    pd: f32,
    vv: f32,
    vd: f32,
    dd: f32,
}

/// One joint's estimate.
#[derive(Clone, Copy, Debug, Default)]
struct Axis {
    count: i32,
    /// From the centre of that count, rad.
    offset_rad: f32,
    rate_rad_s: f32,
    /// Acceleration over the last tick, rad/s².
    acceleration_rad_s2: f32,
    /// Torque the model does not explain, N m.
    disturbance_nm: f32,
    covariance: Covariance,
}

/// Estimates of both joints.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Observer {
    axes: PanTilt<Axis>,
}

impl Observer {
    /// A head at rest on these counts.
    pub(crate) fn at_rest(config: &Config, measured: &PanTilt<Measurement>) -> Self {
        let axis = |j: Joint| {
            let width = config.axes[j].count_rad;
            // anywhere in its count; still; up to a friction's worth of torque unexplained
            let fc = config.axes[j].friction.coulomb_nm();
            let covariance =
                Covariance { pp: width * width / 12.0, vv: 1e-6, dd: 0.1 * fc * fc, ..Covariance::default() };
            Axis { count: measured[j].count, covariance, ..Axis::default() }
        };
        Self { axes: PanTilt::from_fn(axis) }
    }

    pub(crate) fn position_rad(&self, config: &Config) -> PanTilt<f32> {
        PanTilt::from_fn(|j| {
            let axis = &self.axes[j];
            axis.count as f32 * config.axes[j].count_rad + axis.offset_rad
        })
    }

    pub(crate) fn rate_rad_s(&self) -> PanTilt<f32> {
        self.axes.map(|a| a.rate_rad_s)
    }

    /// One tick: predict under the torque that was applied, then correct with what the encoders read at its end.
    pub(crate) fn tick(&mut self, config: &Config, torque_nm: PanTilt<f32>, measured: &PanTilt<Measurement>) {
        let tilt = self.position_rad(config).tilt;
        let terms = config.model.terms(tilt, self.rate_rad_s());
        let rate = self.predict_rates(config, &terms, torque_nm);
        let inertia = terms.own_inertia();
        for joint in Joint::BOTH {
            let (axis, settings) = (&mut self.axes[joint], &config.axes[joint]);
            axis.advance(rate[joint], inertia[joint], settings);
            axis.correct(&measured[joint], settings);
        }
    }

    /// New speeds by the same time stepping as an exact plant would use: Gauss–Seidel over the two joints' friction.
    fn predict_rates(&self, config: &Config, terms: &Terms, torque_nm: PanTilt<f32>) -> PanTilt<f32> {
        let old = self.rate_rad_s();
        let momentum = terms.inertial(old);
        let push =
            |j: Joint| momentum[j] + TICK_S * (torque_nm[j] - terms.bias_nm[j] + self.axes[j].disturbance_nm);
        let (push_pan, push_tilt) = (push(Joint::Pan), push(Joint::Tilt));
        let (mut pan, mut tilt) = (old.pan, old.tilt);
        for _ in 0..2 {
            let friction = &config.axes.pan.friction;
            pan = friction.resolve(push_pan - terms.m12 * tilt, terms.m11, TICK_S);
            let friction = &config.axes.tilt.friction;
            tilt = friction.resolve(push_tilt - terms.m12 * pan, terms.m22, TICK_S);
        }
        PanTilt::new(pan, tilt)
    }
}

impl Axis {
    fn advance(&mut self, rate_rad_s: f32, inertia: f32, settings: &AxisConfig) {
        self.offset_rad += 0.5 * TICK_S * (self.rate_rad_s + rate_rad_s);
        self.acceleration_rad_s2 = (rate_rad_s - self.rate_rad_s) / TICK_S;
        self.rate_rad_s = rate_rad_s;
        self.covariance.predict(inertia, settings);
    }

    fn correct(&mut self, measured: &Measurement, settings: &AxisConfig) {
        let width = settings.count_rad;
        let moved = measured.count.wrapping_sub(self.count);
        self.count = measured.count;
        self.offset_rad -= moved as f32 * width;
        let noise = settings.observer.edge_noise_counts * width;
        if moved != 0 {
            // the last edge crossed is the one on the side it came from
            let edge = if moved > 0 { -0.5 * width } else { 0.5 * width };
            let (age_s, blur) = match measured.edge_age_ticks {
                Some(age) => (age * TICK_S, 0.0),
                // without a stamp it was some time in the last of the tick's equal parts
                None => {
                    let part = TICK_S / moved.unsigned_abs() as f32;
                    (0.5 * part, self.rate_rad_s * part)
                }
            };
            self.observe(edge, age_s, noise * noise + blur * blur / 12.0);
        }
        let inside = within(self.offset_rad, 0.5 * width);
        if inside != self.offset_rad {
            let noise = noise + 0.05 * width;
            self.observe(inside, 0.0, noise * noise);
        }
        // whatever the model says, the joint is in its count, give or take a badly placed edge
        let most = 0.5 * width + 3.0 * noise;
        self.offset_rad = within(self.offset_rad, most);
    }

    /// Kalman update: `age_s` ago the joint was at `offset_rad` ± √`variance`.
    fn observe(&mut self, offset_rad: f32, age_s: f32, variance: f32) {
        let then = self.offset_rad - age_s * self.rate_rad_s + 0.5 * age_s * age_s * self.acceleration_rad_s2;
        let innovation = offset_rad - then;
        self.covariance.expect(innovation, age_s, variance);
        let gain = self.covariance.update(age_s, variance);
        self.offset_rad += gain[0] * innovation;
        self.rate_rad_s += gain[1] * innovation;
        self.disturbance_nm += gain[2] * innovation;
    }
}

impl Covariance {
    /// P ← F P Fᵀ + Q with F = [1 T ½Tg; 0 1 g; 0 0 1], g = T/inertia.
    fn predict(&mut self, inertia: f32, settings: &AxisConfig) {
        let t = TICK_S;
        let g = t / inertia;
        let h = 0.5 * t * g;
        let Self { pp, pv, pd, vv, vd, dd } = *self;
        let (qa, qd) = (settings.observer.acceleration_noise, settings.observer.torque_drift);
        *self = Self {
            pp: pp
                + 2.0 * (t * pv + h * pd)
                + t * t * vv
                + 2.0 * t * h * vd
                + h * h * dd
                + qa * t * t * t / 3.0,
            pv: pv + t * vv + h * vd + g * (pd + t * vd + h * dd) + qa * t * t / 2.0,
            pd: pd + t * vd + h * dd,
            vv: vv + 2.0 * g * vd + g * g * dd + qa * t,
            vd: vd + g * dd,
            dd: dd + qd * t,
        };
    }

    /// Makes room for a surprise: an innovation beyond three standard deviations says that something happens which
    /// the model does not know (a push, a stall), so the covariance is scaled until three fit (fading memory; Xia et
    /// al., *Adaptive fading Kalman filter*, Automatica 1994).
    fn expect(&mut self, innovation: f32, age_s: f32, variance: f32) {
        const DEVIATIONS_SQUARED: f32 = 9.0;
        let own = self.pp - 2.0 * age_s * self.pv + age_s * age_s * self.vv;
        let needed = innovation * innovation / DEVIATIONS_SQUARED - variance;
        if needed > own && own > 0.0 {
            self.scale((needed / own).min(1e4));
        }
    }

    fn scale(&mut self, by: f32) {
        for entry in [&mut self.pp, &mut self.pv, &mut self.pd, &mut self.vv, &mut self.vd, &mut self.dd] {
            *entry *= by;
        }
    }

    /// Gains for a measurement H = [1 −age 0], and P ← (I − KH) P.
    fn update(&mut self, age_s: f32, variance: f32) -> [f32; 3] {
        let Self { pp, pv, pd, vv, vd, dd } = *self;
        let ph = [pp - age_s * pv, pv - age_s * vv, pd - age_s * vd];
        let innovation = ph[0] - age_s * ph[1] + variance;
        let k = ph.map(|p| p / innovation);
        *self = Self {
            pp: (pp - k[0] * ph[0]).max(0.0),
            pv: pv - k[0] * ph[1],
            pd: pd - k[0] * ph[2],
            vv: (vv - k[1] * ph[1]).max(0.0),
            vd: vd - k[1] * ph[2],
            dd: (dd - k[2] * ph[2]).max(0.0),
        };
        k
    }
}
