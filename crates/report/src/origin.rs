//! How results speak of where the spot was: who tells it.

use tracelight_sim::{LightFrom, Origin};

/// Added to the name of a figure of the spot.
pub(crate) const fn told_by(origin: Origin) -> &'static str {
    match origin.light_from {
        LightFrom::Simulation => "",
        LightFrom::Commands => ", as commanded",
        LightFrom::Encoders => ", by the encoders",
    }
}

/// In a word or two what a badge says, and in a sentence what that means; nothing of a head whose light was seen.
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
