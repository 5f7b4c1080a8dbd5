use std::fmt::Write;

use super::axis::Axis;
use super::curve::{Band, Curve, SIDE};
use super::html::escaped;

/// One diagram over time. Its curves are an SVG stretched to the room there is; its words and numbers are text of the
/// page, so they keep their size on a phone.
pub(super) struct Plot {
    title: String,
    y_title: String,
    x_title: &'static str,
    x: Axis,
    y: Axis,
    height_rem: f64,
    shift_s: f64,
    layers: String,
    legend: String,
    labels: String,
    note: String,
}

impl Plot {
    /// An empty diagram.
    pub(super) fn new(title: &str, y_title: &str, x: Axis, y: Axis) -> Self {
        Self {
            title: title.to_owned(),
            y_title: y_title.to_owned(),
            x_title: "time, s",
            x,
            y,
            height_rem: 11.0,
            shift_s: 0.0,
            layers: String::new(),
            legend: String::new(),
            labels: String::new(),
            note: String::new(),
        }
    }

    /// Another height, in lines of text.
    pub(super) const fn height(mut self, rem: f64) -> Self {
        self.height_rem = rem;
        self
    }

    /// Another title below the horizontal axis.
    pub(super) const fn over(mut self, x_title: &'static str) -> Self {
        self.x_title = x_title;
        self
    }

    /// What its time is behind the run's, s.
    pub(super) const fn shifted(mut self, shift_s: f64) -> Self {
        self.shift_s = shift_s;
        self
    }

    /// Adds an area of a class of the style sheet, from path data.
    pub(super) fn area(mut self, class: &str, data: &str, legend: Option<&str>) -> Self {
        if !data.is_empty() {
            let _ = write!(self.layers, r#"<path class="{class}" d="{data}"/>"#);
        }
        self.explain(class, "box", legend);
        self
    }

    /// Adds a curve of a class of the style sheet.
    pub(super) fn line(mut self, class: &str, curve: &Curve, legend: Option<&str>) -> Self {
        if !curve.path.is_empty() {
            let (path, values) = (&curve.path, curve.cells.attributes());
            let _ = write!(self.layers, r#"<path class="line {class}" d="{path}"{values}/>"#);
        }
        self.explain(class, "dash", legend);
        self
    }

    /// Adds a band of a class of the style sheet, and its mean as a line.
    pub(super) fn band(mut self, class: &str, band: &Band, legend: Option<&str>) -> Self {
        let Band { spread: Curve { path, cells }, mean } = band;
        let values = cells.attributes();
        let _ = write!(
            self.layers,
            r#"<path class="band {class}" d="{path}" data-band{values}/><path class="line {class}" d="{mean}"/>"#
        );
        self.explain(class, "dash", legend);
        self
    }

    /// Adds a level line across the diagram.
    pub(super) fn level(mut self, class: &str, value: f64, legend: Option<&str>) -> Self {
        let height = (1.0 - self.y.share(value)) * SIDE;
        let _ = write!(self.layers, r#"<path class="line {class}" d="M0 {height:.1}H{SIDE}"/>"#);
        self.explain(class, "dash", legend);
        self
    }

    /// Adds a short text to a stretch of the horizontal axis, near the top; one that is `narrow` is seen by who looks closer.
    pub(super) fn label(mut self, (from, to): (f64, f64), narrow: bool, text: &str) -> Self {
        let (a, b) = (self.x.share(from), self.x.share(to));
        let class = if narrow { r#" class="narrow""# } else { "" };
        let _ = write!(
            self.labels,
            r#"<b{class} data-from="{a:.5}" data-to="{b:.5}" style="left:{:.2}%">{}</b>"#,
            50.0 * (a + b),
            escaped(text)
        );
        self
    }

    /// Adds a sentence below the diagram.
    pub(super) fn note(mut self, text: &str) -> Self {
        if !text.is_empty() {
            let _ = write!(self.note, r#"<p class="note">{}</p>"#, escaped(text));
        }
        self
    }

    fn explain(&mut self, class: &str, shape: &str, legend: Option<&str>) {
        if let Some(text) = legend {
            let _ = write!(
                self.legend,
                r#"<span><svg class="key" viewBox="0 0 20 10" aria-hidden="true">{}</svg>{}</span>"#,
                key(class, shape),
                escaped(text)
            );
        }
    }

    /// The diagram as HTML.
    pub(super) fn html(&self) -> String {
        let marks_x = self.x.marks().into_iter();
        let marks_y = self.y.marks().into_iter();
        let mut grid = String::new();
        let mut texts_x = String::new();
        let mut texts_y = String::new();
        for (value, text) in marks_x {
            let share = self.x.share(value);
            let _ = write!(grid, "M{:.1} 0V{SIDE}", share * SIDE);
            let _ = write!(texts_x, r#"<span style="left:{:.2}%">{text}</span>"#, share * 100.0);
        }
        for (value, text) in marks_y {
            let share = 1.0 - self.y.share(value);
            let _ = write!(grid, "M0 {:.1}H{SIDE}", share * SIDE);
            let _ = write!(texts_y, r#"<span style="top:{:.2}%">{text}</span>"#, share * 100.0);
        }
        format!(
            include_str!("plot.html"),
            title = escaped(&self.title),
            y_title = escaped(&self.y_title),
            x_title = self.x_title,
            legend = self.legend,
            height = self.height_rem,
            from = self.x.low(),
            to = self.x.high(),
            shift = self.shift_s,
            grid = grid,
            texts_x = texts_x,
            texts_y = texts_y,
            layers = self.layers,
            labels = self.labels,
            note = self.note,
        )
    }
}

/// The picture beside a legend's text.
fn key(class: &str, shape: &str) -> String {
    match shape {
        "box" => format!(r#"<path class="{class}" d="M0 0H20V10H0Z"/>"#),
        _ => format!(r#"<path class="line {class}" d="M0 5H20"/>"#),
    }
}
