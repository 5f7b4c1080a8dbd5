//! When it was dark where light was planned, and why.

use tracelight_rig::{Darkness, Fault, FaultRecord, TICK_F64_S, Telemetry};
use tracelight_sim::Run;

/// A time when the rig darkened a beam that the plan wanted lit, or a fault that ended the job.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Event {
    /// Stable code of the first reason.
    pub code: &'static str,
    /// What it means.
    pub words: &'static str,
    /// When it began, s since power-up.
    pub t_s: f64,
    /// How long it lasted, s.
    pub lasted_s: f64,
    /// Whether the job ended with it.
    pub stops: bool,
    /// Of a fault: what showed it.
    pub latched: Option<FaultRecord>,
    /// Of a fault after which what the head stands on was turned: how far, rad about the head's x, y and z (ahead, left, up), by its gyroscope.
    pub foot_turned_rad: Option<[f32; 3]>,
}

impl Event {
    /// What it means, with its figures.
    #[must_use]
    pub fn told(&self) -> String {
        let evidence =
            self.latched.as_ref().map(FaultRecord::evidence).filter(|evidence| !evidence.is_empty());
        let words = evidence
            .map_or_else(|| self.words.to_owned(), |shown| format!("{} Shown by {shown}.", self.words));
        let Some([ahead, left, up]) = self.foot_turned_rad else { return words };
        let way = |rad: f32, positive: &str, negative: &str| {
            let degrees = f64::from(rad).to_degrees();
            format!("{:.2}° {}", degrees.abs(), if degrees < 0.0 { negative } else { positive })
        };
        let turned = [
            way(up, "to the left", "to the right"),
            way(left, "down", "up"),
            way(ahead, "clockwise", "anticlockwise"),
        ];
        format!("{words} Its gyroscope says that it has turned by {}.", turned.join(", "))
    }
}

/// Finds events in a stream of ticks, one open at a time.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Watch {
    open: Option<Event>,
    /// There was light already.
    lit: bool,
    /// The head waits for its first light until its encoders were seen to follow its motors, and it is back on its stroke.
    waits: bool,
}

/// What changed with a tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Change {
    /// Nothing.
    None,
    /// An event began; its length is not known yet.
    Began(Event),
    /// An event ended.
    Ended(Event),
    /// One ended by turning into another, which began.
    Became(Event, Event),
}

impl Watch {
    /// Takes the next tick.
    pub(crate) fn push(&mut self, telemetry: &Telemetry) -> Change {
        self.lit |= telemetry.actuation.lights();
        let dark = telemetry.darkness;
        self.waits |= dark.contains(Darkness::Untested) && !dark.contains(Darkness::Planned);
        self.waits &= !self.lit;
        let now = trouble(telemetry, self.waits);
        match (self.open.as_mut(), now) {
            (None, None) => Change::None,
            (None, Some(event)) => {
                self.open = Some(event);
                Change::Began(event)
            }
            (Some(open), Some(event)) if open.stops || !event.stops => {
                open.lasted_s += TICK_F64_S;
                Change::None
            }
            (Some(_), event) => {
                let ended = std::mem::replace(&mut self.open, event);
                match (ended, event) {
                    (Some(ended), Some(event)) => Change::Became(ended, event),
                    (Some(ended), None) => Change::Ended(ended),
                    (None, _) => Change::None,
                }
            }
        }
    }

    /// The event still going on, as it stands.
    pub(crate) const fn open(&self) -> Option<Event> {
        self.open
    }
}

/// The event a tick belongs to: a latched fault, or the interlock against the plan's will. That a head waits before its first light until its
/// encoders were seen to follow its motors is none.
fn trouble(telemetry: &Telemetry, waits: bool) -> Option<Event> {
    let t_s = f64::from(telemetry.tick) * TICK_F64_S;
    if let Some(fault) = telemetry.fault() {
        let (code, words) = (fault.code(), fault.words());
        let foot_turned_rad = telemetry.foot_turned_rad.filter(|_| fault == Fault::Bumped);
        let (lasted_s, latched) = (TICK_F64_S, telemetry.latched);
        return Some(Event { code, words, t_s, lasted_s, stops: true, latched, foot_turned_rad });
    }
    let dark = telemetry.darkness;
    if waits || dark.contains(Darkness::Planned) || dark.contains(Darkness::Disarmed) {
        return None;
    }
    // a head that is jolted is held, as one is whose host is silent, and that is why
    let why = [Darkness::Jolted, Darkness::HostSilent].into_iter().find(|&reason| dark.contains(reason));
    let reason = why.or_else(|| Darkness::ALL.into_iter().find(|&reason| dark.contains(reason)))?;
    let (code, words) = (reason.code(), reason.words());
    let lasted_s = TICK_F64_S;
    Some(Event { code, words, t_s, lasted_s, stops: false, latched: None, foot_turned_rad: None })
}

/// All events of a run in time order; an event's length runs to the tick before the light was allowed again.
#[must_use]
pub fn events(run: &Run) -> Vec<Event> {
    let mut watch = Watch::default();
    let mut found = Vec::new();
    for tick in &run.ticks {
        if let Change::Ended(event) | Change::Became(event, _) = watch.push(&tick.telemetry) {
            found.push(event);
        }
    }
    found.extend(watch.open());
    // a fault after which the head was found again did not stop the run
    let stopped = run.fault().is_some();
    let last = found.len().saturating_sub(1);
    found.iter_mut().enumerate().for_each(|(i, event)| event.stops &= stopped && i == last);
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::latched;
    use tracelight_rig::DarknessSet;
    use tracelight_sim::Tick;

    fn run_of(reasons: &[&[Darkness]], fault_from: usize) -> Run {
        let tick = |(i, set): (usize, &&[Darkness])| {
            let mut darkness = DarknessSet::default();
            set.iter().for_each(|&reason| darkness.insert_if(true, reason));
            let fault = (i >= fault_from).then_some(Fault::EncoderDead);
            let telemetry = Telemetry {
                tick: i as u32,
                darkness,
                latched: fault.and_then(latched),
                ..Telemetry::default()
            };
            Tick {
                telemetry,
                angle_rad: Default::default(),
                rate_rad_s: Default::default(),
                spot: None,
                asked: None,
                light: false,
            }
        };
        Run { ticks: reasons.iter().enumerate().map(tick).collect() }
    }

    #[test]
    fn a_planned_darkness_is_no_event() {
        let run = run_of(&[&[], &[Darkness::Planned], &[Darkness::Planned, Darkness::Holding], &[]], 9);
        assert_eq!(events(&run), []);
    }

    #[test]
    fn a_head_that_waits_for_its_first_light_has_no_event_and_one_that_does_so_later_has() {
        const UNTESTED: &[Darkness] = &[Darkness::Holding, Darkness::Untested];
        let begun: &[&[Darkness]] =
            &[&[Darkness::Planned], UNTESTED, &[Darkness::SpotError], &[Darkness::Holding]];
        let dark = |reasons: &[&[Darkness]]| {
            let mut run = run_of(reasons, usize::MAX);
            for Telemetry { actuation, darkness, .. } in run.ticks.iter_mut().map(|t| &mut t.telemetry) {
                (actuation.gate, actuation.enable) = (darkness.is_empty(), true);
            }
            events(&run).len()
        };
        assert_eq!(dark(&[begun, &[&[]]].concat()), 0);
        assert_eq!(dark(&[begun, &[&[], UNTESTED, &[]]].concat()), 1);
        // without an encoder to wait for it is an event at any time
        assert_eq!(dark(&[&[Darkness::SpotError], &[]]), 1);
    }

    #[test]
    fn an_event_carries_its_first_reason_and_its_length() {
        let run =
            run_of(&[&[], &[Darkness::SpotError], &[Darkness::Holding], &[Darkness::Holding], &[], &[]], 9);
        let found = events(&run);
        assert_eq!(found.len(), 1);
        assert_eq!((found[0].code, found[0].stops), ("spot-error", false));
        assert!((found[0].t_s - 0.001).abs() < 1e-12 && (found[0].lasted_s - 0.003).abs() < 1e-12);
    }

    #[test]
    fn a_latched_fault_is_told_once_and_lasts_to_the_end() {
        let run = run_of(&[&[], &[Darkness::SpotError], &[Darkness::Faulted], &[Darkness::Faulted]], 2);
        let codes: Vec<_> = events(&run).iter().map(|e| (e.code, e.stops)).collect();
        assert_eq!(codes, [("spot-error", false), ("encoder-dead", true)]);
    }
}
