//! What a figure says to who does not see it.

use crate::css::dark_style;

/// The words of a figure.
pub(crate) struct Words<'a> {
    pub(crate) title: &'a str,
    /// What is across and what is up, a diagram each.
    pub(crate) axes: Vec<(&'a str, &'a str)>,
    /// Of the curves.
    pub(crate) names: Vec<&'a str>,
    /// What is written beside places.
    pub(crate) marked: Vec<&'a str>,
}

/// The drawing with its words, and, if it was drawn for a light screen alone, with what shows it on a dark one.
pub(crate) fn told(svg: &str, words: &Words<'_>, is_light: bool) -> String {
    let Some((root, drawn)) = svg.split_once('>') else { return svg.to_owned() };
    let style = if is_light { dark_style(svg) } else { String::new() };
    let (title, words) = (escaped(words.title), escaped(&description(words)));
    format!("{root} role=\"img\">\n<title>{title}</title>\n<desc>{words}</desc>\n{style}{drawn}")
}

/// Each diagram by its axes, then the names of the curves.
fn description(words: &Words<'_>) -> String {
    let axes = |&(x, y): &(&str, &str)| match (x.is_empty(), y.is_empty()) {
        (true, _) => y.to_owned(),
        (false, true) => format!("over {x}"),
        (false, false) => format!("{y} over {x}"),
    };
    let diagrams: Vec<String> = words.axes.iter().map(axes).filter(|words| !words.is_empty()).collect();
    let mut text = format!("Diagrams: {}.", diagrams.join("; "));
    if !words.names.is_empty() {
        text += &format!(" Curves: {}.", words.names.join("; "));
    }
    if !words.marked.is_empty() {
        text += &format!(" Marked: {}.", words.marked.join("; "));
    }
    text
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
