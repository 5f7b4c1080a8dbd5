//! A state that begins anew in place is one that begins.

#![allow(clippy::disallowed_methods, reason = "tests may ask the C library: they allow for the last digit")]

use tracelight_board::Start;
use tracelight_control::{Carried, Controller, State};
use tracelight_rig::{Command, Measurement, PanTilt, RateLimit, Segment, Sensed, Telemetry};
use tracelight_sim::RigConfig;

/// A move to and fro, lit the second time.
fn segment(number: u32) -> Segment {
    let way = if number.is_multiple_of(2) { 0.02_f32 } else { -0.02 };
    let from = if number.is_multiple_of(2) { 0.0 } else { 0.02 };
    let n = 200.0_f32;
    let quintic = [from, 0.0, 0.0, 10.0 * way / n.powi(3), -15.0 * way / n.powi(4), 6.0 * way / n.powi(5)];
    Segment {
        start_tick: 200 * number,
        ticks: 200,
        coefficients: PanTilt::new(quintic, quintic.map(|c| -c)),
        tolerance_rad: PanTilt::new(0.05, 0.05),
        gate: number % 3 == 1,
        rate_limit: RateLimit::PLANNED,
    }
}

/// What is sensed of joints that follow somehow.
fn sensed(tick: u32) -> Sensed {
    let at = (0.01 * f64::from(tick)).sin() * 12.0;
    let measured = |count: f64| Measurement {
        count: count as i32,
        edge_age_ticks: tick.is_multiple_of(3).then_some(0.4),
    };
    Sensed { encoders: PanTilt::new(measured(at), measured(-0.5 * at)), ..Sensed::default() }
}

/// Ticks with all that a host says: a job that is slowed, paused, left and begun again.
fn told(controller: &Controller, state: &mut State<8>, ticks: u32) -> Vec<Telemetry> {
    let mut next = 0;
    (0..ticks)
        .map(|tick| {
            let mut say = |command| controller.accept(state, command).is_ok();
            say(Command::KeepAlive);
            match tick {
                5 | 700 => _ = say(Command::Arm { acknowledges: 0 }),
                300 => _ = say(Command::Speed(0.5)),
                650 => _ = say(Command::Disarm),
                1200 => _ = say(Command::Abandon),
                1500 => _ = say(Command::Home(PanTilt::new(3, -4))),
                _ => {}
            }
            // what does not join is taken, and a fault
            for _ in 0..2 {
                next += u32::from(say(Command::Append(segment(next))));
            }
            controller.tick(state, &sensed(tick))
        })
        .collect()
}

#[test]
fn a_state_that_is_renewed_is_that_of_a_controller_that_begins() {
    for rig in RigConfig::presets() {
        let controller = Controller::new(rig.control_config());
        for (is_absolute, home, carried) in [
            (false, None, None),
            (true, None, None),
            (
                false,
                Some(PanTilt::new(0, 0)),
                Some(Carried { heat: PanTilt::new(0.4, 0.1), shut_ticks: 900 }),
            ),
        ] {
            let start = Start { tick: 77, is_absolute, home, carried };
            let mut used: State<8> = controller.start_homed(&sensed(0));
            for ticks in [0, 40, 333, 1100, 1900] {
                told(&controller, &mut used, ticks);
                start.renew(&controller, &sensed(0), &mut used);
                let mut fresh: State<8> = start.state(&controller, &sensed(0));
                assert_eq!(used.is_homed(), fresh.is_homed());
                let (renewed, begun) =
                    (told(&controller, &mut used, 1700), told(&controller, &mut fresh, 1700));
                assert!(renewed == begun, "{}: after {ticks}", rig.name);
                assert!(
                    begun.iter().any(|told| told.plan_tick > 100) || !fresh.is_homed(),
                    "nothing was run"
                );
            }
        }
    }
}
