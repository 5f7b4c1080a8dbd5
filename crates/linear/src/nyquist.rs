//! Nyquist's curve, closed: where the value is infinite it is followed round the pole, as Nyquist's contour goes.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use tracelight_maths::{complex, exp};

use crate::stability::{Stability, stabilities};
use crate::{Complex, Time, TransferFunction, logspace};

/// What an open loop's value goes along as the frequency rises from 0 to its end: infinity, or half the sampling frequency. With its
/// mirror, for the frequencies below 0, it is a closed curve.
#[derive(Clone, Debug, PartialEq)]
pub struct NyquistCurve {
    /// Values beyond this are not followed, but joined by an arc.
    pub level: f64,
    /// Part by part, in the order of the frequencies.
    pub parts: Vec<NyquistPart>,
}

/// A part of Nyquist's curve.
#[derive(Clone, Debug, PartialEq)]
pub enum NyquistPart {
    /// Values no larger than the level.
    Finite {
        /// Their frequencies, rad/s.
        rad_s: Vec<f64>,
        /// The values.
        values: Vec<Complex>,
    },
    /// What passes infinity.
    Arc(InfiniteArc),
}

/// How the value turns round at infinity, near a pole on the edge of stability that Nyquist's contour leaves to its left, or, of more
/// zeros than poles, for infinite frequencies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InfiniteArc {
    /// Frequency of the pole, rad/s: 0, or above; infinite of more zeros than poles.
    pub rad_s: f64,
    /// How many poles are there, more than zeros; of an infinite frequency how many more zeros than poles there are.
    pub order: usize,
    /// Argument of the value where it begins to be larger than the level, rad.
    pub from_rad: f64,
    /// How far it turns until it is not any more, rad; clockwise is negative.
    pub by_rad: f64,
    /// Whether it comes from the mirrored half of the curve, or leads there: it then is its own mirror.
    pub is_own_mirror: bool,
}

impl TransferFunction {
    /// The largest finite absolute value among those that stand out: at both ends, where the value is real, where the absolute value is
    /// larger or smaller than about it. Beyond that it only grows, towards a pole on the edge of stability or an infinite frequency.
    pub fn largest_finite_gain(&self) -> f64 {
        let edge: Vec<f64> = self.poles_at_edge_rad_s().collect();
        // rounding may put a place of the curve on the pole itself, or about it: squares of absolute values have it twice as
        // often, and of many roots at one place each is off by so many digits more
        let unit = |pole: f64| match self.time() {
            Time::Continuous => pole.abs(),
            Time::Sampled(period_s) => period_s.recip(),
        };
        let scatter = |pole: f64| {
            let there = edge.iter().filter(|other| (*other - pole).abs() <= 1e-3 * unit(pole)).count();
            unit(pole) * tracelight_maths::powf(1e-13, 0.5 / there.max(1) as f64)
        };
        let is_apart = |w: &f64| edge.iter().all(|&pole| (w - pole).abs() > scatter(pole));
        let places = self.gain_extremes().into_iter().chain(self.real_frequencies()).filter(is_apart);
        let ends = [0.0, self.time().nyquist_rad_s()].into_iter().filter(is_apart);
        let ends = ends.filter(|w| w.is_finite() || self.relative_degree() >= 0);
        let gains = places.chain(ends).map(|w| complex::norm(self.end_value(w)));
        gains.filter(|gain| gain.is_finite()).fold(0.0, f64::max)
    }

    /// Frequencies of the poles on the edge of stability, rad/s, as angles: below 0 too.
    fn poles_at_edge_rad_s(&self) -> impl Iterator<Item = f64> {
        let at_edge = stabilities(self.denominator(), self.time()).into_iter();
        let time = self.time();
        at_edge
            .filter(|(_, stability)| *stability == Stability::Marginal)
            .map(move |(pole, _)| time.continuous(pole).im)
    }

    /// Nyquist's curve up to a level, which is above 0 and above every finite largest absolute value; closely enough that straight lines
    /// between its values are off by no more than that share of them, or of 1 where they are smaller.
    pub fn nyquist_curve(&self, level: f64, tolerance: f64) -> NyquistCurve {
        let end = self.time().nyquist_rad_s();
        let mut bounds = vec![0.0];
        bounds.extend(self.frequencies_of_gain(level).into_iter().filter(|w| *w < end));
        bounds.push(end);
        let between = |pair: &[f64]| self.part((pair[0], pair[1]), level, tolerance);
        NyquistCurve { level, parts: bounds.windows(2).filter_map(between).collect() }
    }

    fn part(&self, (from, to): (f64, f64), level: f64, tolerance: f64) -> Option<NyquistPart> {
        let band = self.band();
        let middle = match (from, to) {
            (0.0, to) if to.is_infinite() => (band.0 * band.1).sqrt(),
            (0.0, to) => 0.5 * to,
            (from, to) if to.is_infinite() => 2.0 * from,
            (from, to) => (from * to).sqrt(),
        };
        if complex::norm(self.value(middle)) > level
            && let Some(arc) = self.arc((from, to))
        {
            return Some(NyquistPart::Arc(arc));
        }
        let rad_s = self.followed((from, to), tolerance);
        let values = rad_s.iter().map(|&w| self.end_value(w)).collect();
        (rad_s.len() > 1).then_some(NyquistPart::Finite { rad_s, values })
    }

    /// The value at a frequency, at infinity too.
    fn end_value(&self, rad_s: f64) -> Complex {
        if rad_s.is_finite() {
            return self.value(rad_s);
        }
        if self.relative_degree() > 0 { Complex::ZERO } else { self.numerator().leading().into() }
    }

    /// Frequencies from one to another between which the value goes straight on, but for that share of it.
    fn followed(&self, (from, to): (f64, f64), tolerance: f64) -> Vec<f64> {
        const EVENLY: usize = 160;
        const BEYOND: f64 = 1e4;
        let band = self.band();
        let low = if from > 0.0 { from } else { (band.0 / BEYOND).min(to / 10.0) };
        let high = if to.is_finite() { to } else { (band.1 * BEYOND).max(10.0 * low) };
        let mut grid = logspace((low, high), EVENLY);
        // where something happens between them; ends that logarithms have rounded are put right
        let own = self.gain_extremes().into_iter().chain(self.real_frequencies());
        grid.extend(own.filter(|w| *w > low && *w < high));
        grid.sort_by(f64::total_cmp);
        grid.dedup();
        grid[0] = low;
        if let Some(last) = grid.last_mut() {
            *last = high;
        }
        let mut followed = Vec::new();
        if from == 0.0 && self.value(0.0).is_finite() {
            followed.push(0.0);
        }
        followed.push(grid[0]);
        for pair in grid.windows(2) {
            self.halved((pair[0], pair[1]), tolerance, 12, &mut followed);
        }
        if to.is_infinite() && self.relative_degree() >= 0 {
            followed.push(to);
        }
        followed
    }

    /// Frequencies after the first of two, up to the second: more of them where the value bends between.
    fn halved(&self, (from, to): (f64, f64), tolerance: f64, depth: u32, followed: &mut Vec<f64>) {
        let at = |share: f64| from * tracelight_maths::powf(to / from, share);
        let (a, b) = (self.value(from), self.value(to));
        let allowed = tolerance * complex::norm(a).min(complex::norm(b)).max(1.0);
        let is_bent = |share: f64| {
            let off = distance_to_line(self.value(at(share)), a, b);
            off.is_nan() || off > allowed
        };
        if depth > 0 && [0.5, 0.27, 0.81].into_iter().any(is_bent) {
            let middle = at(0.5);
            self.halved((from, middle), tolerance, depth - 1, followed);
            self.halved((middle, to), tolerance, depth - 1, followed);
        } else {
            followed.push(to);
        }
    }

    /// How the value turns at infinity between two frequencies at which it is at the level.
    fn arc(&self, (from, to): (f64, f64)) -> Option<InfiniteArc> {
        let end = self.time().nyquist_rad_s();
        if to.is_infinite() {
            return self.arc_at_infinity(from);
        }
        // below 0, and beyond half the sampling frequency, lies the mirror
        let (first, last) = match (from == 0.0, to == end) {
            (true, _) => (-to, to),
            (_, true) => (from, 2.0 * end - from),
            _ => (from, to),
        };
        let mut inside: Vec<f64> = self
            .poles_at_edge_rad_s()
            .map(|w| if w < first { w + 2.0 * end } else { w })
            .filter(|w| *w > first && *w < last)
            .collect();
        inside.sort_by(f64::total_cmp);
        let (&lowest, &highest) = (inside.first()?, inside.last()?);
        let room = (lowest - first).min(last - highest);
        let middle = if from == 0.0 {
            0.0
        } else if to == end {
            end
        } else {
            0.5 * (lowest + highest)
        };
        let radius = 0.5 * (highest - lowest) + 1e-3 * room;
        let before = self.turned(|t| Complex::new(0.0, first + t * (middle - radius - first)));
        let round = self.turned(|t| {
            let angle = PI * t - FRAC_PI_2;
            Complex::new(0.0, middle) + complex::from_polar(radius, angle)
        });
        let after = self.turned(|t| Complex::new(0.0, middle + radius + t * (last - middle - radius)));
        Some(InfiniteArc {
            rad_s: middle,
            order: (-round / PI).round().max(0.0) as usize,
            from_rad: complex::arg(self.on_contour(Complex::new(0.0, first))),
            by_rad: before + round + after,
            is_own_mirror: from == 0.0 || to == end,
        })
    }

    /// How it turns from a frequency on through infinity to its mirror, of more zeros than poles.
    fn arc_at_infinity(&self, from: f64) -> Option<InfiniteArc> {
        let order = usize::try_from(-self.relative_degree()).ok().filter(|order| *order > 0)?;
        let far = 1e3 * from.max(self.band().1);
        let out = self.turned(|t| Complex::new(0.0, from * tracelight_maths::powf(far / from, t)));
        let round = self.turned(|t| complex::from_polar(far, FRAC_PI_2 - PI * t));
        Some(InfiniteArc {
            rad_s: f64::INFINITY,
            order,
            from_rad: complex::arg(self.on_contour(Complex::new(0.0, from))),
            by_rad: 2.0 * out + round,
            is_own_mirror: true,
        })
    }

    /// The value at a place of Nyquist's contour, given in continuous time.
    fn on_contour(&self, s: Complex) -> Complex {
        match self.time() {
            Time::Continuous => self.at(s),
            Time::Sampled(period_s) => self.at(complex::from_polar(exp(s.re * period_s), s.im * period_s)),
        }
    }

    /// How far the value turns along a way, rad.
    fn turned(&self, way: impl Fn(f64) -> Complex) -> f64 {
        const STEPS: u32 = 720;
        let value = |k: u32| self.on_contour(way(f64::from(k) / f64::from(STEPS)));
        let mut turned = 0.0;
        let mut last = value(0);
        for k in 1..=STEPS {
            let next = value(k);
            turned += complex::arg(next / last);
            last = next;
        }
        turned
    }
}

impl InfiniteArc {
    /// Places on it, as an arc of that radius that bulges by a share of it, so that what turns more than once does not hide itself.
    pub fn points(&self, radius: f64, bulge: f64) -> Vec<Complex> {
        let steps = (self.by_rad.abs() / TAU * 180.0).ceil().clamp(8.0, 4000.0) as u32;
        let at = |k: u32| {
            let share = f64::from(k) / f64::from(steps);
            let wide = radius * (1.0 + bulge * tracelight_maths::sin(PI * share));
            complex::from_polar(wide, self.from_rad + share * self.by_rad)
        };
        (0..=steps).map(at).collect()
    }
}

impl NyquistCurve {
    /// The closed curve: the mirrored half first, from the end of the frequencies to 0, then the other.
    pub fn closed(&self) -> Vec<Complex> {
        let arc = |arc: &InfiniteArc| arc.points(self.level, 0.0);
        let mut half = Vec::new();
        let (mut at_zero, mut at_end) = (Vec::new(), Vec::new());
        for part in &self.parts {
            match part {
                NyquistPart::Finite { values, .. } => half.extend(values.iter().copied()),
                NyquistPart::Arc(a) if a.is_own_mirror && a.rad_s == 0.0 => at_zero = arc(a),
                NyquistPart::Arc(a) if a.is_own_mirror => at_end = arc(a),
                NyquistPart::Arc(a) => half.extend(arc(a)),
            }
        }
        let mirror = half.iter().rev().map(Complex::conj);
        mirror.chain(at_zero).chain(half.iter().copied()).chain(at_end).collect()
    }

    /// How often it turns round a place, counterclockwise; nothing reliable if it goes through that place.
    pub fn turns_round(&self, place: Complex) -> i64 {
        let closed = self.closed();
        let next = closed.iter().cycle().skip(1);
        let turned: f64 = closed.iter().zip(next).map(|(a, b)| complex::arg((b - place) / (a - place))).sum();
        (turned / TAU).round() as i64
    }
}

/// How far a place is from a straight line between two others.
fn distance_to_line(place: Complex, from: Complex, to: Complex) -> f64 {
    let (along, way) = (place - from, to - from);
    let length = way.norm_sqr();
    if length == 0.0 {
        return complex::norm(along);
    }
    let share = ((along * way.conj()).re / length).clamp(0.0, 1.0);
    complex::norm(along - share * way)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn level(system: &TransferFunction) -> f64 {
        1.2 * system.largest_finite_gain().max(1.0)
    }

    fn check(text: &str, time: Time) {
        let open = TransferFunction::parse(text, time).unwrap();
        let closed = open.closed().unwrap();
        let curve = open.nyquist_curve(level(&open), 1e-4);
        let turns = curve.turns_round(Complex::new(-1.0, 0.0));
        let expected = open.growing_poles() as i64 - closed.growing_poles() as i64;
        assert_eq!(turns, expected, "{text}");
    }

    /// Nyquist's theorem: the closed curve turns round −1 as often as poles become stable.
    #[test]
    fn the_curve_that_is_drawn_turns_as_often_as_is_said() {
        for text in [
            "10/(s+1)^3",
            "5/(s+1)^3",
            "3(s+6)^2/(s(s+1)^2)",
            "1/(s^4+s^3)",
            "1/(s(s+1)(s+2))",
            "7/(s(s+1)(s+2))",
            "1/s",
            "(s+1)/s^2",
            "(s+1)^2/s^3",
            "0.3(s+1)^2/s^3",
            "2/(s-1)",
            "0.5/(s-1)",
            "-2/(s+1)",
            "0.5(1-s)/(s+1)",
            "3(1-s)/(s+1)^2",
            "1/(s(s^2+1))",
            "(s+0.1)/(s^2+1)",
            "(s^2+4)/(s(s^2+1)(s+1))",
            "1/(s^2+0.01s+1)",
            "s",
            "s^2+1",
            "(s^2+s+1)/(s+1)",
            "s^3/(s+1)",
            "1e4/((s+1)(s^2+0.02s+100))",
            "(s-1)/(s-1.001)",
            "1/(s^2+1)^2",
            "10/(s(s-1))",
            "(s+3)/(s(s-1))",
            "40(s+3)/(s(s-1))",
            "1/(s^2(s^2+1))",
            "1000/(s(s+1)(s+100))",
        ] {
            check(text, Time::Continuous);
        }
        for text in [
            "0.5/(z-1)",
            "3/(z-1)",
            "0.1(z+1)/(z-1)^2",
            "1/(z+1)",
            "0.2/(z^2-1)",
            "0.1/(z^2-z+1)",
            "2/(z-1.5)",
            "1/z^3",
            "0.3z/((z-1)(z-0.5))",
            "5z/((z-1)(z-0.5))",
            "0.01/((z-1)^2(z-0.9))",
        ] {
            check(text, Time::Sampled(0.1));
        }
    }

    #[test]
    fn four_poles_of_which_three_integrate_turn_once_and_a_half_at_infinity() {
        let open = TransferFunction::parse("1/(s^4+s^3)", Time::Continuous).unwrap();
        let curve = open.nyquist_curve(10.0, 1e-4);
        let NyquistPart::Arc(arc) = &curve.parts[0] else { panic!("{:?}", curve.parts[0]) };
        assert_eq!((arc.rad_s, arc.order, arc.is_own_mirror), (0.0, 3, true));
        assert!((arc.by_rad + 3.0 * PI).abs() < 1.0, "{arc:?}");
        assert_eq!(curve.turns_round(Complex::new(-1.0, 0.0)), -2);
    }

    /// Random loops with poles and zeros on both sides and on the edge.
    #[test]
    fn random_loops_turn_as_often_as_is_said() {
        let mut state = 7_u64;
        let mut random = move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) as f64 / f64::from(1_u32 << 31)
        };
        let mut tried = 0;
        for _ in 0..300 {
            let mut factor = |edge: bool| match (random() * 4.0) as u32 {
                0 if edge => "(s)".to_owned(),
                1 if edge => format!("(s^2+{:.3})", 0.1 + 5.0 * random()),
                2 => format!("(s^2+{:.3}s+{:.3})", 2.0 * random() - 0.5, 0.1 + 5.0 * random()),
                _ => format!("(s+{:.3})", 4.0 * random() - 1.0).replace("+-", "-"),
            };
            let (zeros, poles) = (factor(false), [factor(true), factor(true), factor(false)].concat());
            let text = format!("{:.3}{zeros}/({poles})", 0.2 + 5.0 * random()).replace("+-", "-");
            let open = TransferFunction::parse(&text, Time::Continuous).unwrap();
            let closed = open.closed().unwrap();
            // at the edge the count is not defined
            if closed.stability() == Stability::Marginal
                || open.margins().modulus.is_some_and(|m| m.distance < 1e-3)
            {
                continue;
            }
            let turns = open.nyquist_curve(level(&open), 1e-4).turns_round(Complex::new(-1.0, 0.0));
            assert_eq!(turns, open.growing_poles() as i64 - closed.growing_poles() as i64, "{text}");
            tried += 1;
        }
        assert!(tried > 200, "{tried}");
    }
}
