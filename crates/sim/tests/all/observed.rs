//! What encoders tell of a head, held against what is true of it.

use tracelight_aim::HeadPose;
use tracelight_rig::{Command, Rig, Telemetry};
use tracelight_session::{Request, Session, State};
use tracelight_sim::{
    ByEncoders, LightFrom, Observed as _, Origin, RigConfig, Simulated as _, SimulatedRig, Tick, job_of,
    observed_tick,
};

use crate::shapes::{self, POSE};

/// A rig that tells its telemetry alone, and keeps what was true.
struct Mute(SimulatedRig, Vec<Tick>, usize);

impl Rig for Mute {
    fn send(&mut self, command: Command) -> Result<(), Command> {
        self.0.send(command)
    }

    fn next(&mut self) -> Option<Telemetry> {
        self.2 = self.2.checked_sub(1)?;
        let tick = self.0.step();
        self.1.push(tick);
        Some(tick.telemetry)
    }
}

/// Draws a star by its encoders alone: what they told, and what was true.
fn drawn(config: &RigConfig, ticks: usize) -> (Vec<Tick>, Vec<Tick>, State) {
    let plan = shapes::plan_of(config, shapes::star(0.2));
    let mute = Mute(SimulatedRig::new(config, POSE, 3), Vec::new(), ticks);
    let mut rig = ByEncoders::new(mute, config, POSE, true);
    assert_eq!(rig.origin(), Origin { simulated: true, light_from: LightFrom::Encoders });
    let mut told = Vec::new();
    let state = {
        let mut wall = Session::new(&mut rig);
        told.extend(observed_tick(&mut wall));
        wall.request(Request::Arm).unwrap();
        wall.request(Request::Trace(job_of(&plan, false))).unwrap();
        while wall.state() != State::Done
            && let Some(tick) = observed_tick(&mut wall)
        {
            told.push(tick);
        }
        wall.state()
    };
    let true_ticks = std::mem::take(&mut rig.rig_mut().1);
    (told, true_ticks, state)
}

#[test]
fn encoders_tell_of_a_sound_head_what_is_true() {
    let config = RigConfig::report();
    let (told, truth, state) = drawn(&config, usize::MAX);
    assert_eq!((told.len(), state), (truth.len(), State::Done));
    let mut lit = (0, 0);
    for (told, truth) in told.iter().zip(&truth) {
        assert_eq!((told.telemetry, told.asked), (truth.telemetry, truth.asked));
        lit = (lit.0 + u32::from(truth.light), lit.1 + u32::from(told.light));
        if truth.light {
            let off_m = told.spot.unwrap().distance(truth.spot.unwrap());
            assert!(off_m < 2e-4, "{off_m} m at tick {}", truth.telemetry.tick);
        }
    }
    assert!(lit.0 > 1000, "{lit:?}");
    assert!(lit.0.abs_diff(lit.1) < 10, "{lit:?}");
}

#[test]
fn a_head_that_stands_elsewhere_is_told_where_it_was_said_to_stand() {
    let config = RigConfig::report();
    let plan = shapes::plan_of(&config, shapes::star(0.2));
    let moved = HeadPose { right_m: 0.03, ..POSE };
    let rig = SimulatedRig::new(&config, POSE, 3).standing(moved);
    let mut rig = ByEncoders::new(Mute(rig, Vec::new(), usize::MAX), &config, POSE, true);
    let wall = &mut Session::new(&mut rig);
    observed_tick(wall);
    wall.request(Request::Arm).unwrap();
    wall.request(Request::Trace(job_of(&plan, false))).unwrap();
    for _ in 0..1000 {
        observed_tick(wall);
    }
    let told = observed_tick(wall).unwrap();
    let truth = wall.rig().rig().1.last().unwrap();
    let off = truth.spot.unwrap() - told.spot.unwrap();
    assert!((off.x - 0.03).abs() < 3e-3, "{off:?}");
}

#[test]
fn a_rig_that_is_gone_ends_the_session_and_nothing_is_told_of_it_any_more() {
    let (told, truth, state) = drawn(&RigConfig::report(), 900);
    assert_eq!((told.len(), truth.len(), state), (900, 900, State::Lost));
}
