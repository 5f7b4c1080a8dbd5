use super::Places;
use crate::chapter::{Chapter, Part};

impl Places<'_> {
    /// What is left out, and why.
    pub(super) fn missing(&self) -> Chapter {
        Chapter {
            title: "What cannot be made again, and why",
            parts: vec![Part::List(vec![
                (
                    "Figure 1, the friction test's LabVIEW program",
                    "A screenshot of a program for instruments that are gone. `tracelight lab friction` does what it did (2.1).",
                ),
                (
                    "Figures 2 to 4, the points",
                    "The speeds that were measured are not printed; only the four lines through them are, and those are compared.",
                ),
                (
                    "Figures 8 to 11, the curves",
                    "Made again from the printed G11, G22, K11 and K22; but no number stands beside the originals, so there is nothing to compare with.",
                ),
                (
                    "Figures 14 to 17, the curves",
                    "The model file is lost, and with it what Kmtr and p are, the units of the gains and the array of the circle. What can be read from the axes is used (2.6.2).",
                ),
                (
                    "Figures 18 to 21, LabVIEW Motion Assistant",
                    "A commercial program whose moves are not described. Lines and arcs are made with the report's limits (2.6.3).",
                ),
                (
                    "Figures 22 and 23, photographs of a ruler",
                    "Two drawn rulers with tapes 48 px apart stand in their place (2.7).",
                ),
                (
                    "Figures 24 to 27, the image programs' wiring",
                    "Diagrams of LabVIEW programs. What each does is run, step by step (2.7); the wiring itself has no counterpart.",
                ),
                (
                    "Encoder that misread, pan encoder that slipped",
                    "Faults of one rig that the report did not find. `tracelight trace --rig worn` and the faults of `tracelight explain` are about such ones.",
                ),
                ("Tables 3 to 5: schedule, labour, costs", "They are about the project, not about the rig."),
            ])],
        }
    }
}
