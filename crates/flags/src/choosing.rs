use clap::Args;
use tracelight_pipeline::Choice;
use tracelight_stroke::Colour;

/// Which strokes of a drawing are taken.
#[derive(Args, Clone, Debug, Default)]
pub struct ChoiceArgs {
    /// Only strokes on this layer of an SVG, DXF or JSON drawing; give it again for more layers
    #[arg(long, value_name = "NAME")]
    pub layer: Vec<String>,
    /// Only strokes of this colour, such as #ff0000 or red; give it again for more colours
    #[arg(long, visible_alias = "color", value_name = "#RRGGBB|NAME", value_parser = colour)]
    pub colour: Vec<Colour>,
}

fn colour(text: &str) -> Result<Colour, String> {
    tracelight_formats::colour_of(text)
        .ok_or_else(|| format!("{text} is no colour; give one such as #ff0000, red or steelblue"))
}

impl ChoiceArgs {
    /// What they mean.
    pub fn choice(&self) -> Choice {
        Choice { layers: self.layer.clone(), colours: self.colour.clone(), ..Choice::default() }
    }
}
