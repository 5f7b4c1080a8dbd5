//! A job: a request to strokes on the target, to a plan, to a run of a rig, told tick by tick to whoever keeps it. Values in, values out:
//! no flag, no file, no format of a log.
//!
//! ```text
//! prepare       a picture or a drawing ─┐
//!                                       ├─► Prepared ─► run(keep) ─► Ran
//! prepare_wall  what a camera sees ─────┘
//! ```
//!
//! From a picture to figures:
//!
//! ```
#![doc = include_str!("../examples/picture_to_figures.rs")]
//! ```

mod aside;
mod attended;
mod course;
mod diary;
mod frame;
mod hands;
mod head;
mod keep;
mod lap;
mod learned;
mod looped;
mod mover;
mod points;
mod prepared;
mod recovery;
mod remainder;
mod request;
mod seen;
mod steps;
mod stretch;
mod wall;
mod watched;

pub use hands::{Ask, Hands, Look, Nobody, Sighting, Step};
pub use head::Head;
pub use keep::{Keep, KeepNothing};
pub use mover::{Jog, Mover, Place};
pub use points::PointDone;
pub use prepared::{Prepared, Ran, prepare};
pub use request::{Request, RunRequest, Scene, Wall};
pub use wall::prepare_wall;
