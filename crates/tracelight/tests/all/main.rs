//! All integration tests of the crate in one program: linked once.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking, in its helpers too")]
#![allow(clippy::disallowed_methods, reason = "tests may ask the C library: they allow for the last digit")]

mod arrows;
#[cfg(unix)]
mod at_wall;
mod batch;
mod calibrate;
mod camera;
mod circles;
mod command_lines;
mod completing;
mod contract;
mod device;
mod drives;
mod emulated;
mod every_command;
mod examples;
mod extensions;
mod fault_page;
mod film;
mod formats;
mod friction;
mod gang;
mod homing;
mod hostile;
mod house_rules;
mod identify_parts;
mod lab;
mod lesson;
mod licences;
mod linear;
mod looks;
mod made_examples;
#[path = "../../examples/make_examples/main.rs"]
#[allow(dead_code, reason = "its `main` writes the files")]
mod make_examples;
mod net_camera;
mod own_logs;
mod paper;
mod ports;
mod preview;
mod quality;
#[cfg(unix)]
mod readme_commands;
mod readmes;
mod reproduce;
mod results;
mod resume;
mod sets;
mod several;
mod simulate;
mod sizes;
mod standing;
mod studio;
mod support;
mod where_on_wall;
mod whole_rig;
mod wire_page;
mod wrong_lines;
