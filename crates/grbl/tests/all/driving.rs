use tracelight_aim::HeadPose;
use tracelight_grbl::{Asking, Driver, Trouble};
use tracelight_maths::hypot;
use tracelight_rig::{Command, PanTilt, Rig, Telemetry};
use tracelight_session::{Request, Session, State, When};
use tracelight_sim::{RigConfig, job_of};
use tracelight_stroke::{Drawing, Element, Path, Point, Stroke};
use tracelight_trajectory::{DarkMove, LitSpeed, Plan, PlanRequest, Ramps, Shape};

use crate::board::{Board, Seen};

const POSE: HeadPose = HeadPose::square_on(0.9144);
const MS_US: u64 = 1000;
const DEGREE_RAD: f64 = std::f64::consts::PI / 180.0;

/// A driver with its board, millisecond by millisecond.
#[derive(Clone, Debug)]
struct Bench {
    driver: Driver,
    board: Board,
    now_us: u64,
    /// Ticks that were told, and when, ms of the board.
    told: Vec<(usize, Telemetry)>,
}

impl Bench {
    fn pass(&mut self) {
        let mut bytes = Vec::new();
        self.driver.give(self.now_us, &mut bytes);
        self.board.hear(&bytes);
        self.board.pass();
        self.now_us += MS_US;
        self.driver.take(&self.board.say(), self.now_us);
    }
}

impl Rig for Bench {
    fn send(&mut self, command: Command) -> Result<(), Command> {
        self.driver.send(command, self.now_us)
    }

    fn next(&mut self) -> Option<Telemetry> {
        for _ in 0..20_000 {
            if let Some(told) = self.driver.telemetry() {
                self.told.push((self.board.seen.len(), told));
                return Some(told);
            }
            if self.driver.trouble().is_some() {
                return None;
            }
            self.pass();
        }
        unreachable!("no tick for 20 s")
    }
}

/// The usual rig on stepper motors, slowed to half of the acceleration that the usual board has.
fn config() -> RigConfig {
    let mut config = RigConfig::stepper();
    config.motion.acceleration_limit_rad_s2 = PanTilt::new(4000.0 * DEGREE_RAD, 4000.0 * DEGREE_RAD);
    // its laser has no relay
    (config.model.relay.on_s, config.model.relay.off_s) = (0.0, 0.0);
    (config.model.enable.on_s, config.model.enable.off_s) = (0.0, 0.0);
    config
}

fn steps_a_degree(config: &RigConfig) -> f64 {
    DEGREE_RAD / config.drive.stepper.microstep_rad()
}

/// Asks a board and takes it in hand.
fn connected(mut board: Board, config: &RigConfig) -> Result<Bench, Trouble> {
    let (mut asking, mut now_us) = (Asking::new(0), 0);
    let found = loop {
        let mut bytes = Vec::new();
        asking.give(now_us, &mut bytes);
        board.hear(&bytes);
        board.pass();
        now_us += MS_US;
        asking.take(&board.say(), now_us);
        if let Some(found) = asking.board(now_us) {
            break found?;
        }
    };
    let near = (5e-5 / POSE.distance_m, u32::MAX);
    let driver = Driver::new(config.control_config(), found, config.drive.axes, near, now_us)?;
    Ok(Bench { driver, board, now_us, told: Vec::new() })
}

/// A session with a head that was told that it points straight ahead.
fn homed(config: &RigConfig) -> Session<Bench> {
    homed_at(Board::new(steps_a_degree(config)), config, PanTilt::default())
}

/// Likewise, that it points somewhere else.
fn homed_at(board: Board, config: &RigConfig, counts: PanTilt<i32>) -> Session<Bench> {
    let mut session = Session::new(connected(board, config).unwrap());
    until(&mut session, State::Unhomed, 10);
    session.request(Request::Home(counts)).unwrap();
    until(&mut session, State::Ready, 10);
    session
}

fn until(session: &mut Session<Bench>, state: State, most: usize) {
    for _ in 0..most {
        if session.tick().is_some() && session.state() == state {
            return;
        }
    }
    unreachable!("{:?} and not {state:?}: {:?}", session.state(), session.rig().driver.trouble());
}

fn ticks(session: &mut Session<Bench>, count: usize) {
    (0..count).for_each(|_| assert!(session.tick().is_some()));
}

/// A square and a circle.
fn plan(config: &RigConfig) -> Plan {
    let corners = [(-0.2, -0.1), (-0.05, -0.1), (-0.05, 0.05), (-0.2, 0.05)].map(Point::from);
    let mut circle = Path::new(Point::new(0.2, 0.1));
    circle.push(Element::Arc { centre: Point::new(0.1, 0.1), sweep: std::f64::consts::TAU });
    circle.close();
    let strokes = vec![Stroke::new(Path::polyline(&corners, true).unwrap()), Stroke::new(circle)];
    let request = PlanRequest {
        speed_m_s: 0.3048,
        lit_speed: LitSpeed::Fastest,
        travel: DarkMove::Shaped(Shape::Ramped(Ramps::REPORT)),
        ramp_s: config.motion.ramp_s,
        settle_s: config.motion.settle_s,
        tolerance_m: config.control.tolerance_m,
        corner_m: 0.0,
    };
    tracelight_trajectory::plan(&Drawing { strokes }, &config.machine(POSE), &request).unwrap()
}

fn begin(session: &mut Session<Bench>, plan: &Plan) {
    session.request(Request::Arm).unwrap();
    ticks(session, 20);
    session.request(Request::Trace(job_of(plan, false))).unwrap();
}

/// Angles in steps where the plan is lit.
fn lit(plan: &Plan, step_rad: f64) -> Vec<[f64; 2]> {
    let of = |p: &tracelight_trajectory::PlanPoint| {
        [p.joints.pan.position_rad / step_rad, p.joints.tilt.position_rad / step_rad]
    };
    plan.points.iter().filter(|p| p.lit).map(of).collect()
}

/// Furthest that any of these is from the nearest of those, steps.
fn furthest(of: &[[f64; 2]], from: &[[f64; 2]]) -> f64 {
    let near =
        |a: &[f64; 2]| from.iter().map(|b| hypot(a[0] - b[0], a[1] - b[1])).fold(f64::INFINITY, f64::min);
    of.iter().map(near).fold(0.0, f64::max)
}

fn lights(seen: &[Seen]) -> Vec<[f64; 2]> {
    seen.iter().filter(|seen| seen.light > 0.0).map(|seen| seen.at).collect()
}

/// What was lit is what the plan has lit, within so many steps.
fn assert_drawn(session: &Session<Bench>, plan: &Plan, config: &RigConfig) {
    let wanted = lit(plan, config.drive.stepper.microstep_rad());
    let board = &session.rig().board;
    let begins = board.begins().map(|begins| begins * board.steps);
    let drawn: Vec<[f64; 2]> =
        lights(&board.seen).into_iter().map(|[x, y]| [x - begins[0], y - begins[1]]).collect();
    let (off, missing) = (furthest(&drawn, &wanted), furthest(&wanted, &drawn));
    println!("light off by {off:.2} steps, missing by {missing:.2}");
    assert!(off < 1.6 && missing < 1.6, "off {off} missing {missing}");
}

#[test]
fn a_drawing_is_where_and_when_it_is_planned() {
    let config = config();
    let (mut session, plan) = (homed(&config), plan(&config));
    begin(&mut session, &plan);
    until(&mut session, State::Done, 20_000);
    assert_drawn(&session, &plan, &config);
    let bench = session.rig();
    // each stroke takes the time that it is planned for
    let seen: Vec<bool> = bench.board.seen.iter().map(|seen| seen.light > 0.0).collect();
    let runs = |lit: Vec<bool>| -> Vec<usize> {
        lit.chunk_by(|a, b| a == b).filter(|run| run[0]).map(<[bool]>::len).collect()
    };
    let (took, wanted) = (runs(seen), runs(plan.points.iter().map(|p| p.lit).collect()));
    println!("strokes took {took:?} ms, planned {wanted:?}");
    assert_eq!(took.len(), wanted.len());
    for (took, wanted) in took.iter().zip(&wanted) {
        assert!((*took as f64 / *wanted as f64 - 1.0).abs() < 0.02, "{took} ms of {wanted}");
    }
    assert!(bench.board.most <= 127 && bench.driver.most_waiting() <= 127, "{}", bench.board.most);
    // a tick is told once the board has done it
    let last = bench.told.iter().rposition(|(_, told)| told.actuation.lights()).unwrap();
    let dark = bench.board.seen.iter().rposition(|seen| seen.light > 0.0).unwrap();
    let late = bench.told[last].0 as i64 - dark as i64;
    assert!((-20..200).contains(&late), "{late} ms");
}

#[test]
fn a_pause_is_dark_soon_and_what_was_not_done_is_drawn_after_it() {
    let config = config();
    let plan = plan(&config);
    for (after, when) in [300, 700, 1111, 1717, 2500]
        .into_iter()
        .flat_map(|after| [(after, When::AtOnce), (after, When::AfterStroke)])
    {
        let mut session = homed(&config);
        begin(&mut session, &plan);
        ticks(&mut session, after);
        let asked = session.rig().board.seen.len();
        session.request(Request::Pause(when)).unwrap();
        until(&mut session, State::Paused, 4000);
        let dark = session.rig().board.seen[asked..].iter().rposition(|seen| seen.light > 0.0).unwrap_or(0);
        assert!(when == When::AfterStroke || dark < 60, "dark after {dark} ms");
        ticks(&mut session, 500);
        session.request(Request::Resume).unwrap();
        until(&mut session, State::Done, 20_000);
        assert_drawn(&session, &plan, &config);
    }
}

#[test]
fn other_boards_and_other_zeros_are_drawn_on_as_well() {
    let config = config();
    let plan = plan(&config);
    let other = |reports_work, welcome, options, holds| {
        let mut board = Board::new(steps_a_degree(&config));
        (board.reports_work, board.welcome, board.options) = (reports_work, welcome, options);
        board.holds = holds;
        board
    };
    for board in [
        other(true, "Grbl 1.1h ['$' for help]", "[OPT:V,15,128]", 127),
        other(false, "GrblHAL 1.1f ['$' or '$HELP' for help]", "[OPT:VNM,35,1024,3,0]", 1023),
        other(true, "Grbl 3.7 [FluidNC v3.7.0 (wifi) '$' for help]", "[OPT:MPHS]", 127),
    ] {
        let mut session = homed_at(board, &config, PanTilt::new(77, -40));
        session.request(Request::Park).unwrap();
        until(&mut session, State::Ready, 5000);
        begin(&mut session, &plan);
        ticks(&mut session, 900);
        session.request(Request::Pause(When::AtOnce)).unwrap();
        until(&mut session, State::Paused, 4000);
        session.request(Request::Resume).unwrap();
        until(&mut session, State::Done, 20_000);
        assert_drawn(&session, &plan, &config);
    }
}

#[test]
fn stopped_it_is_dark_soon_and_goes_on_when_somebody_arms() {
    let config = config();
    let (mut session, plan) = (homed(&config), plan(&config));
    begin(&mut session, &plan);
    ticks(&mut session, 900);
    session.request(Request::Stop).unwrap();
    ticks(&mut session, 300);
    assert!(session.rig().board.knows_zero());
    session.request(Request::Arm).unwrap();
    ticks(&mut session, 50);
    session.request(Request::Resume).unwrap();
    until(&mut session, State::Done, 20_000);
    assert_drawn(&session, &plan, &config);
    // and it goes back to straight ahead
    session.request(Request::Park).unwrap();
    until(&mut session, State::Ready, 5000);
    ticks(&mut session, 300);
    assert_eq!(session.rig().board.seen.last().unwrap().at, [0.0, 0.0]);
}

#[test]
fn the_boards_own_button_stops_it_like_anybody() {
    let config = config();
    let (mut session, plan) = (homed(&config), plan(&config));
    begin(&mut session, &plan);
    ticks(&mut session, 800);
    session.rig_mut().board.press_hold();
    until(&mut session, State::Stopped, 1000);
    session.request(Request::Arm).unwrap();
    ticks(&mut session, 50);
    session.request(Request::Resume).unwrap();
    until(&mut session, State::Done, 20_000);
    assert_drawn(&session, &plan, &config);
}

#[test]
fn slower_it_takes_longer_and_is_drawn_as_well() {
    let config = config();
    let (mut session, plan) = (homed(&config), plan(&config));
    session.request(Request::Speed(0.5)).unwrap();
    begin(&mut session, &plan);
    until(&mut session, State::Done, 40_000);
    assert_drawn(&session, &plan, &config);
    let drawn = session.rig().board.seen.iter().filter(|seen| seen.light > 0.0).count();
    let share = drawn as f64 / plan.points.iter().filter(|p| p.lit).count() as f64;
    assert!((1.9..2.1).contains(&share), "{share}");
}

#[test]
fn alarms_refusals_and_silence_end_it_dark() {
    let config = config();
    let plan = plan(&config);
    let ended = |interfere: &dyn Fn(&mut Board)| {
        let mut session = homed(&config);
        begin(&mut session, &plan);
        ticks(&mut session, 900);
        interfere(&mut session.rig_mut().board);
        let gone = (0..10_000).find(|_| session.tick().is_none());
        assert!(gone.is_some() && session.state() == State::Lost);
        let mut bench = session.rig().clone();
        (0..400).for_each(|_| bench.pass());
        assert_eq!(bench.board.seen.last().unwrap().light, 0.0);
        bench.driver.trouble().unwrap().clone()
    };
    assert_eq!(ended(&|board| board.hit_stop()), Trouble::Alarm { code: 1 });
    let refused = ended(&|board| board.refuses = Some((board.lines.len() + 3, 33)));
    assert!(matches!(refused, Trouble::Refused { code: 33, .. }), "{refused:?}");
    assert!(matches!(ended(&|board| board.dead = true), Trouble::Silent { .. }));
    let reset = ended(&|board| board.hear(&[0x18]));
    assert!(matches!(reset, Trouble::Alarm { code: 3 } | Trouble::Reset), "{reset:?}");
}

#[test]
fn a_dot_is_lit_where_the_head_rests() {
    let config = config();
    let board = Board::new(steps_a_degree(&config));
    let mut session = Session::new(connected(board, &config).unwrap());
    // of a head that is not homed nobody knows where it was lit before
    ticks(&mut session, 10_000);
    session.request(Request::Arm).unwrap();
    session.request(Request::Seek).unwrap();
    ticks(&mut session, 20);
    session.request(Request::Mark(300)).unwrap();
    ticks(&mut session, 1500);
    let lit = session.rig().board.seen.iter().filter(|seen| seen.light == 1.0).count();
    assert!((200..=320).contains(&lit), "{lit} ms");
    assert_eq!(session.rig().board.seen.last().unwrap().light, 0.0);
}

#[test]
fn a_program_that_comes_later_knows_where_it_points() {
    let config = config();
    let mut session = homed(&config);
    ticks(&mut session, 100);
    let board = session.rig().board.clone();
    assert!(connected(board.clone(), &config).unwrap().driver.is_homed());
    // not after a reset by somebody else
    let mut board = board;
    board.hear(&[0x18]);
    board.pass();
    board.say();
    assert!(!connected(board, &config).unwrap().driver.is_homed());
}

#[test]
fn boards_that_are_set_otherwise_are_refused() {
    let config = config();
    let mut board = Board::new(steps_a_degree(&config));
    board.laser_mode = 0;
    let why = connected(board, &config).unwrap_err().to_string();
    assert!(why.contains("$32=1"), "{why}");
}
