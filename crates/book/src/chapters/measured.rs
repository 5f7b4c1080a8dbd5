//! What was measured on the rig: friction, and speed from counts.

use tracelight_rig::Joint;
use tracelight_sim::RigConfig;

use super::{MILLI, Places, command, own, text};
use crate::chapter::{Chapter, Done, Joined, Part, Run};
use crate::table::{Cell, Compared, Table};

/// The report's Tables 1 and 2, mN m s/rad and mN m.
const TABLES: [(&str, [f64; 4]); 2] = [("pan", [0.9, 0.9, 40.6, -38.5]), ("tilt", [1.9, 1.7, 58.4, -56.9])];
const NAMES: [(&str, &str, &str); 4] = [
    ("viscous_pos", "viscous, forwards", "mN m s/rad"),
    ("viscous_neg", "viscous, backwards", "mN m s/rad"),
    ("coulomb_pos", "Coulomb, forwards", "mN m"),
    ("coulomb_neg", "Coulomb, backwards", "mN m"),
];

impl Places<'_> {
    pub(super) fn friction(&self) -> Chapter {
        let b = self.friction_test(
            "Figures 2 to 4, Tables 1 and 2, on parameter set B: speeds over time, torque over speed",
            "friction",
            "B",
            ", last speeds",
            "/steady",
        );
        let b = with_times(b, "30 s are several of them: the speeds are steady", "30 s are many of them")
            .scaled(
                "pan: speed after 30 s at 1 V",
                None,
                "/pan/steady/points/40/velocity_rad_s",
                (1.0, "rad/s"),
                "as Table 1 has it, (0.0619 − 0.0406) / 0.0009; but the axis of the report's figure 3 ends at 15 rad/s: either its last points are not on it, or \
                 pan was not given 1 V",
            )
            .scaled(
                "tilt: speed after 30 s at 1 V",
                None,
                "/tilt/steady/points/40/velocity_rad_s",
                (1.0, "rad/s"),
                "fits on the axis of figure 4, which ends at 15 rad/s",
            );
        let a = self.friction_test(
            "The same on parameter set A",
            "friction-a",
            "A",
            ", set A, last speeds",
            "/steady",
        );
        let a = with_times(a, "longer than a trial: nothing is steady", "longer than a trial");
        let a = tables(
            a,
            ", set A, whole curves",
            "",
            "the equation of motion fitted to the whole of each curve needs no steady speed",
        );
        Chapter {
            title: "2.1 Friction identification",
            parts: vec![
                text(
                    "Voltages of −1 to 1 V in steps of 0.05 V, 30 s each after a pulse of 1 V against stiction; the speed at the end is taken for \
                      steady, and a line laid through torque over speed for each direction. The report has two sets of masses: A in its model file \
                      (pantiltmodel.m), where the rotors' inertia is multiplied by the square of the gear ratio, and B in the start file of its simulation, \
                      where the same number is the inertia \"as seen by encoder\". They differ by a factor of 20 in what a motor has to turn.",
                ),
                text(
                    "On set B the report's protocol, followed to the letter, gives the report's own tables back within 0.2 %. On set A the time constant J/Fv is longer \
                      than a trial, and the same protocol finds a viscous friction several times too large, along perfectly straight lines. The report is at one \
                      with itself on set B; its linear model and compensators (2.4, 2.5), which are set A's, are what stands apart.",
                ),
                text(
                    "On its feet the head could not have been tested so: 1 V is 0.077 N m at tilt, and gravity there is more on either set. Each axis stands upright here, \
                      free to turn on and on.",
                ),
                Part::Run(b),
                Part::Run(a),
                Part::Facts("Torque a volt", torque()),
            ],
        }
    }

    /// The test on one of the sets, and the report's tables beside what the report's own reading finds.
    fn friction_test(&self, caption: &str, folder: &str, set: &str, how: &str, at: &str) -> Run {
        let folder = self.out.join(folder);
        let out = folder.display().to_string();
        let mut run = command(caption, &["lab", "friction", "--set", set, "--fixture", "--out", &out]);
        run.figure = Some(folder.join("friction.svg"));
        let why = if set == "B" {
            "the report's own reading: a line through the last speeds"
        } else {
            "the speeds are not steady yet"
        };
        tables(run, how, at, why)
    }

    pub(super) fn velocity(&self) -> Chapter {
        let speeds = ["lab", "velocity", "--speeds", "0.1ft/s,1ft/s,3ft/s"];
        let run = command("Velocity and acceleration from counts", &speeds)
            .drawn(self, "velocity.svg")
            .scaled(
                "highest speed of pan, estimated, the spot at up to 3 ft/s",
                None,
                "/highest/pan/velocity_rad_s",
                (1.0, "rad/s"),
                "of a spot that draws a circle; the motors' own limits stand below",
            )
            .scaled(
                "highest acceleration of pan, estimated",
                None,
                "/highest/pan/acceleration_rad_s2",
                (1.0, "rad/s²"),
                "an estimate from counts, which is above the truth: what noise adds counts as acceleration",
            );
        let best = Joined {
            caption: "The interval with the smallest error of the speed, at each speed of the spot",
            runs: vec![command("", &speeds)],
            show: Box::new(intervals),
        };
        Chapter {
            title: "2.2 Velocity estimation",
            parts: vec![
                text(
                    "The report counts pulses over a fixed interval, finds the readings erratic where it is short, looks for an ideal \
                      sampling time and thinks of a washout filter. One count in a millisecond is 1.5 rad/s, and the spot at 1 ft/s is 0.33. Each \
                      way is played the counts of the same runs; dashed is a Kalman filter that knows the equation of motion.",
                ),
                Part::Run(run),
                text(
                    "There is no one ideal sampling time: the faster the joint turns, the shorter the interval that serves it best. An interval that is the longest of those \
                      tried is no optimum; a longer one would do better still.",
                ),
                Part::Joined(best),
                text(
                    "The report wanted the motors' own highest speed and acceleration for its profiles, and put 24 rad/s and 100 rad/s². By its own numbers the amplifiers' \
                      ±10 V give this, each axis upright:",
                ),
                Part::Facts("What the motors give", motors()),
            ],
        }
    }
}

/// The report's tables beside what a run found at a place of its answer.
fn tables(mut run: Run, how: &str, at: &str, why: &str) -> Run {
    for (joint, table) in TABLES {
        for ((name, words, unit), value) in NAMES.into_iter().zip(table) {
            let what = format!("{joint}: {words}{how}");
            run = run.scaled(&what, value, &format!("/{joint}{at}/{name}"), (MILLI, unit), why);
        }
    }
    run
}

fn with_times(run: Run, pan: &str, tilt: &str) -> Run {
    run.scaled("pan: time constant J/Fv", None, "/pan/time_constant_s", (1.0, "s"), pan).scaled(
        "tilt: time constant J/Fv",
        None,
        "/tilt/time_constant_s",
        (1.0, "s"),
        tilt,
    )
}

/// Torque at the joint for a volt at the amplifier: what the report prints, and what its ratio comes to.
fn torque() -> Vec<Compared> {
    const NM_PER_A: f64 = 0.0432;
    const A_PER_V: f64 = 0.1;
    let preset = RigConfig::report().model.motors;
    vec![
        own(
            "torque a volt, at tilt",
            0.077_389,
            preset.tilt.torque_nm_per_v,
            "N m/V",
            "0.1 A/V × 0.0432 N m/A × 6.3 × 2.8435, the ratio of the report's scripts",
        ),
        own(
            "the same with the ratio of the report's equation",
            0.077_389,
            A_PER_V * NM_PER_A * 6.3 * (2.47 / 0.869),
            "N m/V",
            "the equation has 2.47/.869 = 2.8423, which does not come to the number printed below it; the scripts' 2.8435 does, and is used here",
        ),
        own(
            "torque a volt, at pan",
            None,
            preset.pan.torque_nm_per_v,
            "N m/V",
            "its amplifier gave 0.08 A/V with the motor turning, and the report used that; unplugged it gave 0.1 A/V",
        ),
        own(
            "tilt: viscous friction, forwards",
            0.19,
            MILLI * RigConfig::report_b().model.friction.tilt.viscous_pos,
            "mN m s/rad",
            "the start files have fv2 = 0.00019, Table 2 has 0.0019: taken for a slip, and Table 2 used on both sets here",
        ),
    ]
}

/// What the motors can do by the report's numbers, against friction.
fn motors() -> Vec<Compared> {
    let mut facts = Vec::new();
    for (set, rig) in [("B", RigConfig::report_b()), ("A", RigConfig::report())] {
        let model = rig.model;
        for joint in Joint::BOTH {
            let friction_nm = model.friction[joint].coulomb_pos_nm;
            let left_nm = model.motors[joint].torque_limit_nm() - friction_nm;
            facts.push(own(
                &format!("{joint}: highest acceleration, set {set}"),
                100.0,
                left_nm / model.own_inertia_kg_m2()[joint],
                "rad/s²",
                if set == "B" {
                    "the report's 100 rad/s² are within reach"
                } else {
                    "the report's 100 rad/s² are out of reach"
                },
            ));
        }
    }
    let model = RigConfig::report().model;
    facts.push(own(
        "pan: speed at which viscous friction takes all of it, either set",
        None,
        (model.motors.pan.torque_limit_nm() - model.friction.pan.coulomb_pos_nm) / model.friction.pan.viscous_pos,
        "rad/s",
        "the amplifiers drive a current, and the report has no back-EMF in its model: its 24 rad/s come from elsewhere",
    ));
    facts
}

/// For each speed and observer the interval of the smallest error.
fn intervals(done: &[Done]) -> Table {
    let none = Vec::new();
    let errors = done.first().and_then(|(answer, _)| answer["errors"].as_array()).unwrap_or(&none);
    let number = |row: &serde_json::Value, name: &str| row[name].as_f64();
    let longest = errors.iter().filter_map(|row| number(row, "interval_ms")).fold(0.0, f64::max);
    let mut speeds: Vec<f64> = errors.iter().filter_map(|row| number(row, "speed_m_s")).collect();
    speeds.sort_by(f64::total_cmp);
    speeds.dedup();
    let observers = ["differences", "washout", "edge-times"];
    let best = |speed: f64, observer: &str| {
        let of = errors
            .iter()
            .filter(|row| row["observer"] == observer && number(row, "speed_m_s") == Some(speed));
        let pairs = of.filter_map(|row| number(row, "interval_ms").zip(number(row, "velocity_rms_rad_s")));
        pairs.min_by(|a, b| a.1.total_cmp(&b.1))
    };
    let row = |&speed: &f64| {
        let mut cells = vec![Cell::number(Some(speed / 0.3048), "ft/s")];
        for observer in observers {
            cells.push(Cell::words(match best(speed, observer) {
                Some((ms, rms)) => {
                    let end = if ms >= longest { ", the longest tried" } else { "" };
                    format!("{ms} ms{end} ({:.3} rad/s rms)", rms)
                }
                None => "–".to_owned(),
            }));
        }
        cells
    };
    let heads = ["spot", "counts over an interval", "washout", "edges, timed"];
    Table {
        heads: heads.map(str::to_owned).to_vec(),
        rows: speeds.iter().map(row).collect(),
        finding: String::new(),
    }
}
