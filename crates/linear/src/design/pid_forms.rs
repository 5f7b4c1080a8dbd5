use super::pid::Pid;

/// The standard form: gain · (1 + 1/(Ti s) + Td s / (1 + s/f)).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IdealForm {
    /// The gain of all three terms.
    pub gain: f64,
    /// Ti, s; none without an integral.
    pub integral_s: Option<f64>,
    /// Td, s; 0 without a derivative.
    pub derivative_s: f64,
}

/// The interacting form: gain · (1 + 1/(Ti s)) (1 + Td s) / (1 + s/f); the very same controller, its filter over all of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeriesForm {
    /// The gain before both factors.
    pub gain: f64,
    /// Ti, s; none without an integral.
    pub integral_s: Option<f64>,
    /// Td, s; 0 without a derivative.
    pub derivative_s: f64,
}

impl Pid {
    /// In the standard form; none without a proportional term.
    pub fn ideal(&self) -> Option<IdealForm> {
        let Self { kp, ki, kd, .. } = *self;
        let integral_s = (ki != 0.0).then_some(kp / ki);
        (kp != 0.0).then_some(IdealForm { gain: kp, integral_s, derivative_s: kd / kp })
    }

    /// In the interacting form; none where its zeros are complex, or without a proportional term.
    pub fn series(&self) -> Option<SeriesForm> {
        let Self { kp, ki, kd, filter_rad_s: f } = *self;
        if kp == 0.0 {
            return None;
        }
        let lag_s = if kd == 0.0 { 0.0 } else { 1.0 / f };
        if ki == 0.0 {
            let derivative_s = if kd == 0.0 { 0.0 } else { kd / kp + lag_s };
            return Some(SeriesForm { gain: kp, integral_s: None, derivative_s });
        }
        // (kd + kp/f) s² + (kp + ki/f) s + ki is ki (1 + Ti s)(1 + Td s)
        let (sum, product) = (kp / ki + lag_s, (kd + kp * lag_s) / ki);
        // double zeros are apart by rounding
        let inside = 1.0 - 4.0 * product / (sum * sum);
        let root = if inside.abs() < 1e-12 { 0.0 } else { inside.sqrt() };
        let integral_s = 0.5 * sum * (1.0 + root);
        let is_real = root.is_finite() && integral_s != 0.0;
        is_real.then(|| SeriesForm {
            gain: ki * integral_s,
            integral_s: Some(integral_s),
            derivative_s: if kd == 0.0 { 0.0 } else { product / integral_s },
        })
    }

    /// How fast an integral that is wound up is brought back (back-calculation), s: √(Ti Td), without a derivative Ti (Åström & Hägglund,
    /// *Advanced PID Control*, 2006, §3.5). None without an integral.
    pub fn tracking_s(&self) -> Option<f64> {
        let Self { kp, ki, kd, .. } = *self;
        let tracking_s = if kd == 0.0 { kp / ki } else { (kd / ki).sqrt() };
        (ki != 0.0 && tracking_s > 0.0).then_some(tracking_s)
    }
}

#[cfg(test)]
mod tests {
    use tracelight_maths::complex;

    use super::*;
    use crate::{Complex, Time, TransferFunction};

    fn value(text: &str) -> Complex {
        TransferFunction::parse(text, Time::Continuous).unwrap().at(Complex::new(0.3, 2.0))
    }

    fn is_same(pid: &Pid, text: &str) {
        let (is, wanted) = (pid.transfer().at(Complex::new(0.3, 2.0)), value(text));
        assert!(complex::norm(is - wanted) < 1e-12 * complex::norm(wanted), "{pid:?} {text}: {is} {wanted}");
    }

    #[test]
    fn all_forms_are_the_same_controller() {
        for (kp, ki, kd) in
            [(3.0, 1.5, 0.7), (3.0, 1.5, 0.0), (3.0, 0.0, 0.7), (3.0, 0.0, 0.0), (-2.0, -0.4, -1.0)]
        {
            let pid = Pid { kp, ki, kd, filter_rad_s: 20.0 };
            let IdealForm { gain, integral_s, derivative_s } = pid.ideal().unwrap();
            let integral = integral_s.map_or(String::new(), |s| format!(" + 1/({s:.17} s)"));
            is_same(
                &pid,
                &format!("({gain:.17})*(1{integral} + {derivative_s:.17} s/(1 + s/20))").replace("(-", "(0-"),
            );
            let SeriesForm { gain, integral_s, derivative_s } = pid.series().unwrap();
            let integral = integral_s.map_or(String::new(), |s| format!("(1 + 1/({s:.17} s))"));
            let lag = if kd == 0.0 { "" } else { "/(1 + s/20)" };
            is_same(
                &pid,
                &format!("({gain:.17}){integral}(1 + {derivative_s:.17} s){lag}").replace("(-", "(0-"),
            );
        }
    }

    /// Ti of 4 Td is the least: then both time constants are 2 Td (Åström & Hägglund 2006, §3.2).
    #[test]
    fn complex_zeros_have_no_interacting_form() {
        let with = |kd: f64| Pid { kp: 4.0, ki: 1.0, kd, filter_rad_s: 1e12 }.series();
        let double = with(4.0 - 1e-9).unwrap();
        assert!(
            (double.integral_s.unwrap() - 2.0).abs() < 1e-4 && (double.derivative_s - 2.0).abs() < 1e-4,
            "{double:?}"
        );
        assert!(with(4.1).is_none());
    }

    #[test]
    fn windup_is_brought_back_between_both_times() {
        let pid = Pid { kp: 4.0, ki: 1.0, kd: 1.0, filter_rad_s: 50.0 };
        assert_eq!(pid.tracking_s(), Some(1.0));
        assert_eq!(Pid { kd: 0.0, ..pid }.tracking_s(), Some(4.0));
        assert_eq!(Pid { ki: 0.0, ..pid }.tracking_s(), None);
    }
}
