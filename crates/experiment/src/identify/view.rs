//! What a head is made of, as it is shown.

use std::fmt::Write;

use serde_json::{Value, json};
use tracelight_lab::JointFit;
use tracelight_maths::hypot;
use tracelight_rig::{Joint, TICK_F64_S};
use tracelight_sim::RigConfig;
use tracelight_task::Failure;

use super::Finding;
use crate::finding::{self, Filed, Improved};
use crate::numbers::lines;
use crate::record;

/// A figure of a joint.
type Figure = fn(&RigConfig, Joint) -> f64;

/// Name in JSON, where it is plain SI; words for the table; by how much it is multiplied there.
const FIGURES: [(&str, &str, f64, Figure); 18] = [
    ("torque_nm_per_v", "torque per volt, mNm", 1e3, |r, j| r.model.motors[j].torque_nm_per_v),
    ("inertia_kg_m2", "inertia, g m²", 1e3, |r, j| r.model.own_inertia_kg_m2()[j]),
    ("viscous_pos", "viscous +, mNms/rad", 1e3, |r, j| r.model.friction[j].viscous_pos),
    ("viscous_neg", "viscous −, mNms/rad", 1e3, |r, j| r.model.friction[j].viscous_neg),
    ("coulomb_pos_nm", "Coulomb +, mNm", 1e3, |r, j| r.model.friction[j].coulomb_pos_nm),
    ("coulomb_neg_nm", "Coulomb −, mNm", 1e3, |r, j| r.model.friction[j].coulomb_neg_nm),
    ("break_away_nm", "on top near standstill, mNm", 1e3, |r, j| r.quirks_of(j).break_away_nm),
    ("break_away_rad_s", "  falls at, mrad/s", 1e3, |r, j| r.quirks_of(j).break_away_rad_s),
    ("ripple_nm", "friction ripples by, mNm", 1e3, |r, j| {
        let ripple = r.quirks_of(j).ripple;
        hypot(ripple.sin_nm, ripple.cos_nm)
    }),
    ("ripple_periods", "  times a turn", 1.0, |r, j| r.quirks_of(j).ripple.periods),
    ("gravity_level_nm", "weight, beam level, mNm", 1e3, |r, j| weight(r, j).0),
    ("gravity_upright_nm", "weight, beam upright, mNm", 1e3, |r, j| weight(r, j).1),
    ("cable_load_nm", "cables at zero, mNm", 1e3, |r, j| r.quirks_of(j).cable.load_nm),
    ("cable_spring_nm_per_rad", "  against the angle, mNm/rad", 1e3, |r, j| {
        r.quirks_of(j).cable.spring_nm_per_rad
    }),
    ("edge_0_counts", "edges 0, 4, 8 … off, 1/1000 count", 1e3, |r, j| r.quirks_of(j).edges_counts[0]),
    ("edge_1_counts", "edges 1, 5, 9 …", 1e3, |r, j| r.quirks_of(j).edges_counts[1]),
    ("edge_2_counts", "edges 2, 6, 10 …", 1e3, |r, j| r.quirks_of(j).edges_counts[2]),
    ("edge_3_counts", "edges 3, 7, 11 …", 1e3, |r, j| r.quirks_of(j).edges_counts[3]),
];

/// Torque that gravity has on a joint, N m: beam level, beam upright. Pan stands upright and feels none.
fn weight(rig: &RigConfig, joint: Joint) -> (f64, f64) {
    let lumped = rig.model.bodies.lumped();
    if joint == Joint::Pan { (0.0, 0.0) } else { (lumped.gravity_c, lumped.gravity_s) }
}

impl finding::Finding for Finding {
    fn text(&self) -> String {
        if let &[joint] = self.joints.as_slice() {
            return self.one_joint(joint);
        }
        let (rig, found) = (self.rig(), &self.found);
        let ticks: usize = self.records.iter().map(Vec::len).sum();
        let JointFit { stretches, edges, .. } = found.joints.pan;
        let tilt = found.joints.tilt;
        let mut text = format!(
            "{}: identified from {:.1} s: {stretches} stretches of pan's motion with {edges} edges, {} of tilt's with {}\n\n\
             {:34} {:>10} {:>10} {:>12} {:>10}",
            rig.name,
            ticks as f64 * TICK_F64_S,
            tilt.stretches,
            tilt.edges,
            "",
            "pan was",
            "is",
            "tilt was",
            "is"
        );
        for (_, words, times, value) in FIGURES {
            let figure = |r: &RigConfig, j: Joint| times * value(r, j);
            // writing to a String cannot fail
            let _ = write!(
                text,
                "\n{words:34} {:10.3} {:10.3} {:12.3} {:10.3}",
                figure(rig, Joint::Pan),
                figure(&found.rig, Joint::Pan),
                figure(rig, Joint::Tilt),
                figure(&found.rig, Joint::Tilt)
            );
        }
        let (pan, tilt) = (&found.joints.pan, &found.joints.tilt);
        let _ = write!(
            text,
            "\n{:34} {:10.3} {:10.3} {:12.3} {:10.3}\n",
            "edges off the model, counts rms",
            pan.before_counts,
            pan.after_counts,
            tilt.before_counts,
            tilt.after_counts
        );
        for j in Joint::BOTH.into_iter().filter(|&j| !found.joints[j].taken) {
            let _ = write!(
                text,
                "\n{j}: what was found explains its motion no better; what was believed is kept"
            );
        }
        text
    }

    fn json(&self) -> String {
        let (rig, found) = (self.rig(), &self.found);
        let joint = |j: Joint| {
            let fit = &found.joints[j];
            let figures = |r: &RigConfig| {
                let pairs =
                    FIGURES.iter().map(|(name, _, _, value)| ((*name).to_owned(), value(r, j).into()));
                Value::Object(pairs.collect())
            };
            json!({
                "taken": fit.taken,
                "stretches": fit.stretches,
                "edges": fit.edges,
                "residual_counts": { "before": fit.before_counts, "after": fit.after_counts },
                "believed": figures(rig),
                "found": figures(&found.rig),
            })
        };
        let mut all: serde_json::Map<String, Value> =
            self.joints.iter().map(|&j| (j.name().to_owned(), joint(j))).collect();
        if !self.said.is_empty() {
            all.insert("read_as".into(), self.said.clone().into());
        }
        Value::Object(all).to_string()
    }
}

impl Finding {
    /// The table of one joint, by records of nothing else.
    fn one_joint(&self, joint: Joint) -> String {
        let (rig, found, fit) = (self.rig(), &self.found, &self.found.joints[joint]);
        let ticks: usize = self.records.iter().map(Vec::len).sum();
        let mut text = format!(
            "{}: {joint} identified from {:.1} s: {} stretches of its motion with {} edges{}\n\n{:34} {:>10} {:>10}",
            rig.name,
            ticks as f64 * TICK_F64_S,
            fit.stretches,
            fit.edges,
            lines(&self.said),
            "",
            format!("{joint} was"),
            "is"
        );
        for (_, words, times, value) in FIGURES {
            // writing to a String cannot fail
            let _ = write!(
                text,
                "\n{words:34} {:10.3} {:10.3}",
                times * value(rig, joint),
                times * value(&found.rig, joint)
            );
        }
        let _ = write!(
            text,
            "\n{:34} {:10.3} {:10.3}\n",
            "edges off the model, counts rms", fit.before_counts, fit.after_counts
        );
        if !fit.taken {
            text += "\nwhat was found explains its motion no better; what was believed is kept";
        }
        text
    }
}

impl Filed for Finding {
    /// The record of the simulated rig's motion, if it moved.
    fn files(&self) -> Result<Vec<(&'static str, String)>, Failure> {
        let moved = self.of.records.is_empty();
        let own = self.records.iter().filter(|_| moved);
        Ok(own.map(|record| ("record.csv", record::write(record))).collect())
    }
}
