//! A session with the simulated rig: what somebody at the wall asks, in order and at random.

#![allow(clippy::print_stdout, reason = "a test shows figures")]

use tracelight_rig::{Darkness, Fault, Joint, PanTilt, Phase, Segment};
use tracelight_session::{
    ARMED_TICKS, ATTENDED_TICKS, Event, Job, Refused, Repeated, Request, Session, State, When,
};
use tracelight_sim::{RigConfig, Run, SimulatedRig, Tick, Trouble, job_of, looped_job, tick};
use tracelight_stroke::Path;
use tracelight_trajectory::Plan;

use crate::dice::Dice;
use crate::shapes::ink::ink;
use crate::shapes::{POSE, circle, house, plan_of, plan_of_all, plan_there, star};

type Wall = Session<SimulatedRig>;

pub(crate) fn at_the_wall(config: &RigConfig, seed: u64) -> Wall {
    let mut wall = Session::new(SimulatedRig::new(config, POSE, seed));
    step(&mut wall);
    assert_eq!(wall.state(), State::Ready);
    wall
}

pub(crate) fn step(wall: &mut Wall) -> Tick {
    tick(wall)
}

pub(crate) fn steps(wall: &mut Wall, ticks: usize) -> Vec<Tick> {
    (0..ticks).map(|_| step(wall)).collect()
}

/// Ticks until a state is reached.
pub(crate) fn until(wall: &mut Wall, state: State, most: usize) -> Vec<Tick> {
    let mut ticks = Vec::new();
    while wall.state() != state {
        assert!(ticks.len() < most, "still {:?} after {most} ticks, and not {state:?}", wall.state());
        ticks.push(step(wall));
    }
    ticks
}

fn states(wall: &mut Wall) -> Vec<State> {
    let mut states = Vec::new();
    while let Some(event) = wall.event() {
        if let Event::State { to, .. } = event {
            states.push(to);
        }
    }
    states
}

#[test]
fn a_job_is_armed_traced_paused_and_done() {
    let config = RigConfig::report();
    let plan = plan_of_all(&config, house());
    let mut wall = at_the_wall(&config, 0);
    assert_eq!(wall.request(Request::Trace(job_of(&plan, false))), Err(Refused::NotArmed));
    wall.request(Request::Arm).unwrap();
    assert_eq!(wall.snapshot().armed_ticks, ARMED_TICKS);
    assert!(steps(&mut wall, 100).iter().all(|t| !t.light && t.telemetry.phase == Phase::Dark));
    wall.request(Request::Trace(job_of(&plan, false))).unwrap();
    let mut ran = Run { ticks: steps(&mut wall, 3000) };
    wall.request(Request::Pause(When::AfterStroke)).unwrap();
    ran.ticks.extend(until(&mut wall, State::Paused, 5000));
    let paused = wall.snapshot();
    assert!(!plan.points[paused.plan_tick as usize].lit, "{paused:?}");
    ran.ticks.extend(steps(&mut wall, 2000));
    wall.request(Request::Resume).unwrap();
    ran.ticks.extend(steps(&mut wall, 1000));
    // at once, and stopped: it goes on only when somebody arms
    wall.request(Request::Stop).unwrap();
    ran.ticks.extend(steps(&mut wall, 1000));
    assert_eq!(wall.request(Request::Resume), Err(Refused::NotArmed));
    wall.request(Request::Arm).unwrap();
    wall.request(Request::Resume).unwrap();
    ran.ticks.extend(until(&mut wall, State::Done, 20_000));
    let ink = ink(&plan, &ran);
    println!("paused and stopped once each: {ink:?}");
    assert!(ink.missing_mm < 0.2 && ink.doubled_mm < 0.5 && ink.off_mm < 0.2, "{ink:?}");
    let mut strokes = Vec::new();
    while let Some(event) = wall.event() {
        if let Event::Stroke { stroke, of, .. } = event {
            assert_eq!(of, 5);
            strokes.push(stroke);
        }
    }
    assert_eq!(strokes, [0, 1, 2, 3, 4]);
    assert_eq!(wall.snapshot().stroke, None);
}

#[test]
fn a_job_whose_light_would_stand_is_not_slowed_so_far() {
    let config = RigConfig::report();
    let mut wall = at_the_wall(&config, 0);
    let job = Job { slowest: 0.6, ..job_of(&plan_of(&config, circle(0.1)), false) };
    for request in [Request::Speed(0.25), Request::Arm, Request::Trace(job)] {
        wall.request(request).unwrap();
    }
    assert!((wall.snapshot().speed - 0.6).abs() < 1e-6);
    assert!(wall.request(Request::Speed(0.5)).unwrap_err().to_string().contains("60 % at least"));
}

#[test]
fn arming_is_forgotten_and_a_dry_job_needs_none() {
    let config = RigConfig::report();
    let plan = plan_of(&config, circle(0.1));
    let mut wall = at_the_wall(&config, 0);
    wall.request(Request::Arm).unwrap();
    steps(&mut wall, ARMED_TICKS as usize + 1);
    assert_eq!(wall.state(), State::Ready);
    assert_eq!(wall.request(Request::Trace(job_of(&plan, false))), Err(Refused::NotArmed));
    wall.request(Request::Trace(job_of(&plan, true))).unwrap();
    assert!(until(&mut wall, State::Done, 10_000).iter().all(|t| !t.light && !t.telemetry.actuation.gate));
    // where it ended no job begins
    let refused = wall.request(Request::Trace(job_of(&plan, true)));
    assert!(matches!(refused, Err(Refused::Elsewhere { .. })), "{refused:?}");
    wall.request(Request::Park).unwrap();
    until(&mut wall, State::Ready, 5000);
    wall.request(Request::Trace(job_of(&plan, true))).unwrap();
    until(&mut wall, State::Done, 10_000);
    assert_eq!(
        states(&mut wall),
        [
            State::Ready,
            State::Armed,
            State::Ready,
            State::Tracing,
            State::Done,
            State::Parking,
            State::Ready,
            State::Tracing,
            State::Done
        ]
    );
}

fn looped_of(config: &RigConfig, path: Path, dry: bool) -> Job {
    repeated(config, path, (Repeated::Stroke, dry))
}

fn repeated(config: &RigConfig, path: Path, (what, dry): (Repeated, bool)) -> Job {
    let once = plan_of(config, path.clone());
    let end = once.points.last().unwrap().joints.map(|joint| joint.position_rad);
    let again = plan_there(config, path, end);
    looped_job(config, (what, &once, &again), dry).unwrap()
}

/// How often the light passed so many places of a plan's lit way, at least and at most.
fn passes(plan: &Plan, ticks: &[Tick]) -> (usize, usize) {
    let lit: Vec<_> = plan.points.iter().filter(|point| point.lit).map(|point| point.spot).collect();
    let places = (1..8).map(|k| lit[k * lit.len() / 8]);
    let times = places.map(|place| {
        let near: Vec<bool> =
            ticks.iter().map(|t| t.light && t.spot.is_some_and(|spot| spot.distance(place) < 1e-3)).collect();
        near.windows(2).filter(|pair| !pair[0] && pair[1]).count()
    });
    let times: Vec<usize> = times.collect();
    (*times.iter().min().unwrap(), *times.iter().max().unwrap())
}

#[test]
fn a_job_is_done_again_and_again_until_another_one_is_asked_for() {
    let config = RigConfig::report();
    let plan = plan_of(&config, circle(0.1));
    let looped = looped_of(&config, circle(0.1), false);
    let other = looped_of(&config, star(0.1), false);
    let mut wall = at_the_wall(&config, 0);
    wall.request(Request::Arm).unwrap();
    wall.request(Request::Trace(looped)).unwrap();
    assert_eq!(wall.state(), State::Stepping);
    let mut ticks = Vec::new();
    while wall.snapshot().laps < 5 {
        ticks.push(step(&mut wall));
    }
    assert_eq!(passes(&plan, &ticks), (5, 5));
    // in the middle of a time: it pauses, goes on, and is stopped
    steps(&mut wall, 200);
    wall.request(Request::Pause(When::AfterStroke)).unwrap();
    until(&mut wall, State::Paused, 5000);
    steps(&mut wall, 1000);
    wall.request(Request::Resume).unwrap();
    until(&mut wall, State::Stepping, 5000);
    let laps = wall.snapshot().laps;
    let more = steps(&mut wall, 8000);
    assert!(wall.snapshot().laps > laps, "{:?}", wall.snapshot());
    assert!(passes(&plan, &more).0 > 0);
    wall.request(Request::Stop).unwrap();
    assert_eq!(
        wall.request(Request::Next(other.clone())).unwrap_err().to_string(),
        "next is not possible while the session is stopped: arm and resume, or park"
    );
    wall.request(Request::Arm).unwrap();
    wall.request(Request::Resume).unwrap();
    steps(&mut wall, 500);
    // another one: dark at once, by way of zero
    wall.request(Request::Next(other.clone())).unwrap();
    let gone = until(&mut wall, State::Stepping, 8000);
    assert!(gone.iter().skip(1).all(|t| !t.telemetry.actuation.gate));
    let star_plan = plan_of(&config, star(0.1));
    let mut ticks = Vec::new();
    while wall.snapshot().laps < 3 {
        ticks.push(step(&mut wall));
    }
    assert_eq!(passes(&star_plan, &ticks).0, 3);
    // nobody asks for anything any more
    wall.request(Request::Speed(1.0)).unwrap();
    until(&mut wall, State::Done, ATTENDED_TICKS as usize + 10_000);
    assert!(steps(&mut wall, 20_000).iter().all(|t| !t.light && !t.telemetry.actuation.gate));
    assert_eq!(wall.state(), State::Done);
}

#[test]
fn stopped_anywhere_on_the_way_to_another_job_it_begins_when_somebody_arms() {
    let config = RigConfig::report();
    let [first, other] = [circle(0.1), star(0.1)].map(|path| looped_of(&config, path, false));
    let mut wall = at_the_wall(&config, 0);
    for moment in (0..400).step_by(25) {
        wall.request(Request::Arm).unwrap();
        wall.request(Request::Next(first.clone())).unwrap();
        until(&mut wall, State::Stepping, 8000);
        steps(&mut wall, 500);
        wall.request(Request::Next(other.clone())).unwrap();
        steps(&mut wall, moment);
        wall.request(Request::Stop).unwrap();
        while !matches!(wall.state(), State::Ready | State::Stopped) {
            step(&mut wall);
        }
        wall.request(Request::Arm).unwrap();
        wall.request(Request::Next(other.clone())).unwrap();
        let gone = until(&mut wall, State::Stepping, 8000);
        assert!(gone.iter().skip(1).all(|t| !t.telemetry.actuation.gate), "{moment}");
        let laps = wall.snapshot().laps;
        steps(&mut wall, 8000);
        assert!(wall.snapshot().laps > laps, "{moment}: {:?}", wall.snapshot());
        wall.request(Request::Stop).unwrap();
        wall.request(Request::Park).unwrap();
        until(&mut wall, State::Ready, 8000);
    }
}

#[test]
fn another_job_is_lit_only_where_the_one_before_was_and_waits_where_it_waited() {
    let config = RigConfig::report();
    let mut wall = at_the_wall(&config, 0);
    // in the dark nobody needs to arm, and nothing that follows is lit
    wall.request(Request::Trace(looped_of(&config, circle(0.1), true))).unwrap();
    steps(&mut wall, 1500);
    let lit = looped_of(&config, star(0.1), false);
    assert_eq!(wall.request(Request::Next(lit.clone())), Err(Refused::NotArmed));
    wall.request(Request::Next(looped_of(&config, star(0.1), true))).unwrap();
    assert_eq!(wall.request(Request::Next(lit)), Err(Refused::NotArmed));
    assert!(steps(&mut wall, 8000).iter().all(|t| !t.light));
    wall.request(Request::Stop).unwrap();
    wall.request(Request::Park).unwrap();
    until(&mut wall, State::Ready, 8000);
    // a small one waits in the dark between, and may be paused and go on there
    let small = looped_of(&config, circle(0.004), false);
    assert!(small.again.as_ref().unwrap().wait_ticks > 100);
    wall.request(Request::Arm).unwrap();
    wall.request(Request::Trace(small)).unwrap();
    while wall.snapshot().laps < 2 || wall.told().phase != Phase::Done {
        step(&mut wall);
    }
    wall.request(Request::Pause(When::AtOnce)).unwrap();
    until(&mut wall, State::Paused, 100);
    wall.request(Request::Resume).unwrap();
    let laps = wall.snapshot().laps;
    steps(&mut wall, 5000);
    assert_eq!(wall.state(), State::Stepping);
    assert!(wall.snapshot().laps > laps);
    // held up on its way for more than a minute, another one is not begun
    wall.request(Request::Next(looped_of(&config, star(0.1), false))).unwrap();
    let hand = |wall: &mut Wall, nm: f64| wall.rig_mut().suffer(Trouble::Push(PanTilt::new(nm, 0.0)));
    hand(&mut wall, 0.1);
    let held = steps(&mut wall, 70_000);
    let was_parking = wall.state() == State::Parking;
    hand(&mut wall, 0.0);
    if was_parking {
        let after = steps(&mut wall, 20_000);
        assert!(held.iter().chain(&after).skip(100).all(|t| !t.light));
        assert_eq!(wall.state(), State::Ready);
    }
}

#[test]
fn light_that_is_drawn_again_and_again_stands_nowhere() {
    let config = RigConfig::report();
    for (width, seconds) in [(0.003, 580), (0.004, 60), (0.01, 60), (0.03, 60), (0.1, 60)] {
        let looped = looped_of(&config, circle(width), false);
        let wait = looped.again.as_ref().unwrap().wait_ticks;
        let mut wall = at_the_wall(&config, 0);
        wall.request(Request::Arm).unwrap();
        wall.request(Request::Trace(looped)).unwrap();
        let is_dark = |tick: Tick| tick.telemetry.darkness.contains(Darkness::Standing);
        let dark = (0..1000 * seconds).filter(|_| is_dark(step(&mut wall))).count();
        assert_eq!(wall.state(), State::Stepping, "{width}");
        let laps = wall.snapshot().laps;
        println!("circle of {:.0} mm: {laps} times in {seconds} s, {wait} ms dark between", 1e3 * width);
        assert!(dark == 0 && laps > 5, "{width}: {laps} times, {dark} ticks dark");
    }
}

#[test]
fn after_a_fault_it_goes_on_only_when_that_was_cleared_and_somebody_armed() {
    let config = RigConfig::report();
    let plan = plan_of(&config, star(0.2));
    let mut wall = at_the_wall(&config, 0);
    wall.request(Request::Arm).unwrap();
    wall.request(Request::Trace(job_of(&plan, false))).unwrap();
    steps(&mut wall, 2500);
    wall.rig_mut().suffer(Trouble::LaserStuck);
    until(&mut wall, State::Fault, 5000);
    assert!(
        std::iter::from_fn(|| wall.event())
            .any(|e| matches!(e, Event::Fault(record) if record.fault == Fault::LaserStuck))
    );
    wall.rig_mut().suffer(Trouble::LaserMended);
    assert!(steps(&mut wall, 500).iter().skip(100).all(|t| !t.light));
    assert!(wall.request(Request::Resume).is_err() && wall.request(Request::Arm).is_err());
    wall.request(Request::Clear).unwrap();
    until(&mut wall, State::Stopped, 10);
    wall.request(Request::Arm).unwrap();
    wall.request(Request::Resume).unwrap();
    until(&mut wall, State::Done, 20_000);
}

/// A request of any kind, legal here or not.
fn any_request(dice: &mut Dice, jobs: &[Job]) -> Request {
    match dice.below(20) {
        0 => Request::Home(PanTilt::new(dice.below(5) as i32 - 2, dice.below(5) as i32 - 2)),
        1 | 2 => Request::Arm,
        3 => Request::Disarm,
        4 | 5 => Request::Trace(jobs[dice.below(jobs.len())].clone()),
        6 => Request::Pause(When::AtOnce),
        7 => Request::Pause(When::AfterStroke),
        8 | 9 => Request::Resume,
        10 => Request::Speed(dice.of(&[0.1, 0.5, 1.0, 2.0, 0.0, -1.0, f32::NAN])),
        11 => Request::Stop,
        12 => Request::Clear,
        16 => Request::Seek,
        17 => Request::Jog(jobs[dice.below(jobs.len())].clone()),
        18 => Request::Mark(dice.of(&[30, 500])),
        19 if dice.below(20) == 0 => Request::Unhome,
        13 | 14 => Request::Next(jobs[dice.below(jobs.len())].clone()),
        _ => Request::Park,
    }
}

fn any_trouble(dice: &mut Dice) -> Trouble {
    match dice.below(6) {
        0 | 1 => Trouble::Push(PanTilt::new(0.3, 0.0)),
        2 => Trouble::EncoderJump(Joint::Tilt, 40),
        3 => Trouble::PowerLoss,
        4 => Trouble::TickLate(30.0),
        _ => Trouble::EncoderJump(Joint::Pan, -3),
    }
}

/// Waits until the joints rest: pushed while nothing holds it, one without end stops spins. Whether they are still within their travel.
fn comes_to_rest_in_travel(wall: &mut Wall) -> bool {
    const FAR_RAD: f64 = 0.5;
    let mut was = step(wall).angle_rad;
    for _ in 0..200 {
        steps(wall, 600);
        let is = step(wall).angle_rad;
        if Joint::BOTH.iter().all(|&j| (is[j] - was[j]).abs() < 1e-6) {
            return Joint::BOTH.iter().all(|&j| is[j].abs() < FAR_RAD);
        }
        was = is;
    }
    // upside down it is held by what it weighs the right way up, and hunts
    if Joint::BOTH.iter().any(|&j| was[j].abs() >= FAR_RAD) {
        return false;
    }
    panic!("it does not come to rest: {was:?}, {:?}", wall.told());
}

/// Leads out of any state to the end of a job.
fn check_it_can_be_left(wall: &mut Wall, job: &Job, config: &RigConfig) {
    wall.request(Request::Stop).unwrap();
    wall.request(Request::Speed(1.0)).unwrap();
    wall.rig_mut().suffer(Trouble::Push(PanTilt::default()));
    if !comes_to_rest_in_travel(wall) {
        // that is a matter of hands
        *wall = at_the_wall(config, 0);
        return;
    }
    for _ in 0..10 {
        match wall.state() {
            State::Fault => wall.request(Request::Clear).unwrap(),
            State::Unhomed => {
                let (uncounted, counted) = (wall.rig().true_counts(), wall.told().measured.map(|m| m.count));
                let homed = PanTilt::from_fn(|j| uncounted[j].wrapping_add(counted[j]));
                let _ = wall.request(Request::Home(homed));
            }
            State::Stopped => wall.request(Request::Park).unwrap(),
            State::Ready | State::Done => break,
            _ => {}
        }
        steps(wall, 3000);
    }
    assert!(matches!(wall.state(), State::Ready | State::Done), "{:?}, {:?}", wall.state(), wall.told());
    wall.request(Request::Park).unwrap();
    until(wall, State::Ready, 8000);
    wall.request(Request::Trace(Job { dry: true, ..job.clone() })).unwrap();
    until(wall, State::Done, 20_000);
    wall.request(Request::Park).unwrap();
    until(wall, State::Ready, 8000);
}

/// So many random requests; how often each state was met.
fn at_random((config, size_m): (&RigConfig, f64), requests: usize, seed: u64) -> [usize; State::ALL.len()] {
    let good = plan_of(config, star(size_m));
    let mut bad = job_of(&good, false);
    bad.segments[1] = Segment { coefficients: PanTilt::new([f32::NAN; 6], [0.0; 6]), ..bad.segments[1] };
    let jobs = [
        job_of(&good, false),
        job_of(&plan_of(config, circle(size_m)), false),
        job_of(&good, true),
        bad,
        Job::default(),
        looped_of(config, star(size_m), false),
        looped_of(config, circle(size_m), true),
        repeated(config, star(size_m), (Repeated::Point, false)),
        repeated(config, circle(size_m), (Repeated::Frame, false)),
    ];
    let mut dice = Dice::of_seed(u128::from(seed));
    let mut met = [0; State::ALL.len()];
    let mut wall = at_the_wall(config, seed);
    let mut was = wall.state();
    for n in 0..requests {
        let ticks = match dice.below(40) {
            0 | 1 => 700,
            2..5 => 150,
            5..10 => 20,
            10..20 => 3,
            20..35 => 1,
            // a flood
            _ => 0,
        };
        let request = any_request(&mut dice, &jobs);
        let before = wall.state();
        if let Err(why) = wall.request(request) {
            assert_eq!(wall.state(), before, "{why}");
            assert!(why.to_string().len() > 10);
        }
        if dice.below(400) == 0 {
            let trouble = any_trouble(&mut dice);
            wall.rig_mut().suffer(trouble);
        }
        for _ in 0..ticks {
            let tick = step(&mut wall);
            // a state may end within the tick in which its gate was still open
            let lights = tick.telemetry.actuation.lights();
            assert!(
                !lights || was.may_light() || wall.state().may_light(),
                "light while {was:?}, {:?}",
                wall.state()
            );
            was = wall.state();
            met[State::ALL.iter().position(|&state| state == was).unwrap()] += 1;
        }
        // nobody pushes for long
        wall.rig_mut().suffer(Trouble::Push(PanTilt::default()));
        if n % 1000 == 999 {
            check_it_can_be_left(&mut wall, &jobs[0], config);
            was = wall.state();
        }
    }
    met
}

fn check_at_random(requests: usize) {
    let met = at_random((&RigConfig::report(), 0.05), requests, 7);
    println!("{requests} requests: ticks in {:?}", State::ALL.iter().zip(met).collect::<Vec<_>>());
    let never = State::ALL.iter().zip(met).filter(|(state, met)| *met == 0 && **state != State::Lost);
    assert_eq!(never.map(|(state, _)| *state).collect::<Vec<_>>(), [], "states that were never met");
}

#[test]
fn random_requests_find_no_light_outside_a_job_and_no_state_that_cannot_be_left() {
    check_at_random(10_000);
}

#[test]
fn nor_do_they_on_heads_without_encoders() {
    // light that is drawn again and again stands sooner on a head that is known less well
    for (rig, size_m) in [(RigConfig::stepper(), 0.05), (RigConfig::servo(), 0.3)] {
        let met = at_random((&rig, size_m), 3000, 11);
        println!("{}: ticks in {:?}", rig.name, State::ALL.iter().zip(met).collect::<Vec<_>>());
    }
}

#[test]
#[ignore = "minutes: `bash .ci/run long`; its short twin always runs"]
fn a_million_random_requests_do_not_either() {
    check_at_random(1_000_000);
}
