//! What every experiment has in common: it is run, and what it finds is shown.

use tracelight_chart::Figure;
use tracelight_sim::RigConfig;
use tracelight_task::{Failure, Task};

/// A question, with all that it is asked of.
pub trait Experiment {
    /// What it comes to.
    type Finding: Finding;

    /// Tries it out.
    ///
    /// # Errors
    /// A request that contradicts itself, an experiment that comes to nothing, or [`Failure::interrupted`].
    fn run(self, task: Task<'_>) -> Result<Self::Finding, Failure>;
}

/// What an experiment came to, for people and for scripts.
pub trait Finding {
    /// For people: lines without one at the end.
    fn text(&self) -> String;

    /// For scripts: one JSON object.
    fn json(&self) -> String;
}

/// A finding that has one plot and one table.
pub trait Plotted: Finding {
    /// The plot.
    ///
    /// # Errors
    /// What is to be plotted cannot be computed.
    fn figure(&self) -> Result<Figure, Failure>;

    /// The table: CSV with names above its columns.
    ///
    /// # Errors
    /// What is in the table cannot be computed.
    fn csv(&self) -> Result<String, Failure>;
}

/// A finding that fills a folder.
pub trait Filed: Finding {
    /// Names of its files and what is in them.
    ///
    /// # Errors
    /// What is in a file cannot be computed or drawn.
    fn files(&self) -> Result<Vec<(&'static str, String)>, Failure>;
}

/// A finding by which a rig is known, or tuned, better.
pub trait Improved: Finding {
    /// The rig as it was believed to be.
    fn rig(&self) -> &RigConfig;

    /// The rig with what was found.
    fn better(&self) -> &RigConfig;
}

/// A figure as SVG.
///
/// # Errors
/// A figure that cannot be drawn, which is a mistake of the program.
pub fn svg(figure: &Figure) -> Result<String, Failure> {
    figure.svg().map_err(|e| Failure::failed("internal", e))
}
