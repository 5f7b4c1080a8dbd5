//! Experiments of the control engineer's bench: a request in, a finding out, and how that is shown.
//!
//! Each experiment is a file that is named after its command: its request, which is an [`Experiment`]; what it finds; and in
//! `view.rs` beside it how that is shown, as text, as JSON, as a plot, as tables ([`Finding`], [`Plotted`], [`Filed`]), and as a better rig ([`Improved`]). Who has it
//! done (a command line, a page, a script) makes the request of what was typed, and puts what is shown where it belongs.
//! Nothing here opens a file, prints, or knows a flag but by its name in a message.

pub mod amplifier;
pub mod backlash;
pub mod better;
pub mod bode;
pub mod by_hand;
mod closing;
pub mod columns;
pub mod design;
pub mod encoder;
mod finding;
pub mod frequencies;
pub mod frequency;
pub mod friction;
pub mod gang;
pub mod gravity;
pub mod head;
pub mod identify;
pub mod inertia;
mod left_out;
pub mod lesson;
pub mod linearize;
pub mod locus;
mod margins;
pub mod montecarlo;
pub mod moves;
mod named;
mod numbers;
pub mod nyquist;
mod panels;
mod parts;
pub mod plane;
pub mod plant_file;
pub mod plants;
pub mod profile;
pub mod profile_name;
pub mod pzmap;
pub mod record;
pub mod relay;
pub mod response;
pub mod shape;
pub mod sigma;
pub mod simulate;
mod steady;
pub mod step;
mod step_words;
mod system_json;
pub mod systems;
pub mod table;
mod trial;
pub mod trials;
pub mod tune;
pub mod velocity;

pub use finding::{Experiment, Filed, Finding, Improved, Plotted, svg};
