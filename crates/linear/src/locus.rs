use tracelight_maths::{complex, ln, powf, powi};

use crate::{Complex, Polynomial, Root, TransferFunction};

/// Where the poles of a closed loop go as the gain of its open loop rises.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RootLocus {
    /// Factors on the open loop, rising.
    pub gains: Vec<f64>,
    /// For each gain the closed loop's poles, each at the place in the list where it was at the gain before; as many for each, no
    /// numbers where the branch is infinitely far away.
    pub poles: Vec<Vec<Complex>>,
}

/// Where branches of a root locus meet and part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Breakaway {
    /// The multiple pole.
    pub pole: Complex,
    /// Gain that makes it.
    pub gain: f64,
    /// How many branches meet there.
    pub branches: usize,
}

/// Where branches go as the gain rises without end: from one point in directions that share out the turn.
#[derive(Clone, Debug, PartialEq)]
pub struct Asymptotes {
    /// The point on the real axis.
    pub centre: f64,
    /// Directions, rad.
    pub angles_rad: Vec<f64>,
}

impl TransferFunction {
    /// Poles of 1 + k G for each of these gains, which rise: each gain's poles are looked for from those before, all at once
    /// (Aberth's iteration).
    pub fn root_locus(&self, gains: Vec<f64>) -> RootLocus {
        let Some(&first) = gains.first() else { return RootLocus::default() };
        let mut poles: Vec<Vec<Complex>> = Vec::with_capacity(gains.len());
        let mut last = self.closed_at(first).root_values();
        let mut follower = Follower::new(self);
        for &gain in &gains {
            let followed = if poles.is_empty() { None } else { follower.follow_in_turn(gain, &last) };
            let next = followed.unwrap_or_else(|| {
                let closed = self.closed_at(gain);
                // with more digits, or all anew
                let near = closed.roots_near(&last).filter(|_| !poles.is_empty());
                near.unwrap_or_else(|| nearest(&last, closed.root_values()))
            });
            follower.remember(gain, &last, &next);
            last.clone_from(&next);
            poles.push(next);
        }
        let branches = poles.iter().map(Vec::len).max().unwrap_or(0);
        poles.iter_mut().for_each(|poles| poles.resize(branches, Complex::new(f64::NAN, f64::NAN)));
        RootLocus { gains, poles }
    }

    /// Denominator of the closed loop with that gain.
    pub fn closed_at(&self, gain: f64) -> Polynomial {
        self.denominator() + &self.numerator().scaled(gain)
    }

    /// Gains that show every branch from its pole to its zero or far out: evenly on a logarithmic scale, and closer where poles
    /// move far or meet. `count` at least.
    pub fn locus_gains(&self, count: usize) -> Vec<f64> {
        let breakaways = self.breakaways();
        let (low, high) = self.gain_range(&breakaways);
        let mut gains = crate::logspace((low, high), count.max(2));
        for Breakaway { gain, .. } in breakaways {
            // branches leave a double pole as roots do: by the square root of the gain
            let around =
                (-12..=12).map(|n: i32| gain * (1.0 + f64::from(n.signum()) * powi(4.0, n.abs() - 13)));
            gains.extend(around.filter(|g| (low..=high).contains(g)));
        }
        gains.push(0.0);
        gains.sort_by(f64::total_cmp);
        gains.dedup();
        gains
    }

    /// From where nothing has moved yet to where all is about where it goes.
    fn gain_range(&self, breakaways: &[Breakaway]) -> (f64, f64) {
        let (above, below) = (self.numerator(), self.denominator());
        let sizes = |p: &Polynomial| {
            p.coefficients().iter().map(|c| c.abs()).filter(|c| *c > 0.0).collect::<Vec<_>>()
        };
        let (small, large) = (sizes(below), sizes(above));
        let most = |values: &[f64]| values.iter().fold(0.0_f64, |a, b| a.max(*b));
        let least = |values: &[f64]| values.iter().fold(f64::INFINITY, |a, b| a.min(*b));
        if large.is_empty() {
            return (1e-3, 1e3);
        }
        let crossing = self.margins().gain.iter().map(|m| m.factor).fold(0.0, f64::max);
        let meeting = breakaways.last().map_or(0.0, |b| b.gain);
        // the gain that brings a branch as far beyond all poles and zeros
        let reach =
            10.0 * self.poles().into_iter().chain(self.zeros()).map(complex::norm).fold(0.0, f64::max);
        let out = if self.relative_degree() > 0 { below.value(reach) / above.value(reach) } else { 0.0 };
        let high = [1e2 * most(&small) / most(&large), 10.0 * crossing, 10.0 * meeting, out.abs(), 1e2];
        let high = high.into_iter().filter(|gain| gain.is_finite()).fold(0.0, f64::max).min(1e300);
        let low = (1e-3 * least(&small) / most(&large)).min(1e-3 * high).max(1e-12 * high);
        (low, high)
    }

    /// Double poles at gains above 0: roots of N D′ − N′ D that are poles of the closed loop for a real gain.
    pub fn breakaways(&self) -> Vec<Breakaway> {
        let (above, below) = (self.numerator(), self.denominator());
        let meeting = &(above * &below.derivative()) - &(&above.derivative() * below);
        let ends: Vec<Root> = below.roots().into_iter().chain(above.roots()).collect();
        let place = |meeting: Root| {
            let pole = meeting.value;
            // at a double pole or zero of the open loop branches begin or end
            if ends.iter().any(|end| complex::norm(end.value - pole) <= end.radius + meeting.radius) {
                return None;
            }
            let gain = -below.at(pole) / above.at(pole);
            let real = gain.im.abs() < 1e-6 * gain.re.abs();
            (real && gain.re > 0.0 && gain.re.is_finite()).then_some((meeting, gain.re))
        };
        let mut found = together(meeting.roots().into_iter().filter_map(place).collect());
        found.sort_by(|a, b| a.gain.total_cmp(&b.gain));
        found
    }

    /// Where the branches without a zero go; none if there are none.
    pub fn asymptotes(&self) -> Option<Asymptotes> {
        let excess = usize::try_from(self.relative_degree()).ok().filter(|n| *n > 0)?;
        let (above, below) = (self.numerator(), self.denominator());
        if above.is_zero() {
            return None;
        }
        let sum = |p: &Polynomial| -p.coefficient(p.degree().wrapping_sub(1)) / p.leading();
        let zeros = if above.degree() == 0 { 0.0 } else { sum(above) };
        let centre = (sum(below) - zeros) / excess as f64;
        let first = if above.leading() > 0.0 { 1 } else { 0 };
        let angle = |k: usize| std::f64::consts::PI * (2 * k + first) as f64 / excess as f64;
        Some(Asymptotes { centre, angles_rad: (0..excess).map(angle).collect() })
    }

    /// Gains at which the closed loop just oscillates, and at which frequency, rad/s.
    pub fn oscillating_gains(&self) -> Vec<(f64, f64)> {
        self.margins().gain.into_iter().map(|margin| (margin.factor, margin.rad_s)).collect()
    }
}

/// Places where branches meet, with their gains: those that rounding cannot tell apart are one, where more branches meet.
fn together(found: Vec<(Root, f64)>) -> Vec<Breakaway> {
    /// Share of a place's size within which roots of a multiple one scatter.
    const SCATTER: f64 = 1e-3;
    let mut groups: Vec<Vec<(Root, f64)>> = Vec::new();
    for (root, gain) in found {
        let reach = |root: &Root| root.radius.min(SCATTER * complex::norm(root.value));
        let is_same = |(other, other_gain): &(Root, f64)| {
            complex::norm(root.value - other.value) <= reach(&root) + reach(other)
                && (gain - other_gain).abs() <= SCATTER * gain
        };
        match groups.iter_mut().find(|group| group.iter().any(is_same)) {
            Some(group) => group.push((root, gain)),
            None => groups.push(vec![(root, gain)]),
        }
    }
    let one = |group: Vec<(Root, f64)>| {
        let count = group.len() as f64;
        let middle = group.iter().map(|(root, _)| root.value).sum::<Complex>() / count;
        let radius = group.iter().map(|(root, _)| root.radius).fold(0.0, f64::max);
        let pole = if middle.im.abs() <= radius { middle.re.into() } else { middle };
        let gain = group.iter().map(|(_, gain)| gain).sum::<f64>() / count;
        Breakaway { pole, gain, branches: group.len() + 1 }
    };
    groups.into_iter().map(one).collect()
}

/// Poles from gain to gain.
struct Follower {
    below: Vec<f64>,
    above: Vec<f64>,
    coefficients: Vec<f64>,
    /// How far each pole went last, and over which factor of the gain, as a logarithm.
    moved: Option<(Vec<Complex>, f64)>,
    /// Logarithm of the last gain.
    at: f64,
    /// Gains that are left to those who have more digits, as these were too few.
    resting: u32,
}

impl Follower {
    fn new(open: &TransferFunction) -> Self {
        let size = open.denominator().coefficients().len().max(open.numerator().coefficients().len());
        let padded = |p: &Polynomial| (0..size).rev().map(|power| p.coefficient(power)).collect::<Vec<_>>();
        Self {
            below: padded(open.denominator()),
            above: padded(open.numerator()),
            coefficients: vec![0.0; size],
            moved: None,
            at: f64::NAN,
            resting: 0,
        }
    }

    /// Where poles will be that go on as they went: of three steps there one is saved. Not where one would come near another.
    fn ahead(&self, last: &[Complex], by: f64) -> Option<Vec<Complex>> {
        /// Share of the distance to another that a pole may go.
        const NEAR: f64 = 0.1;
        let (moved, over) = self.moved.as_ref()?;
        let share = by / over;
        if !(share.is_finite() && 0.0 < share && share < 2.0) || moved.len() != last.len() {
            return None;
        }
        let step = |i: usize| share * moved[i];
        let free = |i: usize| {
            let far = step(i).norm_sqr();
            last.iter()
                .enumerate()
                .all(|(j, other)| j == i || far <= NEAR * NEAR * (last[i] - other).norm_sqr())
        };
        (0..last.len()).all(free).then(|| last.iter().enumerate().map(|(i, place)| place + step(i)).collect())
    }

    /// Remembers where poles went.
    fn remember(&mut self, gain: f64, last: &[Complex], next: &[Complex]) {
        let at = ln(gain);
        let by = at - self.at;
        self.moved = (last.len() == next.len() && by.is_finite())
            .then(|| (next.iter().zip(last).map(|(next, last)| next - last).collect(), by));
        self.at = at;
    }

    /// As [`follow`](Self::follow), but not for some gains after one at which they were not found.
    fn follow_in_turn(&mut self, gain: f64, last: &[Complex]) -> Option<Vec<Complex>> {
        const REST: u32 = 7;
        if self.resting > 0 {
            self.resting -= 1;
            return None;
        }
        let found = self.follow(gain, last);
        self.resting = if found.is_none() { REST } else { 0 };
        found
    }

    /// The poles at a gain, near those at another; none if they are not found in some rounds.
    fn follow(&mut self, gain: f64, last: &[Complex]) -> Option<Vec<Complex>> {
        /// Some three are usual. Where real poles have become a pair none suffice: real places stay real.
        const MOST_ROUNDS: usize = 12;
        for ((c, below), above) in self.coefficients.iter_mut().zip(&self.below).zip(&self.above) {
            *c = below + gain * above;
        }
        if self.coefficients[0] == 0.0 || last.len() + 1 != self.coefficients.len() {
            return None;
        }
        // a step of 1e-10 leaves at most its square
        let middle =
            powf((self.coefficients[last.len()] / self.coefficients[0]).abs(), 2.0 / last.len() as f64);
        let most = last.iter().map(Complex::norm_sqr).fold(middle, f64::max);
        let near = |place: Complex| 1e-20 * (place.norm_sqr() + 1e-30 * most);
        // two at one place push each other nowhere
        let close = |i: usize| {
            last[..i].iter().any(|other| (last[i] - other).norm_sqr() < 1e-16 * last[i].norm_sqr())
        };
        if (0..last.len()).any(close) {
            return None;
        }
        let mut places = self.ahead(last, ln(gain) - self.at).unwrap_or_else(|| last.to_vec());
        for _ in 0..MOST_ROUNDS {
            let mut moving = false;
            for i in 0..places.len() {
                let place = places[i];
                let (value, slope) = self.value(place);
                // Newton's step v / v′ away from the others: with one division
                let step = value / (slope - value * repulsion(&places, i));
                if value == Complex::ZERO {
                    continue;
                }
                if !step.is_finite() {
                    return None;
                }
                places[i] -= step;
                moving |= step.norm_sqr() > near(place);
            }
            if !moving {
                places.iter_mut().for_each(|place| *place = tidied(*place, most));
                return Some(places);
            }
        }
        None
    }

    /// Value and derivative of the closed loop's denominator.
    fn value(&self, at: Complex) -> (Complex, Complex) {
        let start = (Complex::ZERO, Complex::ZERO);
        let fold = |(value, slope): (Complex, Complex), &c: &f64| (value * at + c, slope * at + value);
        self.coefficients.iter().fold(start, fold)
    }
}

/// Without what rounding alone puts beside the real axis, or beside zero where the largest is that large.
fn tidied(place: Complex, most: f64) -> Complex {
    if place.norm_sqr() < 1e-36 * most {
        Complex::ZERO
    } else if place.im.abs() < 1e-12 * place.re.abs() {
        Complex::new(place.re, 0.0)
    } else {
        place
    }
}

/// Σ 1 / (zᵢ − zⱼ) over the others, for places whose squares do not overflow.
fn repulsion(places: &[Complex], i: usize) -> Complex {
    let here = places[i];
    let mut sum = Complex::ZERO;
    for there in places {
        let apart = here - there;
        let square = apart.norm_sqr();
        if square > 0.0 {
            sum += apart.conj() * square.recip();
        }
    }
    sum
}

/// The same poles, each where the nearest was.
fn nearest(last: &[Complex], mut poles: Vec<Complex>) -> Vec<Complex> {
    let mut placed = Vec::with_capacity(poles.len());
    for before in last {
        let apart = |pole: &Complex| (pole - before).norm_sqr();
        let Some(at) = (0..poles.len()).min_by(|&a, &b| apart(&poles[a]).total_cmp(&apart(&poles[b]))) else {
            break;
        };
        placed.push(poles.swap_remove(at));
    }
    placed.extend(poles);
    placed
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Time;

    fn parse(text: &str) -> TransferFunction {
        TransferFunction::parse(text, Time::Continuous).unwrap()
    }

    const K11_G11: &str = "281 (s+32.9)(s+97.8)/((s+250)(s+177)) 13.16/(s(s+0.1316))";

    #[test]
    fn every_pole_of_a_locus_is_one_and_moves_a_little_from_gain_to_gain() {
        for text in
            [K11_G11, "1/(s(s+1)(s+2))", "(s+3)/(s^2 (s+10))", "(s^2+4)/((s+1)^4)", "1/s^3", "-1/(s+1)^2"]
        {
            let open = parse(text);
            let locus = open.root_locus(open.locus_gains(400));
            for (gain, poles) in locus.gains.iter().zip(&locus.poles) {
                let closed = open.closed_at(*gain);
                assert_eq!(poles.len(), closed.degree());
                for pole in poles {
                    let terms =
                        closed.coefficients().iter().fold(0.0, |sum, c| sum * complex::norm(*pole) + c.abs());
                    assert!(complex::norm(closed.at(*pole)) <= 1e-12 * terms, "{text}: {gain} {pole}");
                }
                let sum: Complex = poles.iter().sum();
                let size: f64 = poles.iter().map(|p| complex::norm(*p)).sum();
                assert!(
                    (sum.re + closed.coefficient(closed.degree() - 1) / closed.leading()).abs()
                        <= 1e-6 * size,
                    "{text}: {gain}"
                );
            }
            let far = locus.poles.last().unwrap().iter().map(|p| complex::norm(*p)).fold(1.0, f64::max);
            for pair in locus.poles.windows(2).skip(1) {
                let moved =
                    pair[0].iter().zip(&pair[1]).map(|(a, b)| complex::norm(a - b)).fold(0.0, f64::max);
                assert!(moved < 0.1 * far, "{text}: {moved} of {far}");
            }
        }
    }

    /// Where plain digits leave nothing of a derivative.
    #[test]
    fn poles_are_followed_where_coefficients_cancel() {
        let open = parse("(s+1)^60");
        let gains = crate::logspace((1e-9, 1e2), 60);
        let locus = open.root_locus(gains);
        for (gain, poles) in locus.gains.iter().zip(&locus.poles) {
            let closed = open.closed_at(*gain);
            assert!(poles.iter().all(|pole| closed.may_vanish_at(*pole)), "{gain}");
            let near = closed.roots_near(poles).unwrap();
            let moved = |(a, b): (&Complex, &Complex)| complex::norm(a - b) < 1e-6;
            assert!(near.iter().zip(poles).all(moved), "{gain}");
        }
    }

    #[test]
    fn branches_part_and_oscillate_where_the_textbook_says() {
        let open = parse("1/(s(s+1)(s+2))");
        let apart = open.breakaways();
        assert_eq!(apart.len(), 1);
        assert!(
            (apart[0].pole.re + 0.42265).abs() < 1e-5 && (apart[0].gain - 0.3849).abs() < 1e-4,
            "{apart:?}"
        );
        let swinging = open.oscillating_gains();
        assert!((swinging[0].0 - 6.0).abs() < 1e-12 && (swinging[0].1 - 2.0_f64.sqrt()).abs() < 1e-12);
        let far = open.asymptotes().unwrap();
        assert!((far.centre + 1.0).abs() < 1e-15);
        let angles: Vec<f64> = far.angles_rad.iter().map(|a| a.to_degrees()).collect();
        assert!(angles.iter().zip([60.0, 180.0, 300.0]).all(|(a, b)| (a - b).abs() < 1e-12), "{angles:?}");
        assert_eq!(parse("(s+1)/(s+2)").asymptotes(), None);
    }

    #[test]
    fn branches_that_come_from_infinity_have_their_place() {
        let open = parse("s^2/(s+1)");
        let locus = open.root_locus(open.locus_gains(50));
        assert!(locus.poles.iter().all(|poles| poles.len() == 2));
        assert!(locus.poles[0][1].re.is_nan() && locus.poles[1].iter().all(|pole| pole.is_finite()));
    }

    #[test]
    fn a_pole_of_many_is_no_breakaway_and_its_branches_are_followed_in_time() {
        assert_eq!(parse("1/(s+1)^3").breakaways(), []);
        assert_eq!(parse("(s+1)^9").breakaways(), []);
        let open = parse("1/(s+1)^60");
        let locus = open.root_locus(open.locus_gains(200));
        // at gain k they stand about −1 on a circle of radius k^(1/60), as closely as rounding lets
        let last = locus.poles.last().unwrap();
        let radius = locus.gains.last().unwrap().powf(1.0 / 60.0);
        assert!(
            last.iter().all(|pole| (complex::norm(pole + 1.0) / radius - 1.0).abs() < 0.5),
            "{last:?} {radius}"
        );
    }
}
