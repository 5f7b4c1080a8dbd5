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

use crate::{LinearError, Time};

fn in_continuous_time(time: Time, what: &str) -> Result<(), LinearError> {
    match time {
        Time::Continuous => Ok(()),
        Time::Sampled(_) => Err(LinearError::Wish(format!(
            "{what} is designed in continuous time: design it there and sample the controller"
        ))),
    }
}
