//! The seeds, and every input that was ever a finding, without a fuzzer.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking, in its helpers too")]

use std::fs;
use std::path::Path;

use tracelight_stroke::{Drawing, Stroke};

/// Replays a target's inputs; returns how many there are.
fn replay(target: &str, check: fn(&[u8])) -> usize {
    let inputs = |kind: &str| {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(kind).join(target);
        fs::read_dir(folder).into_iter().flatten().map(|entry| entry.unwrap().path())
    };
    let mut paths: Vec<_> = inputs("seeds").chain(inputs("found")).collect();
    paths.sort();
    for path in &paths {
        println!("{}", path.display());
        check(&fs::read(path).unwrap());
    }
    paths.len()
}

#[test]
fn pictures_are_decoded_or_refused() {
    assert!(replay("picture", tracelight_fuzz::picture::check) >= 15);
}

#[test]
fn drawings_are_read_written_and_read_back() {
    assert!(replay("formats", tracelight_fuzz::formats::check) >= 7);
}

#[test]
fn images_are_traced_within_themselves() {
    assert!(replay("trace", tracelight_fuzz::trace::check) >= 22);
}

#[test]
fn points_are_fitted_nearby() {
    assert!(replay("fit", tracelight_fuzz::fit::check) >= 6);
}

#[test]
fn strokes_are_ordered_and_none_is_lost() {
    assert!(replay("order", tracelight_fuzz::order::check) >= 4);
}

#[test]
fn hosts_and_boards_go_on_whatever_they_hear() {
    assert!(replay("wire", tracelight_fuzz::wire::check) >= 3);
}

/// The same with what a fuzzer would begin with: bits of the seeds turned, pieces left out and put together anew.
#[test]
fn hosts_and_boards_go_on_whatever_becomes_of_the_seeds() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("seeds/wire");
    let seeds: Vec<Vec<u8>> =
        fs::read_dir(folder).unwrap().map(|entry| fs::read(entry.unwrap().path()).unwrap()).collect();
    let mut state = 1_u64;
    let mut roll = |below: usize| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 8) as usize % below
    };
    for _ in 0..300 {
        let (first, second) = (&seeds[roll(seeds.len())], &seeds[roll(seeds.len())]);
        let mut bytes = [&first[..roll(first.len() + 1)], &second[roll(second.len())..]].concat();
        for _ in 0..roll(20).min(bytes.len()) {
            let at = roll(bytes.len());
            bytes[at] ^= 1 << roll(8);
        }
        tracelight_fuzz::wire::check(&bytes);
    }
}

#[test]
#[should_panic(expected = "loses a line")]
fn a_drawing_that_came_back_changed_would_be_seen() {
    // one stroke of our own SVG in another place than its twin in the drawing
    let line =
        |x: f64| tracelight_stroke::Path::polyline(&[(x, 0.0).into(), (x, 0.4).into()], false).unwrap();
    let drawing = |x: f64| Drawing { strokes: vec![Stroke::new(line(x))] };
    let svg = tracelight_formats::svg::write(&drawing(0.3), 1.0, 1.0);
    let back = tracelight_formats::svg::read(svg.as_bytes()).map(|r| r.sheet);
    tracelight_fuzz::formats::check_near("SVG", back, &drawing(0.2), 1e-3);
}
