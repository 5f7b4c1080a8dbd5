//! Systems of several inputs and outputs: singular values, norms, zeros, what is not controllable or not observable, disk margins.

mod compressed;
mod disk;
mod gain;
mod hidden;
mod minimal;
mod norms;
mod responses;
mod scaling;
mod singular;
mod zeros;

pub use disk::{DiskMargin, DiskMargins};
pub use gain::ComplexMatrix;
pub use hidden::Hidden;
pub use minimal::Minimal;
pub use singular::singular_values;
