use super::{MILLI, Places, command, text};
use crate::chapter::{Chapter, Part, Run};

/// The report's PD gains, their derivative's filter at the unexplained p = 50.
const PD: [&str; 2] = ["2 + 10 s/(1 + s/50)", "2 + 5 s/(1 + s/50)"];
/// The same as volts, 0.0774 N m each; and times the unexplained Kmtr = 0.01447.
const VOLTS: [&str; 2] = ["0.0774 (2 + 10 s/(1 + s/50))", "0.0774 (2 + 5 s/(1 + s/50))"];
const KMTR: [&str; 2] = ["0.01447 (2 + 10 s/(1 + s/50))", "0.01447 (2 + 5 s/(1 + s/50))"];

/// By transfer functions.
const fn by([pan, tilt]: [&'static str; 2]) -> [&'static str; 3] {
    ["--controller", pan, tilt]
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
            title: "2.6.1 Profiles",
            parts: vec![
                text(
                    "From 0 to π with at most 24 rad/s and 100 rad/s². On this rig these limits are wishes: 100 rad/s² take 7.6 N m, ten times what the motors give.",
                ),
                Part::Run(s_curve),
                Part::Run(trapezoid),
                Part::Run(others),
            ],
        }
    }

    pub(super) fn following(&self) -> Chapter {
        let capped = ["--cap", "500Nm"];
        let mut parts = vec![text(
            "The report follows a half turn and a circle by PD, kp 2 and kd 10 on pan, 2 and 5 on tilt, and sees an overshoot in the beginning and a constant \
             tracking error. Which units the gains have it does not say, nor what Kmtr = 0.01447 and p = 50 are. Read as N m per radian, with p as the \
             pole of the derivative's filter, and with its start files' cap of 500 N m, PD does what the report describes: it overshoots where the move ends, and keeps \
             a constant error, friction and weight over kp. Within what the rig's motors give the same array is out of reach for any law: it asks \
             for 7.6 N m on pan, and there are 0.62. A planner that knows the motors must stand before the law.",
        )];
        for (caption, name, array) in [
            ("Figures 14 and 15, half a turn by the trapezoid", "half-turn", "trapezoid.csv"),
            ("Figures 16 and 17, a circle", "circle", "circle.csv"),
        ] {
            let one = |how: &str, file: &str, with: &[&str]| {
                Part::Run(self.followed(
                    &format!("{caption}: {how}"),
                    &format!("{name}-{file}.svg"),
                    array,
                    with,
                ))
            };
            parts.extend([
                one("the report's PD, torque capped at 500 N m", "pd", &[&by(PD)[..], &capped].concat()),
                one("the same within what the rig's motors give", "pd-rig", &by(PD)),
                one("ours, torque capped at 500 N m", "ours", &[&["--law", "state"][..], &capped].concat()),
                one("ours within what the rig's motors give", "ours-rig", &["--law", "state"]),
            ]);
        }
        parts.push(text(
            "The limits that the start file has commented out, vmax = 5, amax = 4, dmax = 1, are within the motors' reach. Read as volts, or times Kmtr, the \
             gains lag by a tenth of a radian and by half of one, which nobody would call tuned: the first reading fits best.",
        ));
        let one = |how: &str, file: &str, with: &[&str]| {
            Part::Run(self.followed(&format!("A half turn in reach: {how}"), file, "feasible.csv", with))
        };
        parts.extend([
            one("PD as N m per radian", "feasible-pd.svg", &by(PD)),
            one("PD as volts per radian", "feasible-volts.svg", &by(VOLTS)),
            one("PD times Kmtr", "feasible-kmtr.svg", &by(KMTR)),
            one(
                "parameter set B, PD as N m per radian",
                "feasible-b.svg",
                &[&by(PD)[..], &["--set", "B"]].concat(),
            ),
            one("ours", "feasible-ours.svg", &["--law", "state"]),
        ]);
        Chapter { title: "2.6.2 Desired and actual", parts }
    }

    /// An array followed, and how far off it was.
    fn followed(&self, caption: &str, figure: &str, array: &str, with: &[&str]) -> Run {
        let array = self.path("arrays", array);
        command(caption, &[&["lab", "simulate", array.as_str()], with].concat()).drawn(self, figure).more(
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
            let run = command(caption, &[&["lab", "move"], arguments].concat()).drawn(self, name);
            run.more(
                (1.0, "s"),
                &[
                    ("trapezoid, as asked", "/moves/0/asked/duration_s", "at 100 rad/s²"),
                    ("S-curve, as asked", "/moves/1/asked/duration_s", ""),
                    ("trapezoid, on the rig", "/moves/0/rig/duration_s", "within the motors' torque"),
                    ("S-curve, on the rig", "/moves/1/rig/duration_s", ""),
                ],
            )
            .more(
                (1.0, "mm"),
                &[
                    ("trapezoid, error rms on the rig", "/moves/0/rig/tracking/rms_mm", ""),
                    ("S-curve, error rms on the rig", "/moves/1/rig/tracking/rms_mm", ""),
                ],
            )
        };
        let both = ["--profile", "trapezoid,s-curve"];
        Chapter {
            title: "2.6.3 Moves along an arc and a line",
            parts: vec![
                text(
                    "The report finds the trapezoid faster on the curved path and nearly identical on the straight one. As asked both paths cost an S-curve the same, \
                      a tenth more: its limits are joint limits whatever the path. On the rig the arc's bend takes torque where a trapezoid still speeds up, so \
                      there it loses less, not more. Nearly identical they are where a line is long enough to be at the highest speed for most of it.",
                ),
                Part::Run(one(
                    "Figures 18 and 19: an arc of 90°",
                    &[&["arc", "--angle", "90deg"], &both[..]].concat(),
                    "arc.svg",
                )),
                Part::Run(one(
                    "Figures 20 and 21: a line",
                    &[&["line", "--start=-10in,0in", "--to=10in,0in"], &both[..]].concat(),
                    "line.svg",
                )),
            ],
        }
    }
}
