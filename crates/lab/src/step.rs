/// What a step response is judged by.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepFigures {
    /// Furthest excursion beyond the goal, % of the step.
    pub overshoot_percent: f64,
    /// Last moment at which it is not within ±2 % of the step about the goal, s; `None` if that is the end.
    pub settle_s: Option<f64>,
    /// Mean distance from the goal over the last 0.2 s, in the unit of the step.
    pub final_error: f64,
}

impl StepFigures {
    /// Of a response from zero to `goal`, a value every `tick_s`.
    pub fn of(response: &[f64], goal: f64, tick_s: f64) -> Self {
        const BAND: f64 = 0.02;
        const REST_S: f64 = 0.2;
        let beyond = |value: f64| value / goal - 1.0;
        let overshoot = response.iter().map(|&value| beyond(value)).fold(0.0, f64::max);
        let outside = response.iter().rposition(|&value| beyond(value).abs() > BAND);
        let settled = outside.map_or(0, |last| last + 1);
        let rest = (REST_S / tick_s).round() as usize;
        let last = &response[response.len().saturating_sub(rest)..];
        Self {
            overshoot_percent: 100.0 * overshoot,
            settle_s: (settled < response.len()).then_some(settled as f64 * tick_s),
            final_error: last.iter().map(|value| (value - goal).abs()).sum::<f64>()
                / last.len().max(1) as f64,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// s² + 2ζω s + ω² answers a step with exp(−πζ/√(1 − ζ²)) of overshoot.
    #[test]
    fn a_second_order_system_overshoots_as_the_textbook_says() {
        let (w, zeta, tick_s, goal) = (20.0_f64, 0.5_f64, 1e-4, -0.3);
        let damped = w * (1.0 - zeta * zeta).sqrt();
        let response: Vec<f64> = (0..20_000)
            .map(|k| {
                let t = f64::from(k) * tick_s;
                let swing = (damped * t).cos() + zeta * w / damped * (damped * t).sin();
                goal * (1.0 - (-zeta * w * t).exp() * swing)
            })
            .collect();
        let figures = StepFigures::of(&response, goal, tick_s);
        let expected = 100.0 * (-std::f64::consts::PI * zeta / (1.0 - zeta * zeta).sqrt()).exp();
        assert!((figures.overshoot_percent - expected).abs() < 1e-3, "{figures:?}");
        // the envelope is at 2 % at 4/(ζω), the last exit a little before
        assert!(figures.settle_s.is_some_and(|s| (0.3..0.42).contains(&s)), "{figures:?}");
        assert!(figures.final_error < 1e-8);
    }

    #[test]
    fn what_never_settles_has_no_settling_time() {
        let figures = StepFigures::of(&[0.0, 1.0, 0.9], 1.0, 0.1);
        assert_eq!(figures.settle_s, None);
        assert!((figures.final_error - 0.05).abs() < 1e-12, "{figures:?}");
    }
}
