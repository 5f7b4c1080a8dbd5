//! Bytes to records, whichever way a file writes its groups.

use super::ascii::Lines;
use super::binary::{self, Typed};
use super::groups::{Group, Record};
use crate::FormatError;

/// The records of a file, one after another.
pub(super) struct Records<'a> {
    groups: Groups<'a>,
    /// The group of code 0 that ended the record before.
    next: Option<Group<'a>>,
    /// How the file ended before its EOF, if it did.
    cut: Option<Cut>,
}

/// How a file without EOF ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Cut {
    /// After a whole record.
    Between,
    /// Within a record, which was left out.
    Within,
}

/// The ways of writing groups.
enum Groups<'a> {
    Ascii(Lines<'a>),
    Binary(Typed<'a>),
}

/// Groups of one record at most: a polyline of a million vertices.
const MAX_GROUPS: usize = 4_000_000;

impl<'a> Records<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        let groups = match bytes.strip_prefix(binary::SENTINEL) {
            Some(rest) => Groups::Binary(Typed::new(rest)),
            None => Groups::Ascii(Lines::new(bytes)),
        };
        Self { groups, next: None, cut: None }
    }

    /// Reads the next record into `record`, whose memory is used again. `false` after `EOF`, and where the file is cut
    /// off: see [`cut`](Self::cut).
    ///
    /// # Errors
    /// A code that is no number, a record beyond all measure.
    pub(super) fn read(&mut self, record: &mut Record<'a>) -> Result<bool, FormatError> {
        record.groups.clear();
        let first = loop {
            match self.next.take() {
                Some(group) if group.code == 0 => break group,
                // comments may stand before the first record
                _ => match self.group()? {
                    Some(group) => self.next = Some(group),
                    None => return Ok(self.ends(Cut::Between)),
                },
            }
        };
        (record.kind, record.at) = (first.bytes(), first.at);
        if record.kind == b"EOF" {
            return Ok(false);
        }
        while let Some(group) = self.group()? {
            if group.code == 0 {
                self.next = Some(group);
                return Ok(true);
            }
            record.groups.push(group);
            if record.groups.len() > MAX_GROUPS {
                let found = record.groups.len();
                return Err(FormatError::TooLarge {
                    what: "DXF's entity",
                    found,
                    unit: "groups",
                    limit: MAX_GROUPS,
                });
            }
        }
        // nobody can tell whether more of it should come: only what ends a list needs no more
        let is_whole = matches!(record.kind, b"ENDSEC" | b"ENDBLK" | b"ENDTAB" | b"SEQEND");
        self.ends(if is_whole { Cut::Between } else { Cut::Within });
        Ok(is_whole)
    }

    /// How the file ended before its EOF, if it did.
    pub(super) const fn cut(&self) -> Option<Cut> {
        self.cut
    }

    /// What is wrong with a file that is cut off before anything was read.
    pub(super) fn cut_off(&self) -> FormatError {
        const MESSAGE: &str = "the file is cut off, it does not end with EOF; save it again";
        self.broken(MESSAGE)
    }

    fn ends(&mut self, cut: Cut) -> bool {
        self.cut.get_or_insert(cut);
        false
    }

    fn group(&mut self) -> Result<Option<Group<'a>>, FormatError> {
        match &mut self.groups {
            Groups::Ascii(lines) => lines.group(),
            Groups::Binary(typed) => typed.group(),
        }
    }

    fn broken(&self, message: &str) -> FormatError {
        match &self.groups {
            Groups::Ascii(lines) => lines.broken(message.into()),
            Groups::Binary(typed) => typed.broken(message.into()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn records_end_where_the_next_one_begins() {
        let check = |bytes: &[u8]| {
            let mut records = Records::new(bytes);
            let mut record = Record::default();
            assert!(records.read(&mut record).unwrap());
            assert_eq!((record.kind, record.groups.len(), record.key(8)), (&b"LINE"[..], 2, "a".into()));
            assert_eq!(record.number_or(10, 0.0).unwrap(), 1.5);
            assert!(!records.read(&mut record).unwrap());
            assert_eq!(records.cut(), None);
        };
        check(b"999\ncomment\n  0\nLINE\n  8\nA\n 10\n1.5\n  0\nEOF\n");
        check(b"0\r\nLINE\r\n8\r\nA\r\n10\r\n1.5\r\n0\r\nEOF");
        check(b"0\rLINE\r8\rA\r10\r1.5\r0\rEOF\r");
    }

    #[test]
    fn what_is_no_number_is_named_with_its_line() {
        let check = |bytes: &[u8], message: &str| {
            let mut record = Record::default();
            let found = Records::new(bytes).read(&mut record).and_then(|_| record.number_or(10, 0.0));
            let found = found.unwrap_err().to_string();
            assert!(found.contains(message), "{found}");
        };
        check(b"0\nLINE\n10\nleft\n0\nEOF\n", "line 4: an x coordinate is \"left\", expected a number");
        check(b"0\nLINE\n10\nNaN\n0\nEOF\n", "line 4");
        check(b"0\nLINE\n10\ninf\n0\nEOF\n", "line 4");
        check(b"0\nLINE\n10\n1e300\n0\nEOF\n", "line 4");
        check(b"0\nLINE\nten\n1\n", "line 3, column 1: not valid DXF: \"ten\" is no group code");
    }

    #[test]
    fn a_file_that_is_cut_off_says_whether_a_record_is() {
        let check = |bytes: &[u8], whole: usize, cut: Cut| {
            let (mut records, mut record) = (Records::new(bytes), Record::default());
            let found = (0..).take_while(|_| records.read(&mut record).unwrap()).count();
            assert_eq!((found, records.cut()), (whole, Some(cut)), "{}", String::from_utf8_lossy(bytes));
        };
        check(b"", 0, Cut::Between);
        check(b"0\nLINE\n10\n", 0, Cut::Within);
        check(b"0\nLINE\n10\n1\n", 0, Cut::Within);
        check(b"0\nLINE\n10\n1\n0\nENDSEC\n", 2, Cut::Between);
        check(b"0\nLINE\n10\n1\n0\nENDSEC", 2, Cut::Between);
        check(b"0\nLINE\n10\n1\n0\nENDS", 1, Cut::Within);
        check(b"0\nLINE\n10\n1\n0\n", 0, Cut::Within);
    }
}
