//! Scores the eyes on simulated cameras, whose truth is known.
#![allow(clippy::print_stdout, reason = "a bench prints what it finds")]
#![allow(clippy::disallowed_methods, reason = "a measurement may ask the C library: it keeps no results")]

mod markers;
mod none;
mod scene;
mod spot;

use tracelight_aim::Board;

const HOW: &str = "tracelight-bench-eyes fine|coarse [SEEDS [FOLDER]]   markers and the wall after a survey of four pages; leaves the images\n\
                   tracelight-bench-eyes time                           how long markers take to be found\n\
                   tracelight-bench-eyes spot [SEEDS]                     the laser's spot at rest\n\
                   tracelight-bench-eyes none [FRAMES]                  how often a marker is found where there is none";

fn main() {
    let mut args = std::env::args().skip(1);
    let what = args.next().unwrap_or_default();
    let count = args.next().and_then(|n| n.parse().ok());
    let folder = args.next();
    match what.as_str() {
        "fine" => markers::score(&Board::FINE, count.unwrap_or(50), folder.as_deref()),
        "coarse" => markers::score(&Board::COARSE, count.unwrap_or(50), folder.as_deref()),
        "time" => markers::time(),
        "spot" => spot::score(count.unwrap_or(20)),
        "none" => none::count(count.unwrap_or(10_000)),
        _ => println!("{HOW}"),
    }
}
