//! Why a picture is missing.

/// Why a picture is missing.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("cannot encode {name}: {reason}")]
pub struct EncodeError {
    /// The file it was for.
    pub name: String,
    /// What the encoder says.
    pub reason: String,
}
