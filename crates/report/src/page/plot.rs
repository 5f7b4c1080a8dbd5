use std::fmt::Write;

use super::axis::Axis;
use super::curve::SIDE;
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

    /// Adds an area of a class of the style sheet, from path data.
    pub(super) fn area(mut self, class: &str, data: &str, legend: Option<&str>) -> Self {
        if !data.is_empty() {
            let _ = write!(self.layers, r#"<path class="{class}" d="{data}"/>"#);
        }
        self.explain(class, "box", legend);
        self
    }

    /// Adds a curve of a class of the style sheet, from path data.
    pub(super) fn line(mut self, class: &str, data: &str, legend: Option<&str>) -> Self {
        if !data.is_empty() {
            let _ = write!(self.layers, r#"<path class="line {class}" d="{data}"/>"#);
        }
        self.explain(class, "dash", legend);
        self
    }

    /// Adds a level line across the diagram.
    pub(super) fn level(self, class: &str, value: f64, legend: Option<&str>) -> Self {
        let height = (1.0 - self.y.share(value)) * SIDE;
        self.line(class, &format!("M0 {height:.1}H{SIDE}"), legend)
    }

    /// Adds a short text at a place of the horizontal axis, near the top.
    pub(super) fn label(mut self, at: f64, text: &str) -> Self {
        let left = self.x.share(at) * 100.0;
        let _ = write!(self.labels, r#"<b style="left:{left:.2}%">{}</b>"#, escaped(text));
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
