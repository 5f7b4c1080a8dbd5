//! A job that a camera follows is paused, stopped, slowed and let go on anywhere: all of its ink is there, hardly any twice, and the camera suspects nothing.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test that cannot go on may panic, and shows figures"
)]

mod ink;

use tracelight_aim::HeadPose;
use tracelight_eye::room::SimulatedEye;
use tracelight_job::{
    Ask, Hands, Head, Keep, Look, Prepared, Ran, Request as Asks, RunRequest, Scene, Wall, prepare,
    prepare_wall,
};
use tracelight_picture::{Source, decode};
use tracelight_pipeline::{Asked, Driving, Placing, Tracing, request_of};
use tracelight_session::{Event, Refused, Request, Snapshot, State, When};
use tracelight_sim::{RigConfig, Tick};
use tracelight_stroke::Point;
use tracelight_task::{Failure, NoProgress, Stop, Task};
use tracelight_trajectory::Plan;

use crate::ink::{Lines, longest_mm};

/// Light this near to a line is on it, m, where a camera found the head, to less than two tenths of a millimetre, and where it is known. At a sharp corner
/// places of one leg are that near to the other: what an undisturbed run lights twice is not doubled by a hold.
const ON_IT_M: [f64; 2] = [3e-4, 1.5e-4];
/// How long it rests, ticks.
const REST_TICKS: u32 = 400;
/// Ticks of the plan about a pause in which a place may be lit twice; further on lines cross.
const ABOUT_TICKS: u32 = 300;

/// What a hold may leave out, light twice, and be further off than an undisturbed run, mm.
const MOST_MM: (f64, f64, f64) = (0.2, 0.5, 0.1);
/// How much further off a run may be that is hurried to twice its speed, mm.
const HURRIED_MM: f64 = 0.3;

/// How somebody holds a job.
#[derive(Clone, Copy, Debug, PartialEq)]
enum How {
    Pause(When),
    Stop,
    Slow,
}

/// Somebody who holds a job once.
struct Somebody {
    how: How,
    at: u32,
    rests: u32,
    refused: Vec<String>,
    /// A dot is let out to check where the head points.
    checks: bool,
    checked: u32,
}

impl Somebody {
    const fn who(how: How, at: u32) -> Self {
        Self { how, at, rests: 0, refused: Vec::new(), checks: false, checked: 0 }
    }
}

impl Hands for Somebody {
    fn tick(&mut self, now: &Snapshot) -> Option<Ask> {
        let ask = |request| Some(Ask::Request(request));
        if self.checks {
            return None;
        }
        if now.tick == self.at {
            return ask(match self.how {
                How::Pause(when) => Request::Pause(when),
                How::Stop => Request::Stop,
                How::Slow => Request::Speed(0.25),
            });
        }
        if self.how == How::Slow {
            return (self.at.checked_add(1500) == Some(now.tick))
                .then_some(Ask::Request(Request::Speed(2.0)));
        }
        let is_held = matches!(now.state, State::Paused | State::Stopped | State::Armed);
        self.rests += u32::from(is_held);
        match now.state {
            State::Stopped if self.rests == REST_TICKS => ask(Request::Arm),
            State::Paused | State::Armed if self.rests >= REST_TICKS => ask(Request::Resume),
            _ => None,
        }
    }

    fn event(&mut self, _: &Event) {}

    fn refused(&mut self, why: &Refused) {
        self.refused.push(why.to_string());
    }

    fn looks(&mut self, look: Look) {
        self.checks = look != Look::Over;
        self.checked += u32::from(look == Look::Begun);
    }

    fn is_there(&self) -> bool {
        true
    }
}

/// Keeps the light of a run.
#[derive(Default)]
struct Light {
    /// From where to where light went, with the tick and the plan's.
    lit: Vec<([u32; 2], [Point; 2])>,
    last: Option<Point>,
    /// The clock of the plan and the gate, tick by tick.
    ticks: Vec<(u32, bool)>,
    off_mm: f64,
    /// How often a dot was let out to check where the head points.
    checked: u32,
}

impl Keep for Light {
    fn tick(&mut self, _: &Plan, tick: &Tick) -> Result<(), Failure> {
        let spot = tick.spot.filter(|_| tick.light);
        if let (Some(from), Some(to)) = (self.last, tick.spot) {
            self.lit.push(([tick.telemetry.tick, tick.telemetry.plan_tick], [from, to]));
        }
        if let (Some(spot), Some(asked)) = (spot, tick.asked) {
            self.off_mm = self.off_mm.max(1e3 * spot.distance(asked));
        }
        self.last = spot;
        self.ticks.push((tick.telemetry.plan_tick, tick.telemetry.actuation.lights()));
        Ok(())
    }
}

impl Light {
    /// Which places light passed as near as that up to a tick, and after it: by the run's ticks or the plan's.
    fn passed(&self, lines: &Lines, near_m: f64, clock: usize, held: u32) -> [Vec<bool>; 2] {
        [false, true].map(|after| {
            let then = self.lit.iter().filter(|(ticks, _)| (ticks[clock] > held) == after);
            lines.passed(&then.map(|(_, way)| *way).collect::<Vec<_>>(), near_m)
        })
    }
}

/// Clocks of [`Light::passed`].
const RUN: usize = 0;
const PLAN: usize = 1;

/// Those that a camera follows first.
const PICTURES: [(&str, &[u8]); 6] = [
    ("house.png", include_bytes!("../../../examples/house.png")),
    ("star.png", include_bytes!("../../../examples/star.png")),
    ("chalk.png", include_bytes!("../../../examples/chalk.png")),
    ("handwriting.png", include_bytes!("../../../examples/handwriting.png")),
    ("shapes.png", include_bytes!("../../../examples/shapes.png")),
    ("silhouette.png", include_bytes!("../../../examples/silhouette.png")),
];

fn prepared(
    (name, bytes): (&str, &[u8]),
    seen: bool,
    (seed, troubles): (u64, &[&str]),
    task: Task<'_>,
) -> Prepared {
    let Source::Pixels(pixels) = decode(name, bytes).unwrap() else { unreachable!() };
    let rig = RigConfig::report();
    let wishes = request_of(&rig);
    let request = Asks {
        name,
        tracing: Tracing::default(),
        placing: Placing::default(),
        driving: Driving::new(rig, HeadPose::square_on(0.9144), wishes, Asked::default()),
        run: RunRequest { seed, ..RunRequest::default() },
    };
    if !seen {
        return prepare(&request, Source::Pixels(pixels), task).unwrap();
    }
    let wall = Wall {
        scene: Scene::Room { picture: Some((name, pixels)), eye: SimulatedEye::Webcam, pages: true },
        camera: None,
        head: None,
        home: false,
        retakes: 3,
        open_loop: false,
        troubles: troubles.iter().map(|text| text.parse().unwrap()).collect(),
        today: "2026-11-30".to_owned(),
    };
    prepare_wall(&request, wall, task).unwrap()
}

/// A run, undisturbed or held once.
fn held(job: &Prepared, somebody: Option<Somebody>, task: Task<'_>) -> (Ran, Light) {
    let at = somebody.as_ref().map_or(u32::MAX, |somebody| somebody.at);
    let mut keep = Light::default();
    let mut somebody = somebody.unwrap_or(Somebody::who(How::Slow, u32::MAX));
    let ran = job.run_by_hand(Head::Simulated, (&mut keep, &mut somebody), task).unwrap();
    assert!(ran.failure.is_none() && ran.finished, "{at}: {:?}", ran.failure);
    assert_eq!(somebody.refused, Vec::<String>::new(), "{at}");
    if let Some(follow) = ran.eye.as_ref().and_then(|eye| eye.follow.as_ref()) {
        assert!(follow.recoveries.is_empty() && follow.remarks.is_empty(), "{at}: {:?}", follow.remarks);
    }
    keep.checked = somebody.checked;
    (ran, keep)
}

/// Holds each job so many times.
fn check_holds(pictures: &[(&str, &[u8])], seen: bool, times: u64) {
    let (most_missing_mm, most_doubled_mm, most_more_mm) = MOST_MM;
    let stop = Stop::default();
    let task = Task { progress: &NoProgress, stop: &stop };
    for (seed, &picture) in (3..).zip(pictures) {
        let job = prepared(picture, seen, (seed, &[]), task);
        let lines = Lines::of(&job.schedule.plan);
        let (_, usual) = held(&job, None, task);
        let near_m = ON_IT_M[usize::from(!seen)];
        let [usually, _] = usual.passed(&lines, near_m, RUN, u32::MAX);
        let all = 0..lines.len();
        let (mut missing_mm, mut doubled_mm) = (0.0_f64, 0.0_f64);
        // held, and hurried to twice its speed
        let (mut more_mm, mut checked) = ([0.0_f64; 2], [0; 2]);
        for moment in 0..times {
            let mut dice = oorandom::Rand64::new(u128::from(moment));
            let hows = [How::Pause(When::AtOnce), How::Pause(When::AfterStroke), How::Stop, How::Slow];
            let how = hows[(moment % 4) as usize];
            // while it goes on by itself
            let at = dice.rand_range(200..usual.ticks.len() as u64 - 200) as u32;
            let (ran, light) = held(&job, Some(Somebody::who(how, at)), task);
            let was_lit = light.ticks[at as usize].1;
            if matches!(how, How::Pause(When::AtOnce) | How::Stop) {
                assert!(
                    light.ticks[at as usize + 1..][..REST_TICKS as usize].iter().all(|(_, gate)| !gate),
                    "{at} {how:?}"
                );
            } else if how == How::Pause(When::AfterStroke) && was_lit {
                let rest = light.ticks[at as usize..].windows(50).find(|ticks| ticks[0].0 == ticks[49].0);
                let clock = rest.unwrap()[0].0 as usize;
                assert!(!job.schedule.plan.points[clock].lit, "{at}: it rests on a stroke");
            }
            assert!(!ran.notes.is_empty(), "what somebody did is told");
            let [before, after] = light.passed(&lines, near_m, RUN, at);
            let held_at = light.ticks[at as usize].0;
            let [first, second] = usual.passed(&lines, near_m, PLAN, held_at);
            let missing = all.clone().map(|p| usually[p] && !before[p] && !after[p]);
            let near = |p: usize| lines.tick(p).abs_diff(held_at) < ABOUT_TICKS;
            let doubled = all.clone().map(|p| near(p) && before[p] && after[p] && !(first[p] && second[p]));
            missing_mm = missing_mm.max(longest_mm(missing));
            doubled_mm = doubled_mm.max(longest_mm(doubled));
            let hurried = usize::from(how == How::Slow);
            if light.checked == 0 {
                // a dot at rest is within its count
                more_mm[hurried] = more_mm[hurried].max(light.off_mm - usual.off_mm);
            }
            checked[hurried] += light.checked;
        }
        println!(
            "{}, {}, held {times} times: missing {missing_mm:.2} mm, doubled {doubled_mm:.2} mm; {:.3} mm further off than undisturbed ({:.3}), {} dots to check it; \
             hurried {:.3} mm, {} dots",
            picture.0,
            if seen { "seen" } else { "unseen" },
            more_mm[0],
            usual.off_mm,
            checked[0],
            more_mm[1],
            checked[1],
        );
        assert!(missing_mm <= most_missing_mm && doubled_mm <= most_doubled_mm);
        assert!(more_mm[0] <= most_more_mm && more_mm[1] <= HURRIED_MM);
        assert!(u64::from(checked[0]) <= times.div_ceil(3), "{checked:?} checks");
    }
}

#[test]
fn what_a_camera_follows_is_held_anywhere_and_goes_on_where_its_light_was() {
    check_holds(&PICTURES[..2], true, 8);
}

#[test]
fn so_is_what_nobody_follows() {
    check_holds(&PICTURES[1..2], false, 12);
}

/// A run of a job with which something goes wrong on its way, to its end.
fn run_by(job: &Prepared, mut keep: Light, hands: &mut dyn Hands, task: Task<'_>) -> Light {
    let ran = job.run_by_hand(Head::Simulated, (&mut keep, hands), task).unwrap();
    assert!(ran.failure.is_none() && ran.finished, "{:?} {:?}", ran.failure, ran.notes);
    let follow = ran.eye.as_ref().unwrap().follow.as_ref().unwrap();
    assert!(!follow.recoveries.is_empty(), "{:?}", follow.remarks);
    keep
}

/// Somebody who stops a job of which an image under way shows that something is off, and has it go on after a while.
#[derive(Default)]
struct Quick {
    at: u32,
    since: Option<u32>,
    lit: u32,
}

impl Hands for Quick {
    fn tick(&mut self, now: &Snapshot) -> Option<Ask> {
        if now.tick == self.at {
            self.since = Some(0);
            return Some(Ask::Request(Request::Stop));
        }
        let since = self.since.as_mut()?;
        *since += 1;
        self.lit += u32::from((2..3000).contains(since) && now.gate);
        match (*since, now.state) {
            (..3000, _) => None,
            (_, State::Armed) => {
                self.since = None;
                Some(Ask::Request(Request::Resume))
            }
            (since, _) => since.is_multiple_of(500).then_some(Ask::Request(Request::Arm)),
        }
    }

    fn event(&mut self, _: &Event) {}

    fn refused(&mut self, _: &Refused) {}

    fn is_there(&self) -> bool {
        true
    }
}

/// Somebody who arms a job before its first light.
#[derive(Default)]
struct Arms {
    refused: Vec<String>,
    armed: bool,
}

/// When he arms, and when he lets it begin, ticks.
const ARMED_AT: u32 = 2000;
const BEGUN_AT: u32 = 3000;

impl Hands for Arms {
    fn tick(&mut self, now: &Snapshot) -> Option<Ask> {
        self.armed |= now.state == State::Armed;
        match now.tick {
            ARMED_AT => Some(Ask::Request(Request::Arm)),
            BEGUN_AT => Some(Ask::Request(Request::Resume)),
            _ => None,
        }
    }

    fn event(&mut self, _: &Event) {}

    fn refused(&mut self, why: &Refused) {
        self.refused.push(why.to_string());
    }

    fn arms(&self) -> bool {
        true
    }

    fn is_there(&self) -> bool {
        true
    }
}

#[test]
fn a_job_that_a_camera_follows_is_lit_only_once_somebody_has_armed_and_lets_it_begin() {
    let stop = Stop::default();
    let task = Task { progress: &NoProgress, stop: &stop };
    let job = prepared(PICTURES[1], true, (3, &[]), task);
    let (mut keep, mut arms) = (Light::default(), Arms::default());
    let ran = job.run_by_hand(Head::Simulated, (&mut keep, &mut arms), task).unwrap();
    assert!(ran.failure.is_none() && ran.finished, "{:?}", ran.failure);
    assert!(arms.armed && arms.refused.is_empty(), "{:?}", arms.refused);
    let first = keep.lit.first().unwrap().0[RUN];
    assert!(first > BEGUN_AT, "lit at {first}");
}

#[test]
fn a_job_that_was_stopped_lets_out_no_dots_before_somebody_arms() {
    let stop = Stop::default();
    let task = Task { progress: &NoProgress, stop: &stop };
    let job = prepared(PICTURES[1], true, (5, &["head-bump=0.2@2"]), task);
    let (mut looked, mut light) = (0, Light::default());
    let _ = job
        .run_by_hand(Head::Simulated, (&mut light, &mut Quick { at: u32::MAX, ..Quick::default() }), task)
        .unwrap();
    let struck = light.ticks.iter().position(|(plan_tick, gate)| *plan_tick >= 2000 && *gate).unwrap();
    for later in (10..250).step_by(16) {
        let mut hands = Quick { at: struck as u32 + later, ..Quick::default() };
        let mut keep = Light::default();
        let ran = job.run_by_hand(Head::Simulated, (&mut keep, &mut hands), task).unwrap();
        assert!(ran.failure.is_none() && ran.finished, "{later}: {:?} {:?}", ran.failure, ran.notes);
        assert_eq!(hands.lit, 0, "{later}: light while it was stopped");
        let follow = ran.eye.as_ref().unwrap().follow.as_ref().unwrap();
        looked += u32::from(!follow.recoveries.is_empty());
    }
    assert!(looked > 10, "it was looked into only {looked} times");
}

/// Somebody who stops the camera's looking into what is off each time, and has it go on.
#[derive(Default)]
struct Impatient {
    /// Ticks since it looks into something.
    looks: Option<u32>,
    /// After so many of them it is stopped.
    stops_after: u32,
    stopped: u32,
    refused: Vec<String>,
    /// Ticks with an open gate while it was stopped, but for the first.
    lit: u32,
}

impl Hands for Impatient {
    fn tick(&mut self, now: &Snapshot) -> Option<Ask> {
        let looks = self.looks.as_mut()?;
        *looks += 1;
        let since = looks.checked_sub(self.stops_after)?;
        self.lit += u32::from((1..600).contains(&since) && now.gate);
        let request = match since {
            0 => Request::Stop,
            // neither of these is for now
            10 => Request::Pause(When::AtOnce),
            20 => Request::Resume,
            500 => Request::Arm,
            // what is parked comes to rest before it can be armed
            501.. if now.state == State::Armed => {
                self.looks = None;
                self.stopped += 1;
                Request::Resume
            }
            501.. if since.is_multiple_of(500) => Request::Arm,
            _ => return None,
        };
        Some(Ask::Request(request))
    }

    fn event(&mut self, _: &Event) {}

    fn refused(&mut self, why: &Refused) {
        self.refused.push(why.to_string());
    }

    fn looks(&mut self, look: Look) {
        match look {
            // in the end it has patience
            Look::Begun => self.looks = (self.stopped < 2).then_some(0),
            Look::Stopped => {}
            Look::Over => self.looks = None,
        }
    }

    fn is_there(&self) -> bool {
        true
    }
}

#[test]
fn whoever_stops_a_camera_that_looks_for_the_head_may_have_it_go_on() {
    let stop = Stop::default();
    let task = Task { progress: &NoProgress, stop: &stop };
    for (number, trouble) in (0..).zip(["pan-slip=20@2", "head-bump=1@3", "camera-bump=6@2"]) {
        let job = prepared(PICTURES[1], true, (5, &[trouble]), task);
        let alone = Light::default();
        let mut nobody = Impatient { stops_after: u32::MAX, ..Impatient::default() };
        let alone = run_by(&job, alone, &mut nobody, task);
        for stops_after in [50, 400, 2000 + 700 * number, 6000] {
            let mut hands = Impatient { stops_after, ..Impatient::default() };
            let case = format!("{trouble} stopped {stops_after} ticks later");
            let light = Light::default();
            let light = run_by(&job, light, &mut hands, task);
            assert!(stops_after > 400 || hands.stopped > 0, "{case}: nobody stopped anything");
            assert!(light.off_mm < alone.off_mm + 1.0, "{case}: {} mm off, {}", light.off_mm, alone.off_mm);
            assert_eq!(hands.lit, 0, "{case}: light while it was stopped");
            assert!(hands.refused.len() >= hands.stopped as usize, "{case}: {:?}", hands.refused);
            println!(
                "{case}: stopped {} times, {:.2} mm off at most ({:.2})",
                hands.stopped, light.off_mm, alone.off_mm
            );
        }
    }
}

#[test]
#[ignore = "minutes: `bash .ci/run long`; its short twin always runs"]
fn held_at_many_moments() {
    check_holds(&PICTURES[..2], true, 62);
    check_holds(&PICTURES, false, 64);
}
