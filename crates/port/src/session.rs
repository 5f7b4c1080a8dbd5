//! Numbers of connections.

use std::time::{SystemTime, UNIX_EPOCH};

/// A number that no connection had before, as far as that can be, and not 0, which is nobody's.
pub(crate) fn new_session() -> u32 {
    let since = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    (since.as_secs() as u32).wrapping_mul(1_000_003).wrapping_add(since.subsec_micros()) | 1
}
