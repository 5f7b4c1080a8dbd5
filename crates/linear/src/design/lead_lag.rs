use std::f64::consts::{FRAC_PI_2, PI};

use tracelight_maths::{atan, complex, tan};

use super::in_continuous_time;
use crate::notation::four_digits;
use crate::time::positive;
use crate::{Complex, LinearError, Time, TransferFunction, Zpk};

/// What a lead-lag compensator is to do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LeadLagWish {
    /// Where the loop's gain is 1, rad/s.
    pub crossover_rad_s: f64,
    /// Its phase margin there, rad.
    pub phase_margin_rad: f64,
    /// How many times more it amplifies what hardly changes; 1: no lag.
    pub lag: f64,
}

/// The phase that one lead gives at most: its pole then is 20 times its zero.
const MOST_LEAD_RAD: f64 = 65.0 * PI / 180.0;

/// Leads that are put one after the other at most.
const MOST_LEADS: usize = 3;

impl TransferFunction {
    /// The compensator K that gives the open loop K G that crossover and that phase margin, both exactly: as many equal leads about the
    /// crossover as its phase asks for, and a lag a decade below. Where no lead is needed, the margin is more than was wished. Where no
    /// positive gain closes a stable loop, a negative one may.
    pub fn lead_lag(&self, wish: LeadLagWish) -> Result<Zpk, LinearError> {
        let settles = |k: &Zpk| k.transfer().series(self).is_ok_and(|open| open.closes_stable());
        let why = match self.positive_lead_lag(wish) {
            Ok(k) if settles(&k) => return Ok(k),
            Ok(_) => LinearError::Wish(
                "the loop would not be stable: at that crossover leads alone do not settle that system"
                    .into(),
            ),
            Err(why) => why,
        };
        let turned =
            self.scaled(-1.0).positive_lead_lag(wish).ok().and_then(|k| {
                Zpk::new(-k.gain(), k.zeros().to_vec(), k.poles().to_vec(), Time::Continuous).ok()
            });
        turned.filter(settles).ok_or(why)
    }

    fn positive_lead_lag(&self, wish: LeadLagWish) -> Result<Zpk, LinearError> {
        in_continuous_time(self.time(), "a lead-lag compensator")?;
        let w = positive("the crossover, rad/s,", wish.crossover_rad_s)?;
        if !(0.0..PI).contains(&wish.phase_margin_rad) {
            return Err(LinearError::Wish("a phase margin is between 0 and 180°".into()));
        }
        if !(1.0..=1e6).contains(&wish.lag) {
            return Err(LinearError::Wish(format!("a lag of {} is not between 1 and 1e6", wish.lag)));
        }
        let (mut zeros, mut poles) = (Vec::new(), Vec::new());
        let left = |size: f64| Complex::new(-size, 0.0);
        let mut missing = wish.phase_margin_rad - PI - self.phase(w);
        if wish.lag > 1.0 {
            zeros.push(left(0.1 * w));
            poles.push(left(0.1 * w / wish.lag));
            missing += atan(10.0 * wish.lag) - atan(10.0);
        }
        let leads = (missing / MOST_LEAD_RAD).ceil().max(0.0);
        if leads > MOST_LEADS as f64 || leads.is_nan() {
            return Err(LinearError::Wish(format!(
                "at {} rad/s {:.1}° of phase are missing; {MOST_LEADS} leads give {:.0}° at most: ask for a lower crossover or a smaller phase margin",
                four_digits(w),
                missing.to_degrees(),
                (MOST_LEADS as f64 * MOST_LEAD_RAD).to_degrees()
            )));
        }
        if leads > 0.0 {
            // arg (1 + j r) − arg (1 + j/r) = 2 atan r − π/2
            let root = tan(0.5 * (missing / leads + FRAC_PI_2));
            for _ in 0..leads as usize {
                zeros.push(left(w / root));
                poles.push(left(w * root));
            }
        }
        let shape = Zpk::new(1.0, zeros.clone(), poles.clone(), Time::Continuous)?.transfer();
        let gain = 1.0 / complex::norm(shape.at(Complex::new(0.0, w)) * self.at(Complex::new(0.0, w)));
        if !(gain.is_finite() && gain > 0.0) {
            return Err(LinearError::Wish(format!(
                "at {} rad/s the system's gain is no number, or none",
                four_digits(w)
            )));
        }
        Zpk::new(gain, zeros, poles, Time::Continuous)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_wishes_are_met_exactly() {
        for (text, crossover_rad_s, degrees, lag) in [
            ("13.16/(s(s+0.1316))", 60.0, 55.0, 1.0),
            ("13.16/(s(s+0.1316))", 60.0, 55.0, 10.0),
            ("13.33/(s^2+0.1333s+0.7822)", 11.9, 64.0, 100.0),
            ("1/(s(s+1)(s+2))", 3.0, 50.0, 1.0),
            ("2/((s-1)(s+20))", 40.0, 45.0, 1.0),
        ] {
            let plant = TransferFunction::parse(text, Time::Continuous).unwrap();
            let wish = LeadLagWish { crossover_rad_s, phase_margin_rad: f64::to_radians(degrees), lag };
            let open = plant.lead_lag(wish).unwrap().transfer().series(&plant).unwrap();
            let phase = open.margins();
            let there = phase.phase.iter().find(|m| (m.rad_s / crossover_rad_s - 1.0).abs() < 1e-9);
            assert!((there.unwrap().degrees() - degrees).abs() < 1e-7, "{text}: {phase:?}");
        }
    }

    #[test]
    fn what_leads_cannot_give_is_refused() {
        let plant = TransferFunction::parse("1/(s+1)^6", Time::Continuous).unwrap();
        let wish = LeadLagWish { crossover_rad_s: 10.0, phase_margin_rad: 1.0, lag: 1.0 };
        assert!(matches!(plant.lead_lag(wish), Err(LinearError::Wish(_))));
        assert!(TransferFunction::parse("s^3", Time::Continuous).unwrap().lead_lag(wish).is_err());
        let down = TransferFunction::parse("-1/(s+1)", Time::Continuous).unwrap();
        let k = down.lead_lag(LeadLagWish { crossover_rad_s: 5.0, ..wish }).unwrap();
        assert!(k.gain() < 0.0 && k.poles().is_empty(), "{k}");
        let easy = plant.lead_lag(LeadLagWish { crossover_rad_s: 0.1, ..wish }).unwrap();
        assert!(easy.poles().is_empty());
    }
}
