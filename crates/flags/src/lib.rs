//! Flags of the commands that take a picture and draw it: how it is read and traced, where it goes on a wall, in which order it is drawn, by which law, and who stands there.
//!
//! Each group is a struct of `clap`'s that a command takes in whole ([`PlacementArgs`], [`TracingArgs`], …), with one function that says what was asked for in the words of the
//! crates below.

mod by_hand;
mod choosing;
mod fonts;
mod laws;
mod lettering;
mod ordering;
mod placing;
mod reading;
mod shapes;
mod tracing;
mod wall;

pub use by_hand::{ByHandArgs, FrameName, each, factor, served};
pub use choosing::ChoiceArgs;
pub use laws::{LawArgs, law, observer};
pub use lettering::LetteringArgs;
pub use ordering::{SequenceArgs, SequenceName};
pub use placing::{PlacementArgs, positive_length};
pub use reading::ReadingArgs;
pub use shapes::{profile, ramps};
pub use tracing::{ModeName, OrAuto, PaperName, Pixels, TracingArgs};
pub use wall::{CornerName, FitName, FromArgs, Marks, WallArgs};
