//! When a host did what it does every so often.

/// When something was done last, µs.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Times {
    /// Something came.
    pub(crate) heard: Option<u64>,
    pub(crate) greeted: Option<u64>,
    pub(crate) configured: Option<u64>,
    /// Whoever drives it said that he is there.
    pub(crate) said: Option<u64>,
    pub(crate) alive: Option<u64>,
    pub(crate) disarmed: Option<u64>,
    pub(crate) asked: Option<u64>,
    /// Rows are missing since then.
    pub(crate) missing: Option<u64>,
}

/// Whether something is due that is to be done every so often.
pub(crate) fn is_due(last: &mut Option<u64>, now_us: u64, every_us: u64) -> bool {
    let due = last.is_none_or(|last| now_us.saturating_sub(last) >= every_us);
    if due {
        *last = Some(now_us);
    }
    due
}
