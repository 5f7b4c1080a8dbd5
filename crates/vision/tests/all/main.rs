//! All integration tests of the crate in one program: linked once.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking, in its helpers too")]
#![allow(clippy::disallowed_methods, reason = "tests may ask the C library: they allow for the last digit")]

mod any_image;
mod arcs;
mod border;
mod corners;
#[path = "../../examples/draw_examples/main.rs"]
#[allow(dead_code, reason = "its `main` writes the files")]
mod draw_examples;
#[path = "../../../stroke/tests/all/support/drawn.rs"]
#[allow(dead_code, reason = "these tests use a part of it")]
mod drawn;
mod examples;
mod examples_again;
mod faint;
mod figures;
mod marks;
mod pens;
mod quality;
#[path = "support/raster.rs"]
mod raster;
mod robustness;
mod ruled;
mod shapes;
mod sheet;
mod silhouettes;
mod small;
mod sweep;
