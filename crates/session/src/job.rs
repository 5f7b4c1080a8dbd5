use tracelight_rig::Segment;

use crate::state::State;

/// Ticks of the plan in which a stroke is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StrokeTicks {
    /// The first tick.
    pub start: u32,
    /// The tick after the last.
    pub end: u32,
}

/// A plan as a session needs it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Job {
    /// Segments of the plan; the first begins at tick 0, where the head rests.
    pub segments: Vec<Segment>,
    /// Its strokes, in time order.
    pub strokes: Vec<StrokeTicks>,
    /// Number of the first of them in the drawing, from 0, and how many that has.
    pub first: u32,
    /// How many strokes the drawing has.
    pub of: u32,
    /// Whether it is traced in the dark.
    pub dry: bool,
    /// Lowest speed at which its light stands nowhere for too long; 0 where any is fast enough.
    pub slowest: f32,
    /// What it does at its end instead of ending.
    pub again: Option<Again>,
}

/// What is done again and again.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Repeated {
    /// A stroke.
    #[default]
    Stroke,
    /// The mark of a point.
    Point,
    /// The frame of a drawing.
    Frame,
}

impl Repeated {
    /// The state meanwhile.
    pub(crate) const fn state(self) -> State {
        match self {
            Self::Stroke => State::Stepping,
            Self::Point => State::Pointing,
            Self::Frame => State::Framing,
        }
    }
}

/// A job's way from where it ends to there, again and again.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Again {
    /// What that is.
    pub what: Repeated,
    /// Segments of that way; the first begins at tick 0, at rest.
    pub segments: Vec<Segment>,
    /// Strokes of that way.
    pub strokes: Vec<StrokeTicks>,
    /// How long it is dark before each, ticks: the light keeps within its budget.
    pub wait_ticks: u32,
}

impl Job {
    /// Returns the length of the job, ticks.
    pub fn ticks(&self) -> u32 {
        ticks_of(&self.segments)
    }
}

/// Length of what begins at tick 0, ticks.
pub(crate) fn ticks_of(segments: &[Segment]) -> u32 {
    segments.last().map_or(0, Segment::end_tick)
}

/// Returns the number of the stroke that is drawn at a tick of the plan, or comes next.
pub(crate) fn stroke_at(strokes: &[StrokeTicks], plan_tick: u32) -> Option<u32> {
    let number = strokes.partition_point(|stroke| stroke.end <= plan_tick);
    (number < strokes.len()).then_some(number as u32)
}
