//! Drawings with exact truth, spoilt on purpose.
//!
//! A [`Case`] names a picture: its kind of drawing, how it is degraded, its size and seed. [`Case::draw`] makes it: a
//! [`Picture`] of grey levels and the strokes that a hand would use, to the pixel's hundredth. The rules, what counts as
//! one stroke and what is never drawn because nobody could say, stand in the README beside this crate; [`rules`] checks
//! them and every figure passes.
//!
//! | module | what |
//! |---|---|
//! | [`case`] | kind × degradation × size × seed to a picture with its truth |
//! | `kinds`, `shapes` | the figures, each in its own frame |
//! | `page` | figures placed clear of each other |
//! | [`rules`] | what is drawn only if a hand could decide it |
//! | `warp` | the page seen a little from the side |
//! | `ink` | area coverage of pen lines and filled shapes |
//! | [`look`] | light, shadow, blur, noise and the other degradations |
//! | [`nine`] | the nine-stroke drawing that other tracers were measured on |
//! | [`mod@show`] | a picture with truth and strokes on it, to look at |
//! | [`verdict`], [`table`] | one picture's score; many in a table |

pub mod case;
mod figure;
mod ink;
mod kinds;
pub mod look;
pub mod nine;
mod page;
mod picture;
mod random;
pub mod rules;
mod shapes;
pub mod show;
pub mod table;
pub mod verdict;
mod warp;

pub use case::{Case, Size};
pub use figure::{Figure, Hand, Ink, Nib};
pub use kinds::Kind;
pub use look::Degradation;
pub use page::Page;
pub use picture::Picture;
pub use random::Random;
