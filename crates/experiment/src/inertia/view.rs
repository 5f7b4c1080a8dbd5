//! Inertia, as it is shown.

use std::fmt::Write;

use serde_json::json;
use tracelight_lab::Uncertain;

use super::Finding;
use crate::finding::{self, Improved};
use crate::numbers::{HOW_SURE, lines, milli};
use crate::parts::by_joint;
use crate::trials::Subject;

impl finding::Finding for Finding {
    fn text(&self) -> String {
        let mut text = self.trials.in_words() + &lines(&self.said);
        let _ = write!(
            text,
            "\n\n{:10} {:>22} {:>17} {:>17}",
            "", "inertia, g m²", "the rig file has", "of it the rotor"
        );
        for (subject, inertia) in &self.joints {
            let rotor = self.rig().model.bodies.rotor_kg_m2[subject.joint];
            let had = self.rig().model.own_inertia_kg_m2()[subject.joint];
            let cell = milli(Some(*inertia));
            // writing to a String cannot fail
            let _ = write!(
                text,
                "\n{:10} {cell:>22} {:>17.4} {:>17.4}",
                subject.joint.name(),
                1e3 * had,
                1e3 * rotor
            );
        }
        text += &self.joints.iter().map(|(subject, _)| subject.left_out()).collect::<String>();
        text + HOW_SURE
    }

    fn json(&self) -> String {
        let one = |(subject, inertia): &(Subject, Uncertain)| {
            let object = json!({
                "inertia_kg_m2": inertia.value,
                "within": inertia.within,
                "believed_kg_m2": self.rig().model.own_inertia_kg_m2()[subject.joint],
            });
            (subject.joint, object)
        };
        by_joint(self.joints.iter().map(one))
    }
}
