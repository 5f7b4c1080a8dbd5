use clap::ValueEnum;
use tracelight_trajectory::{DarkMove, Ramps, Shape};

/// How a move goes from rest to rest.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum ProfileName {
    /// Constant acceleration and deceleration
    Trapezoid,
    /// Acceleration that builds up and fades over a fifth of its phase
    SCurve,
    /// Half a sine of velocity
    Sine,
    /// A whole sine of acceleration
    Cycloid,
    /// Logistic position
    Sigmoid,
    /// Polynomial of fifth degree
    Quintic,
    /// As fast as the motors can; dark moves limited in jerk
    Optimal,
}

impl ProfileName {
    /// In the order of tables.
    pub(crate) const ALL: [ProfileName; 7] = [
        ProfileName::Trapezoid,
        ProfileName::SCurve,
        ProfileName::Sine,
        ProfileName::Cycloid,
        ProfileName::Sigmoid,
        ProfileName::Quintic,
        ProfileName::Optimal,
    ];

    /// The shape of velocity that it names, an S-curve with these ramps; none for the optimum, which has none.
    pub(crate) const fn shape(self, ramps: Ramps) -> Option<Shape> {
        Some(match self {
            ProfileName::Trapezoid => Shape::Ramped(Ramps::NONE),
            ProfileName::SCurve => Shape::Ramped(ramps),
            ProfileName::Sine => Shape::Sine,
            ProfileName::Cycloid => Shape::Cycloid,
            ProfileName::Sigmoid => Shape::Sigmoid,
            ProfileName::Quintic => Shape::Quintic,
            ProfileName::Optimal => return None,
        })
    }

    pub(crate) const fn dark_move(self) -> DarkMove {
        match self.shape(Ramps::REPORT) {
            Some(shape) => DarkMove::Shaped(shape),
            None => DarkMove::Optimal,
        }
    }

    pub(crate) const fn name(self) -> &'static str {
        match self {
            ProfileName::Trapezoid => "trapezoid",
            ProfileName::SCurve => "s-curve",
            ProfileName::Sine => "sine",
            ProfileName::Cycloid => "cycloid",
            ProfileName::Sigmoid => "sigmoid",
            ProfileName::Quintic => "quintic",
            ProfileName::Optimal => "optimal",
        }
    }
}

/// `pa1,pa2,pb1,pb2`: shares of the acceleration phase over which the acceleration builds up and fades, and the same of
/// the deceleration phase.
pub(crate) fn ramps(text: &str) -> Result<Ramps, String> {
    let wrong = |why: &str| {
        format!(
            "{text} {why}; give four shares with commas between, such as 0.2,0.2,0.15,0.15: how long the acceleration \
             builds up and fades, then the deceleration, each of its own phase and the two not more than 1 together"
        )
    };
    let shares: Result<Vec<f64>, _> = text.split(',').map(|share| share.trim().parse::<f64>()).collect();
    let Ok(&[pa1, pa2, pb1, pb2]) = shares.as_deref() else {
        return Err(wrong("is not four numbers"));
    };
    let in_one = |a: f64, b: f64| a >= 0.0 && b >= 0.0 && a + b <= 1.0;
    if in_one(pa1, pa2) && in_one(pb1, pb2) {
        Ok(Ramps { pa1, pa2, pb1, pb2 })
    } else {
        Err(wrong("leaves a phase less than nothing, or more than all"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn four_shares_are_ramps_and_nothing_else_is() {
        assert_eq!(ramps("0.2, 0.2,0.15,0.15"), Ok(Ramps::REPORT));
        assert_eq!(ramps("0,0,0,0"), Ok(Ramps::NONE));
        for text in
            ["", "0.2", "0.2,0.2,0.15", "0.6,0.5,0,0", "-0.1,0,0,0", "NaN,0,0,0", "0,0,0,0,0", "a,0,0,0"]
        {
            assert!(ramps(text).unwrap_err().contains("0.2,0.2,0.15,0.15"), "{text}");
        }
    }
}
