use tracelight_maths as maths;

use crate::{Complex, LinearError, Matrix, StateSpace, Zpk};

/// A factor of order one or two with real coefficients: zeros over poles.
struct Section {
    /// Monic, highest power first; as many as the order and one.
    poles: Vec<f64>,
    /// As many, leading zeros included.
    zeros: Vec<f64>,
}

impl Zpk {
    /// In state space, as a chain of sections of order one and two: of systems whose poles are far apart, or many, it keeps digits that
    /// [`TransferFunction::state_space`](crate::TransferFunction::state_space) loses. Not possible with more zeros than poles.
    pub fn state_space(&self) -> Result<StateSpace, LinearError> {
        self.cascade("state space")
    }

    /// State space as a chain of sections of order one and two, whose states stay apart as the poles do: a companion matrix mixes
    /// fast and slow ones, and loses the slow ones' digits. `what` is asked for it.
    pub(crate) fn cascade(&self, what: &'static str) -> Result<StateSpace, LinearError> {
        if self.zeros().len() > self.poles().len() {
            return Err(LinearError::Improper { zeros: self.zeros().len(), poles: self.poles().len(), what });
        }
        let through = Matrix::from_element(1, 1, 1.0);
        let (none, row, column) = (Matrix::zeros(0, 0), Matrix::zeros(1, 0), Matrix::zeros(0, 1));
        let start = StateSpace::new(none, column, row, through * self.gain(), self.time())?;
        sections(self.zeros(), self.poles())
            .iter()
            .try_fold(start, |chain, section| chain.series(&section.state_space(self)?))
    }
}

impl Section {
    fn state_space(&self, of: &Zpk) -> Result<StateSpace, LinearError> {
        let order = self.poles.len() - 1;
        let through = self.zeros[0];
        let mut a = Matrix::zeros(order, order);
        // observable form: what the section does to what comes in, not how it is read out, holds the small numbers
        let mut b = Matrix::zeros(order, 1);
        for i in 0..order {
            a[(i, 0)] = -self.poles[i + 1];
            if i + 1 < order {
                a[(i, i + 1)] = 1.0;
            }
            b[(i, 0)] = self.zeros[i + 1] - through * self.poles[i + 1];
        }
        let mut c = Matrix::zeros(1, order);
        c[(0, 0)] = 1.0;
        StateSpace::new(a, b, c, Matrix::from_element(1, 1, through), of.time())
    }
}

/// Poles and zeros in factors: each pole or pair takes the nearest zeros there are for it, the least damped first.
fn sections(zeros: &[Complex], poles: &[Complex]) -> Vec<Section> {
    let upper = |roots: &[Complex]| roots.iter().filter(|root| root.im >= 0.0).copied().collect::<Vec<_>>();
    let (mut zeros, mut singles) = (upper(zeros), Vec::new());
    let mut groups: Vec<Vec<Complex>> = Vec::new();
    for pole in upper(poles) {
        if pole.im > 0.0 {
            groups.push(vec![pole, pole.conj()]);
        } else {
            singles.push(pole);
        }
    }
    // complex zeros need two poles: real ones are paired for those that no pair takes
    let wanting = zeros.iter().filter(|zero| zero.im > 0.0).count().saturating_sub(groups.len());
    let paired = (2 * wanting).min(singles.len() / 2 * 2);
    groups.extend(singles[..paired].chunks(2).map(<[Complex]>::to_vec));
    groups.extend(singles[paired..].iter().map(|&pole| vec![pole]));
    // a pair of zeros goes to two poles, the largest groups first
    let mut taken: Vec<Vec<Complex>> = vec![Vec::new(); groups.len()];
    zeros.sort_by(|a, b| b.im.total_cmp(&a.im));
    for zero in zeros {
        let size = if zero.im > 0.0 { 2 } else { 1 };
        let room = |i: &usize| groups[*i].len() >= taken[*i].len() + size;
        let apart = |i: usize| maths::complex::norm(groups[i][0] - zero);
        if let Some(i) = (0..groups.len()).filter(room).min_by(|&a, &b| apart(a).total_cmp(&apart(b))) {
            taken[i].push(zero);
            if size == 2 {
                taken[i].push(zero.conj());
            }
        }
    }
    groups.iter().zip(&taken).map(|(poles, zeros)| Section::of(zeros, poles)).collect()
}

impl Section {
    fn of(zeros: &[Complex], poles: &[Complex]) -> Self {
        let below = multiplied(poles);
        let above = multiplied(zeros);
        let missing = below.len() - above.len();
        Self { zeros: [vec![0.0; missing], above].concat(), poles: below }
    }
}

/// Π(s − r) of none, one, two real roots or a pair.
fn multiplied(roots: &[Complex]) -> Vec<f64> {
    match roots {
        [a, b] => vec![1.0, -(a + b).re, (a * b).re],
        [a] => vec![1.0, -a.re],
        _ => vec![1.0],
    }
}

#[cfg(test)]
mod tests {
    use tracelight_maths::complex;

    use crate::{Complex, Time, TransferFunction};

    #[test]
    fn a_chain_of_sections_is_the_same_system() {
        for text in [
            "7",
            "5/(s+1)",
            "2 (s^2+1)/((s+1)(s+2)(s+300))",
            "(s^2+2s+9)(s+4)/((s+1)(s+2)(s^2+s+50))",
            "(s^2+2s+9)(s^2+4)/((s+1)(s+2)(s+3)(s+4))",
            "(s+1)(s+2)(s+3)/((s^2+s+1)(s^2+4))",
            "1e4 (s+3)/(s^2 (s+1e-3)(s+1e4))",
        ] {
            let g = TransferFunction::parse(text, Time::Continuous).unwrap();
            let chain = g.zpk().cascade("a test").unwrap();
            assert_eq!(chain.order(), g.denominator().degree());
            for w in [0.01, 0.7, 20.0, 1e3] {
                let s = Complex::new(0.0, w);
                let inverse = chain.a().map(|x| Complex::new(-x, 0.0))
                    + nalgebra::DMatrix::identity(chain.order(), chain.order()) * s;
                let inverse = inverse.try_inverse().unwrap();
                let complex = |m: &crate::Matrix| m.map(|x| Complex::new(x, 0.0));
                let value = (complex(chain.c()) * inverse * complex(chain.b()) + complex(chain.d()))[(0, 0)];
                assert!(
                    complex::norm(value - g.at(s)) < 1e-10 * complex::norm(g.at(s)),
                    "{text} at {w}: {value} {}",
                    g.at(s)
                );
            }
        }
    }
}
