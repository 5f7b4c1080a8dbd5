//! The budget by itself, of a spot that is here and there at once: what no head can do, and a table is most easily overrun by.

use std::f64::consts::{FRAC_PI_2, PI};

use tracelight_control::{Config, LightBudget};
use tracelight_rig::PanTilt;
use tracelight_sim::RigConfig;

const TICKS: u32 = 12_000;

fn config(standing_ticks: u32) -> Config {
    Config { standing_ticks, laser_off_ticks: 0, ..RigConfig::report().control_config() }
}

/// Where a beam goes on the unit sphere.
fn direction(angle_rad: PanTilt<f32>) -> [f64; 3] {
    let PanTilt { pan, tilt } = angle_rad.map(f64::from);
    [tilt.cos() * pan.cos(), tilt.cos() * pan.sin(), tilt.sin()]
}

/// The most light in a cone about one direction beyond a tenth of the time, of what the budget lets through, ticks.
fn most(config: &Config, asked: impl Fn(u32) -> PanTilt<f32>, centre: PanTilt<f32>) -> f64 {
    let mut budget = LightBudget::new();
    let still = PanTilt::new(0.0, 0.0);
    let (mut gate, mut held, mut most) = (false, 0.0_f64, 0.0_f64);
    let middle = direction(centre);
    for tick in 0..TICKS {
        let at = asked(tick);
        budget.tick(config, Some(at), gate, None);
        let shines = gate;
        gate = !budget.is_spent(config, Some((asked(tick + 1), still)));
        let off = direction(at).iter().zip(&middle).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
        let lit = shines && off <= f64::from(config.standing_radius_rad);
        held = (held - 0.1).max(0.0) + f64::from(u8::from(lit));
        most = most.max(held);
    }
    most
}

#[test]
fn light_straight_up_or_behind_is_in_one_place_however_joints_turn_there() {
    let config = config(500);
    // tilt at the pole while pan goes round, pan from either side to what is behind, and one place from over the pole
    let up = |tick: u32| PanTilt::new(1e-3 * tick as f32 % 6.0 - 3.0, FRAC_PI_2 as f32);
    assert!(most(&config, up, PanTilt::new(0.0, FRAC_PI_2 as f32)) <= 500.0);
    let behind = |tick: u32| PanTilt::new(if tick.is_multiple_of(2) { PI as f32 } else { -PI as f32 }, 0.1);
    assert!(most(&config, behind, PanTilt::new(PI as f32, 0.1)) <= 500.0);
    let over = |tick: u32| match tick % 2 {
        0 => PanTilt::new(0.3, 1.5),
        _ => PanTilt::new((0.3 - PI) as f32, (PI - 1.5) as f32),
    };
    let most = most(&config, over, PanTilt::new(0.3, 1.5));
    assert!((400.0..=500.0).contains(&most), "{most}");
}

/// Places that are visited in turn, more of them than the table has, so that a place is always dropped for another; and one that is come back to.
#[test]
fn nothing_is_forgotten_where_more_places_are_lit_than_the_table_has() {
    for (places, visit, home) in
        [(40, 1, 1), (33, 3, 9), (100, 1, 4), (12, 20, 60), (64, 2, 40), (9, 100, 100)]
    {
        let config = config(200);
        let asked = |tick: u32| {
            let round = places * visit + home;
            let within = tick % round;
            if within < home {
                PanTilt::new(0.0, 0.2)
            } else {
                PanTilt::new(0.05 * ((within - home) / visit + 1) as f32, -0.3)
            }
        };
        let most = most(&config, asked, PanTilt::new(0.0, 0.2));
        assert!(most <= 200.0, "{places} places: {most}");
    }
}

/// Fast strokes all over leave next to nothing that a new place is charged with.
#[test]
fn a_spot_that_moves_is_never_dark() {
    let config = config(1000);
    let mut budget = LightBudget::new();
    for tick in 0..200_000_u32 {
        let t = 1e-3 * f64::from(tick);
        // 0.3 m/s at 3 ft, over and over the same picture of half a metre
        let at = PanTilt::new((0.27 * (1.21 * t).sin()) as f32, (0.2 * (1.37 * t + 0.3).sin()) as f32);
        budget.tick(&config, Some(at), true, None);
        assert!(!budget.is_spent(&config, Some((at, PanTilt::new(0.0, 0.0)))), "{tick}");
    }
}

/// A controller that begins anew knows how long it was dark, and not where it was lit: it lets no more through than one that had gone on would.
#[test]
fn who_begins_anew_after_a_dark_time_lets_no_more_through() {
    let config = config(500);
    let (at, still) = (PanTilt::new(0.1, 0.2), PanTilt::new(0.0, 0.0));
    for dark_ticks in (0..9000).step_by(250) {
        let mut budget = LightBudget::new();
        let (mut gate, mut held, mut most, mut again) = (false, 0.0_f64, 0.0_f64, 0);
        let mut pass = |budget: &mut LightBudget, gate: &mut bool, wants: bool| {
            budget.tick(&config, Some(at), *gate, None);
            held = (held - 0.1).max(0.0) + f64::from(u8::from(*gate));
            most = most.max(held);
            *gate = wants && !budget.is_spent(&config, Some((at, still)));
            u32::from(*gate)
        };
        (0..1000).for_each(|_| _ = pass(&mut budget, &mut gate, true));
        (0..dark_ticks).for_each(|_| _ = pass(&mut budget, &mut gate, false));
        let shut_ticks = budget.shut_ticks();
        let mut anew = LightBudget::spent(&config, shut_ticks);
        assert_eq!(anew.shut_ticks(), shut_ticks, "{dark_ticks}: also of the one after that");
        let opens_in = anew.opens_in_ticks(&config);
        (0..9000).for_each(|_| again += pass(&mut anew, &mut gate, true));
        assert!(most <= 500.0, "{dark_ticks}: {most}");
        // and it keeps nobody waiting for longer than it says, nor for ever
        assert!(opens_in <= 2600 && again > 300, "{dark_ticks}: in {opens_in}, lit {again}");
        assert!(dark_ticks < 2600 || opens_in == 0, "{dark_ticks}: in {opens_in}");
    }
    assert_eq!(LightBudget::spent(&config, u32::MAX).opens_in_ticks(&config), 0, "it was never lit");
}
