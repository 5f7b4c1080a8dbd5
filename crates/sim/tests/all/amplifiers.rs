//! Amplifiers that weaken: what is left follows, or is dark in time.

#![allow(clippy::print_stdout, reason = "a test that shows figures")]

use tracelight_rig::Joint;
use tracelight_sim::{RigConfig, Trouble, Weakening};

use crate::troubled::{Tally, three_plans};

const MOMENTS: usize = 4;
/// Shares of its gain an amplifier loses a second: within a drawing, within a stroke, at once.
const RATES: [f64; 3] = [0.1, 0.5, 1e3];

fn weakening(joint: Joint, left: f64, per_s: f64) -> Tally {
    let config = RigConfig::report();
    let trouble = Trouble::AmplifierWeakens(joint, Weakening { left, per_s });
    let tally = Tally::of(&config, &three_plans(&config), MOMENTS, trouble);
    println!("{joint:?}'s amplifier loses {per_s} a second down to {left}: {tally}");
    tally
}

#[test]
fn an_amplifier_that_weakens_lets_light_fall_no_further_than_six_millimetres() {
    for joint in Joint::BOTH {
        for per_s in RATES {
            for left in [0.8, 0.7, 0.5, 0.3, 0.0] {
                let tally = weakening(joint, left, per_s);
                assert!(
                    tally.furthest_mm <= 6.0 && tally.longest_ticks <= 25,
                    "{joint:?} {per_s} {left}: {tally}"
                );
            }
        }
    }
}

/// A tenth is what amplifiers differ by.
#[test]
fn an_amplifier_that_lost_a_tenth_draws_as_ever() {
    for joint in Joint::BOTH {
        for per_s in RATES {
            let tally = weakening(joint, 0.9, per_s);
            assert!(tally.finished == tally.runs && tally.unseen == 0, "{joint:?} {per_s}: {tally}");
        }
    }
}

/// No drawing ends as if nothing were that lost its torque at once.
#[test]
fn an_amplifier_that_fails_ends_the_drawing() {
    for joint in Joint::BOTH {
        let tally = weakening(joint, 0.0, 1e3);
        assert_eq!(tally.finished, 0, "{joint:?}: {tally}");
    }
}
