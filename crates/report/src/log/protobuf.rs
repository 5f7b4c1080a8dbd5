//! As much of Protocol Buffers as the run log needs: messages out, and their own description.
//!
//! Readers of logs want a channel's messages as Protocol Buffers with a serialized `FileDescriptorSet` as schema
//! (<https://mcap.dev/spec/registry#protobuf-1>). The log has five flat messages; a table of their fields makes both,
//! so that they cannot disagree, and no compiler of schemas is needed. Wire format:
//! <https://protobuf.dev/programming-guides/encoding/>.

/// The type of a field; the numbers are those of `FieldDescriptorProto.Type`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Kind {
    Double,
    Bool,
    Text,
    UInt32,
    Int32,
    Int64,
    SInt32,
    /// Another message, by full name with a leading dot.
    Message(&'static str),
    /// An enumeration, by full name with a leading dot.
    Enum(&'static str),
}

/// A message and its fields, numbered from one in order.
pub(super) struct Message {
    pub(super) name: &'static str,
    pub(super) fields: &'static [(&'static str, Kind)],
    /// Enumeration declared inside, with its values numbered from zero.
    pub(super) choice: Option<(&'static str, &'static [&'static str])>,
}

/// A `.proto` file: a package of messages.
pub(super) struct ProtoFile {
    pub(super) name: &'static str,
    pub(super) package: &'static str,
    pub(super) imports: &'static [&'static str],
    pub(super) messages: &'static [Message],
}

/// Grows a message field by field. Zeros, empty texts and `false` are left out, as proto3 has it.
#[derive(Default)]
pub(super) struct Encoder {
    bytes: Vec<u8>,
}

impl Encoder {
    /// The message so far.
    pub(super) fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// Forgets everything but the memory.
    pub(super) fn clear(&mut self) {
        self.bytes.clear();
    }

    fn key(&mut self, number: u32, wire: u32) {
        self.varint(u64::from(number << 3 | wire));
    }

    fn varint(&mut self, mut value: u64) {
        while value >= 0x80 {
            self.bytes.push(value as u8 | 0x80);
            value >>= 7;
        }
        self.bytes.push(value as u8);
    }

    pub(super) fn double(&mut self, number: u32, value: f64) {
        if value.to_bits() != 0 {
            self.key(number, 1);
            self.bytes.extend_from_slice(&value.to_le_bytes());
        }
    }

    pub(super) fn unsigned(&mut self, number: u32, value: u64) {
        if value != 0 {
            self.key(number, 0);
            self.varint(value);
        }
    }

    /// A signed number in zigzag form (`sint32`).
    pub(super) fn signed(&mut self, number: u32, value: i32) {
        self.unsigned(number, u64::from((value << 1 ^ value >> 31) as u32));
    }

    pub(super) fn flag(&mut self, number: u32, value: bool) {
        self.unsigned(number, u64::from(value));
    }

    pub(super) fn text(&mut self, number: u32, value: &str) {
        if !value.is_empty() {
            self.field_bytes(number, value.as_bytes());
        }
    }

    /// A message inside this one.
    pub(super) fn message(&mut self, number: u32, fill: impl FnOnce(&mut Self)) {
        let mut inner = Self::default();
        fill(&mut inner);
        self.field_bytes(number, &inner.bytes);
    }

    fn field_bytes(&mut self, number: u32, bytes: &[u8]) {
        self.key(number, 2);
        self.varint(bytes.len() as u64);
        self.bytes.extend_from_slice(bytes);
    }
}

/// The serialized `FileDescriptorSet` of some files, imported ones first.
pub(super) fn descriptor_set(files: &[&ProtoFile]) -> Vec<u8> {
    let mut set = Encoder::default();
    for file in files {
        set.message(1, |out| describe_file(out, file));
    }
    set.bytes
}

fn describe_file(out: &mut Encoder, file: &ProtoFile) {
    out.text(1, file.name);
    out.text(2, file.package);
    file.imports.iter().for_each(|import| out.text(3, import));
    file.messages.iter().for_each(|message| out.message(4, |m| describe_message(m, message)));
    out.text(12, "proto3");
}

fn describe_message(out: &mut Encoder, message: &Message) {
    out.text(1, message.name);
    for (i, &(name, kind)) in message.fields.iter().enumerate() {
        out.message(2, |field| describe_field(field, name, i as u64 + 1, kind));
    }
    if let Some((name, values)) = message.choice {
        out.message(4, |choice| describe_enum(choice, name, values));
    }
}

fn describe_field(out: &mut Encoder, name: &str, number: u64, kind: Kind) {
    const OPTIONAL: u64 = 1;
    let (code, type_name) = match kind {
        Kind::Double => (1, ""),
        Kind::Int64 => (3, ""),
        Kind::Int32 => (5, ""),
        Kind::Bool => (8, ""),
        Kind::Text => (9, ""),
        Kind::Message(name) => (11, name),
        Kind::UInt32 => (13, ""),
        Kind::Enum(name) => (14, name),
        Kind::SInt32 => (17, ""),
    };
    out.text(1, name);
    out.unsigned(3, number);
    out.unsigned(4, OPTIONAL);
    out.unsigned(5, code);
    out.text(6, type_name);
}

fn describe_enum(out: &mut Encoder, name: &str, values: &[&str]) {
    out.text(1, name);
    for (number, value) in values.iter().enumerate() {
        out.message(2, |v| {
            v.text(1, value);
            v.unsigned(2, number as u64);
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_the_bytes_of_the_published_examples() {
        let mut out = Encoder::default();
        out.unsigned(1, 150); // the encoding guide's first message
        assert_eq!(out.bytes(), [0x08, 0x96, 0x01]);
        out.clear();
        out.text(2, "testing"); // and its second
        assert_eq!(out.bytes(), b"\x12\x07testing");
        out.clear();
        for (value, wanted) in [(-1, 1), (1, 2), (-2, 3), (i32::MAX, u64::from(u32::MAX) - 1)] {
            out.signed(1, value);
            let mut same = Encoder::default();
            same.unsigned(1, wanted);
            assert_eq!(out.bytes(), same.bytes(), "{value}");
            out.clear();
        }
    }

    #[test]
    fn what_is_zero_takes_no_bytes() {
        let mut out = Encoder::default();
        out.double(1, 0.0);
        out.flag(2, false);
        out.text(3, "");
        assert!(out.bytes().is_empty());
        out.double(1, -0.0);
        assert_eq!(out.bytes().len(), 9);
    }
}
