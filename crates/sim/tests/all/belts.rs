//! Belts that jump teeth: before an encoder that sits on its joint it is dark within 12 ms; behind one that sits on its motor nothing is
//! seen at all.

#![allow(clippy::print_stdout, reason = "a test that shows figures")]

use tracelight_rig::Joint;
use tracelight_sim::{LooseBelt, RigConfig, Trouble};

use crate::troubled::{Tally, three_plans};

const MOMENTS: usize = 4;
/// A tooth is 4 degrees, 64 mm in the middle of the wall.
const TEETH: u32 = 90;
/// What belts hold that jump in a drawing, as shares of what the motors give: pan's carry what they speed up, tilt's a weight as well.
const TOO_LITTLE: [(Joint, [f64; 3]); 2] =
    [(Joint::Pan, [0.001, 0.003, 0.01]), (Joint::Tilt, [0.05, 0.15, 0.19])];

/// The head of the report with encoders on one side of belts that give so much, Hz; zero for belts that do not.
fn head(encoders_at_motors: bool, resonance_hz: f64) -> RigConfig {
    let mut config = RigConfig::report();
    let wear = &mut config.truth.wear;
    (wear.encoders_at_motors, wear.belt_resonance_hz, wear.belt_damping) =
        (encoders_at_motors, resonance_hz, 0.3);
    config
}

fn skip(joint: Joint, holds_share: f64) -> Trouble {
    Trouble::BeltSkip(joint, LooseBelt { holds_share, teeth: TEETH })
}

/// Teeth that ride over those of the wheel let go of the joint, and its encoder with it.
#[test]
fn a_belt_that_skips_before_its_encoder_is_dark_within_12_ms() {
    for hz in [0.0, 100.0] {
        let config = head(false, hz);
        let plans = three_plans(&config);
        for (joint, shares) in TOO_LITTLE {
            for share in shares {
                let tally = Tally::of(&config, &plans, MOMENTS, skip(joint, share));
                println!("encoders at joints, belts of {hz} Hz, {joint:?}'s holds {share}: {tally}");
                assert!(tally.unseen == 0 && tally.furthest_mm <= 8.0, "{joint:?} {share}: {tally}");
                assert!(tally.longest_ticks <= 12, "{joint:?} {share}: {tally}");
            }
        }
    }
}

/// This is not what is wished for, but what is true: an encoder on the motor's side counts as before, and light goes where it should not, to the
/// end. Only a camera tells (`eye::follow`), or an encoder on the joint.
#[test]
fn a_belt_that_skips_behind_its_encoder_is_not_seen() {
    for hz in [0.0, 100.0] {
        let config = head(true, hz);
        let plans = three_plans(&config);
        for (joint, shares) in TOO_LITTLE {
            for share in shares {
                let tally = Tally::of(&config, &plans, MOMENTS, skip(joint, share));
                println!("encoders at motors, belts of {hz} Hz, {joint:?}'s holds {share}: {tally}");
                assert!(tally.finished == tally.runs && tally.unseen > 0, "{joint:?} {share}: {tally}");
                assert!(tally.furthest_mm > 60.0, "not by a tooth: {joint:?} {share}: {tally}");
            }
        }
    }
}

/// A belt that holds what its drawing asks of it skips nowhere.
#[test]
fn a_belt_that_is_loose_but_holds_draws_as_ever() {
    for at_motors in [false, true] {
        let config = head(at_motors, 0.0);
        let plans = three_plans(&config);
        for (joint, share) in [(Joint::Pan, 0.06), (Joint::Tilt, 0.25)] {
            let tally = Tally::of(&config, &plans, MOMENTS, skip(joint, share));
            assert!(tally.finished == tally.runs && tally.furthest_mm < 1.0, "{joint:?} {share}: {tally}");
        }
    }
}
