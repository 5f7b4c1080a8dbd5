//! A swing and the PID from it, as they are shown.

use std::fmt::Write;

use serde_json::json;
use tracelight_chart::{Colour, Curve, Figure, Key, Pen, Theme};
use tracelight_linear::decibels;
use tracelight_maths::complex;
use tracelight_rig::TICK_F64_S;
use tracelight_sim::{BenchTick, LawName};
use tracelight_task::Failure;

use super::{Finding, relayed_nm_per_v};
use crate::finding::{self, Plotted};
use crate::panels::{curve, over_time};
use crate::step_words::{figures_json, heading, row};

impl finding::Finding for Finding {
    fn text(&self) -> String {
        let Self { of, relay, swing, pid, .. } = self;
        let (rig, joint) = (&of.rig, of.joint);
        let torque_nm_per_v = relayed_nm_per_v(&rig.model.motors[joint], relay.level_v);
        let there = swing.response(relay, torque_nm_per_v);
        let (inertia_kg_m2, coulomb_nm) = swing.mass(relay, torque_nm_per_v);
        let mut text = format!(
            "{joint} of rig {} between {:.2} V and {:.2} V, turned over {:.3}° beyond its middle:\n\
             swings by ±{:.3}° in {:.4} s, periods and amplitudes within {:.1} %\n\
             at {:.2} rad/s it answers {:.2} dB and {:.1}°, rad per N m,\n\
             like {:.5} kg m² with {:.4} N m of Coulomb friction\n\n\
             gains for a phase margin of {:.1}° at {:.2} rad/s, as it answers at this amplitude: kp = {:.4} N m/rad, ki = {:.4} N m/(rad s), kd = {:.4} N m s/rad\n\n",
            rig.name,
            swing.hold_v - relay.level_v,
            swing.hold_v + relay.level_v,
            relay.hysteresis_rad.to_degrees(),
            swing.amplitude_rad.to_degrees(),
            swing.period_s,
            100.0 * swing.unevenness,
            swing.rad_s(),
            decibels(complex::norm(there)),
            complex::arg(there).to_degrees(),
            inertia_kg_m2,
            coulomb_nm,
            of.phase_margin_rad.to_degrees(),
            of.crossover_rad_s.unwrap_or(swing.rad_s()),
            pid.kp,
            pid.ki,
            pid.kd,
        );
        text += &heading(rig, joint, of.to_rad);
        text += &row(LawName::HandTuned.name(), &self.nonlinear, &self.linear, rig);
        text + "\n\nmm on a target 3 ft away."
    }

    fn json(&self) -> String {
        let Self { of, relay, swing, pid, .. } = self;
        let (rig, joint) = (&of.rig, of.joint);
        let mut object = figures_json(&self.nonlinear, rig);
        object["linear"] = figures_json(&self.linear, rig);
        let torque_nm_per_v = relayed_nm_per_v(&rig.model.motors[joint], relay.level_v);
        let there = swing.response(relay, torque_nm_per_v);
        let (inertia_kg_m2, coulomb_nm) = swing.mass(relay, torque_nm_per_v);
        let swung = json!({
            "axis": joint.name(),
            "amplitude_rad": swing.amplitude_rad,
            "period_s": swing.period_s,
            "unevenness": swing.unevenness,
            "hold_v": swing.hold_v,
            "rad_s": swing.rad_s(),
            "magnitude_rad_per_nm": complex::norm(there),
            "phase_deg": complex::arg(there).to_degrees(),
            "inertia_kg_m2": inertia_kg_m2,
            "coulomb_nm": coulomb_nm,
            "crossover_rad_s": of.crossover_rad_s.unwrap_or(swing.rad_s()),
            "kp": pid.kp,
            "ki": pid.ki,
            "kd": pid.kd,
            "to_rad": of.to_rad,
            "step": object,
        });
        swung.to_string()
    }
}

impl Plotted for Finding {
    fn figure(&self) -> Result<Figure, Failure> {
        let joint = self.of.joint;
        let swung = |value: &dyn Fn(&(f64, f64)) -> f64| {
            let ticks = self.swing.ticks.iter().enumerate();
            let points = ticks.map(|(k, tick)| (k as f64 * TICK_F64_S, value(tick))).collect();
            vec![Curve { colour: Colour::Violet, pen: Pen::Solid, points }]
        };
        let angle = |tick: &BenchTick| tick.angle_rad[joint].to_degrees();
        let volts = |tick: &BenchTick| f64::from(tick.command_v[joint]);
        let of = |ticks, pen, value| curve(Colour::Ochre, ticks, pen, value);
        let tried = vec![
            of(&self.response.nonlinear, Pen::Solid, &angle),
            of(&self.response.linear, Pen::Dashed, &angle),
        ];
        Ok(Figure {
            title: format!("{joint} of rig {}: swung by a relay, tuned, tried", self.of.rig.name),
            legend: vec![
                Key::new(Colour::Violet, "by the relay"),
                Key::new(Colour::Ochre, "by the PID tuned from it (dashed: linearized)"),
            ],
            panels: vec![
                over_time("angle, °", vec![0.0], swung(&|(_, angle)| angle.to_degrees())),
                over_time("relay, V", Vec::new(), swung(&|(volts, _)| *volts)),
                over_time("angle, °", vec![self.of.to_rad.to_degrees()], tried),
                over_time("command, V", Vec::new(), vec![of(&self.response.nonlinear, Pen::Solid, &volts)]),
            ],
            columns: 2,
            panel: (560, 260),
            theme: Theme::Light,
        })
    }

    fn csv(&self) -> Result<String, Failure> {
        let mut text = String::from("t_s,volt,angle_rad\n");
        for (number, (volts, angle_rad)) in self.swing.ticks.iter().enumerate() {
            // writing to a String cannot fail
            let _ = writeln!(text, "{:.3},{volts:.4},{angle_rad:.7}", number as f64 * TICK_F64_S);
        }
        Ok(text)
    }
}
