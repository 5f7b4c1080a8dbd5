use super::{MILLI, Places, command, own, text};
use crate::chapter::{Chapter, Done, Joined, Part, Run};
use crate::readings::{self, controller};
use crate::table::{Cell, Compared, Kind, Table};
use crate::{counts, given};

/// PD in a reading: what its gains are multiplied by, in continuous time.
fn pd(factor: f64) -> [String; 3] {
    const DERIVATIVE: &str = "s/(1 + s/50)";
    ["--controller".into(), controller(factor, 10.0, DERIVATIVE), controller(factor, 5.0, DERIVATIVE)]
}

impl Places<'_> {
    pub(super) fn profiles(&self) -> Chapter {
        let limits = ["--vmax", "24rad/s", "--amax", "100rad/s2", "--dmax", "100rad/s2"];
        let one = |caption: &str, profile: &str| {
            let arguments =
                [&["lab", "profile", "--distance", "180deg"], &limits[..], &["--profile", profile]].concat();
            command(caption, &arguments).drawn(self, &format!("{profile}.svg"))
        };
        let s_curve = one("Figure 12: S-curve over half a turn", "s-curve")
            .scaled("S-curve: duration", 0.3905, "/duration_s", (1.0, "s"), "")
            .scaled("S-curve: highest speed", 16.09, "/peak_rad_s", (1.0, "rad/s"), "");
        let trapezoid = one("Figure 13: trapezoid over half a turn", "trapezoid")
            .scaled(
                "trapezoid: duration",
                0.3545,
                "/duration_s",
                (1.0, "s"),
                "2 √(π/100): 24 rad/s are never reached",
            )
            .scaled("trapezoid: highest speed", 17.72, "/peak_rad_s", (1.0, "rad/s"), "");
        let others = command(
            "Sine and sigmoid, which the report names, and two more",
            &[
                &["lab", "profile", "--distance", "180deg"],
                &limits[..],
                &["--profile", "sine,cycloid,sigmoid,quintic"],
            ]
            .concat(),
        )
        .drawn(self, "profiles.svg");
        Chapter {
            title: "2.6.1 S-curve and trapezoidal method",
            parts: vec![
                text(
                    "From 0 to π with at most 24 rad/s and 100 rad/s². On set B the motors can do that; on set A they cannot (2.2 has what they give).",
                ),
                Part::Run(s_curve),
                Part::Run(trapezoid),
                Part::Run(others),
            ],
        }
    }

    pub(super) fn following(&self) -> Chapter {
        let mut parts = vec![
            text(
                "The report follows a half turn and a circle by PD, kp 2 and kd 10 on pan, 2 and 5 on tilt. It does not say which units the gains have, nor what Kmtr = 0.01447 and p = 50 \
                 are. Of its figures 14 to 17 it says that \"both pan and tilt axes exhibit an overshoot in the beginning and a constant tracking error\". They were run from the \
                 start file of Appendix B, so with set B, which also makes tilt's array half of pan's.",
            ),
            text(
                "The table tries every reading: kp times an angle as N m at the joint, as volts (0.077389 N m each), times Kmtr at the joint, or times Kmtr at the motor (and 17.914 at the joint); p as the \
                 pole of a filter of the derivative that keeps its gain, as one that does not, or as something else; torques limited to the start files' 500 or to what the rig gives; on either set. A \
                 figure is shown (✓) if its curve stays on the report's axes, overshoots and ends off the desired angle, each by a hundredth of the axis or more, which is as much as a line is wide, \
                 and does not rattle by as much, which the report would have said. For a circle the error is the root mean square on the figure's time axis. The circle's array is not in the \
                 report; this one goes through the times and angles on the axes.",
            ),
            Part::Joined(readings::joined(self.out)),
            Part::Facts("The ends of the axes", axes()),
        ];
        let capped = ["--cap".to_owned(), "500Nm".to_owned()];
        let ours = ["--law".to_owned(), "state".to_owned()];
        for (caption, name, array) in [
            ("Figures 14 and 15, half a turn by the trapezoid", "half-turn", "trapezoid.csv"),
            ("Figures 16 and 17, a circle", "circle", "circle.csv"),
        ] {
            let one = |how: &str, set: &str, file: &str, with: &[String]| {
                let set = ["--set".to_owned(), set.to_owned()];
                let (caption, file) = (format!("{caption}: {how}"), format!("{name}-{file}.svg"));
                Part::Run(self.followed(&caption, &file, array, &[with, &set].concat()))
            };
            parts.extend([
                one(
                    "set B, the report's PD times Kmtr, torque limited to 500 N m",
                    "B",
                    "kmtr",
                    &[&pd(0.01447)[..], &capped].concat(),
                ),
                one("set B, the same as volts", "B", "volts", &[&pd(0.077_389)[..], &capped].concat()),
                one("set B, the same in N m, within the rig's volts", "B", "pd-rig", &pd(1.0)),
                one(
                    "set A, the same in N m, torque limited to 500 N m",
                    "A",
                    "pd-a",
                    &[&pd(1.0)[..], &capped].concat(),
                ),
                one("set B, ours, within the rig's volts", "B", "ours", &ours),
                one("set A, ours, within the rig's volts", "A", "ours-a", &ours),
            ]);
        }
        parts.push(text(
            "On set B this array is within what the rig's motors give, and a law that knows the model follows it. On set A it is out of their reach, whatever the law. The limits that the start file has \
             commented out, vmax = 5, amax = 4, dmax = 1, are in reach on both.",
        ));
        for (set, file) in [("B", "feasible-b.svg"), ("A", "feasible-a.svg")] {
            let with = [&ours[..], &["--set".to_owned(), set.to_owned()]].concat();
            parts.push(Part::Run(self.followed(
                &format!("A half turn by the limits that are commented out: ours, set {set}"),
                file,
                "feasible.csv",
                &with,
            )));
        }
        Chapter { title: "2.6.2 Desired angle and output angle", parts }
    }

    /// An array followed, and how far off it was.
    fn followed(&self, caption: &str, figure: &str, array: &str, with: &[String]) -> Run {
        let array = self.path("arrays", array);
        let with: Vec<&str> = with.iter().map(String::as_str).collect();
        let run = command(caption, &[&["lab", "simulate", array.as_str()], &with[..]].concat());
        let capped = "of the time, its torque was at the limit";
        run.drawn(self, figure)
            .more(
                (100.0, "%"),
                &[
                    ("pan: at its limit", "/runs/0/pan/capped_share", capped),
                    ("tilt: at its limit", "/runs/0/tilt/capped_share", ""),
                ],
            )
            .more(
                (MILLI, "mrad"),
                &[
                    ("pan: error rms", "/runs/0/pan/rms_rad", ""),
                    ("pan: error at rest", "/runs/0/pan/final_error_rad", ""),
                    ("tilt: error rms", "/runs/0/tilt/rms_rad", ""),
                    ("tilt: error at rest", "/runs/0/tilt/final_error_rad", ""),
                ],
            )
    }

    pub(super) fn moves(&self) -> Chapter {
        let one = |caption: &str, arguments: &[&str], name: &str| {
            let profiles = ["--profile", "trapezoid,s-curve", "--set", "B"];
            let run =
                command(caption, &[&["lab", "move"], arguments, &profiles[..]].concat()).drawn(self, name);
            run.more(
                (1.0, "s"),
                &[
                    ("trapezoid, as asked", "/moves/0/asked/duration_s", "at 100 rad/s²"),
                    ("S-curve, as asked", "/moves/1/asked/duration_s", ""),
                    ("trapezoid, on the rig", "/moves/0/rig/duration_s", "within the motors' torque"),
                    ("S-curve, on the rig", "/moves/1/rig/duration_s", ""),
                ],
            )
        };
        Chapter {
            title: "2.6.3 LabVIEW simulation: moves along an arc and a line",
            parts: vec![
                text(
                    "The report finds the trapezoid faster on the curved path and nearly identical on the straight one. As asked both paths cost an S-curve the same, \
                      a tenth more: its limits are joint limits whatever the path. Nearly identical they are where a line is long enough to be at the highest speed for most of it. (The text \
                      says \"Figures 20 and 21 show\" of the curved path and \"trapezoidal and s-curve\" of 20 and 21; the captions give the arc 18 and 19 and have the S-curve first. The captions are \
                      followed here.)",
                ),
                Part::Run(one("Figures 18 and 19: an arc of 90°, set B", &ARC, "arc.svg")),
                Part::Run(one("Figures 20 and 21: a line, set B", &LINE, "line.svg")),
                Part::Joined(on_the_rig()),
                text(
                    "\"Using the encoder position profile, straight line and curved path trajectories will be followed.\" Each move also comes as encoder positions, a row a millisecond in the columns \
                     pan_count and tilt_count; these are its tenths.",
                ),
                Part::Joined(counts::joined(self.out, &[("arc", &ARC), ("line", &LINE)])),
            ],
        }
    }
}

const ARC: [&str; 3] = ["arc", "--angle", "90deg"];
const LINE: [&str; 3] = ["line", "--start=-10in,0in", "--to=10in,0in"];

/// Where the axes of figures 14 and 15 end, and what would end there.
fn axes() -> Vec<Compared> {
    let on = given::carried_on_rad();
    const WHY: &str = "MATLAB ends an axis at the next tick beyond its curves. π/2 alone would end it at 1.6; so the desired or the actual angle of tilt came beyond that";
    vec![
        own(
            "figure 14: pan's array at 7 s, carried on by its last two rows",
            3.5,
            on,
            "rad",
            "the axis ends at 3.5. Simulink carries an array on unless told otherwise, and the report does not say: its desired angle may have crept on. Every array rests here",
        ),
        own("figure 15: tilt's array at 7 s, carried on", 1.8, 0.5 * on, "rad", WHY),
    ]
}

/// Both moves on both sets, and whether the head stayed on its course.
fn on_the_rig() -> Joined {
    let moves = [("arc", &ARC), ("line", &LINE)].into_iter().flat_map(|of| ["B", "A"].map(|set| (of, set)));
    let moves: Vec<((&str, &[&str; 3]), &str)> = moves.collect();
    let run = |((_, course), set): &((&str, &[&str; 3]), &str)| {
        command(
            "",
            &[&["lab", "move"], &course[..], &["--profile", "trapezoid,s-curve", "--set", set]].concat(),
        )
    };
    let runs = moves.iter().map(run).collect();
    let names: Vec<[&str; 2]> = moves.iter().map(|((name, _), set)| [*name, *set]).collect();
    let caption =
        "The same moves by the simulated rig: whether it stays on its course, and its error where it does";
    Joined { caption, runs, show: Box::new(move |done| followed_moves(&names, done)) }
}

fn followed_moves(names: &[[&'static str; 2]], done: &[Done]) -> Table {
    let mut rows = Vec::new();
    for (name, (answer, _)) in names.iter().zip(done) {
        for (k, profile) in ["trapezoid", "S-curve"].into_iter().enumerate() {
            let rig = &answer["moves"][k]["rig"];
            let mut row = [name[0], name[1], profile].map(Cell::words).to_vec();
            row.push(Cell::number(rig["duration_s"].as_f64(), "s"));
            row.push(Cell::number(rig["peak_m_s"].as_f64(), "m/s"));
            // an error of what was lit before the head left its course says nothing of the move
            row.push(match rig["held"].as_bool() {
                Some(false) => {
                    let rms_mm = rig["tracking"]["rms_mm"].as_f64();
                    Cell { kind: Kind::Fits, ..Cell::number(rms_mm, "mm rms") }
                }
                _ => Cell { text: "left its course, and went back dark".into(), kind: Kind::Misses },
            });
            rows.push(row);
        }
    }
    let heads = ["move", "set", "profile", "takes", "fastest", "error of the spot"];
    Table { heads: heads.map(str::to_owned).to_vec(), rows, finding: String::new() }
}
