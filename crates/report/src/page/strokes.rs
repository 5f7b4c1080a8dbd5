//! The strokes in their order, to be found again on the wall and in the drawing.

use super::html::escaped;
use crate::finished::Finished;
use crate::sequence::{DrawnStroke, sequence};

/// Rows of the table at most: a page is to be read, and `plan --json` has them all.
const MOST: usize = 500;

/// A table that is folded away until somebody looks for a stroke.
pub(super) fn section(job: &Finished<'_>) -> String {
    let all = sequence(job.drawing, job.plan);
    let has_layers = all.iter().any(|stroke| stroke.layer.is_some());
    let has_entities = all.iter().any(|stroke| stroke.entity.is_some());
    let head = |has: bool, name: &str| if has { format!("<th>{name}</th>") } else { String::new() };
    let heads = head(has_layers, "layer") + &head(has_entities, "comes from");
    let rows: String = all.iter().take(MOST).map(|stroke| row(stroke, [has_layers, has_entities])).collect();
    let rest = match all.len().saturating_sub(MOST) {
        0 => String::new(),
        more => format!("<p class=\"note\">and {more} more, all of them in plan --json</p>"),
    };
    format!(
        "<section><h2>Strokes in their order</h2><details><summary>{} {}</summary><div class=\"wide\" role=\"region\" aria-label=\"Strokes in their order\" tabindex=\"0\"><table class=\"list\"><thead><tr><th>number</th>{heads}\
         <th>length, mm</th><th>begins at, mm</th><th>ends at, mm</th><th>lit, s</th></tr></thead><tbody>{rows}</tbody></table></div>{rest}</details></section>",
        all.len(),
        if all.len() == 1 { "stroke" } else { "strokes" },
    )
}

fn row(stroke: &DrawnStroke, [has_layers, has_entities]: [bool; 2]) -> String {
    let mm = |m: f64| format!("{:.1}", m * 1e3 + 0.0).replace('-', "−");
    let place = |[x, y]: [f64; 2]| format!("{}, {}", mm(x), mm(y));
    let time = stroke.lit_from_s.zip(stroke.lit_to_s);
    let lit = time.map_or_else(|| "–".to_owned(), |(from, to)| format!("{from:.2} to {to:.2}"));
    let cell = |has: bool, name: Option<&str>| match has {
        true => format!("<td>{}</td>", escaped(name.unwrap_or("–"))),
        false => String::new(),
    };
    let names = cell(has_layers, stroke.layer.as_deref()) + &cell(has_entities, stroke.entity.as_deref());
    format!(
        "<tr><th>{}</th>{names}<td>{}</td><td>{}</td><td>{}</td><td>{lit}</td></tr>",
        stroke.number,
        mm(stroke.length_m),
        place(stroke.from_m),
        place(stroke.to_m),
    )
}
