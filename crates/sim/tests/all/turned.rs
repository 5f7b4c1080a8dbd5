//! A head that somebody turns, homes and has let out dots, by requests.

use tracelight_rig::{PanTilt, Phase};
use tracelight_session::{ARMED_TICKS, Job, Refused, Request, State, When};
use tracelight_sim::{RigConfig, Tick, job_of};
use tracelight_trajectory::turn;

use crate::session::{at_the_wall, step, steps, until};
use crate::shapes::{circle, plan_of, star};

#[test]
fn a_head_that_is_not_homed_is_turned_and_lets_out_dots_only_once_somebody_armed() {
    let config = RigConfig::report();
    let mut wall = at_the_wall(&config, 3);
    let lit = || job_of(&plan_of(&config, star(0.05)), false);
    wall.request(Request::Unhome).unwrap();
    assert_eq!(wall.state(), State::Unhomed);
    for request in [Request::Seek, Request::Mark(50), Request::Trace(lit())] {
        assert!(matches!(wall.request(request), Err(Refused::State { .. })));
    }
    wall.request(Request::Arm).unwrap();
    assert!(wall.request(Request::Trace(lit())).is_err(), "nobody knows where its strokes would fall");
    steps(&mut wall, ARMED_TICKS as usize + 1);
    assert_eq!(wall.state(), State::Unhomed, "arming is forgotten");
    wall.request(Request::Arm).unwrap();
    wall.request(Request::Seek).unwrap();
    assert!(wall.request(Request::Trace(lit())).is_err());
    wall.request(Request::Jog(lit())).unwrap();
    let turned = steps(&mut wall, 20_000);
    assert!(turned.iter().any(|t| t.angle_rad.pan.abs() > 0.02) && turned.iter().all(|t| !t.light));
    assert_eq!((wall.state(), wall.told().phase), (State::Homing, Phase::Dark));
    wall.request(Request::Mark(60)).unwrap();
    let dot = steps(&mut wall, 400).iter().filter(|t| t.light).count();
    assert!((40..=70).contains(&dot), "{dot}");
    wall.request(Request::Mark(60)).unwrap();
    wall.request(Request::Stop).unwrap();
    assert!(steps(&mut wall, 100).iter().skip(4).all(|t| !t.light) && wall.state() == State::Unhomed);
    wall.request(Request::Park).unwrap();
    assert_eq!(wall.state(), State::Parking);
    until(&mut wall, State::Unhomed, 8000);
    let counts = wall.rig().true_counts();
    wall.request(Request::Home(counts)).unwrap();
    until(&mut wall, State::Ready, 3);
}

#[test]
fn a_dot_on_the_way_of_a_job_falls_on_its_stroke_and_the_job_goes_on() {
    let config = RigConfig::report();
    let plan = plan_of(&config, circle(0.2));
    let mut wall = at_the_wall(&config, 0);
    wall.request(Request::Arm).unwrap();
    wall.request(Request::Trace(job_of(&plan, false))).unwrap();
    steps(&mut wall, 2500);
    assert!(wall.told().actuation.lights() && wall.request(Request::Mark(60)).is_err());
    wall.request(Request::Pause(When::AtOnce)).unwrap();
    until(&mut wall, State::Paused, 3);
    steps(&mut wall, 300);
    wall.request(Request::Mark(60)).unwrap();
    let dot = until(&mut wall, State::Paused, 100);
    let lit: Vec<&Tick> = dot.iter().filter(|t| t.light).collect();
    assert!((40..=70).contains(&lit.len()), "{}", lit.len());
    assert!(lit.iter().all(|t| t.spot.unwrap().distance(t.asked.unwrap()) < 1e-3));
    wall.request(Request::Mark(500)).unwrap();
    steps(&mut wall, 20);
    wall.request(Request::Disarm).unwrap();
    assert!(steps(&mut wall, 200).iter().skip(4).all(|t| !t.light));
    wall.request(Request::Resume).unwrap();
    until(&mut wall, State::Done, 20_000);
}

#[test]
fn a_head_is_jogged_in_the_dark_homed_or_not_and_parked_from_there() {
    let config = RigConfig::report();
    let mut wall = at_the_wall(&config, 0);
    let turned = |to: PanTilt<f64>, from: PanTilt<f64>| {
        Request::Jog(Job { segments: vec![turn(from, to, (0.5, 2.0))], ..Job::default() })
    };
    let (zero, there) = (PanTilt::default(), PanTilt::new(0.3, -0.1));
    for homed in [true, false] {
        let rests = if homed { State::Ready } else { State::Unhomed };
        assert_eq!(wall.state(), rests);
        wall.request(turned(there, zero)).unwrap();
        assert!(wall.request(Request::Arm).is_err() && wall.state() == State::Jogging);
        assert!(until(&mut wall, rests, 5000).iter().all(|t| !t.light));
        steps(&mut wall, 300);
        let at = step(&mut wall).angle_rad;
        assert!((at.pan - 0.3).abs() < 2e-3 && (at.tilt + 0.1).abs() < 2e-3, "{at:?}");
        // on its way back it is stopped, and goes on from wherever that is only by being parked
        wall.request(turned(zero, there)).unwrap();
        steps(&mut wall, 400);
        wall.request(Request::Stop).unwrap();
        assert_eq!(wall.state(), rests);
        steps(&mut wall, 1000);
        if homed {
            assert!(matches!(wall.request(turned(there, zero)), Err(Refused::Elsewhere { .. })));
            wall.request(Request::Arm).unwrap();
            let begun = wall.request(Request::Trace(job_of(&plan_of(&config, star(0.05)), false)));
            assert!(matches!(begun, Err(Refused::Elsewhere { .. })));
            wall.request(Request::Disarm).unwrap();
        }
        wall.request(Request::Park).unwrap();
        until(&mut wall, rests, 8000);
        let at = step(&mut wall).angle_rad;
        assert!(at.pan.abs() < 2e-3 && at.tilt.abs() < 2e-3, "{at:?}");
        wall.request(Request::Unhome).unwrap();
        step(&mut wall);
    }
}
