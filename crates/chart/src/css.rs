//! The colours as style sheets have them.

use std::fmt::Write;

use crate::colour::Colour;
use crate::ramp::{Ramp, STEPS};
use crate::rgb::Rgb;
use crate::theme::Theme;

/// Custom properties of a page: its grounds and inks, what colours stand for, and its scales (`--e0` to `--e7` of errors, `--g0` to
/// `--g7` greys), on a light screen and on a dark one. An element of class `dark-wall` or `light-wall` has its own, whatever the screen.
#[must_use]
pub fn page_colours() -> String {
    let (light, dark) = (properties(Theme::Light), properties(Theme::Dark));
    format!(
        ":root{{{light}}}\n@media (prefers-color-scheme:dark){{:root{{{dark}}}}}\n\
         .light-wall{{{light}}}\n.dark-wall{{{dark}}}\n@media print{{:root{{{light}}}}}\n"
    )
}

fn properties(theme: Theme) -> String {
    let of = |colour: Colour| colour.rgb(theme);
    let named = [
        ("page", theme.page()),
        ("card", theme.ground()),
        ("wall", theme.wall()),
        ("ink", theme.ink()),
        ("soft", theme.soft()),
        ("rule", theme.rule()),
        ("grid", theme.grid()),
        ("dark", theme.dark_way()),
        ("light", of(Colour::Light)),
        ("pan", of(Colour::Pan)),
        ("tilt", of(Colour::Tilt)),
        ("limit", of(Colour::Limit)),
        ("good", of(Colour::Good)),
    ];
    let mut text = String::new();
    for (name, colour) in named {
        // writing to a String cannot fail
        let _ = write!(text, "--{name}:{colour};");
    }
    for step in 0..STEPS {
        let (error, grey) = (Ramp::Error.rgb(step, theme), Ramp::Grey.rgb(step, theme));
        let _ = write!(text, "--e{step}:{error};--g{step}:{grey};");
    }
    text
}

/// A style element that shows an SVG drawn for a light ground on a dark one, wherever the screen is dark. It goes by the colours that the
/// SVG's own attributes name, and only those: readers without style sheets see the light one.
#[must_use]
pub fn dark_style(svg: &str) -> String {
    let mut rules = String::new();
    for (light, dark) in pairs() {
        for what in ["fill", "stroke"] {
            if svg.contains(&format!("{what}=\"{light}\"")) {
                let _ = write!(rules, "[{what}=\"{light}\"]{{{what}:{dark}}}");
            }
        }
    }
    if rules.is_empty() {
        return String::new();
    }
    format!("<style>@media (prefers-color-scheme:dark){{{rules}}}</style>")
}

/// Every colour on light and on dark ground.
fn pairs() -> Vec<(Rgb, Rgb)> {
    const GROUNDS: [fn(Theme) -> Rgb; 9] = [
        Theme::ground,
        Theme::page,
        Theme::wall,
        Theme::ink,
        Theme::soft,
        Theme::rule,
        Theme::grid,
        Theme::fainter,
        Theme::dark_way,
    ];
    let grounds = GROUNDS.map(|of| (of(Theme::Light), of(Theme::Dark)));
    let colours = Colour::ALL.map(|colour| (colour.rgb(Theme::Light), colour.rgb(Theme::Dark)));
    let steps = Ramp::ALL.into_iter().flat_map(|ramp| {
        (0..STEPS).map(move |step| (ramp.rgb(step, Theme::Light), ramp.rgb(step, Theme::Dark)))
    });
    grounds.into_iter().chain(colours).chain(steps).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_colour_on_light_ground_has_one_on_dark_ground() {
        let all = pairs();
        for (i, (light, _)) in all.iter().enumerate() {
            assert!(all[..i].iter().all(|(other, _)| other != light), "{light} twice");
        }
    }

    #[test]
    fn only_what_is_there_is_restyled() {
        let ink = Theme::Light.ink();
        let style = dark_style(&format!("<path stroke=\"{ink}\"/>"));
        assert_eq!(style.matches("stroke:").count(), 1);
        assert!(style.contains(&Theme::Dark.ink().to_string()));
        assert_eq!(dark_style("<path/>"), "");
    }

    #[test]
    fn a_page_has_every_colour_on_both_grounds() {
        let css = page_colours();
        for name in ["--light:", "--pan:", "--tilt:", "--limit:", "--e0:", "--e7:", "--g7:", "--wall:"] {
            assert_eq!(css.matches(name).count(), 5, "{name}");
        }
    }
}
