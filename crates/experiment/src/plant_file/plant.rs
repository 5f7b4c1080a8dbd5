//! What comes of a system file, and how large it may be.

use tracelight_linear::{FrequencyData, StateSpace, TransferFunction};

/// Largest file, bytes: a Bode plot of 10⁶ points as JSON.
pub const MOST_BYTES: usize = 64 << 20;
/// Most states, and the highest order of a transfer function.
pub const MOST_STATES: usize = 200;
/// Most inputs, and most outputs.
pub const MOST_PORTS: usize = 32;

/// What a system file holds.
#[derive(Clone, Debug, PartialEq)]
pub enum PlantFile {
    /// Matrices A, B, C, D.
    StateSpace(StateSpace),
    /// Numerator and denominator, or zeros, poles and gain.
    Transfer(TransferFunction),
    /// Values at frequencies.
    Frequencies(FrequencyData),
}

/// A system with what its file says of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Plant {
    /// The system.
    pub system: PlantFile,
    /// Names of its inputs, where the file has them; as many as it has inputs, or none.
    pub inputs: Vec<String>,
    /// Names of its outputs, likewise.
    pub outputs: Vec<String>,
    /// How the file was understood, where that is worth saying: which columns were taken in which units.
    pub understood: Option<String>,
}

impl Plant {
    pub(super) const fn of(system: PlantFile) -> Self {
        Self { system, inputs: Vec::new(), outputs: Vec::new(), understood: None }
    }
}
