//! A file's bytes as the text of its kind.

use tracelight_task::Failure;

/// A kind of file.
pub(crate) struct Kind {
    /// As people call it.
    pub(crate) name: &'static str,
    /// Of what is wrong with one.
    pub(crate) code: &'static str,
    /// Largest one.
    pub(crate) most_bytes: usize,
}

impl Kind {
    /// Says what is wrong with a file.
    pub(crate) fn wrong(&self, file: &str, what: &str) -> Failure {
        Failure::usage(self.code, format!("{file}: {what}"))
    }
}

/// A file's text, if it is no larger than one of its kind.
pub(crate) fn text_of(kind: &Kind, file: &str, bytes: Vec<u8>) -> Result<String, Failure> {
    let Kind { name, most_bytes, .. } = kind;
    if bytes.len() > *most_bytes {
        let length = bytes.len();
        return Err(
            kind.wrong(file, &format!("{length} bytes are no {name} file, which has at most {most_bytes}"))
        );
    }
    String::from_utf8(bytes).map_err(|_| kind.wrong(file, &format!("not text; give a {name} file (.toml)")))
}
