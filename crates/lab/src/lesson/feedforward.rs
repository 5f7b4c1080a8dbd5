use tracelight_maths::cos;
use tracelight_rig::{Joint, PanTilt, TICK_F64_S};
use tracelight_sim::{Between, Feedforward, HandTuned, MotionArray, RigConfig, follow_array};

use super::check::Check;
use super::experiment::{Experiment, Quantity};
use super::question::{Ask, Lesson};
use super::rigs::{driven, pid};

/// What is known of a head need not be found out by its errors.
pub(super) const LESSON: Lesson = Lesson {
    number: 7,
    title: "Feedforward: knowing beats correcting",
    asks: &[
        Ask {
            name: "inertia", unit: "kg m²", bounds: (1e-3, 10.0), meaning: "what pan's motor has to turn"
        },
        Ask { name: "coulomb", unit: "N m", bounds: (0.0, 10.0), meaning: "friction whatever the speed" },
        Ask { name: "viscous", unit: "N m s/rad", bounds: (0.0, 10.0), meaning: "friction per speed" },
    ],
    examples: &[
        ("the model as it was", &[0.076, 0.04, 0.0009]),
        ("its inertia right, its friction as it was", &[0.104, 0.04, 0.0009]),
    ],
    panels: &[(0, Quantity::Error), (0, Quantity::Command)],
    rig: Some(heavy),
    run,
    check,
};

const KP: f64 = 10.0;
const KD: f64 = 0.5;

/// The rig after somebody put a bigger laser on it and forgot the grease; its model does not know.
fn heavy() -> RigConfig {
    let mut rig = RigConfig::report();
    rig.name = "heavy".into();
    rig.description =
        "the rig of the 2006 report with a bigger laser and stiff grease, of which its model knows nothing"
            .into();
    let truth = &mut rig.truth.model;
    truth.set_own_inertia(Joint::Pan, 0.104);
    let friction = &mut truth.friction.pan;
    (friction.coulomb_pos_nm, friction.coulomb_neg_nm) = (0.083, -0.083);
    (friction.viscous_pos, friction.viscous_neg) = (0.021, 0.021);
    rig
}

/// To and fro by 20°, each swing a second and a half.
fn swing() -> Option<MotionArray> {
    const REACH_RAD: f64 = 0.35;
    const PERIOD_S: f64 = 1.5;
    let row = |k: u32| {
        let time_s = 0.025 * f64::from(k);
        let turn = std::f64::consts::TAU * time_s / PERIOD_S;
        (time_s, PanTilt::new(0.5 * REACH_RAD * (1.0 - cos(turn)), 0.0))
    };
    let rows: Vec<(f64, PanTilt<f64>)> = (0..=120).map(row).collect();
    MotionArray::new(&rows, Between::Spline).ok()
}

fn run(values: &[f64]) -> Vec<Experiment> {
    let (Some(swing), &[inertia_kg_m2, coulomb_nm, viscous]) = (swing(), values) else { return Vec::new() };
    let mut rig =
        driven(heavy(), Joint::Pan, HandTuned { feedforward: Feedforward::Model, ..pid(KP, 0.0, KD) });
    rig.control.observer = Some(tracelight_sim::ObserverName::KalmanModel);
    rig.model.set_own_inertia(Joint::Pan, inertia_kg_m2);
    let friction = &mut rig.model.friction.pan;
    (friction.coulomb_pos_nm, friction.coulomb_neg_nm) = (coulomb_nm, -coulomb_nm);
    (friction.viscous_pos, friction.viscous_neg) = (viscous, viscous);
    let ticks = follow_array(&rig, &swing, 0.5, 0);
    vec![Experiment { name: "pan, to and fro by 20°".into(), joint: Joint::Pan, ticks }]
}

fn check(_: &[f64], experiments: &[Experiment]) -> Vec<Check> {
    let [experiment] = experiments else { return Vec::new() };
    let moving = (3.0 / TICK_F64_S) as usize;
    let errors = experiment.ticks.iter().take(moving).map(|tick| Quantity::Error.of(tick, Joint::Pan));
    let (count, squares) = errors.clone().fold((0.0, 0.0), |(n, sum), e| (n + 1.0, sum + e * e));
    let worst = errors.map(f64::abs).fold(0.0, f64::max);
    const HINT: &str = "the model does not know this head: write it with -o heavy.toml and identify it with \
                        `tracelight lab friction --rig heavy.toml`";
    vec![
        Check::at_most("error, rms", (squares / f64::max(count, 1.0)).sqrt(), 0.3, "mm", HINT),
        Check::at_most("error, at most", worst, 1.0, "mm", HINT),
    ]
}
