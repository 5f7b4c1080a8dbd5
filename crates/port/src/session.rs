//! Numbers of connections, and a host's clock.

use std::time::{Instant, SystemTime, UNIX_EPOCH};

/// A number that no connection had before, as far as that can be, and not 0, which is nobody's.
pub(crate) fn new_session() -> u32 {
    let since = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    (since.as_secs() as u32).wrapping_mul(1_000_003).wrapping_add(since.subsec_micros()) | 1
}

/// A host's clock that began then, µs.
pub(crate) fn micros(since: Instant) -> u64 {
    u64::try_from(since.elapsed().as_micros()).unwrap_or(u64::MAX)
}
