//! Which strokes of a drawing are taken.

use tracelight_stroke::{Colour, Drawing, Place, Stroke};
use tracelight_task::Failure;

/// Which strokes of a drawing are taken; all of them by default.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Choice {
    /// Only strokes on these layers of an SVG, DXF or JSON drawing.
    pub layers: Vec<String>,
    /// Only strokes of these colours.
    pub colours: Vec<Colour>,
    /// Layers whose closed paths light keeps out of; they are not drawn.
    pub no_go: Vec<String>,
    /// Points and blocks are enough, without a stroke.
    pub places: bool,
}

/// Names in a message at most.
const MOST_NAMES: usize = 20;

impl Choice {
    /// The strokes on one of the layers asked for and of one of the colours asked for, all where nothing is asked; and the closed paths that light
    /// keeps out of. Names of layers differ in more than case.
    ///
    /// # Errors
    /// A layer or colour that no stroke has, with those there are; strokes of both that are none; and a path to keep out of that is not closed. Where `places`
    /// are enough, what one of them has is there.
    pub fn of(&self, name: &str, drawing: Drawing, places: &[Place]) -> Result<(Drawing, Drawing), Failure> {
        let places = if self.places { places } else { &[] };
        let refused = |message| Failure::failed("no-strokes", format!("{name}: {message}"));
        let layers = self.layers.iter().map(|layer| ("layer", layer));
        for (flag, layer) in layers.chain(self.no_go.iter().map(|layer| ("no-go", layer))) {
            let strokes = drawing.strokes.iter().map(|s| s.layer.as_deref());
            let mut all = strokes.chain(places.iter().map(|place| place.layer.as_deref()));
            if !all.clone().any(|own| is_same(own, layer)) {
                let known = names(all.by_ref().flatten().map(str::to_owned));
                return Err(refused(missing("layer", flag, layer, &known)));
            }
        }
        for colour in &self.colours {
            let strokes = drawing.strokes.iter().map(|s| s.colour);
            let mut all = strokes.chain(places.iter().map(|place| place.colour));
            if !all.clone().any(|own| own == Some(*colour)) {
                let known = names(all.by_ref().flatten().map(|c| c.to_string()));
                return Err(refused(missing("colour", "colour", &colour.to_string(), &known)));
            }
        }
        let is_no_go = |stroke: &Stroke| self.no_go.iter().any(|layer| is_on(stroke, layer));
        let (no_go, drawn): (Vec<Stroke>, Vec<Stroke>) = drawing.strokes.into_iter().partition(is_no_go);
        if let Some(open) = no_go.iter().find(|stroke| !stroke.path.is_closed()) {
            let layer = open.layer.as_deref().unwrap_or_default();
            let start = open.path.start();
            return Err(refused(format!(
                "--no-go {layer}: a path of this layer is not closed, it begins at ({:.1}, {:.1}) on its sheet: close it, or give the area by \
                 its place and size, such as --no-go 10cm,20cm,8cm,8cm",
                start.x, start.y
            )));
        }
        let no_go = Drawing { strokes: no_go };
        let strokes: Vec<Stroke> = drawn.into_iter().filter(|s| self.takes(s)).collect();
        let is_asked = !(self.layers.is_empty() && self.colours.is_empty());
        match strokes.is_empty() && is_asked && !places.iter().any(|place| self.takes_place(place)) {
            true => Err(refused("no stroke is on these layers and of these colours; ask for less".into())),
            false => Ok((Drawing { strokes }, no_go)),
        }
    }

    fn takes(&self, stroke: &Stroke) -> bool {
        self.takes_these(stroke.layer.as_deref(), stroke.colour)
    }

    /// Whether a place is on one of the layers, and of one of the colours, and light does not keep out of its layer.
    pub(crate) fn takes_place(&self, place: &Place) -> bool {
        let layer = place.layer.as_deref();
        !self.no_go.iter().any(|own| is_same(layer, own)) && self.takes_these(layer, place.colour)
    }

    fn takes_these(&self, layer: Option<&str>, colour: Option<Colour>) -> bool {
        let on_layer = self.layers.is_empty() || self.layers.iter().any(|own| is_same(layer, own));
        on_layer && (self.colours.is_empty() || colour.is_some_and(|c| self.colours.contains(&c)))
    }
}

fn is_on(stroke: &Stroke, layer: &str) -> bool {
    is_same(stroke.layer.as_deref(), layer)
}

fn is_same(own: Option<&str>, layer: &str) -> bool {
    own.is_some_and(|own| own.to_lowercase() == layer.to_lowercase())
}

/// Each once, in order of appearance.
fn names(all: impl Iterator<Item = String>) -> Vec<String> {
    let mut seen = std::collections::HashSet::new();
    all.filter(|name| seen.insert(name.clone())).collect()
}

fn missing(what: &str, flag: &str, asked: &str, known: &[String]) -> String {
    if known.is_empty() {
        return format!("it has no {what}s; leave --{flag} {asked} out");
    }
    let shown = known[..known.len().min(MOST_NAMES)].join(", ");
    let more = if known.len() > MOST_NAMES { ", …" } else { "" };
    format!("no stroke has the {what} {asked}; there are: {shown}{more}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use tracelight_stroke::{Path, Point};

    fn drawing() -> Drawing {
        let stroke = |layer: Option<&str>, colour: Option<u32>| Stroke {
            layer: layer.map(Into::into),
            colour: colour.map(Colour::from_rgb),
            ..Stroke::new(Path::polyline(&[Point::ORIGIN, Point::new(1.0, 0.0)], false).unwrap())
        };
        let strokes = vec![
            stroke(Some("Cut"), Some(0xff0000)),
            stroke(Some("Engrave"), Some(0x0000ff)),
            stroke(Some("Engrave"), Some(0xff0000)),
            stroke(None, None),
        ];
        Drawing { strokes }
    }

    fn chosen(layers: &[&str], colours: &[&str]) -> Result<usize, String> {
        let layers = layers.iter().map(|&l| l.to_owned()).collect();
        let colours = colours.iter().map(|c| tracelight_formats::colour_of(c).unwrap()).collect();
        let chosen = Choice { layers, colours, no_go: vec![], places: false }.of("a.svg", drawing(), &[]);
        chosen.map(|(drawn, _)| drawn.strokes.len()).map_err(|failure| failure.message)
    }

    #[test]
    fn layers_and_colours_choose_together() {
        assert_eq!(chosen(&[], &[]), Ok(4));
        assert_eq!(chosen(&["cut"], &[]), Ok(1));
        assert_eq!(chosen(&["Cut", "engrave"], &[]), Ok(3));
        assert_eq!(chosen(&[], &["#F00", "blue"]), Ok(3));
        assert_eq!(chosen(&["Engrave"], &["red"]), Ok(1));
    }

    #[test]
    fn what_is_not_there_is_refused_with_what_is() {
        assert_eq!(
            chosen(&["Score"], &[]).unwrap_err(),
            "a.svg: no stroke has the layer Score; there are: Cut, Engrave"
        );
        let message = chosen(&[], &["lime"]).unwrap_err();
        assert_eq!(message, "a.svg: no stroke has the colour #00ff00; there are: #ff0000, #0000ff");
        assert!(chosen(&["Cut"], &["blue"]).unwrap_err().contains("ask for less"));
        let bare =
            Choice { layers: vec!["Cut".into()], ..Choice::default() }.of("a.png", Drawing::default(), &[]);
        assert!(bare.unwrap_err().message.contains("it has no layers"));
    }

    #[test]
    fn places_are_enough_where_they_are_what_is_wanted() {
        let place = |layer: &str| Place {
            at: Point::ORIGIN,
            kind: tracelight_stroke::PlaceKind::Block,
            block: Some("Socket".into()),
            layer: Some(layer.into()),
            colour: None,
            entity: None,
        };
        let of = |layer: &str, places: bool| {
            let choice = Choice { layers: vec![layer.into()], places, ..Choice::default() };
            choice.of("a.dxf", drawing(), &[place("Sockets")])
        };
        assert!(of("sockets", false).is_err());
        assert!(of("sockets", true).unwrap().0.strokes.is_empty());
        assert!(of("lamps", true).unwrap_err().message.contains("Sockets"));
    }
}
