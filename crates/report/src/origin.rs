//! How results speak of where the spot was: who tells it.

use tracelight_sim::{LightFrom, Origin};

/// The words for figures of the spot, by who tells them.
pub(crate) struct Words {
    /// Added to the name of a figure.
    pub(crate) by: &'static str,
    /// What the map of the target shows.
    pub(crate) map: &'static str,
    /// The spot that errors are of.
    pub(crate) spot: &'static str,
    /// What is counted as light.
    pub(crate) lit: &'static str,
    /// Added to errors on a terminal.
    pub(crate) warning: &'static str,
}

/// How a result speaks of figures that come from there.
pub(crate) const fn words(light_from: LightFrom) -> Words {
    const GATE: &str = "the laser's gate was open for";
    match light_from {
        LightFrom::Simulation => Words {
            by: "",
            map: "Where the light fell",
            spot: "true spot",
            lit: "light left the head for",
            warning: "",
        },
        LightFrom::Commands => Words {
            by: ", as commanded",
            map: "Where the spot was commanded to be while lit",
            spot: "where the head was told to have the spot, on a target at the distance that was given,",
            lit: GATE,
            warning: "; as commanded, nobody measured it",
        },
        LightFrom::Encoders => Words {
            by: ", by the encoders",
            map: "Where the encoders had the spot while lit",
            spot: "where the encoders say that the spot is, on a target at the distance that was given,",
            lit: GATE,
            warning: "; by the encoders, nobody saw the light",
        },
    }
}

/// In a word or two what a badge says, and in a sentence what that means.
pub(crate) const fn badge(origin: Origin) -> (&'static str, &'static str) {
    match (origin.simulated, origin.light_from) {
        (true, LightFrom::Simulation) => {
            ("simulated", "The rig was one of equations: nothing moved, no light fell")
        }
        (true, LightFrom::Commands) => (
            "simulated, as commanded",
            "A board emulated the head: nothing moved, no light fell, and where it would have fallen is what it was told",
        ),
        (false, LightFrom::Commands) => (
            "as commanded",
            "Nobody saw the light, and nobody measured the head: where it fell is what it was told",
        ),
        (true, LightFrom::Encoders) => (
            "simulated, by its encoders",
            "A board emulated the head: nothing moved, no light fell, and where it would have fallen is what its encoders say",
        ),
        (false, _) => ("by its encoders", "Nobody saw the light: where it fell is what the encoders say"),
    }
}
