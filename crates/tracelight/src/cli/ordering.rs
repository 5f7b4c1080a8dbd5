use clap::{Args, ValueEnum};
use tracelight_pipeline::Sequence;

/// In which order the strokes are drawn.
#[derive(Args, Clone, Debug)]
pub(crate) struct SequenceArgs {
    /// Order that somebody at the wall can follow: time takes the shortest; layer draws one layer of the drawing after the other;
    /// reading goes row by row from the top left
    #[arg(long, value_enum, default_value_t)]
    pub(crate) order: SequenceName,
}

/// What may come after what.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum SequenceName {
    /// The least time between strokes
    #[default]
    Time,
    /// Layer by layer
    Layer,
    /// As a page is read
    Reading,
}

impl SequenceName {
    /// As `--order` takes it.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Time => "time",
            Self::Layer => "layer",
            Self::Reading => "reading",
        }
    }
}

impl SequenceArgs {
    /// What they mean.
    pub(crate) const fn sequence(&self) -> Sequence {
        match self.order {
            SequenceName::Time => Sequence::Free,
            SequenceName::Layer => Sequence::Layers,
            SequenceName::Reading => Sequence::Reading,
        }
    }
}
