//! What is hashed is what is simulated.

#[test]
fn the_numbers_are_those_of_the_preset() {
    let preset = tracelight_sim::RigConfig::report().control_config();
    assert_eq!(tracelight_bench_bits::report(), preset);
}

#[test]
fn the_hash_depends_on_every_tick() {
    let run = tracelight_bench_bits::run;
    assert_eq!(run(1000), run(1000));
    assert_ne!(run(1000).hash, run(1001).hash);
}

/// Light, darkness, pushes and the way back: what is hashed is not a head that stands still.
#[test]
fn what_is_hashed_draws() {
    let outcome = tracelight_bench_bits::run(tracelight_bench_bits::TICKS);
    assert!((20_000..60_000).contains(&outcome.lit_ticks), "{outcome:?}");
    assert!((200..30_000).contains(&outcome.held_ticks), "{outcome:?}");
}
