//! Slips of every share at any moment.

#![allow(clippy::print_stdout, reason = "a test that shows figures")]

use std::time::Instant;

use tracelight_rig::Joint;
use tracelight_sim::{RigConfig, Trouble};
use tracelight_trajectory::Plan;

use crate::shapes::lit_ticks;
use crate::troubled::{Tally, run_with, three_plans};

/// Shares of what its joint turns that an encoder shows.
const SHARES: u32 = 41;
const FROM_SHARE: f64 = -1.0;
const TO_SHARE: f64 = 1.5;

/// Every share, both joints, all plans, once each at a moment that is drawn from a seed.
fn round(
    config: &RigConfig,
    plans: &[Plan],
    seed: u64,
    trouble: fn(Joint, f64) -> Trouble,
    tally: &mut Tally,
) {
    let mut dice = oorandom::Rand64::new(u128::from(seed));
    for step in 0..SHARES {
        let share = FROM_SHARE + (TO_SHARE - FROM_SHARE) * f64::from(step) / f64::from(SHARES - 1);
        for joint in Joint::BOTH {
            for plan in plans {
                let lit = lit_ticks(plan);
                let when = lit[dice.rand_range(0..lit.len() as u64) as usize] as u32;
                tally.add(&run_with(config, plan, seed, when, trouble(joint, share)));
            }
        }
    }
}

/// The share of all runs that ended as if nothing were, and had light over 3 mm beside its point.
fn unseen_share(tally: &Tally) -> f64 {
    tally.unseen as f64 / tally.runs as f64
}

#[test]
#[ignore = "minutes: `bash .ci/run long`; its short twins in `slips` always run"]
fn slips_of_every_share_are_seen_as_often_as_is_claimed() {
    let number = |name: &str| std::env::var(name).ok().and_then(|text| text.parse::<u64>().ok());
    let (from, seconds) = (number("FROM").unwrap_or(1_000_000), number("FOR_S").unwrap_or(3600));
    let config = RigConfig::report();
    let plans = three_plans(&config);
    let (mut discs, mut counters) = (Tally::default(), Tally::default());
    let begun = Instant::now();
    let mut slowest_s = 0;
    for seed in from..from + 1000 {
        let before = begun.elapsed().as_secs();
        if seed > from && before + slowest_s >= seconds {
            break;
        }
        round(&config, &plans, seed, Trouble::EncoderSlip, &mut discs);
        round(&config, &plans, seed, Trouble::EdgesMissed, &mut counters);
        slowest_s = slowest_s.max(begun.elapsed().as_secs() - before);
    }
    println!("discs that slip: {discs}\ncounters that miss edges: {counters}");
    assert!(unseen_share(&counters) <= 0.005, "counters that miss edges: {counters}");
    assert!(unseen_share(&discs) <= 0.2, "discs that slip: {discs}");
}
