//! What is around an emulated board: the simulated head behind its pins, and a host at its line.
//!
//! A module for Node: numbers go in and out of functions, edges and bytes lie in memory where functions say.

mod circle;
mod head;
mod host;

use tracelight_sim::RigConfig;

/// The head of the 2006 report on two H-bridges.
fn rig() -> RigConfig {
    RigConfig::preset("bridge").expect("there is such a preset")
}
