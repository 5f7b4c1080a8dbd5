//! The plain set draws what it always drew: figures measured years apart are of the same pictures.

use tracelight_bench_strokes::Case;
use tracelight_bench_strokes::case::{Size, Wanted};

/// FNV-1a over the grey levels of cases: Fowler, Noll and Vo, as in RFC 9923.
fn hash(cases: &[Case]) -> u64 {
    let levels = cases.iter().flat_map(|case| case.draw().levels);
    levels.fold(0xCBF2_9CE4_8422_2325, |hash, level| (hash ^ u64::from(level)).wrapping_mul(0x0100_0000_01B3))
}

#[test]
fn the_plain_set_draws_the_bytes_it_drew_before_there_was_another_set() {
    let of = |seed, count, width, height| {
        let wanted = Wanted { size: Some(Size { width, height }), ..Wanted::default() };
        hash(&Case::series(seed, count, &wanted))
    };
    // taken before the kinds of the world were added: thirteen kinds, each degradation
    assert_eq!(of(1, 13 * 18, 160, 120), 2_235_797_834_258_643_098, "160x120");
    assert_eq!(of(2034, 39, 320, 240), 3_380_388_437_646_862_569, "320x240");
}

#[test]
fn the_plain_set_names_the_cases_it_named() {
    let names: Vec<_> = Case::series(1, 1000, &Wanted::default()).iter().map(ToString::to_string).collect();
    let bytes = names.iter().flat_map(|name| name.bytes());
    let hash =
        bytes.fold(0xCBF2_9CE4_8422_2325_u64, |h, b| (h ^ u64::from(b)).wrapping_mul(0x0100_0000_01B3));
    assert_eq!(hash, 17_951_601_683_193_927_603);
}
