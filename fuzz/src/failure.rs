use std::fmt::Display;

/// Stands for the program's failure, which knows about exit statuses too.
pub(crate) struct Failure {
    /// What the user is told.
    pub(crate) message: String,
}

impl Failure {
    pub(crate) fn failed(_code: &'static str, message: impl Display) -> Self {
        Self { message: message.to_string() }
    }

    pub(crate) fn usage(_code: &'static str, message: impl Display) -> Self {
        Self { message: message.to_string() }
    }
}
