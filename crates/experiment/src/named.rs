//! A system as it was typed: rational, or with a dead time, of which rational figures are those of an approximation.

use serde_json::{Value, json};
use tracelight_chart::Colour;
use tracelight_linear::{
    Complex, DelayMargin, Delayed, FrequencyData, FrequencyResponse, GainMargin, GrowingPoles, LinearError,
    LoopFunction, LoopMember, Margins, Norm, NyquistCurve, NyquistPart, Peak, RealCrossing, Stability, Time,
    TransferFunction,
};
use tracelight_maths::complex;

use crate::left_out;
use crate::numbers::four;
use crate::system_json::system_json;

/// A system and what it is called.
#[derive(Clone)]
pub(crate) struct Named {
    /// As typed, and what was made of it.
    pub(crate) name: String,
    /// The system; with a dead time nearly the same.
    pub(crate) system: TransferFunction,
    /// What it is exactly, if it has a dead time.
    pub(crate) late: Option<Late>,
    /// What is known of it, if it was measured: then the system above stands for nothing.
    pub(crate) data: Option<FrequencyData>,
    /// How many unstable poles an open loop that was measured has, if that was said.
    pub(crate) unstable: Option<usize>,
    /// The open loop, of one that was closed: what it was, times −1 if the feedback was positive.
    pub(crate) opened: Option<Box<Named>>,
    /// An open loop times −1: positive feedback closes it.
    pub(crate) is_positive: bool,
    pub(crate) colour: Colour,
}

/// A system with a dead time.
#[derive(Clone, Debug)]
pub(crate) struct Late {
    /// The open loop, if it is closed; otherwise the system.
    pub(crate) open: Delayed,
    /// What of the closed loop it is, if it is closed.
    pub(crate) closed: Option<LoopFunction>,
    /// Order of Padé's approximation in the rational one.
    pub(crate) order: usize,
    /// Up to this frequency, rad/s, its phase is off by no more than that, rad.
    pub(crate) good_to: (f64, f64),
}

impl Late {
    /// Approximated in that order, or the least whose phase is off by no more than a degree up to where it matters.
    pub(crate) fn of(open: Delayed, order: Option<usize>) -> Self {
        /// A degree, rad.
        const WITHIN: f64 = 0.0175;
        /// How far beyond a crossover it matters.
        const BEYOND: f64 = 3.0;
        let margins = open.margins();
        let crossing = margins.phase.iter().map(|margin| margin.rad_s).fold(0.0, f64::max);
        let real = margins.least_gain().map_or(0.0, |margin| margin.rad_s);
        let band = open.rational().band();
        let real = if real.is_finite() { real } else { 0.0 };
        let matters =
            if crossing.max(real) > 0.0 { BEYOND * crossing.max(real) } else { (band.0 * band.1).sqrt() };
        let order = order.unwrap_or_else(|| open.approximation_order(matters, WITHIN));
        let good_to = (matters, open.approximation_error_rad(order, matters));
        Self { open, closed: None, order, good_to }
    }

    /// What the rational figures are worth.
    pub(crate) fn note(&self) -> String {
        format!(
            "    the dead time of {} s is approximated (Padé, order {}): its phase is off by at most {}° up to {} rad/s",
            four(self.open.delay_s()),
            self.order,
            four(self.good_to.1.to_degrees()),
            four(self.good_to.0)
        )
    }
}

impl Named {
    /// A rational system.
    pub(crate) const fn rational(name: String, system: TransferFunction, colour: Colour) -> Self {
        Self {
            name,
            system,
            late: None,
            data: None,
            unstable: None,
            opened: None,
            is_positive: false,
            colour,
        }
    }

    /// What was measured.
    pub(crate) fn measured(name: String, data: FrequencyData, colour: Colour) -> Self {
        let system = TransferFunction::gain(1.0, Time::Continuous);
        Self { data: Some(data), ..Self::rational(name, system, colour) }
    }

    /// What it is exactly, of an open system with a dead time.
    fn exact(&self) -> Option<&Delayed> {
        self.late.as_ref().filter(|late| late.closed.is_none()).map(|late| &late.open)
    }

    /// What it is exactly, of a closed loop with a dead time.
    pub(crate) fn closed_late(&self) -> Option<&LoopFunction> {
        self.late.as_ref().and_then(|late| late.closed.as_ref())
    }

    /// What it is exactly, of an open system that was not measured.
    pub(crate) fn delayed(&self) -> Delayed {
        self.exact().cloned().unwrap_or_else(|| self.system.clone().into())
    }

    /// What closes it as an open loop.
    pub(crate) const fn feedback(&self) -> &'static str {
        if self.is_positive { "positive" } else { "negative" }
    }

    /// How many poles the closed loop has that grow, of an open loop that was measured and of which it was said how many it has itself; or
    /// why the data do not tell.
    pub(crate) fn counted(&self) -> Option<Result<usize, LinearError>> {
        Some(self.data.as_ref()?.unstable_when_closed(self.unstable?))
    }

    /// What it is, for people.
    pub(crate) fn text(&self) -> String {
        if let Some(data) = &self.data {
            let (low, high) = data.band();
            return format!(
                "{} measured values from {} to {} rad/s{}",
                data.values().len(),
                four(low),
                four(high),
                left_out::words(data)
            );
        }
        match &self.late {
            None => self.system.to_string(),
            Some(Late { open, closed: None, .. }) => open.to_string(),
            Some(Late { open, closed: Some(function), .. }) => {
                let member = match function.member() {
                    LoopMember::Sensitivity => "1 / (1 + L)",
                    LoopMember::Complementary if function.is_positive() => "−L / (1 + L)",
                    LoopMember::Complementary => "L / (1 + L)",
                    LoopMember::Load => "P / (1 + L)",
                    LoopMember::Control => "C / (1 + L)",
                };
                format!("{member}, L = {open}")
            }
        }
    }

    /// What rational figures of it are worth, a line; nothing where they are exact.
    pub(crate) fn approximated(&self) -> String {
        self.late.as_ref().map_or(String::new(), |late| late.note() + "\n")
    }

    /// Value at a frequency, rad/s.
    pub(crate) fn at(&self, rad_s: f64) -> Complex {
        if let Some(data) = &self.data {
            return data.at(rad_s).unwrap_or(Complex::new(f64::NAN, f64::NAN));
        }
        match (self.exact(), self.closed_late()) {
            (Some(exact), _) => exact.at_frequency(rad_s),
            (_, Some(closed)) => closed.at_frequency(rad_s),
            _ => self.system.at(self.system.time().at_frequency(rad_s)),
        }
    }

    /// Phase at a frequency, rad.
    pub(crate) fn phase(&self, rad_s: f64) -> f64 {
        if let Some(data) = &self.data {
            return data.phase(rad_s).unwrap_or(f64::NAN);
        }
        self.exact().map_or_else(|| self.system.phase(rad_s), |exact| exact.phase(rad_s))
    }

    /// At each of these frequencies, rad/s; of measured data no numbers beyond them.
    pub(crate) fn frequency_response(&self, rad_s: Vec<f64>) -> FrequencyResponse {
        if self.data.is_some() {
            let values = rad_s.iter().map(|w| self.at(*w)).collect();
            let phases_rad = rad_s.iter().map(|w| self.phase(*w)).collect();
            return FrequencyResponse { rad_s, values, phases_rad };
        }
        match (self.exact(), self.closed_late()) {
            (Some(exact), _) => exact.frequency_response(rad_s),
            (_, Some(closed)) => closed.frequency_response(rad_s),
            _ => self.system.frequency_response(rad_s),
        }
    }

    /// Margins of it as an open loop.
    pub(crate) fn margins(&self) -> Margins {
        if let Some(data) = &self.data {
            return data.margins();
        }
        self.exact().map_or_else(|| self.system.margins(), Delayed::margins)
    }

    /// For how much longer it may be late; of measured data if the loop is stable.
    pub(crate) fn delay_margin(&self, margins: &Margins) -> DelayMargin {
        if self.data.is_some() {
            if let Some(Ok(1..)) = self.counted() {
                return DelayMargin::Unstable;
            }
            return margins.least_delay().map_or(DelayMargin::Unknown, |margin| DelayMargin::Delay {
                delay_s: margin.delay_s,
                rad_s: margin.rad_s,
            });
        }
        self.exact().map_or_else(|| self.system.delay_margin(margins), |exact| exact.delay_margin(margins))
    }

    /// What it does by itself.
    pub(crate) fn stability(&self) -> Stability {
        match self.closed_late() {
            Some(closed) => closed.growing().stability().unwrap_or(Stability::Growing),
            None => self.system.stability(),
        }
    }

    /// The H∞ norm; none of what was measured.
    pub(crate) fn h_infinity(&self) -> Option<Norm> {
        if self.data.is_some() {
            return None;
        }
        Some(match self.closed_late() {
            Some(closed) => closed.h_infinity(),
            // a dead time leaves the gain
            None => self.exact().map_or(&self.system, Delayed::rational).h_infinity(),
        })
    }

    /// The H2 norm, where there is one and it is known.
    pub(crate) fn h2_norm(&self) -> Option<f64> {
        if self.data.is_some() || self.closed_late().is_some() {
            return None;
        }
        self.exact().map_or(&self.system, Delayed::rational).h2_norm().ok().flatten()
    }

    /// What becomes of it once it is closed; none where that is not defined.
    pub(crate) fn closed_stability(&self) -> Option<Stability> {
        if self.data.is_some() {
            let stability = |count| if count == 0 { Stability::Stable } else { Stability::Growing };
            return self.counted()?.ok().map(stability);
        }
        match self.exact() {
            Some(exact) => exact.closed_growing().stability(),
            None => self.system.closed().ok().map(|closed| closed.stability()),
        }
    }

    /// How many poles grow once it is closed; none where that is not defined or has no end.
    pub(crate) fn closed_growing(&self) -> Option<usize> {
        if self.data.is_some() {
            return self.counted()?.ok();
        }
        match self.exact().map(Delayed::closed_growing) {
            None => self.system.closed().ok().map(|closed| closed.growing_poles()),
            Some(GrowingPoles::Count(count) | GrowingPoles::Edge(count)) => Some(count),
            Some(_) => None,
        }
    }

    pub(crate) fn real_crossings(&self) -> Vec<RealCrossing> {
        if let Some(data) = &self.data {
            let crossing = |m: GainMargin| RealCrossing { rad_s: m.rad_s, value: -1.0 / m.factor };
            return data.margins().gain.into_iter().map(crossing).collect();
        }
        /// A dead time crosses without end: what is that much smaller than the largest is not told.
        const TOLD: f64 = 0.02;
        let Some(exact) = self.exact() else { return self.system.real_crossings() };
        let mut all = exact.real_crossings();
        let most = all.iter().map(|crossing| crossing.value.abs()).fold(0.0, f64::max);
        all.retain(|crossing| crossing.value.abs() >= TOLD * most);
        all
    }

    /// Nyquist's curve; of measured data their polygon.
    pub(crate) fn nyquist_curve(&self, level: f64, tolerance: f64) -> NyquistCurve {
        if let Some(data) = &self.data {
            let part = NyquistPart::Finite { rad_s: data.rad_s().to_vec(), values: data.values().to_vec() };
            return NyquistCurve { level, parts: vec![part] };
        }
        match self.exact() {
            Some(exact) => exact.nyquist_curve(level, tolerance),
            None => self.system.nyquist_curve(level, tolerance),
        }
    }

    /// A dead time turns, and leaves the gain.
    pub(crate) fn largest_finite_gain(&self) -> f64 {
        if let Some(data) = &self.data {
            return data.values().iter().map(|value| complex::norm(*value)).fold(0.0, f64::max);
        }
        self.exact().map_or(&self.system, Delayed::rational).largest_finite_gain()
    }

    pub(crate) fn bandwidth(&self) -> Option<f64> {
        if let Some(data) = &self.data {
            return data.bandwidth();
        }
        match self.closed_late() {
            Some(closed) if closed.member() == LoopMember::Complementary => closed.open().closed_bandwidth(),
            Some(_) => None,
            None => self.exact().map_or(&self.system, Delayed::rational).bandwidth(),
        }
    }

    pub(crate) fn resonance(&self) -> Option<Peak> {
        if let Some(data) = &self.data {
            return data.resonance();
        }
        match self.closed_late() {
            Some(closed) if closed.member() == LoopMember::Complementary => closed.open().closed_resonance(),
            Some(closed) => closed.h_infinity().peak(),
            None => self.exact().map_or(&self.system, Delayed::rational).resonance(),
        }
    }

    /// From a decade below the slowest pole or zero to a decade above the fastest, rad/s; of a dead time those of the rational part.
    pub(crate) fn band(&self) -> (f64, f64) {
        if let Some(data) = &self.data {
            return data.band();
        }
        match &self.late {
            Some(late) => {
                let (low, high) = late.open.rational().band();
                // where it turns by a quarter of a turn, and some turns more
                (low.min(0.1 / late.open.delay_s()), high.max(10.0 / late.open.delay_s()))
            }
            None => self.system.band(),
        }
    }

    /// The system for scripts: of a dead time the rational part, and how late it is.
    pub(crate) fn json(&self) -> Value {
        if let Some(data) = &self.data {
            let (low, high) = data.band();
            return json!({
                "name": self.name,
                "measured": data.values().len(),
                "from_rad_s": low,
                "to_rad_s": high,
                "left_out": left_out::json(data),
            });
        }
        let Some(late) = &self.late else { return system_json(&self.name, &self.system) };
        let mut object = system_json(&self.name, late.open.rational());
        object["delay_s"] = late.open.delay_s().into();
        if late.closed.is_some() {
            object["closed"] = true.into();
            let stability = self.stability();
            object["stable"] = (stability == Stability::Stable).into();
            object["stability"] = crate::system_json::stability_name(stability).into();
        }
        object
    }

    /// The system for scripts, as it is approximated.
    pub(crate) fn approximated_json(&self) -> Value {
        let mut object = system_json(&self.name, &self.system);
        if let Some(late) = &self.late {
            object["pade"] = json!({
                "delay_s": late.open.delay_s(),
                "order": late.order,
                "error_deg": late.good_to.1.to_degrees(),
                "up_to_rad_s": late.good_to.0,
            });
        }
        object
    }
}
