/// Reads numbers off the front of some bytes; behind their end everything is zero.
pub(crate) struct Bytes<'a> {
    left: &'a [u8],
}

impl<'a> Bytes<'a> {
    pub(crate) const fn of(bytes: &'a [u8]) -> Self {
        Self { left: bytes }
    }

    /// Bytes that are left.
    pub(crate) const fn rest(&self) -> &'a [u8] {
        self.left
    }

    pub(crate) const fn is_empty(&self) -> bool {
        self.left.is_empty()
    }

    pub(crate) fn take<const N: usize>(&mut self) -> [u8; N] {
        let (taken, left) = self.left.split_at(self.left.len().min(N));
        self.left = left;
        let mut out = [0; N];
        out[..taken.len()].copy_from_slice(taken);
        out
    }

    pub(crate) fn byte(&mut self) -> u8 {
        self.take::<1>()[0]
    }

    /// One of some values.
    pub(crate) fn one_of<T: Copy>(&mut self, values: &[T]) -> T {
        values[usize::from(self.byte()) % values.len()]
    }

    /// From −512 to 512 in steps of 1/64.
    pub(crate) fn coordinate(&mut self) -> f64 {
        f64::from(i16::from_le_bytes(self.take())) / 64.0
    }

    /// Any number there is, and what is none.
    pub(crate) fn any_number(&mut self) -> f64 {
        f64::from_le_bytes(self.take())
    }
}
