use super::{MILLI, Places, command, text};
use crate::chapter::{Chapter, Part};

impl Places<'_> {
    pub(super) fn velocity(&self) -> Chapter {
        let run = command(
            "Velocity and acceleration from counts",
            &["lab", "velocity", "--speeds", "0.1ft/s,1ft/s,3ft/s"],
        )
        .drawn(self, "velocity.svg")
        .scaled(
            "best interval of counting",
            None,
            "/recommended_interval_ms/differences",
            (1.0, "ms"),
            "the \"ideal sampling time\" that was still to be found",
        )
        .scaled(
            "best corner of a washout, as a time",
            None,
            "/recommended_interval_ms/washout",
            (1.0, "ms"),
            "the report's way out",
        )
        .scaled(
            "best interval of timing edges",
            None,
            "/recommended_interval_ms/edge-times",
            (1.0, "ms"),
            "what an FPGA that stamps edges can do",
        )
        .scaled(
            "highest speed of pan at these speeds of the spot",
            None,
            "/highest/pan/velocity_rad_s",
            (1.0, "rad/s"),
            "was to be measured",
        )
        .scaled(
            "highest acceleration of pan",
            None,
            "/highest/pan/acceleration_rad_s2",
            (1.0, "rad/s²"),
            "was to be measured",
        );
        Chapter {
            title: "2.2 Velocity estimation",
            parts: vec![
                text(
                    "The report counts pulses over a fixed interval, finds the readings erratic where it is short, looks for an ideal \
                      sampling time and thinks of a washout filter. One count in a millisecond is 1.5 rad/s, and the spot at 1 ft/s is 0.33. Each \
                      way is played the counts of the same runs; dashed is a Kalman filter that knows the equation of motion.",
                ),
                Part::Run(run),
            ],
        }
    }

    pub(super) fn friction(&self) -> Chapter {
        let folder = self.out.join("friction");
        let mut run = command(
            "Figures 2 to 4, Tables 1 and 2: speeds over time, torque over speed",
            &["lab", "friction", "--fixture", "--out", &folder.display().to_string()],
        );
        run.figure = Some(folder.join("friction.svg"));
        let tables = [("pan", [0.9, 0.9, 40.6, -38.5]), ("tilt", [1.9, 1.7, 58.4, -56.9])];
        let names = [
            ("viscous_pos", "viscous, forwards", "mN m s/rad"),
            ("viscous_neg", "viscous, backwards", "mN m s/rad"),
            ("coulomb_pos", "Coulomb, forwards", "mN m"),
            ("coulomb_neg", "Coulomb, backwards", "mN m"),
        ];
        for (joint, table) in tables {
            for ((name, words, unit), value) in names.into_iter().zip(table) {
                let what = |how: &str| format!("{joint}: {words}{how}");
                run = run
                    .scaled(
                        &what(", whole curves"),
                        value,
                        &format!("/{joint}/{name}"),
                        (MILLI, unit),
                        "the simulated head has the report's tables: they come back",
                    )
                    .scaled(
                        &what(", last speeds"),
                        value,
                        &format!("/{joint}/steady/{name}"),
                        (MILLI, unit),
                        "the report's own reading, were the tables the truth",
                    );
            }
        }
        run = run
            .scaled(
                "pan: time constant J/Fv",
                None,
                "/pan/time_constant_s",
                (1.0, "s"),
                "30 s are a third of it",
            )
            .scaled("tilt: time constant J/Fv", None, "/tilt/time_constant_s", (1.0, "s"), "");
        Chapter {
            title: "2.3 Friction",
            parts: vec![
                text(
                    "Voltages of −1 to 1 V in steps of 0.05 V, 30 s each after a pulse of 1 V against stiction; the speed at the end is taken for \
                      steady, and a line laid through torque over speed for each direction. With the report's inertia the speeds are not steady after 30 s: \
                      they come to all but 1/e of what a voltage allows within J/Fv. So the literal reading finds viscous friction several times \
                      too large, along perfectly straight lines. Fitted to the whole curves, the equation of motion gives the tables back. It \
                      follows that either the rig's inertia was much smaller than the report assumes, or its viscous friction is that much smaller than \
                      its tables say.",
                ),
                text(
                    "On its feet the head could not have been tested so: 1 V are 0.077 N m at tilt, and its weight is 0.150. Each axis stands upright here, free to \
                      turn on and on.",
                ),
                Part::Run(run),
            ],
        }
    }
}
