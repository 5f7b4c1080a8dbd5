//! A smooth curve through points: cubics that keep rises and falls.

/// Cubics between points, each with the slopes at its ends.
///
/// Slopes are of fourth order where five neighbours are there, and limited so that the curve rises and falls where the points do: at a
/// peak of the points the curve may be a little higher than they are, as what they were taken of is.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Curve {
    places: Vec<f64>,
    values: Vec<f64>,
    slopes: Vec<f64>,
}

/// One of the cubics: Hermite's, over a width.
#[derive(Clone, Copy)]
pub(super) struct Piece {
    pub(super) from: f64,
    pub(super) width: f64,
    /// Of powers of the share of the width, from the constant on.
    coefficients: [f64; 4],
}

impl Curve {
    /// At least two places, rising.
    pub(super) fn new(places: Vec<f64>, values: Vec<f64>) -> Self {
        let slopes = (0..places.len()).map(|i| limited(&places, &values, i)).collect();
        Self { places, values, slopes }
    }

    pub(super) fn places(&self) -> &[f64] {
        &self.places
    }

    pub(super) fn values(&self) -> &[f64] {
        &self.values
    }

    /// The curve at a place between the first and the last.
    pub(super) fn at(&self, place: f64) -> f64 {
        let number = self.places.partition_point(|p| *p <= place).clamp(1, self.places.len() - 1) - 1;
        let piece = self.piece(number);
        piece.at((place - piece.from) / piece.width)
    }

    /// The cubic from that point to the next.
    pub(super) fn piece(&self, number: usize) -> Piece {
        let width = self.places[number + 1] - self.places[number];
        let (a, b) = (self.values[number], self.values[number + 1]);
        let (p, q) = (width * self.slopes[number], width * self.slopes[number + 1]);
        let coefficients = [a, p, 3.0 * (b - a) - 2.0 * p - q, p + q - 2.0 * (b - a)];
        Piece { from: self.places[number], width, coefficients }
    }

    /// Places at which the curve is at a level, rising.
    pub(super) fn crossings<'a>(&'a self, level: f64) -> impl Iterator<Item = f64> + 'a {
        (0..self.places.len() - 1).flat_map(move |number| self.piece_crossings(number, level))
    }

    /// Places from that point to the next at which the curve is at a level, rising; what is there at the first point is told of the piece
    /// before, and of none of the first.
    pub(super) fn piece_crossings(&self, number: usize, level: f64) -> Vec<f64> {
        self.piece(number).crossings(level)
    }
}

impl Piece {
    pub(super) fn at(&self, share: f64) -> f64 {
        let [c0, c1, c2, c3] = self.coefficients;
        c0 + share * (c1 + share * (c2 + share * c3))
    }

    /// The least and the most that it is.
    pub(super) fn range(&self) -> (f64, f64) {
        let values = self.turns().into_iter().map(|share| self.at(share));
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)))
    }

    /// Shares of the width at which it begins, turns and ends, rising.
    pub(super) fn turns(&self) -> Vec<f64> {
        let [_, c, b, a] = self.coefficients;
        // 3 a t² + 2 b t + c = 0, without a difference of what is alike
        let root = b * b - 3.0 * a * c;
        let mut all = vec![0.0, 1.0];
        if root > 0.0 {
            let far = -(b + root.sqrt().copysign(b));
            all.extend([far / (3.0 * a), c / far].into_iter().filter(|t| *t > 0.0 && *t < 1.0));
        }
        all.sort_by(f64::total_cmp);
        all
    }

    /// Places at which it is at a level, rising; what only begins there is left to the piece before.
    fn crossings(&self, level: f64) -> Vec<f64> {
        let turns = self.turns();
        let ends = turns.windows(2);
        let found = ends.filter_map(|ends| self.crossing(level, ends[0], ends[1]));
        found.map(|share| self.from + share * self.width).collect()
    }

    /// Where between two shares, between which it does not turn, it is at a level: by halving.
    fn crossing(&self, level: f64, mut low: f64, mut high: f64) -> Option<f64> {
        let off = |share: f64| self.at(share) - level;
        let (begins, ends) = (off(low), off(high));
        let is_across = begins != 0.0 && (ends == 0.0 || (begins < 0.0) != (ends < 0.0));
        if !is_across {
            return None;
        }
        if ends == 0.0 {
            return Some(high);
        }
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if (off(middle) < 0.0) == (begins < 0.0) { low = middle } else { high = middle }
        }
        Some(0.5 * (low + high))
    }
}

/// The slope at a point, of the polynomial through it and its neighbours, no steeper than keeps rises and falls but for peaks: there the
/// parabolas of its neighbours may be followed (Huynh, *Accurate monotone cubic interpolation*, SIAM J. Numer. Anal. 30, 1993, M4).
fn limited(places: &[f64], values: &[f64], i: usize) -> f64 {
    let last = places.len() - 1;
    let first = i.saturating_sub(2).min(last.saturating_sub(4));
    let end = (first + 4).min(last);
    let slope = slope(&places[first..=end], &values[first..=end], i - first);
    let chord = |k: usize| (values[k + 1] - values[k]) / (places[k + 1] - places[k]);
    // how fast chords change at a point, and between two
    let bend = |k: usize| match k {
        k if k == 0 || k == last => 0.0,
        k => (chord(k) - chord(k - 1)) / (places[k + 1] - places[k - 1]),
    };
    let bend_after = |k: usize| smaller(bend(k), bend(k + 1));
    if i == 0 || i == last {
        let own = chord(i.min(last - 1));
        return if slope * own > 0.0 { slope.clamp(-3.0 * own.abs(), 3.0 * own.abs()) } else { 0.0 };
    }
    let steepest = smaller(chord(i - 1), chord(i));
    let parabolas = smaller(
        chord(i - 1) + bend_after(i - 1) * (places[i] - places[i - 1]),
        chord(i) - bend_after(i) * (places[i + 1] - places[i]),
    );
    let most = (3.0 * steepest.abs()).max(1.5 * parabolas.abs()).copysign(parabolas);
    smaller(slope, most)
}

/// The one nearer to 0 of two of the same sign; 0 of others.
fn smaller(a: f64, b: f64) -> f64 {
    if a * b <= 0.0 {
        0.0
    } else if a.abs() < b.abs() {
        a
    } else {
        b
    }
}

/// Derivative at one of the places of the polynomial through all: of Lagrange's form.
fn slope(places: &[f64], values: &[f64], at: usize) -> f64 {
    let x = places[at];
    let others = |skip: [usize; 2]| (0..places.len()).filter(move |k| !skip.contains(k));
    let weight = |j: usize| -> f64 {
        if j == at {
            return others([at, at]).map(|k| 1.0 / (x - places[k])).sum();
        }
        let above: f64 = others([at, j]).map(|k| x - places[k]).product();
        let below: f64 = others([j, j]).map(|k| places[j] - places[k]).product();
        above / below
    };
    // of differences, so that what is constant has none
    (0..places.len()).filter(|j| *j != at).map(|j| weight(j) * (values[j] - values[at])).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quartic_is_met_to_all_digits_where_nothing_is_limited() {
        let f = |x: f64| 0.3 * x * x * x + 2.0 * x + 1.0;
        let places: Vec<f64> = [0.0, 0.4, 1.0, 1.3, 2.1, 2.5].to_vec();
        let curve = Curve::new(places.clone(), places.iter().map(|x| f(*x)).collect());
        for k in 0..=250 {
            let x = f64::from(k) * 0.01;
            assert!((curve.at(x) - f(x)).abs() < 1e-13, "{x}: {}", curve.at(x));
        }
    }

    #[test]
    fn it_rises_where_the_points_do_and_each_crossing_is_found() {
        let places: Vec<f64> = (0..8).map(f64::from).collect();
        let values = vec![0.0, 0.0, 0.1, 5.0, 5.1, 5.1, 2.0, -3.0];
        let curve = Curve::new(places, values);
        for number in 1..4 {
            assert_eq!(curve.piece(number).turns().len(), 2, "piece {number}");
        }
        let found: Vec<f64> = curve.crossings(4.0).collect();
        assert!(found.len() == 2 && found.iter().all(|x| (curve.at(*x) - 4.0).abs() < 1e-12), "{found:?}");
        assert_eq!(curve.crossings(5.0).count(), 2, "a crossing at a point is one");
    }
}
