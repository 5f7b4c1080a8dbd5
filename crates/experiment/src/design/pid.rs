//! A P, PI, PD or PID from wishes: its gains in every form, its setpoint weights, what brings its integral back.

use std::fmt::Write;

use serde_json::{Value, json};
use tracelight_linear::{
    Input, LinearError, Pid, PidWish, SetpointWeights, StepInfo, Terms, Time, TransferFunction,
};

use crate::numbers::{four, percent, seconds};

/// What is wished of a PID and of what a setpoint does to it.
#[derive(Clone, Copy, Debug)]
pub struct PidRequest {
    /// Terms, crossover and margins.
    pub wish: PidWish,
    /// What its terms see of the setpoint.
    pub setpoint: SetpointWish,
    /// What brings its integral back when it is tried on a rig.
    pub anti_windup: AntiWindup,
}

/// What the terms of a PID see of the setpoint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SetpointWish {
    /// All of it.
    Error,
    /// Given shares.
    Given(SetpointWeights),
    /// The largest share that leaves at most so much overshoot after a step, %.
    Overshoot(f64),
}

/// What brings back an integral that grew while a motor was at its limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AntiWindup {
    /// Back-calculation with the time constant that its gains suggest.
    Usual,
    /// Back-calculation with that time constant, s.
    Tracking(f64),
    /// Nothing.
    Off,
}

/// A PID that was designed.
#[derive(Clone, Copy, Debug)]
pub struct PidDesign {
    pub(crate) pid: Pid,
    pub(crate) weights: SetpointWeights,
    /// Time constant of the back-calculation, s.
    pub(crate) tracking_s: Option<f64>,
    terms: Terms,
    /// Its period, s, if it is one of samples.
    sampled: Option<f64>,
}

/// What setpoint weights do, and what they do not.
pub(crate) struct Weighted {
    /// Of a step of the setpoint, with the weights, and the largest of the input after it.
    info: StepInfo,
    input_peak: Option<f64>,
    /// Of the output after a step of 1 at the plant's input: largest, and in the long run.
    load: Option<(f64, f64)>,
}

impl PidRequest {
    pub(crate) fn design(
        &self,
        plant: &TransferFunction,
        others: &[TransferFunction],
    ) -> Result<PidDesign, LinearError> {
        let pid = plant.pid_for_all(others, self.wish)?;
        let weights = match self.setpoint {
            SetpointWish::Error => SetpointWeights::ERROR,
            SetpointWish::Given(weights) => weights,
            SetpointWish::Overshoot(most_percent) => plant.largest_weight(&pid, most_percent)?,
        };
        let tracking_s = match self.anti_windup {
            AntiWindup::Usual => pid.tracking_s(),
            AntiWindup::Tracking(tracking_s) => Some(tracking_s).filter(|_| pid.ki != 0.0),
            AntiWindup::Off => None,
        };
        let sampled = match plant.time() {
            Time::Continuous => None,
            Time::Sampled(period_s) => Some(period_s),
        };
        Ok(PidDesign { pid, weights, tracking_s, terms: self.wish.terms, sampled })
    }
}

impl PidDesign {
    pub(crate) fn weighted(&self, plant: &TransferFunction) -> Result<Weighted, LinearError> {
        const BAND: f64 = 0.02;
        let (to_output, to_input) = plant.weighted(&self.pid, self.weights)?;
        let input_peak = match plant.time() {
            Time::Continuous => to_input.transient(Input::Step).and_then(|transient| transient.peak()),
            Time::Sampled(_) => to_input.step_info(BAND).map(|info| info.peak),
        };
        Ok(Weighted {
            info: to_output.step_info(BAND)?,
            input_peak: input_peak.ok().flatten().map(|peak| peak.value.abs()),
            load: plant.after_load(&self.pid)?,
        })
    }

    /// Its gains, a form a line.
    pub(crate) fn lines(&self) -> String {
        let Pid { kp, ki, kd, filter_rad_s } = self.pid;
        let mut gains = format!("kp = {}", four(kp));
        if ki != 0.0 {
            gains += &format!(", ki = {} 1/s", four(ki));
        }
        let mut lag = String::new();
        if kd != 0.0 {
            gains += &format!(", kd = {} s, derivative up to {} rad/s", four(kd), four(filter_rad_s));
            lag = format!(", filter Tf = {} s", four(1.0 / filter_rad_s));
        }
        let mut lines = vec![gains];
        let form = |gain: f64, integral_s: Option<f64>, derivative_s: f64| {
            let integral = integral_s.map_or(String::new(), |s| format!(", Ti = {} s", four(s)));
            let derivative =
                if kd == 0.0 { String::new() } else { format!(", Td = {} s", four(derivative_s)) };
            format!("{}{integral}{derivative}", four(gain))
        };
        if self.terms != Terms::P {
            lines.push(match self.pid.ideal() {
                Some(ideal) => {
                    format!(
                        "ideal form: Kp = {}{lag}",
                        form(ideal.gain, ideal.integral_s, ideal.derivative_s)
                    )
                }
                None => "ideal form: none, without a proportional term".to_owned(),
            });
            lines.push(match self.pid.series() {
                Some(series) => format!(
                    "series form: Kc = {}{}",
                    form(series.gain, series.integral_s, series.derivative_s),
                    if kd == 0.0 { "" } else { ", the filter over both factors" }
                ),
                None if kp == 0.0 => "series form: none, without a proportional term".to_owned(),
                None => "series form: none, as its zeros are complex".to_owned(),
            });
        }
        if let Some(period_s) = self.sampled {
            lines.push(format!(
                "run every {} ms, its integral and derivative by Tustin's rule: the margins are those of the sampled loop",
                four(1e3 * period_s)
            ));
        }
        lines.iter().map(|line| format!("    {line}\n")).collect()
    }

    pub(crate) fn json(&self, weighted: &Weighted) -> Value {
        let Pid { kp, ki, kd, filter_rad_s } = self.pid;
        let (ideal, series) = (self.pid.ideal(), self.pid.series());
        let step = weighted.info;
        json!({
            "type": self.terms.to_string().to_lowercase(),
            "kp": kp,
            "ki": ki,
            "kd": kd,
            "filter_rad_s": (kd != 0.0).then_some(filter_rad_s),
            "ideal": ideal.map(|f| json!({"kp": f.gain, "ti_s": f.integral_s, "td_s": f.derivative_s})),
            "series": series.map(|f| json!({"kc": f.gain, "ti_s": f.integral_s, "td_s": f.derivative_s})),
            "tracking_s": self.tracking_s,
            "setpoint_weights": {"b": self.weights.proportional, "c": self.weights.derivative},
            "weighted_step": step.ending.value().map(|value| json!({
                "final": value,
                "overshoot_percent": step.overshoot_percent,
                "rise_s": step.rise_s,
                "settle_s": step.settle_s,
                "input_peak": weighted.input_peak,
            })),
            "load": weighted.load.map(|(peak, end)| json!({"peak": peak, "final": end})),
        })
    }

    /// What the weights do and what a load does; nothing of the weights where there are none.
    pub(crate) fn step_lines(&self, weighted: &Weighted) -> String {
        let mut text = String::new();
        let info = weighted.info;
        let is_weighted = self.weights != SetpointWeights::ERROR;
        // writing to a String cannot fail
        if let Some(value) = info.ending.value().filter(|_| is_weighted) {
            let _ = writeln!(
                text,
                "with setpoint weights b = {}, c = {}: final value {}, overshoot {}, rise time {}, settling time (2 %) {}{}",
                four(self.weights.proportional),
                four(self.weights.derivative),
                four(value),
                percent(info.overshoot_percent),
                seconds(info.rise_s),
                seconds(info.settle_s),
                weighted.input_peak.map_or(String::new(), |peak| format!(", input {} at most", four(peak)))
            );
        }
        if let Some((peak, end)) = weighted.load {
            // less is what rounding makes of nothing
            let end = if end.abs() < 1e-9 * peak.abs() { 0.0 } else { end };
            let _ = writeln!(
                text,
                "a step of 1 at the system's input moves the output by {} at most, by {} in the end{}",
                four(peak.abs()),
                four(end),
                if is_weighted { ", whatever the weights" } else { "" }
            );
        }
        text
    }
}
