//! The host's side of a head whose two motors hang on a Grbl board.

mod asking;
mod axis;
mod board;
mod codes;
mod driver;
mod follower;
mod moves;
mod pace;
mod said;
mod sender;
mod stage;
mod teller;
mod text;
mod trouble;
mod window;

pub use asking::Asking;
pub use axis::BoardAxis;
pub use board::{AxisLimits, Board};
pub use codes::{alarm_text, error_text};
pub use driver::Driver;
pub use trouble::{Setting, Trouble};
