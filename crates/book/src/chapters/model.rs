use super::{Places, command, text};
use crate::blocks::{Arrow, Block, svg};
use crate::chapter::{Chapter, Part, Run};

impl Places<'_> {
    pub(super) fn model(&self) -> Chapter {
        Chapter {
            title: "2.4 The simulation's diagrams",
            parts: vec![
                text(
                    "The report's block diagrams, drawn from what stands here in their place. Its friction is a sign of the speed; ours holds a joint at \
                      rest with whatever it takes up to the Coulomb level, so that what sticks does not creep.",
                ),
                Part::Drawing("Figure 5: pan-tilt nonlinear simulation (lab simulate)".into(), simulation()),
                Part::Drawing(
                    "Figure 6: pan-tilt system dynamics (crates/dynamics, crates/plant)".into(),
                    dynamics(),
                ),
                Part::Drawing("Figure 7: friction subsystem (crates/plant)".into(), friction()),
            ],
        }
    }

    pub(super) fn linear(&self) -> Chapter {
        let why = "to every digit printed";
        let whole = command("G11, nothing cancelled", &["lab", "linearize", "--keep-cancellations"])
            .fact("G11, s² above", 13.16, "/G11/num/0", why)
            .fact("G11, s above", 1.754, "/G11/num/1", why)
            .fact("G11, 1 above", 10.29, "/G11/num/2", why)
            .fact("G11, s³ below", 0.2649, "/G11/den/1", why)
            .fact("G11, s² below", 0.7997, "/G11/den/2", why)
            .fact("G11, s below", 0.1029, "/G11/den/3", why);
        let own = command("G22, what tilt hardly moves cancelled", &["lab", "linearize"])
            .fact("G22, above", 13.33, "/G22/num/0", why)
            .fact("G22, s below", 0.1333, "/G22/den/1", why)
            .fact("G22, 1 below", 0.7822, "/G22/den/2", why)
            .scaled(
                "torque that holds tilt there",
                None,
                "/holding_nm/1",
                (1.0, "N m"),
                "18 % of what the motor gives",
            );
        Chapter {
            title: "2.4 The linear model",
            parts: vec![
                text(
                    "At pan and tilt of 26.565°, at rest, with viscous friction of 0.01 N m s/rad on both axes, no Coulomb friction and g = 9.8 m/s². Four \
                      of G11's poles and zeros are the other joint's, which pan hardly moves: they cancel to 13.16 / (s² + 0.1316 s).",
                ),
                Part::Run(whole),
                Part::Run(own),
            ],
        }
    }

    pub(super) fn loops(&self) -> Chapter {
        let mut parts = vec![text(
            "K11 = 281 (s + 32.9)(s + 97.8) / ((s + 250)(s + 177)) and K22 = 144 (s + 31.5)(s + 33.4) / ((s + 194)(s + 83.5)) can be read in two ways: as \
             poles and zeros, as they are typeset, or as the time constants that the design tool of the time showed, 281 (1 + s/32.9) … . Read as typeset, \
             a step overshoots by half; read as time constants the poles are well damped, which must be what was meant. The report prints no numbers \
             beside these figures. Its goal, no overshoot, neither has: that takes a reference that the motors can follow.",
        )];
        for (joint, loops, figures) in
            [("pan", ["K11 G11", "K11t G11"], ["8", "9"]), ("tilt", ["K22 G22", "K22t G22"], ["10", "11"])]
        {
            let locus = command(
                &format!("Figure {}: root locus of {joint}, both readings", figures[0]),
                &["lab", "locus", loops[0], loops[1]],
            )
            .drawn(self, &format!("locus-{joint}.svg"));
            let all = [
                locus,
                self.bode(joint, loops, figures[1]),
                self.closed_step(joint, loops, figures[1]),
                self.step_on_the_rig(joint),
            ];
            parts.extend(all.map(Part::Run));
        }
        Chapter { title: "2.5 Root locus, Bode plot and step response", parts }
    }

    fn bode(&self, joint: &str, loops: [&str; 2], figure: &str) -> Run {
        let caption = format!("Figure {figure}: Bode plot of {joint}");
        command(&caption, &["lab", "bode", loops[0], loops[1]])
            .drawn(self, &format!("bode-{joint}.svg"))
            .more(
                (1.0, "°"),
                &[
                    ("phase margin, as typeset", "/systems/0/margins/phase/deg", "little"),
                    (
                        "phase margin, time constants",
                        "/systems/1/margins/phase/deg",
                        "what designers ask for",
                    ),
                ],
            )
            .more(
                (1.0, ""),
                &[
                    ("modulus margin, as typeset", "/systems/0/margins/modulus/distance", ""),
                    ("modulus margin, time constants", "/systems/1/margins/modulus/distance", ""),
                ],
            )
    }

    fn closed_step(&self, joint: &str, loops: [&str; 2], figure: &str) -> Run {
        let caption = format!("Figure {figure}: step response of {joint}, the loop closed");
        let (percent, s) = ((1.0, "%"), (1.0, "s"));
        command(&caption, &["lab", "response", loops[0], loops[1], "--closed"])
            .drawn(self, &format!("step-{joint}.svg"))
            .scaled(
                "overshoot, as typeset",
                None,
                "/systems/0/overshoot_percent",
                percent,
                "the goal was none",
            )
            .scaled(
                "overshoot, time constants",
                None,
                "/systems/1/overshoot_percent",
                percent,
                "by zeros of the closed loop",
            )
            .more(
                s,
                &[
                    ("within 2 % after, as typeset", "/systems/0/settle_s", ""),
                    ("within 2 % after, time constants", "/systems/1/settle_s", ""),
                ],
            )
    }

    fn step_on_the_rig(&self, joint: &str) -> Run {
        let caption = format!("The same on the nonlinear head, and ours: {joint} sent to 15°");
        let percent = (1.0, "%");
        command(&caption, &["lab", "step", "--axis", joint, "--law", "report-zpk,report-tc,state"])
            .drawn(self, &format!("rig-step-{joint}.svg"))
            .scaled(
                "overshoot, as typeset",
                None,
                "/laws/0/overshoot_percent",
                percent,
                "the motor's limit, friction, weight on tilt",
            )
            .scaled(
                "overshoot, time constants",
                None,
                "/laws/1/overshoot_percent",
                percent,
                "from limit to limit: a count is several N m",
            )
            .scaled(
                "overshoot, ours",
                None,
                "/laws/2/overshoot_percent",
                percent,
                "the goal was none: a reference within the motors' reach, and feedforward",
            )
            .scaled("error at rest, ours", None, "/laws/2/final_error_mm", (1.0, "mm"), "at 3 ft")
    }
}

/// The loop: array, controller, cap, head, quantizer, hold.
fn simulation() -> String {
    svg(
        "simulation",
        &[
            Block { at: (0, 0), name: "array", what: "t, pan, tilt" },
            Block { at: (1, 0), name: "controller", what: "of desired − seen" },
            Block { at: (2, 0), name: "cap", what: "500 N m, or the rig's" },
            Block { at: (3, 0), name: "pan-tilt dynamics", what: "figure 6" },
            Block { at: (2, 1), name: "quantizer", what: "2π/4096" },
            Block { at: (1, 1), name: "hold", what: "1 ms" },
        ],
        &[
            Arrow { from: 0, to: 1, what: "desired" },
            Arrow { from: 1, to: 2, what: "N m" },
            Arrow { from: 2, to: 3, what: "τ" },
            Arrow { from: 3, to: 4, what: "angles" },
            Arrow { from: 4, to: 5, what: "counts" },
            Arrow { from: 5, to: 1, what: "as seen" },
        ],
    )
}

/// The head: motors, mass matrix, two integrators, what is taken away.
fn dynamics() -> String {
    svg(
        "dynamics",
        &[
            Block { at: (0, 0), name: "τ", what: "of the motors" },
            Block { at: (1, 0), name: "M(q)⁻¹", what: "of τ − C − G − F" },
            Block { at: (2, 0), name: "∫", what: "speeds" },
            Block { at: (3, 0), name: "∫", what: "angles" },
            Block { at: (0, 1), name: "gravity G(q)", what: "on tilt alone" },
            Block { at: (1, 1), name: "Coriolis C(q, q̇)", what: "M changes with tilt" },
            Block { at: (2, 1), name: "friction F(q̇)", what: "figure 7" },
        ],
        &[
            Arrow { from: 0, to: 1, what: "" },
            Arrow { from: 1, to: 2, what: "q̈" },
            Arrow { from: 2, to: 3, what: "q̇" },
            Arrow { from: 2, to: 6, what: "q̇" },
            Arrow { from: 6, to: 5, what: "" },
            Arrow { from: 4, to: 5, what: "" },
            Arrow { from: 5, to: 1, what: "taken away" },
        ],
    )
}

/// Friction: sliding or sticking.
fn friction() -> String {
    svg(
        "friction",
        &[
            Block { at: (0, 0), name: "speed", what: "" },
            Block { at: (1, 0), name: "which way", what: "forwards, back, none" },
            Block { at: (2, 0), name: "sliding", what: "sign (Fv |ω| + Fc)" },
            Block { at: (2, 1), name: "sticking", what: "whatever holds, to Fc" },
            Block { at: (3, 0), name: "F", what: "torque" },
        ],
        &[
            Arrow { from: 0, to: 1, what: "ω" },
            Arrow { from: 1, to: 2, what: "turns" },
            Arrow { from: 1, to: 3, what: "rests" },
            Arrow { from: 2, to: 4, what: "" },
            Arrow { from: 3, to: 4, what: "" },
        ],
    )
}
