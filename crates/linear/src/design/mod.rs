//! Controllers from wishes.

mod lead_lag;
mod output;
mod pid;
mod pid_forms;
mod pid_search;
mod place;
mod regulator;
mod riccati;
mod setpoint;
mod states;

pub use lead_lag::LeadLagWish;
pub use output::LqgWish;
pub use pid::{Pid, PidWish, Terms};
pub use pid_forms::{IdealForm, SeriesForm};
pub use regulator::{Estimator, Regulator};
pub use setpoint::SetpointWeights;

use crate::{LinearError, Time};

fn in_continuous_time(time: Time, what: &str) -> Result<(), LinearError> {
    match time {
        Time::Continuous => Ok(()),
        Time::Sampled(_) => Err(LinearError::Wish(format!(
            "{what} is designed in continuous time: design it there and sample the controller"
        ))),
    }
}
