//! Bounds the recent light of an unhomed head, whose beam direction is unknown.

/// Number of parts that the window of recent light is divided into.
const PARTS: usize = 100;
/// Length of one part, ticks.
const PART_TICKS: u8 = 100;

/// Lit ticks of the last ten seconds, to a tenth of a second: never fewer than there were.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RecentLight {
    /// Lit ticks of each part; the one that goes on now, and as many before it as it takes.
    lit: [u8; PARTS + 1],
    part: usize,
    /// Ticks of that one that have passed.
    passed: u8,
    sum: u32,
}

impl RecentLight {
    pub(crate) const NONE: Self = Self { lit: [0; PARTS + 1], part: 0, passed: 0, sum: 0 };
    /// As much as there may be, that many ticks ago.
    pub(crate) const fn full_before(ticks: u32) -> Self {
        let parts = ticks as usize / PART_TICKS as usize;
        if parts > PARTS + 1 {
            return Self::NONE;
        }
        // in the part after the last one the oldest light leaves
        let part = Self::FULL.part + parts;
        Self { part: if part < PARTS { part } else { PARTS }, ..Self::FULL }
    }

    /// As much as there may be, just now.
    const FULL: Self = {
        let mut lit = [0; PARTS + 1];
        let mut part = 0;
        while part < PARTS / 10 {
            lit[part] = PART_TICKS;
            part += 1;
        }
        Self { lit, part: part - 1, passed: PART_TICKS, sum: Self::MOST_TICKS }
    };
    /// Most of them: a tenth.
    pub(crate) const MOST_TICKS: u32 = PARTS as u32 * PART_TICKS as u32 / 10;

    /// One tick passes.
    pub(crate) fn tick(&mut self, is_lit: bool) {
        if self.passed == PART_TICKS {
            self.part = (self.part + 1) % self.lit.len();
            self.sum -= u32::from(self.lit[self.part % (PARTS + 1)]);
            self.lit[self.part % (PARTS + 1)] = 0;
            self.passed = 0;
        }
        self.passed += 1;
        self.lit[self.part % (PARTS + 1)] += u8::from(is_lit);
        self.sum += u32::from(is_lit);
    }

    /// Whether there was none: then no tick needs to pass.
    pub(crate) const fn is_dark(&self) -> bool {
        self.sum == 0
    }

    /// Ticks of light that are left.
    pub(crate) const fn left_ticks(&self) -> u32 {
        Self::MOST_TICKS.saturating_sub(self.sum)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn light_that_may_have_been_before_a_dark_time_leaves_no_sooner_than_it_would_tick_by_tick() {
        let mut passed = RecentLight::FULL;
        let mut dark = 0;
        for ticks in (0..11_000).step_by(37) {
            while dark < ticks {
                passed.tick(false);
                dark += 1;
            }
            let mut at_once = RecentLight::full_before(ticks);
            let mut still = passed;
            for after in (0..10_400).step_by(100) {
                assert!(at_once.left_ticks() <= still.left_ticks(), "{ticks} + {after}");
                (0..100).for_each(|_| at_once.tick(false));
                (0..100).for_each(|_| still.tick(false));
            }
            assert!(at_once.is_dark() && still.is_dark(), "{ticks}");
        }
        assert_eq!(RecentLight::full_before(0).left_ticks(), 0);
        assert!(RecentLight::full_before(10_300).is_dark() && RecentLight::full_before(u32::MAX).is_dark());
    }
}
