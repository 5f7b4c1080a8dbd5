//! A job's figures in words.

use tracelight_eye::figures::EyeFigures;
use tracelight_task::counted;

use crate::origin::words;
use crate::summary::Summary;

impl Summary {
    /// The figures for people: some lines.
    #[must_use]
    pub fn words(&self) -> String {
        let mm = |m: f64| m * 1e3;
        let mut text = format!(
            "{}: {}, {:.3} m of line at {:.0} × {:.0} mm\n\
         time:   {:.2} s, of it lit {:.2} s at {:.3} m/s; torque up to {:.0} %",
            self.picture.path,
            counted(self.strokes.count, "stroke"),
            self.strokes.length_m,
            mm(self.target.width_m),
            mm(self.target.height_m),
            self.run.duration_s,
            self.laser.lit_s,
            self.tracking.lit_speed_m_s,
            100.0 * self.plan.torque_peak_fraction,
        );
        if (self.run.duration_s - self.plan.duration_s).abs() > 0.01 {
            text += &format!("\n        (planned: {:.2} s)", self.plan.duration_s);
        }
        text += &match self.laser.lit_s > 0.0 {
            true => format!(
                "\nerror:  {:.3} mm rms, {:.3} mm at most; overshoot {:.2} %{}{}",
                self.tracking.rms_mm,
                self.tracking.max_mm,
                self.tracking.overshoot_percent,
                self.tracking.final_error_mm.map_or_else(String::new, |mm| format!(", {mm:.3} mm at rest")),
                words(self.light_from).warning,
            ),
            false => "\nerror:  none to measure, nothing was lit".to_owned(),
        };
        text += &format!("\nhead:   {}", self.head.words());
        if self.simulated {
            text += "\nrig:    simulated, nothing of this was measured on a real head";
        }
        self.camera.iter().flat_map(EyeFigures::words).for_each(|line| text += &format!("\n{line}"));
        let lost = self.run.lost_counts;
        if (lost.pan, lost.tilt) != (0, 0) {
            text += &format!(
                "\nlost:   counts, noticed and put back: pan {:+} and tilt {:+} are added to what the encoders read; look at their cables",
                lost.pan, lost.tilt
            );
        }
        match self.laser.faults.len() {
            0 => {}
            1 => text += "\ndark:   once where light was planned; the report says when and why",
            n => {
                text += &format!("\ndark:   {n} times where light was planned; the report says when and why")
            }
        }
        text
    }
}
