//! End conditions of a leg: at rest or in motion, at either end.

use crate::request::End;

/// How a leg is run: by how it starts and how it ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Run {
    pub(crate) start: End,
    pub(crate) end: End,
}

impl Run {
    pub(super) const COUNT: usize = 4;
    pub(super) const ALL: [Run; Run::COUNT] = [
        Run { start: End::Rest, end: End::Rest },
        Run { start: End::Rest, end: End::Moving },
        Run { start: End::Moving, end: End::Rest },
        Run { start: End::Moving, end: End::Moving },
    ];

    pub(super) const fn index(self) -> usize {
        2 * self.start as usize + self.end as usize
    }

    pub(super) const fn ends(self) -> [End; 2] {
        [self.start, self.end]
    }
}
