use std::cell::Cell;

/// Costs of travels that were asked for not long ago: one for each slot, the last one.
pub(super) struct Memo {
    slots: Vec<Cell<(u64, f64)>>,
}

/// No pair of ends: nothing travels from an end to itself.
const NONE: u64 = u64::MAX;

impl Memo {
    /// With so many slots, a power of two.
    pub(super) fn new(slots: usize) -> Self {
        Self { slots: vec![Cell::new((NONE, 0.0)); slots.next_power_of_two()] }
    }

    /// What is remembered of a pair, or what `cost` says.
    pub(super) fn get(&self, (from, to): (u32, u32), cost: impl FnOnce() -> f64) -> f64 {
        let pair = u64::from(from) << 32 | u64::from(to);
        // Fibonacci hashing: the highest bits of the product depend on all of the pair's
        let hash = pair.wrapping_mul(0x9E37_79B9_7F4A_7C15).checked_shr(64 - self.slots.len().ilog2());
        let slot = &self.slots[hash.unwrap_or(0) as usize];
        let (known, remembered) = slot.get();
        if known == pair {
            return remembered;
        }
        let cost = cost();
        slot.set((pair, cost));
        cost
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_remembered_is_what_was_said() {
        let memo = Memo::new(64);
        let asked = Cell::new(0);
        let cost = |a: u32, b: u32| {
            memo.get((a, b), || {
                asked.set(asked.get() + 1);
                f64::from(a) + 1e-3 * f64::from(b)
            })
        };
        for round in 0..3 {
            for a in 0..5 {
                for b in 0..200 {
                    assert_eq!(cost(a, b), f64::from(a) + 1e-3 * f64::from(b), "round {round}");
                }
            }
        }
        asked.set(0);
        assert_eq!([cost(7, 9), cost(7, 9)], [7.009; 2]);
        assert_eq!(asked.get(), 1);
    }
}
