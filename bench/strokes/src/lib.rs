//! Drawings with exact truth, spoilt on purpose.
//!
//! A [`Case`] names a picture: its kind of drawing, how it is degraded, its size and seed. [`Case::draw`] makes it: a
//! [`Picture`] of grey levels and the strokes that a hand would use, to the pixel's hundredth. The rules, what counts as
//! one stroke and what is never drawn because nobody could say, stand in the README beside this crate; [`rules`] checks
//! them and every figure passes. There are two sets: plain drawings, and the kinds of the world ([`Set`]).
//!
//! | module | what |
//! |---|---|
//! | [`case`] | kind × degradation × size × seed to a picture with its truth |
//! | `kinds`, `shapes` | the figures, each in its own frame |
//! | `page`, `habit` | figures placed clear of each other, as is usual for their kind |
//! | [`rules`], [`bounds`] | what is drawn only if a hand could decide it |
//! | `warp` | the page seen a little from the side |
//! | `ink`, `touch`, `plane` | area coverage of pen lines, swelling lines and filled shapes |
//! | `medium`, `grain` | ink, graphite on grain, felt pen |
//! | `paper`, `desk` | rules, squares and dots; a sheet on a table, with a finger |
//! | `degradation`, `light`, `look` | light, shadow, blur, noise and the other ways to spoil a picture |
//! | [`nine`] | the nine-stroke drawing that other tracers were measured on |
//! | [`mod@show`] | a picture with truth and strokes on it, to look at |
//! | [`verdict`], [`table`] | one picture's score; many in a table |

#![allow(clippy::disallowed_methods, reason = "a measurement may ask the C library: it keeps no results")]

pub mod bounds;
pub mod case;
mod degradation;
mod desk;
mod figure;
mod grain;
mod habit;
mod ink;
mod kinds;
mod light;
mod look;
mod medium;
pub mod nine;
mod page;
mod paper;
mod picture;
mod plane;
mod random;
pub mod rules;
mod set;
mod shapes;
pub mod show;
pub mod table;
mod touch;
pub mod verdict;
mod warp;

pub use case::{Case, Size};
pub use degradation::Degradation;
pub use figure::{Figure, Hand, Ink, Nib};
pub use kinds::Kind;
pub use page::Page;
pub use picture::Picture;
pub use random::Random;
pub use set::Set;
pub use touch::Touch;
