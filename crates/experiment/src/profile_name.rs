//! Profiles by name: how a move goes from rest to rest.

use tracelight_chart::Colour;
use tracelight_trajectory::{DarkMove, Ramps, Shape};

/// How a move goes from rest to rest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ProfileName {
    /// Constant acceleration and deceleration.
    Trapezoid,
    /// Jerk-limited: acceleration ramps up and down over a fifth of each phase.
    SCurve,
    /// Half a sine of velocity.
    Sine,
    /// A whole sine of acceleration.
    Cycloid,
    /// Logistic position.
    Sigmoid,
    /// Polynomial of fifth degree.
    Quintic,
    /// As fast as the motors allow; dark moves with limited jerk.
    Optimal,
}

impl ProfileName {
    /// In the order of tables.
    pub const ALL: [Self; 7] = [
        Self::Trapezoid,
        Self::SCurve,
        Self::Sine,
        Self::Cycloid,
        Self::Sigmoid,
        Self::Quintic,
        Self::Optimal,
    ];

    /// What it is called.
    #[must_use]
    pub const fn name(self) -> &'static str {
        self.words().0
    }

    /// What it is, in a few words without a full stop.
    #[must_use]
    pub const fn about(self) -> &'static str {
        self.words().1
    }

    const fn words(self) -> (&'static str, &'static str) {
        match self {
            Self::Trapezoid => ("trapezoid", "Constant acceleration and deceleration"),
            Self::SCurve => {
                ("s-curve", "Jerk-limited: acceleration ramps up and down over a fifth of each phase")
            }
            Self::Sine => ("sine", "Half a sine of velocity"),
            Self::Cycloid => ("cycloid", "A whole sine of acceleration"),
            Self::Sigmoid => ("sigmoid", "Logistic position"),
            Self::Quintic => ("quintic", "Polynomial of fifth degree"),
            Self::Optimal => ("optimal", "As fast as the motors allow; dark moves with limited jerk"),
        }
    }

    /// The one that is called so.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|profile| profile.name() == name)
    }

    /// The shape of velocity that it names, an S-curve with these ramps; none for the optimum, which has none.
    #[must_use]
    pub const fn shape(self, ramps: Ramps) -> Option<Shape> {
        Some(match self {
            Self::Trapezoid => Shape::Ramped(Ramps::NONE),
            Self::SCurve => Shape::Ramped(ramps),
            Self::Sine => Shape::Sine,
            Self::Cycloid => Shape::Cycloid,
            Self::Sigmoid => Shape::Sigmoid,
            Self::Quintic => Shape::Quintic,
            Self::Optimal => return None,
        })
    }

    /// Dark moves that go so, an S-curve with the report's ramps.
    #[must_use]
    pub const fn dark_move(self) -> DarkMove {
        match self.shape(Ramps::REPORT) {
            Some(shape) => DarkMove::Shaped(shape),
            None => DarkMove::Optimal,
        }
    }

    /// Its colour in every plot.
    pub(crate) const fn colour(self) -> Colour {
        match self {
            Self::Trapezoid => Colour::Ochre,
            Self::SCurve => Colour::Violet,
            Self::Sine => Colour::Green,
            Self::Cycloid => Colour::Olive,
            Self::Sigmoid => Colour::Slate,
            Self::Quintic => Colour::Sky,
            Self::Optimal => Colour::Black,
        }
    }
}
