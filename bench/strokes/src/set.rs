use clap::ValueEnum;

/// Which kinds of drawings a series is of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Set {
    /// One even pen on clean paper. What is drawn of a seed stays as it is: its figures are compared over the years.
    #[default]
    Plain,
    /// What people draw and photograph: brushes, pencils, felt pens, small writing, ruled paper, sheets on tables.
    World,
}
