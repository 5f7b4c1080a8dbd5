//! Friction, as it is shown.

use std::fmt::Write;

use serde_json::{Value, json};
use tracelight_lab::{Line, Side, SteadyPoint, Uncertain};
use tracelight_maths::hypot;
use tracelight_rig::Joint;
use tracelight_sim::RigConfig;
use tracelight_task::Failure;

use super::plot::figure;
use super::{Finding, Found, Unscaled};
use crate::finding::{self, Filed, Improved, svg};
use crate::numbers::{HOW_SURE, four, lines, milli};
use crate::parts::by_joint;

impl finding::Finding for Finding {
    fn text(&self) -> String {
        let rig = self.rig();
        let mut text = self.trials.in_words() + &lines(&self.said);
        for one in &self.joints {
            text += &table(rig, one);
            text += &one.subject.left_out();
            if let Some(curves) = &one.curves {
                let trials = one.subject.trials.len();
                // writing to a String cannot fail
                let _ = write!(text, "\n{} of {trials} trials turned it.", curves.trials);
                text += &verdict(one).map_or(String::new(), |verdict| format!(" {verdict}"));
                text += &against_gravity(rig, one);
                text += &below_nothing(one);
                text += &unscaled(one);
            }
        }
        text + HOW_SURE
    }

    fn json(&self) -> String {
        let object = |one: &Found| {
            let mut object = joint_json(one);
            if !self.said.is_empty() {
                object["read_as"] = self.said.clone().into();
            }
            (one.subject.joint, object)
        };
        by_joint(self.joints.iter().map(object))
    }
}

impl Filed for Finding {
    fn files(&self) -> Result<Vec<(&'static str, String)>, Failure> {
        Ok(vec![("friction.svg", svg(&figure(self.rig(), &self.joints))?)])
    }
}

/// A joint's figures: a column for each way they were told.
fn table(rig: &RigConfig, one: &Found) -> String {
    let friction = rig.model.felt_friction(one.subject.joint);
    let believed = &one.subject.believed;
    let viscous: fn(Side) -> Uncertain = |side| side.viscous;
    let coulomb: fn(Side) -> Uncertain = |side| side.coulomb_nm;
    let of =
        |sides: [Option<Side>; 2], side: usize, value: fn(Side) -> Uncertain| milli(sides[side].map(value));
    let (literal, best) = (one.as_the_report(), one.sides());
    let lines = [
        ("viscous +, mNms/rad", 0, viscous, friction.viscous_pos),
        ("viscous −, mNms/rad", 1, viscous, friction.viscous_neg),
        ("Coulomb +, mNm", 0, coulomb, friction.coulomb_pos_nm),
        ("Coulomb −, mNm", 1, coulomb, friction.coulomb_neg_nm),
    ];
    let mut rows: Vec<[String; 4]> = lines
        .map(|(words, side, value, had)| {
            [words.into(), of(literal, side, value), of(best, side, value), format!("{:.4}", 1e3 * had)]
        })
        .into();
    let r2 = |line: Option<Line>| line.map_or("–".to_owned(), |line| format!("{:.6}", line.r2));
    let r2s = format!("{}, {}", r2(one.steady.pos), r2(one.steady.neg));
    rows.push(["r²".into(), r2s, format!("{:.8}", one.r2()), String::new()]);
    if let Some(curves) = &one.curves {
        let mut known = |words: &str, value: Option<Uncertain>, had: f64| {
            rows.push([words.into(), String::new(), milli(value), format!("{:.4}", 1e3 * had)]);
        };
        known("inertia, g m²", curves.inertia_kg_m2, rig.model.own_inertia_kg_m2()[one.subject.joint]);
        if let Some([level, upright]) = believed.gravity_nm {
            known("weight, beam level, mNm", curves.gravity_nm.map(|g| g[0]), level);
            known("weight, upright, mNm", curves.gravity_nm.map(|g| g[1]), upright);
        }
        if believed.cables {
            let had = rig.quirks_of(one.subject.joint).cable.spring_nm_per_rad;
            known("cables, mNm/rad", curves.spring_nm_per_rad, had);
        }
    }
    let heads = [one.subject.joint.name(), "as the report did", "from whole curves", "the rig file has"];
    rows.insert(0, heads.map(str::to_owned));
    let shown = |column: usize| match column {
        1 => !one.steady.points.is_empty(),
        2 => one.curves.is_some(),
        _ => true,
    };
    let line = |row: &[String; 4]| {
        let cell = |column: usize| match column {
            0 => format!("{:23}", row[0]),
            3 => format!("{:>17}", row[3]),
            _ => format!("{:>20}", row[column]),
        };
        (0..4).filter(|&column| shown(column)).map(cell).collect::<String>()
    };
    "\n\n".to_owned() + &rows.iter().map(|row| line(row).trim_end().to_owned()).collect::<Vec<_>>().join("\n")
}

/// By how much lines through the last speeds are too steep, and why.
fn verdict(one: &Found) -> Option<String> {
    const AS_GOOD: f64 = 1.05;
    let of = |sides: [Option<Side>; 2]| sides.map(|side| side.map(|side| side.viscous.value));
    let pairs = of(one.as_the_report()).into_iter().zip(of(one.sides()));
    let steep = pairs.filter_map(|(last, whole)| Some(last? / whole?)).find(|steep| steep.is_finite())?;
    let constant_s = one.time_constant_s()?;
    let constant = if constant_s < 1.0 { four(constant_s) } else { format!("{constant_s:.0}") };
    let said = format!("Within J/Fv = {constant} s a speed comes to all but 1/e of what a voltage allows");
    if (1.0 / AS_GOOD..AS_GOOD).contains(&steep) {
        return Some(format!("{said}: the last speeds\nare as good as steady."));
    }
    Some(format!(
        "{said}: the last speeds\nare not steady, and a line through them, straight as it is, is {steep:.1} times too steep."
    ))
}

/// What does not depend on the rig file's torque per volt, and how well the volts alone make the speeds.
fn unscaled(one: &Found) -> String {
    let Some(sides) = one.unscaled() else { return String::new() };
    let side = |(side, way): (Option<Unscaled>, &str)| {
        let Unscaled { rad_s_per_v, beyond_v, time_constant_s } = side?;
        let constant = time_constant_s.map_or(String::new(), |s| format!(", time constant {} s", four(s)));
        Some(format!("{way} {} rad/s a volt beyond {} V{constant}", four(rad_s_per_v), four(beyond_v)))
    };
    let known: Vec<String> = sides.into_iter().zip(["forwards", "backwards"]).filter_map(side).collect();
    let mut text = String::new();
    if !known.is_empty() {
        text += &format!("\nWhatever the torque per volt: {}.", known.join("; "));
    }
    if let Some(r2) = one.replayed {
        text += &format!("\nFrom the volts alone the model makes its speeds with r² {r2:.4}.");
    }
    text
}

/// What is found below nothing and cannot be written so.
fn below_nothing(one: &Found) -> String {
    let [pos, neg] = one.sides();
    let viscous = [pos, neg].into_iter().flatten().any(|side| side.viscous.value < 0.0);
    let coulomb = pos.is_some_and(|side| side.coulomb_nm.value < 0.0)
        || neg.is_some_and(|side| side.coulomb_nm.value > 0.0);
    if viscous || coulomb {
        "\nFriction that drives is none: rig.toml has 0 for it.".to_owned()
    } else {
        String::new()
    }
}

/// What the highest voltage can do against weight, where the head stands on its feet.
fn against_gravity(rig: &RigConfig, one: &Found) -> String {
    let lumped = rig.model.bodies.lumped();
    let weight_nm = hypot(lumped.gravity_c, lumped.gravity_s);
    let volts = one.steady.points.iter().filter_map(|p| p.volts).fold(0.0, |most: f64, v| most.max(v.abs()));
    let torque_nm = one.subject.believed.torque_nm(volts);
    if one.subject.joint == Joint::Pan || torque_nm == 0.0 || torque_nm > weight_nm {
        return String::new();
    }
    format!(
        "\nOn its feet it would only hang: {volts:.2} V are {torque_nm:.3} N m, and it weighs {weight_nm:.3}."
    )
}

fn joint_json(one: &Found) -> Value {
    let mut object = sides_json(one.sides());
    object["r2"] = one.r2().into();
    let mut steady = sides_json(one.as_the_report());
    steady["r2_pos"] = one.steady.pos.map(|line| line.r2).into();
    steady["r2_neg"] = one.steady.neg.map(|line| line.r2).into();
    let point =
        |p: &SteadyPoint| json!({"volt": p.volts, "torque_nm": p.torque_nm, "velocity_rad_s": p.rate_rad_s});
    steady["points"] = one.steady.points.iter().map(point).collect();
    object["steady"] = steady;
    object["time_constant_s"] = one.time_constant_s().into();
    if let Some(curves) = &one.curves {
        object["inertia_kg_m2"] = curves.inertia_kg_m2.map(|u| u.value).into();
        object["within"]["inertia_kg_m2"] = curves.inertia_kg_m2.map(|u| u.within).into();
        object["gravity_level_nm"] = curves.gravity_nm.map(|g| g[0].value).into();
        object["gravity_upright_nm"] = curves.gravity_nm.map(|g| g[1].value).into();
        object["cable_spring_nm_per_rad"] = curves.spring_nm_per_rad.map(|u| u.value).into();
        object["trials"] = one.subject.trials.len().into();
        object["turned"] = curves.trials.into();
    }
    if let Some(sides) = one.unscaled() {
        let each = |of: fn(Unscaled) -> Option<f64>| sides.map(|side| side.and_then(of));
        object["rad_s_per_v"] = json!(each(|side| Some(side.rad_s_per_v)));
        object["coulomb_v"] = json!(each(|side| Some(side.beyond_v)));
        object["time_constants_s"] = json!(each(|side| side.time_constant_s));
        object["replayed_r2"] = one.replayed.into();
    }
    if !one.subject.plateaus.is_empty() {
        object["left_out"] =
            one.subject.plateaus.iter().map(|plateau| plateau.points.len()).sum::<usize>().into();
    }
    object
}

fn sides_json([pos, neg]: [Option<Side>; 2]) -> Value {
    let value = |side: Option<Side>, of: fn(Side) -> f64| side.map(of);
    json!({
        "viscous_pos": value(pos, |s| s.viscous.value),
        "viscous_neg": value(neg, |s| s.viscous.value),
        "coulomb_pos": value(pos, |s| s.coulomb_nm.value),
        "coulomb_neg": value(neg, |s| s.coulomb_nm.value),
        "within": {
            "viscous_pos": value(pos, |s| s.viscous.within),
            "viscous_neg": value(neg, |s| s.viscous.within),
            "coulomb_pos": value(pos, |s| s.coulomb_nm.within),
            "coulomb_neg": value(neg, |s| s.coulomb_nm.within),
        },
    })
}
