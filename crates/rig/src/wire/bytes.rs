//! Numbers to and from bytes, little endian.

/// Most bytes of a packet's body.
pub const MOST_BODY: usize = 248;

/// The body of a packet as it is written. What does not fit is left out, and then the whole is not sent.
#[derive(Clone, Copy, Debug)]
pub struct Body {
    bytes: [u8; MOST_BODY],
    length: usize,
    is_whole: bool,
}

impl Body {
    /// With nothing in it.
    pub const fn new() -> Self {
        Self { bytes: [0; MOST_BODY], length: 0, is_whole: true }
    }

    /// What was written; nothing if it did not fit.
    pub fn bytes(&self) -> &[u8] {
        let written = self.bytes.get(..self.length).unwrap_or_default();
        if self.is_whole { written } else { &[] }
    }

    pub(super) fn bytes_of<const N: usize>(&mut self, bytes: [u8; N]) {
        self.slice(&bytes);
    }

    pub(super) fn slice(&mut self, bytes: &[u8]) {
        let room = self.bytes.get_mut(self.length..).unwrap_or_default();
        if bytes.len() > room.len() {
            self.is_whole = false;
            return;
        }
        room.iter_mut().zip(bytes).for_each(|(place, byte)| *place = *byte);
        self.length += bytes.len();
    }

    pub(super) fn u8(&mut self, value: u8) {
        self.bytes_of([value]);
    }

    pub(super) fn u16(&mut self, value: u16) {
        self.bytes_of(value.to_le_bytes());
    }

    pub(super) fn u32(&mut self, value: u32) {
        self.bytes_of(value.to_le_bytes());
    }

    pub(super) fn u64(&mut self, value: u64) {
        self.bytes_of(value.to_le_bytes());
    }

    pub(super) fn i32(&mut self, value: i32) {
        self.bytes_of(value.to_le_bytes());
    }

    pub(super) fn f32(&mut self, value: f32) {
        self.u32(value.to_bits());
    }
}

impl Default for Body {
    fn default() -> Self {
        Self::new()
    }
}

/// What is left of bytes that are read; `None` at their end.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rest<'a>(pub(super) &'a [u8]);

impl<'a> Rest<'a> {
    pub(super) const fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// All that is left.
    pub(super) fn all(&mut self) -> &'a [u8] {
        core::mem::take(&mut self.0)
    }

    pub(super) fn bytes<const N: usize>(&mut self) -> Option<[u8; N]> {
        let (bytes, rest) = self.0.split_first_chunk()?;
        self.0 = rest;
        Some(*bytes)
    }

    pub(super) fn u8(&mut self) -> Option<u8> {
        self.bytes().map(|[byte]| byte)
    }

    /// A flag that is one of two bytes.
    pub(super) fn flag(&mut self) -> Option<bool> {
        match self.u8()? {
            0 => Some(false),
            1 => Some(true),
            _ => None,
        }
    }

    pub(super) fn u16(&mut self) -> Option<u16> {
        self.bytes().map(u16::from_le_bytes)
    }

    pub(super) fn u32(&mut self) -> Option<u32> {
        self.bytes().map(u32::from_le_bytes)
    }

    pub(super) fn u64(&mut self) -> Option<u64> {
        self.bytes().map(u64::from_le_bytes)
    }

    pub(super) fn i32(&mut self) -> Option<i32> {
        self.bytes().map(i32::from_le_bytes)
    }

    pub(super) fn f32(&mut self) -> Option<f32> {
        self.u32().map(f32::from_bits)
    }
}
