//! Traces a picture: pixels in, strokes out.
//!
//! [`trace`] takes a [`Grey`](tracelight_image::Grey) image and gives the strokes that draw it, in the pixel frame: x right, y down, the
//! image spans [0, width] × [0, height], the first pixel's centre is (0.5, 0.5). The way: find the sheet of paper
//! ([`Page`](tracelight_sheet::Page)), even out the light and the polarity, cut ink from paper (`ink`), part it into regions, then follow the middle of pen lines (thinning, a
//! graph, junctions resolved, points moved on to the grey levels' ridge) and the edges of filled shapes. Nothing
//! here knows metres, angles, files or cameras; the host decodes. Pixels and masks are `tracelight_image`'s, the sheet and its light
//! `tracelight_sheet`'s.
//!
//! | module | what |
//! |---|---|
//! | `polarity`, `split`, `ink` | dark lines or light ones, threshold, ink cut from paper |
//! | `comb` | the rules of ruled and squared paper, taken out from under the ink |
//! | `quality`, `sharpness` | figures of a picture, their bounds, the gate that refuses bad ones; how sharp it is |
//! | `tone`, `screen`, `seen` | whether it is a drawing at all: no photograph, and no computer's screen; a second look if it seems none |
//! | `reading`, `parts`, `hub`, `dust` | what is a line by its own width; lines and shapes parted; where many lines meet; specks |
//! | `thin`, `graph`, `prune` | one-pixel skeleton; its branches and nodes; without spurs |
//! | `ridge`, `line`, `bow`, `bridge`, `junction`, `centreline` | sub-pixel middle of pen lines; crossings run through |
//! | `coarse`, `closer` | how closely a picture is looked at; a second, closer look at small figures |
//! | `outline` | edges of filled shapes, holes too |
//! | `contrast` | whether a stroke is ink, or the edge of paper or of a shadow |
//! | `dots` | the dots of dotted paper |
//! | `near` | which of many points are near a place |
//! | `follow` | points to paths |
//! | `faint` | where a line goes on too pale for the mask |
//! | `rest` | a second look at the ink that no line follows |
//! | `twice` | a line that was sketched twice is one |
//! | `missed`, `on_ink` | ink that no stroke follows; strokes that follow no ink |
//! | `crumbs` | what a pencil leaves on the paper's grain beside its lines, and smudges |
//! | `sweep` | the original report's tracer |
//! | `marks` | the two marks on a ruler |

#![cfg_attr(
    test,
    allow(clippy::disallowed_methods, reason = "tests may ask the C library: they allow for the last digit")
)]

mod areas;
mod bow;
mod bridge;
mod centreline;
mod closer;
mod coarse;
mod comb;
mod contrast;
mod crumbs;
mod dots;
mod dust;
mod error;
mod faint;
mod felt;
mod follow;
mod gap;
mod graph;
mod hub;
mod ink;
mod inside;
mod junction;
mod line;
mod marks;
mod missed;
mod near;
mod on_ink;
mod options;
mod outline;
mod paler;
mod parts;
mod polarity;
mod prune;
mod quality;
mod reading;
mod rest;
mod ridge;
mod row;
mod screen;
mod seen;
mod sharpness;
mod split;
mod stages;
mod streak;
mod sweep;
mod thin;
mod tone;
mod trace;
mod twice;

pub use comb::{Comb, Rules};
pub use dots::Dots;
pub use error::VisionError;
pub use marks::{Marks, find_two_marks};
pub use options::{Mode, Options};
pub use quality::{Figure, Quality, Verdict};
pub use stages::Stages;
pub use trace::{LeftOut, Traced, trace, trace_page};
