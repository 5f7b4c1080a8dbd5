//! Loops of a plant and a controller: what each signal makes of each, with dead times exactly.
//!
//! | part | what |
//! |---|---|
//! | `around` | the loop, its open loop, and the four transfer functions it has |
//! | `function` | one of the four: values, stability, answers |
//! | `highest` | its largest gain with a dead time |
//! | `norm` | H∞ and H2 norms, and why there is none |
//! | `errors` | error constants and what remains of an error |

mod around;
mod errors;
mod function;
mod highest;
mod norm;

pub use around::{FeedbackLoop, LoopMember};
pub use errors::ErrorConstants;
pub use function::LoopFunction;
pub use norm::Norm;
