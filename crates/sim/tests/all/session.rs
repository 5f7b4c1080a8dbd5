//! A session with the simulated rig: what somebody at the wall asks, in order and at random.

#![allow(clippy::print_stdout, reason = "a test shows figures")]

use tracelight_rig::{Fault, Joint, PanTilt, Phase, Segment};
use tracelight_session::{ARMED_TICKS, Event, Job, Refused, Request, Session, State, When};
use tracelight_sim::{RigConfig, Run, Simulated, SimulatedRig, Tick, Trouble, job_of};

use crate::dice::Dice;
use crate::shapes::ink::ink;
use crate::shapes::{POSE, circle, house, plan_of, plan_of_all, star};

type Wall = Session<SimulatedRig>;

fn at_the_wall(config: &RigConfig, seed: u64) -> Wall {
    let mut wall = Session::new(SimulatedRig::new(config, POSE, seed));
    step(&mut wall);
    assert_eq!(wall.state(), State::Ready);
    wall
}

fn step(wall: &mut Wall) -> Tick {
    wall.tick_by(|rig| Some(rig.step()), |tick| &tick.telemetry).unwrap()
}

fn steps(wall: &mut Wall, ticks: usize) -> Vec<Tick> {
    (0..ticks).map(|_| step(wall)).collect()
}

/// Ticks until a state is reached.
fn until(wall: &mut Wall, state: State, most: usize) -> Vec<Tick> {
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
            .any(|e| matches!(e, Event::Fault { fault: Fault::LaserStuck, .. }))
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
    match dice.below(14) {
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
    panic!("it does not come to rest: {was:?}, {:?}", wall.told());
}

/// Leads out of any state to the end of a job.
fn check_it_can_be_left(wall: &mut Wall, job: &Job) {
    wall.request(Request::Stop).unwrap();
    wall.request(Request::Speed(1.0)).unwrap();
    wall.rig_mut().suffer(Trouble::Push(PanTilt::default()));
    if !comes_to_rest_in_travel(wall) {
        // that is a matter of hands
        *wall = at_the_wall(&RigConfig::report(), 0);
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
fn at_random(requests: usize, seed: u64) -> [usize; State::ALL.len()] {
    let config = RigConfig::report();
    let good = plan_of(&config, star(0.05));
    let mut bad = job_of(&good, false);
    bad.segments[1] = Segment { coefficients: PanTilt::new([f32::NAN; 6], [0.0; 6]), ..bad.segments[1] };
    let jobs = [
        job_of(&good, false),
        job_of(&plan_of(&config, circle(0.05)), false),
        job_of(&good, true),
        bad,
        Job::default(),
    ];
    let mut dice = Dice::of_seed(u128::from(seed));
    let mut met = [0; State::ALL.len()];
    let mut wall = at_the_wall(&config, seed);
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
            check_it_can_be_left(&mut wall, &jobs[0]);
            was = wall.state();
        }
    }
    met
}

fn check_at_random(requests: usize) {
    let met = at_random(requests, 7);
    println!("{requests} requests: ticks in {:?}", State::ALL.iter().zip(met).collect::<Vec<_>>());
    let never = State::ALL.iter().zip(met).filter(|(state, met)| *met == 0 && **state != State::Lost);
    assert_eq!(never.map(|(state, _)| *state).collect::<Vec<_>>(), [], "states that were never met");
}

#[test]
fn random_requests_find_no_light_outside_a_job_and_no_state_that_cannot_be_left() {
    check_at_random(10_000);
}

#[test]
#[ignore = "minutes: `bash .ci/run long`; its short twin always runs"]
fn a_million_random_requests_do_not_either() {
    check_at_random(1_000_000);
}
