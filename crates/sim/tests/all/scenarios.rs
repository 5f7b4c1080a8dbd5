//! What goes wrong at a board's pins and its line, as `tests/faults.json` has it for all who can suffer it: here the simulated head, with a controller in
//! this process and with a board behind a wire. The emulated firmware suffers the same (`firmware/emulator/faults.mjs`).

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test that cannot go on may panic, and shows figures"
)]

use std::ops::ControlFlow;

use serde_json::Value;
use tracelight_rig::{Input, InputState, Joint};
use tracelight_sim::{LinkSettings, RigConfig, Simulated, SimulatedRig, Tick, Trouble, run};

use crate::shapes::{POSE, circle, lit_ticks, plan_of};

const MOMENTS: u64 = 20;
const COUNT_RAD: f64 = std::f64::consts::TAU / 4096.0;

fn input(name: &str) -> Input {
    match name {
        "emergency-stop" => Input::EmergencyStop,
        "lid" => Input::Lid,
        "key" => Input::Key,
        "amplifier-pan" => Input::Amplifier(Joint::Pan),
        _ => Input::Amplifier(Joint::Tilt),
    }
}

/// What a scenario does to the simulated head; `None` for what it cannot suffer: it has neither lines nor a processor.
fn trouble(scenario: &Value, joint: Joint, is_wired: bool) -> Option<Trouble> {
    if let Some(name) = scenario["open"].as_str() {
        // a spark is shorter than a tick
        return scenario["lasts_ms"].is_null().then(|| Trouble::Input(input(name), InputState::Open));
    }
    if scenario["silent"] == true {
        return is_wired.then(|| Trouble::HostStall(scenario["lasts_ms"].as_u64().unwrap_or(1500) as u32));
    }
    let is_cut = scenario["cut"].as_array().is_some_and(|lines| lines.len() == 2);
    is_cut.then_some(Trouble::EncoderCut(joint))
}

#[test]
fn what_goes_wrong_at_pins_and_line_goes_dark_in_time() {
    let scenarios: Vec<Value> = serde_json::from_str(include_str!("../faults.json")).unwrap();
    let config = RigConfig::report();
    let plan = plan_of(&config, circle(0.2));
    let lit = lit_ticks(&plan);
    let mut tried = 0;
    for (scenario, is_wired) in scenarios.iter().flat_map(|one| [(one, false), (one, true)]) {
        let mut slowest = None;
        for seed in 0..MOMENTS {
            let joint = Joint::BOTH[seed as usize % 2];
            let Some(trouble) = trouble(scenario, joint, is_wired) else { continue };
            let when = lit[oorandom::Rand64::new(seed.into()).rand_range(0..lit.len() as u64 / 2) as usize];
            let mut rig = SimulatedRig::new(&config, POSE, seed);
            if is_wired {
                rig = rig.behind_wire(LinkSettings::default(), seed);
                rig.step();
            }
            let mut is_done = false;
            let watch = |rig: &mut SimulatedRig, tick: &Tick| {
                if tick.telemetry.plan_tick == when as u32 && !std::mem::replace(&mut is_done, true) {
                    rig.suffer(trouble);
                }
                ControlFlow::Continue(())
            };
            let ran = run(&mut rig, &plan, false, watch);
            let took = dark_after(&ran.ticks, when as u32, joint, scenario);
            let bound = scenario["dark_ms"].as_f64().unwrap().ceil() as usize;
            let name = scenario["name"].as_str().unwrap();
            assert!(took <= bound, "{name}, seed {seed}, behind a wire {is_wired}: dark after {took} ms");
            if let Some(fault) = scenario["fault"].as_str() {
                assert_eq!(ran.fault().map(|fault| fault.code()), Some(fault), "{name}, seed {seed}");
            }
            assert!(scenario["goes_on"].is_null() || ran.is_done(), "{name}, seed {seed}: it did not go on");
            slowest = slowest.max(Some(took));
        }
        if let Some(slowest) = slowest {
            tried += 1;
            println!("{}, behind a wire {is_wired}: {slowest} ms at most", scenario["name"]);
        }
    }
    assert!(tried > 8, "{tried}");
}

/// Ticks from when it could be seen until the gate was shut.
fn dark_after(ticks: &[Tick], when: u32, joint: Joint, scenario: &Value) -> usize {
    let at = ticks.iter().position(|tick| tick.telemetry.plan_tick == when).unwrap();
    let counts = scenario["after_counts"].as_f64().unwrap_or_default();
    let from = ticks[at].angle_rad[joint];
    let moved = |tick: &Tick| (tick.angle_rad[joint] - from).abs() >= counts * COUNT_RAD;
    let seen = ticks[at..].iter().position(moved).unwrap_or(0);
    let shut = ticks[at..].iter().position(|tick| !tick.telemetry.actuation.gate).unwrap_or(usize::MAX);
    shut.saturating_sub(seen)
}
