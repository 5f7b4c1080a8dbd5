//! Controllers from wishes.

mod lead_lag;
mod output;
mod pid;
mod place;
mod regulator;
mod riccati;

pub use lead_lag::LeadLagWish;
pub use output::LqgWish;
pub use pid::{Pid, PidWish};
pub use regulator::{Estimator, Regulator};
