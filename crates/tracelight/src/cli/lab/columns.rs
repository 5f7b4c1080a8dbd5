//! The flag that says what the columns of somebody's own log hold.

use clap::Args;
use tracelight_experiment::columns::Columns;

/// What the columns of a log hold that has other ones.
#[derive(Args, Debug)]
pub(super) struct ColumnArgs {
    /// What the columns of a log hold, where their names are not as above: time=Timestamp(ms):ms,speed=rpm:rpm,volt=PWM*12/255; each a
    /// column's name or number, then *k, /k, +k or -k, and :unit; what is left out is told from the header, and said
    #[arg(long, value_name = "WHAT=COLUMN,…")]
    columns: Option<Columns>,
}

impl ColumnArgs {
    pub(super) fn columns(&self) -> Columns {
        self.columns.clone().unwrap_or_default()
    }
}
