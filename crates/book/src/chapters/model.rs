use super::{Places, command, own, text};
use crate::blocks::{Arrow, Block, Wire, svg};
use crate::chapter::{Chapter, Part};
use crate::table::Compared;

impl Places<'_> {
    pub(super) fn model(&self) -> Chapter {
        Chapter {
            title: "2.3 Nonlinear model",
            parts: vec![
                text(
                    "The report's block diagrams, drawn from what stands here in their place. Its friction is a sign of the speed; ours holds a joint at \
                      rest with whatever it takes up to the Coulomb level, so that what sticks does not creep. Angles go back to gravity, to the \
                     Coriolis torque and to the mass matrix, speeds to friction and the Coriolis torque; all three torques are taken from the motors'.",
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
        let other = command("The same on set B", &["lab", "linearize", "--set", "B"])
            .fact("G22, above", 13.33, "/G22/num/0", "the motor of tilt has so much less to turn")
            .scaled(
                "torque that holds tilt there",
                None,
                "/holding_nm/1",
                (1.0, "N m"),
                "set B's tilt body is heavier",
            );
        Chapter {
            title: "2.4 Linear model",
            parts: vec![
                text(
                    "At pan and tilt of 26.565°, at rest, with viscous friction of 0.01 N m s/rad on both axes, no Coulomb friction and g = 9.8 m/s². Two \
                      poles and two zeros of G11 are tilt's, which pan hardly moves: they cancel. Masses are those of set A.",
                ),
                Part::Run(whole),
                Part::Run(own),
                Part::Run(other),
                Part::Facts("Where the report's text and its script differ", differences()),
            ],
        }
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
        &[],
    )
}

/// The head: what is left of the motors' torque, mass matrix, two integrators, and what goes back.
fn dynamics() -> String {
    svg(
        "dynamics",
        &[
            Block { at: (0, 0), name: "τ", what: "of the motors" },
            Block { at: (1, 0), name: "Σ", what: "τ − G − C − F" },
            Block { at: (2, 0), name: "M(q)⁻¹", what: "changes with tilt" },
            Block { at: (3, 0), name: "∫", what: "speeds q̇" },
            Block { at: (4, 0), name: "∫", what: "angles q" },
            Block { at: (1, 1), name: "gravity G(q)", what: "on tilt alone" },
            Block { at: (2, 1), name: "Coriolis C(q, q̇)", what: "and centrifugal" },
            Block { at: (3, 1), name: "friction F(q̇)", what: "figure 7" },
        ],
        &[
            Arrow { from: 0, to: 1, what: "τ" },
            Arrow { from: 1, to: 2, what: "rest" },
            Arrow { from: 2, to: 3, what: "q̈" },
            Arrow { from: 3, to: 4, what: "q̇" },
            Arrow { from: 5, to: 1, what: "−" },
            Arrow { from: 6, to: 1, what: "−" },
            Arrow { from: 7, to: 1, what: "−" },
        ],
        &[
            Wire { from: 3, to: &[(7, 0), (6, 1)], level: 0, what: "q̇" },
            Wire { from: 4, to: &[(6, -1), (5, 0)], level: 1, what: "q" },
            Wire { from: 4, to: &[(2, 0)], level: -1, what: "q" },
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
        &[],
    )
}

/// What the text says and what the script does.
fn differences() -> Vec<Compared> {
    const FAR_DEG: f64 = 26.565;
    vec![
        own(
            "gravity in the linear model",
            9.807,
            9.8,
            "m/s²",
            "pantilt_lin.m sets 9.807, but the printed G11 and G22 come out with 9.8 only: the helper gravitylin must have its own",
        ),
        own(
            "pan's angle in the linear model",
            0.0,
            FAR_DEG,
            "°",
            "the text takes 0, the script 26.565°; no matter, as nothing depends on pan",
        ),
        own(
            "tilt's angle in the linear model",
            26.5,
            FAR_DEG,
            "°",
            "the text rounds; the script's 26.565° = atan 1/2 is used",
        ),
    ]
}
