//! Makes laws from compensators given by zeros and poles.

use tracelight_control::{Biquad, Feedback, Feedforward, LawConfig, LeadLag};
use tracelight_linear::{Complex, Discretization, LinearError, Polynomial, Time, TransferFunction, Zpk};
use tracelight_maths::complex;
use tracelight_rig::TICK_F64_S;

/// A law that is nothing but a compensator, from error, rad, to torque, N m, and what holds the head against gravity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CompensatorLaw(LawConfig);

impl CompensatorLaw {
    /// What holds the head against gravity, and nothing that acts on an error.
    pub(crate) const NOTHING: Self = Self(LawConfig {
        feedback: Feedback::LeadLag(LeadLag {
            sections: [Biquad { numerator: [0.0; 3], denominator: [0.0; 2] }, Biquad::PASS],
        }),
        feedforward: Feedforward::Gravity,
    });

    /// Poles that a law has room for.
    pub const MOST_POLES: usize = 4;

    /// Of a compensator in continuous time, by Tustin's rule, or of one whose samples are the controller's ticks. It has four poles at
    /// most, and no more zeros than poles.
    pub fn new(compensator: &Zpk) -> Result<Self, LinearError> {
        let (zeros, poles) = (compensator.zeros(), compensator.poles());
        if poles.len() > Self::MOST_POLES {
            let message = format!("it has {} poles, a law has room for {}", poles.len(), Self::MOST_POLES);
            return Err(LinearError::Wish(message));
        }
        if zeros.len() > poles.len() {
            return Err(LinearError::Improper { zeros: zeros.len(), poles: poles.len(), what: "law" });
        }
        if let Time::Sampled(period_s) = compensator.time()
            && (period_s / TICK_F64_S - 1.0).abs() > 1e-9
        {
            let there = Time::Sampled(TICK_F64_S).to_string();
            return Err(LinearError::Sampling(compensator.time().to_string(), there));
        }
        let [first, second] = shared(zeros, poles);
        let sections = [
            section(compensator.gain(), &first, compensator.time())?,
            section(1.0, &second, compensator.time())?,
        ];
        Ok(Self(LawConfig {
            feedback: Feedback::LeadLag(LeadLag { sections }),
            feedforward: Feedforward::Gravity,
        }))
    }

    pub(crate) const fn config(&self) -> LawConfig {
        self.0
    }
}

/// Zeros and poles of one section.
#[derive(Clone, Debug, Default)]
struct Section {
    zeros: Vec<Complex>,
    poles: Vec<Complex>,
}

/// Zeros and poles on two sections, pairs together, and real poles such that slow ones stand beside fast ones: two slow ones in one
/// section have no digits in `f32`.
fn shared(zeros: &[Complex], poles: &[Complex]) -> [Section; 2] {
    let mut sections = [Section::default(), Section::default()];
    let units = |roots: &[Complex]| {
        let pairs = roots.iter().filter(|root| root.im > 0.0).map(|root| vec![*root, root.conj()]);
        let mut real: Vec<Complex> = roots.iter().filter(|root| root.im == 0.0).copied().collect();
        real.sort_by(|a, b| complex::norm(*a).total_cmp(&complex::norm(*b)));
        (pairs.collect::<Vec<_>>(), real)
    };
    let (pairs, mut real) = units(poles);
    for (section, pair) in sections.iter_mut().zip(pairs) {
        section.poles = pair;
    }
    let mut slowest_first = true;
    while !real.is_empty() {
        let root = if slowest_first { real.remove(0) } else { real.remove(real.len() - 1) };
        slowest_first = !slowest_first;
        // zeros in a pair need a section of two
        if let Some(section) = sections.iter_mut().find(|section| section.poles.len() < 2) {
            section.poles.push(root);
        }
    }
    let (pairs, real) = units(zeros);
    for unit in pairs.into_iter().chain(real.into_iter().map(|root| vec![root])) {
        let room = |section: &&mut Section| section.zeros.len() + unit.len() <= section.poles.len();
        if let Some(section) = sections.iter_mut().find(room) {
            section.zeros.extend(unit);
        }
    }
    sections
}

fn section(gain: f64, section: &Section, time: Time) -> Result<Biquad, LinearError> {
    let system = TransferFunction::new(
        Polynomial::from_roots(gain, &section.zeros),
        Polynomial::from_roots(1.0, &section.poles),
        time,
    )?;
    let sampled = match time {
        Time::Continuous => system.sampled(TICK_F64_S, Discretization::Tustin(None))?,
        Time::Sampled(_) => system,
    };
    // in powers of 1/z
    let order = sampled.denominator().degree();
    let coefficient =
        |p: &Polynomial, ago: usize| order.checked_sub(ago).map_or(0.0, |power| p.coefficient(power));
    let denominator = [1, 2].map(|ago| coefficient(sampled.denominator(), ago) as f32);
    let numerator = [0, 1, 2].map(|ago| coefficient(sampled.numerator(), ago) as f32);
    Ok(Biquad { numerator, denominator })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lead_lag::{Format, LeadLagDesign};

    fn real(values: &[f64]) -> Vec<Complex> {
        values.iter().map(|&re| Complex::new(re, 0.0)).collect()
    }

    /// What a law does to a sine of the samples, from its sections.
    fn value(law: &CompensatorLaw, rad_s: f64) -> Complex {
        let Feedback::LeadLag(LeadLag { sections }) = law.config().feedback else { unreachable!() };
        let late = complex::from_polar(1.0, -rad_s * TICK_F64_S);
        sections.iter().fold(
            Complex::ONE,
            |product, Biquad { numerator: [b0, b1, b2], denominator: [a1, a2] }| {
                let above = late * late * f64::from(*b2) + late * f64::from(*b1) + f64::from(*b0);
                product * above / (late * late * f64::from(*a2) + late * f64::from(*a1) + 1.0)
            },
        )
    }

    #[test]
    fn a_law_does_what_its_compensator_does() {
        let pair = [Complex::new(-20.0, 30.0), Complex::new(-20.0, -30.0)];
        let swift = [Complex::new(-300.0, 200.0), Complex::new(-300.0, -200.0)];
        for (zeros, poles) in [
            (real(&[-32.9, -97.8]), real(&[-250.0, -177.0])),
            (pair.to_vec(), real(&[0.0, -600.0])),
            (pair.to_vec(), [&swift[..], &real(&[0.0])].concat()),
            (real(&[-6.0, -16.0]), real(&[-0.6, -224.0, -400.0, 0.0])),
            (real(&[-5.0]), real(&[0.0])),
            (Vec::new(), Vec::new()),
        ] {
            let zpk = Zpk::new(100.0, zeros, poles, Time::Continuous).unwrap();
            let law = CompensatorLaw::new(&zpk).unwrap();
            let sampled = zpk.transfer().sampled(TICK_F64_S, Discretization::Tustin(None)).unwrap();
            for rad_s in [1.0, 10.0, 60.0, 500.0] {
                let wanted = sampled.at(sampled.time().at_frequency(rad_s));
                let is = value(&law, rad_s);
                assert!(
                    complex::norm(is - wanted) < 2e-3 * complex::norm(wanted),
                    "{zpk} at {rad_s}: {is} {wanted}"
                );
            }
        }
        let report =
            Zpk::new(281.0, real(&[-32.9, -97.8]), real(&[-250.0, -177.0]), Time::Continuous).unwrap();
        let own = LeadLagDesign::report(281.0, [32.9, 97.8], [250.0, 177.0], Format::Zpk).discretize();
        let own =
            CompensatorLaw(LawConfig { feedback: Feedback::LeadLag(own), feedforward: Feedforward::None });
        let law = CompensatorLaw::new(&report).unwrap();
        assert!(
            complex::norm(value(&law, 30.0) - value(&own, 30.0)) < 1e-3 * complex::norm(value(&own, 30.0))
        );
    }

    #[test]
    fn what_a_law_has_no_room_for_is_refused() {
        let many = Zpk::new(1.0, Vec::new(), real(&[-1.0; 5]), Time::Continuous).unwrap();
        assert!(CompensatorLaw::new(&many).is_err());
        let slow = Zpk::new(1.0, Vec::new(), real(&[0.5]), Time::Sampled(0.01)).unwrap();
        assert!(CompensatorLaw::new(&slow).is_err());
    }
}
