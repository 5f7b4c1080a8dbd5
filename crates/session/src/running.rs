use tracelight_rig::{Phase, Rig, Segment, Telemetry};

use crate::feed::{Feeder, Trim};
use crate::job::{Again, Job, StrokeTicks, stroke_at, ticks_of};

/// The job in hand.
#[derive(Clone, Debug)]
pub(crate) struct Running {
    feeder: Feeder<Vec<Segment>>,
    pub(crate) strokes: Vec<StrokeTicks>,
    pub(crate) ticks: u32,
    pub(crate) first: u32,
    pub(crate) of: u32,
    pub(crate) dry: bool,
    pub(crate) again: Option<Again>,
    /// Lowest speed that it may be slowed to.
    pub(crate) slowest: f32,
    /// How often it was done.
    pub(crate) laps: u32,
    /// When it was done last, until it is begun again.
    pub(crate) ended: Option<u32>,
    pub(crate) plan_tick: u32,
    stroke: Option<u32>,
    /// Whether the rig has said that it is armed since it was asked to be: what it says before is of something else.
    pub(crate) answered: bool,
}

impl Running {
    pub(crate) fn of(job: Job) -> Self {
        let (ticks, Job { segments, strokes, first, of, dry, slowest, again }) = (job.ticks(), job);
        Self {
            feeder: Feeder::new(segments, dry),
            strokes,
            ticks,
            first,
            of,
            dry,
            again,
            slowest,
            laps: 0,
            ended: None,
            plan_tick: 0,
            stroke: None,
            answered: false,
        }
    }

    /// Sends what is soon due.
    pub(crate) fn feed(&mut self, rig: &mut impl Rig, trim: &mut impl Trim) {
        self.feeder.feed_trimmed(rig, self.plan_tick, trim);
    }

    /// Takes the way on which it is done again in hand.
    pub(crate) fn begin_again(&mut self) {
        let Some(again) = &self.again else { return };
        self.feeder = Feeder::new(again.segments.clone(), self.dry);
        self.strokes.clone_from(&again.strokes);
        self.ticks = ticks_of(&again.segments);
        self.plan_tick = 0;
        self.ended = None;
        self.laps += 1;
    }

    /// Where it is after a tick; the number of a stroke that begins.
    pub(crate) fn follow(&mut self, told: &Telemetry) -> Option<u32> {
        let Telemetry { tick, plan_tick, phase, .. } = *told;
        self.answered |= !matches!(phase, Phase::Dark | Phase::Done | Phase::Faulted);
        if !self.answered {
            return None;
        }
        if phase == Phase::Done && self.again.is_some() {
            self.ended = self.ended.or(Some(tick));
        }
        self.plan_tick = plan_tick;
        let stroke = stroke_at(&self.strokes, plan_tick)?;
        let begins = self.strokes.get(stroke as usize).is_some_and(|ticks| plan_tick >= ticks.start);
        let is_new = begins && self.stroke != Some(stroke);
        if is_new {
            self.stroke = Some(stroke);
        }
        is_new.then_some(stroke + self.first)
    }
}
