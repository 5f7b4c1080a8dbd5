//! What a board is at, besides moves.

use crate::trouble::Trouble;

/// How far a board is with what is asked of it besides moves.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Stage {
    /// The board takes what it needs before moves: before the first one, and after it was halted.
    SettingUp,
    /// The board moves, or may.
    Ready,
    /// The board comes to a hold, since then.
    Stopping(u64),
    /// The board was reset, then.
    Resetting(u64),
    /// Something is wrong, and it was told to be dark.
    Failed(Trouble),
}
