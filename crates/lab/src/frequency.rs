use std::f64::consts::{PI, TAU};

use nalgebra::{DMatrix, DVector};
use tracelight_linear::{Complex, logspace};
use tracelight_maths::{complex, cos};
use tracelight_rig::{Actuation, Head, Joint, TICK_F64_S};

use crate::start::{OVER_TICKS, come_to_speed};

/// Sines added up, whole periods of each in a period of all.
#[derive(Clone, Debug, PartialEq)]
pub struct Multisine {
    /// Ticks of a period.
    period_ticks: usize,
    /// Length of a tick, s.
    tick_s: f64,
    /// How many periods each sine has in it, rising.
    harmonics: Vec<usize>,
    /// Amplitude and phase of each sine, V.
    sines_v: Vec<Complex>,
}

/// A joint turning one way under a steady voltage and a multisine: friction that does not change sides is a constant, and what is left
/// of the joint is linear.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Excitation {
    /// The steady voltage, V.
    pub bias_v: f64,
    /// Voltage that speeds it up first, V.
    pub start_v: f64,
    /// Speed at which the steady voltage takes over, rad/s.
    pub rate_rad_s: f64,
    /// Width of a count, rad.
    pub count_rad: f64,
    /// Periods that pass before it is watched,
    pub settling: usize,
    /// and those in which it is.
    pub watched: usize,
}

/// What was seen of an excited joint.
#[derive(Clone, Debug, PartialEq)]
pub struct Excited {
    /// What the encoder counted before each tick of the watched periods, rad,
    pub angles_rad: Vec<f64>,
    /// and what the amplifier got in it, V.
    pub volts: Vec<f64>,
    /// It never stood and never turned back: friction was a constant.
    pub one_way: bool,
}

/// The response at one frequency.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrequencyPoint {
    /// rad/s.
    pub rad_s: f64,
    /// Angle per volt, rad/V.
    pub response: Complex,
    /// Share of the angle's power there that the voltage explains, from how periods differ; 0 to 1.
    pub coherence: f64,
    /// Standard deviation of the response, as a share of it.
    pub deviation: f64,
}

/// Powers of time that are told from the sines in each period: where it was, how fast, and how that changed.
const POWERS: usize = 4;

impl Multisine {
    /// At most `count` sines from the lowest to the highest frequency, rad/s, evenly on a logarithmic scale as far as whole numbers of
    /// periods in `period_s` allow; together as strong as one sine of `amplitude_v`.
    pub fn new(range_rad_s: (f64, f64), count: usize, period_s: f64, amplitude_v: f64) -> Self {
        let period_ticks = ((period_s / TICK_F64_S).round() as usize).max(4);
        let most = period_ticks / 4;
        let whole = |rad_s: f64| ((rad_s * period_s / TAU).round() as usize).clamp(1, most);
        let mut harmonics: Vec<usize> = logspace(range_rad_s, count).into_iter().map(whole).collect();
        harmonics.dedup();
        let each_v = amplitude_v / (harmonics.len() as f64).sqrt();
        // such that they are not all at their top at once (Schroeder, *IEEE Trans. Inf. Theory* 16, 1970)
        let phase = |number: usize| -PI * (number * (number + 1)) as f64 / harmonics.len() as f64;
        let sines_v = (0..harmonics.len()).map(|number| complex::from_polar(each_v, phase(number))).collect();
        Self { period_ticks, tick_s: TICK_F64_S, harmonics, sines_v }
    }

    /// What a record of volts, a tick each, has of sines with whole periods in `period_ticks`: all that are not small beside the largest, up to
    /// four ticks a period; `None` if it is shorter than two periods, or steady.
    pub fn in_record(period_ticks: usize, volts: &[f64]) -> Option<Self> {
        /// Share of the largest below which a sine is none.
        const SMALL: f64 = 0.02;
        if period_ticks < 4 || volts.len() < 2 * period_ticks {
            return None;
        }
        let count = (volts.len() / period_ticks) as f64;
        let mean =
            |tick: usize| volts.chunks_exact(period_ticks).map(|period| period[tick]).sum::<f64>() / count;
        let period: Vec<f64> = (0..period_ticks).map(mean).collect();
        let tick_s = TICK_F64_S;
        let all =
            Self { period_ticks, tick_s, harmonics: (1..=period_ticks / 4).collect(), sines_v: Vec::new() };
        let sines_v = amplitudes(&all, &period);
        let largest = sines_v.iter().map(|sine| complex::norm(*sine)).fold(0.0, f64::max);
        // what rounding leaves of a steady voltage is none
        let rounding = 1e-9 * period.iter().map(|v| v.abs()).fold(0.0, f64::max);
        let least = (SMALL * largest).max(rounding).max(f64::MIN_POSITIVE);
        let (harmonics, sines_v) =
            all.harmonics.into_iter().zip(sines_v).filter(|(_, sine)| complex::norm(*sine) >= least).unzip();
        let found = Self { period_ticks, tick_s, harmonics, sines_v };
        (!found.harmonics.is_empty()).then_some(found)
    }

    /// Sets the length of a tick, s.
    #[must_use]
    pub fn with_tick(self, tick_s: f64) -> Self {
        Self { tick_s, ..self }
    }

    /// Its frequencies, rad/s.
    pub fn rad_s(&self) -> impl Iterator<Item = f64> + '_ {
        let period_s = self.period_ticks as f64 * self.tick_s;
        self.harmonics.iter().map(move |&k| TAU * k as f64 / period_s)
    }

    /// Ticks of a period.
    pub const fn period_ticks(&self) -> usize {
        self.period_ticks
    }

    /// A period of it, V.
    pub fn volts(&self) -> Vec<f64> {
        let at = |tick: usize| {
            let turn = TAU * tick as f64 / self.period_ticks as f64;
            let sine = |(&k, volts): (&usize, &Complex)| {
                complex::norm(*volts) * cos(k as f64 * turn + complex::arg(*volts))
            };
            self.harmonics.iter().zip(&self.sines_v).map(sine).sum::<f64>()
        };
        (0..self.period_ticks).map(at).collect()
    }
}

/// Excites a joint of a head that may turn on and on.
pub fn excite(head: &mut impl Head, joint: Joint, multisine: &Multisine, how: &Excitation) -> Excited {
    let mut count = 0;
    let mut tick = |volts: f64| {
        let mut actuation = Actuation::default();
        actuation.command_v[joint] = volts as f32;
        let before = std::mem::replace(&mut count, head.exchange(&actuation).encoders[joint].count);
        (f64::from(before) * how.count_rad, f64::from(count - before) * how.count_rad)
    };
    come_to_speed(|| tick(how.start_v).1 * how.start_v.signum(), how.rate_rad_s);
    let period = multisine.volts();
    let mut angles_rad = Vec::with_capacity(how.watched * period.len());
    let mut given_v = Vec::with_capacity(how.watched * period.len());
    let (mut one_way, mut since) = (true, 0.0);
    for number in 0..how.settling + how.watched {
        for (k, volts) in period.iter().enumerate() {
            let (angle_rad, step_rad) = tick(how.bias_v + volts);
            if number >= how.settling {
                angles_rad.push(angle_rad);
                given_v.push(how.bias_v + volts);
            }
            since += step_rad * how.bias_v.signum();
            if k % OVER_TICKS == OVER_TICKS - 1 {
                one_way &= since > 0.0;
                since = 0.0;
            }
        }
    }
    Excited { angles_rad, volts: given_v, one_way }
}

/// What each sine of a voltage does to the angle, from whole periods. In each the sines are told from a polynomial over time, by which the
/// joint turns meanwhile; they do not depend on each other. Coherence as of periodic excitation (Pintelon & Schoukens, *System
/// Identification*, 2nd ed., §2.4).
pub fn frequency_response(multisine: &Multisine, angles_rad: &[f64]) -> Vec<FrequencyPoint> {
    let separation = Separation::of(multisine);
    let periods: Vec<Vec<Complex>> =
        angles_rad.chunks_exact(multisine.period_ticks).map(|period| separation.sines(period)).collect();
    let count = periods.len().max(1) as f64;
    let point = |(number, rad_s): (usize, f64)| {
        let mean = periods.iter().map(|period| period[number]).sum::<Complex>() / count;
        let power = periods.iter().map(|period| period[number].norm_sqr()).sum::<f64>() / count;
        let volts = multisine.sines_v[number];
        let coherence = if power > 0.0 { mean.norm_sqr() / power } else { 0.0 };
        let left = (1.0 / coherence - 1.0).max(0.0) / (count - 1.0).max(1.0);
        FrequencyPoint { rad_s, response: mean / volts, coherence, deviation: left.sqrt() }
    };
    multisine.rad_s().enumerate().map(point).collect()
}

/// What each sine of a voltage does to the angle, from speeds, rad/s: a speed is an angle times jω. See [`frequency_response`].
pub fn frequency_response_of_speeds(multisine: &Multisine, rates_rad_s: &[f64]) -> Vec<FrequencyPoint> {
    let angle = |point: FrequencyPoint| FrequencyPoint {
        response: point.response / Complex::new(0.0, point.rad_s),
        ..point
    };
    frequency_response(multisine, rates_rad_s).into_iter().map(angle).collect()
}

/// Sines, which are orthogonal over a period, and powers of time, which are not.
struct Separation<'a> {
    multisine: &'a Multisine,
    /// Legendre's polynomials over a period, at each tick.
    powers: Vec<[f64; POWERS]>,
    /// Of each power, what each sine has of it.
    shares: Vec<Vec<Complex>>,
    /// Inverse of what the powers are to each other once the sines are taken out.
    inverse: DMatrix<f64>,
}

impl<'a> Separation<'a> {
    fn of(multisine: &'a Multisine) -> Self {
        let n = multisine.period_ticks;
        let legendre = |tick: usize| {
            let x = (2.0 * tick as f64 + 1.0) / n as f64 - 1.0;
            [1.0, x, 1.5 * x * x - 0.5, 2.5 * x * x * x - 1.5 * x]
        };
        let powers: Vec<[f64; POWERS]> = (0..n).map(legendre).collect();
        let shares: Vec<Vec<Complex>> = (0..POWERS)
            .map(|p| amplitudes(multisine, &powers.iter().map(|row| row[p]).collect::<Vec<_>>()))
            .collect();
        let own = DMatrix::from_fn(POWERS, POWERS, |i, j| {
            let whole: f64 = powers.iter().map(|row| row[i] * row[j]).sum();
            // a sine of amplitude a has a²/2 of power in each tick
            let in_sines: f64 = shares[i].iter().zip(&shares[j]).map(|(a, b)| (a * b.conj()).re).sum();
            whole - 0.5 * n as f64 * in_sines
        });
        // powers of time are no sums of these sines, so this is not singular; if it were, nothing would be told apart
        let inverse = own.try_inverse().unwrap_or_else(|| DMatrix::zeros(POWERS, POWERS));
        Self { multisine, powers, shares, inverse }
    }

    /// Amplitude and phase of each sine in a period.
    fn sines(&self, angles_rad: &[f64]) -> Vec<Complex> {
        // digits: the joint may have turned for long
        let start = angles_rad[0];
        let angles: Vec<f64> = angles_rad.iter().map(|angle| angle - start).collect();
        let mut sines = amplitudes(self.multisine, &angles);
        let n = angles.len() as f64;
        let right = DVector::from_fn(POWERS, |p, _| {
            let whole: f64 = self.powers.iter().zip(&angles).map(|(row, angle)| row[p] * angle).sum();
            let in_sines: f64 = self.shares[p].iter().zip(&sines).map(|(a, b)| (a * b.conj()).re).sum();
            whole - 0.5 * n * in_sines
        });
        let motion = &self.inverse * right;
        for (number, sine) in sines.iter_mut().enumerate() {
            *sine -= (0..POWERS).map(|p| self.shares[p][number] * motion[p]).sum::<Complex>();
        }
        sines
    }
}

/// A from Σ |A| cos(kt + arg A): the discrete Fourier transform at the sines alone.
fn amplitudes(multisine: &Multisine, values: &[f64]) -> Vec<Complex> {
    let n = multisine.period_ticks;
    let one = |&k: &usize| {
        // a turn a tick, by multiplication; renewed before rounding adds up
        const RENEWED: usize = 256;
        let step = complex::from_polar(1.0, -TAU * k as f64 / n as f64);
        let mut sum = Complex::new(0.0, 0.0);
        for (block, part) in values.chunks(RENEWED).enumerate() {
            let turns = (k * block * RENEWED) % n;
            let mut at = complex::from_polar(1.0, -TAU * turns as f64 / n as f64);
            for value in part {
                sum += at * *value;
                at *= step;
            }
        }
        sum * (2.0 / n as f64)
    };
    multisine.harmonics.iter().map(one).collect()
}

#[cfg(test)]
mod tests {
    use tracelight_linear::{Discretization, Time, TransferFunction};
    use tracelight_sim::{Mounting, RigConfig, head_alone};

    use super::*;

    #[test]
    fn sines_are_told_from_a_drift() {
        let multisine = Multisine::new((TAU * 0.5, TAU * 40.0), 12, 4.0, 1.0);
        let separation = Separation::of(&multisine);
        let wanted: Vec<Complex> = (0..multisine.harmonics.len())
            .map(|k| complex::from_polar(1.0 / (k + 1) as f64, k as f64))
            .collect();
        let at = |tick: usize| {
            let x = tick as f64 / multisine.period_ticks as f64;
            let sine = |(k, a): (&usize, &Complex)| (a * complex::from_polar(1.0, TAU * *k as f64 * x)).re;
            multisine.harmonics.iter().zip(&wanted).map(sine).sum::<f64>() + 50.0 * x - 7.0 * x * x
                + 3.0 * x * x * x
        };
        let found = separation.sines(&(0..multisine.period_ticks).map(at).collect::<Vec<_>>());
        for (found, wanted) in found.iter().zip(&wanted) {
            assert!(complex::norm(found - wanted) < 1e-9, "{found} {wanted}");
        }
    }

    #[test]
    fn sines_are_found_in_a_record_of_their_volts() {
        let made = Multisine::new((TAU * 0.5, TAU * 40.0), 12, 2.0, 1.0);
        let record: Vec<f64> = made.volts().repeat(3).iter().map(|v| v + 0.7).collect();
        let found = Multisine::in_record(2000, &record).unwrap();
        assert_eq!(found.harmonics, made.harmonics);
        assert!(found.sines_v.iter().zip(&made.sines_v).all(|(a, b)| complex::norm(a - b) < 1e-9));
        assert_eq!(Multisine::in_record(2000, &record[..3999]), None);
        assert_eq!(Multisine::in_record(2000, &[1.0; 6000]), None);
    }

    #[test]
    fn a_turning_joint_is_the_linear_model_where_it_coheres() {
        let rig = RigConfig::report();
        for (joint, way) in [(Joint::Pan, 1.0), (Joint::Tilt, -1.0)] {
            let friction = &rig.truth.model.friction[joint];
            let kv = rig.truth.model.motors[joint].torque_nm_per_v;
            let viscous = if way > 0.0 { friction.viscous_pos } else { friction.viscous_neg };
            let multisine = Multisine::new((TAU * 0.2, TAU * 60.0), 30, 10.0, 0.3);
            let how = Excitation {
                bias_v: friction.torque(10.0 * way) / kv,
                start_v: 3.0 * way,
                rate_rad_s: 10.0,
                count_rad: rig.model.encoder.count_rad(),
                settling: 1,
                watched: 6,
            };
            let mut head = head_alone(&rig, joint, Mounting::Fixture, 1);
            let seen = excite(&mut head, joint, &multisine, &how);
            assert!(seen.one_way);
            let inertia = rig.truth.model.own_inertia_kg_m2()[joint];
            let model =
                TransferFunction::parse(&format!("{kv}/({inertia} s^2 + {viscous} s)"), Time::Continuous)
                    .unwrap();
            let model = model.sampled(TICK_F64_S, Discretization::ZeroOrderHold).unwrap();
            let found = frequency_response(&multisine, &seen.angles_rad);
            assert!(found.len() > 25);
            for point in &found {
                let wanted = model.frequency_response(vec![point.rad_s]).values[0];
                let off = complex::norm(point.response / wanted - 1.0);
                if point.coherence > 0.5 {
                    assert!(
                        off < 2e-3 + 4.0 * point.deviation,
                        "{joint} {}: {off} {}",
                        point.rad_s,
                        point.deviation
                    );
                }
            }
            assert!(found[0].coherence > 0.9999 && found[5].coherence > 0.9999, "{found:?}");
        }
    }
}
