use clap::{Args, ValueEnum};
use tracelight_pipeline::Sequence;

/// In which order the strokes are drawn.
#[derive(Args, Clone, Debug)]
pub struct SequenceArgs {
    /// Order of the strokes: time (fastest), layer (one layer after the other), reading (row by row from the top left)
    #[arg(long, value_enum, default_value_t)]
    pub order: SequenceName,
}

/// Orders of strokes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum SequenceName {
    /// Least travel time between strokes
    #[default]
    Time,
    /// One layer after the other
    Layer,
    /// Row by row from the top left
    Reading,
}

impl SequenceName {
    /// As `--order` takes it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Time => "time",
            Self::Layer => "layer",
            Self::Reading => "reading",
        }
    }
}

impl SequenceArgs {
    /// What they mean.
    pub const fn sequence(&self) -> Sequence {
        match self.order {
            SequenceName::Time => Sequence::Free,
            SequenceName::Layer => Sequence::Layers,
            SequenceName::Reading => Sequence::Reading,
        }
    }
}
