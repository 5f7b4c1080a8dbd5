//! Figures of curves as SVG: panels in a grid under one title and one legend.

use plotters::chart::ChartContext;
use plotters::coord::Shift;
use plotters::coord::ranged1d::{Ranged, ValueFormatter};
use plotters::prelude::{
    Cartesian2d, ChartBuilder, Circle, DashedLineSeries, DrawingArea, EmptyElement, IntoDrawingArea,
    IntoFont, IntoLogRange, LineSeries, PathElement, RGBColor, SVGBackend, Text,
};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color, TextStyle};

/// A page of panels.
pub(crate) struct Figure {
    pub(crate) title: String,
    /// What each colour stands for.
    pub(crate) legend: Vec<Key>,
    /// Row by row.
    pub(crate) panels: Vec<Panel>,
    /// Panels beside each other.
    pub(crate) columns: usize,
    /// Size of a panel, pixels.
    pub(crate) panel: (i32, i32),
}

/// An entry of the legend.
pub(crate) struct Key {
    pub(crate) colour: Colour,
    pub(crate) name: String,
}

/// One diagram.
pub(crate) struct Panel {
    pub(crate) x_title: String,
    pub(crate) y_title: String,
    pub(crate) curves: Vec<Curve>,
    /// Values of y that are marked by a line.
    pub(crate) levels: Vec<f64>,
    pub(crate) scale: Scale,
}

/// How values become places.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Scale {
    /// Each axis as its values need.
    Free,
    /// A unit is as long on both axes.
    Even,
    /// Both axes logarithmic; what is not positive is not drawn.
    Log,
}

/// One line of a diagram.
pub(crate) struct Curve {
    pub(crate) colour: Colour,
    pub(crate) pen: Pen,
    /// NaN lifts the pen.
    pub(crate) points: Vec<(f64, f64)>,
}

/// How a curve is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Pen {
    Solid,
    Dashed,
    /// Points, not joined.
    Dots,
}

/// Colours that people who see red and green alike can tell apart (Okabe and Ito, "Color universal design", 2008).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Colour {
    Vermilion,
    Blue,
    Green,
    Purple,
    Orange,
    Sky,
    Black,
}

impl Colour {
    const fn rgb(self) -> RGBColor {
        match self {
            Colour::Vermilion => RGBColor(213, 94, 0),
            Colour::Blue => RGBColor(0, 114, 178),
            Colour::Green => RGBColor(0, 158, 115),
            Colour::Purple => RGBColor(204, 121, 167),
            Colour::Orange => RGBColor(230, 159, 0),
            Colour::Sky => RGBColor(86, 180, 233),
            Colour::Black => RGBColor(20, 20, 20),
        }
    }
}

/// The backend rounds to whole units: so many of them make a pixel.
const FINE: i32 = 8;
/// What is above all panels, pixels.
const TITLE: i32 = 40;
const LEGEND_ROW: i32 = 22;
const KEY_WIDTH: i32 = 200;
const INK: RGBColor = RGBColor(51, 51, 51);
const FAINT: RGBColor = RGBColor(225, 225, 225);

/// Nothing goes wrong in drawing into a text; the backend's interface says it might.
type Drawn = Result<(), Box<dyn std::error::Error>>;

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

type Chart<'a, X, Y> = ChartContext<'a, SVGBackend<'a>, Cartesian2d<X, Y>>;

impl Figure {
    /// The figure as an SVG file.
    pub(crate) fn svg(&self) -> Result<String, Box<dyn std::error::Error>> {
        let columns = self.columns.clamp(1, self.panels.len().max(1));
        let rows = self.panels.len().div_ceil(columns).max(1);
        let width = self.panel.0 * columns as i32;
        let keys_a_row = (width / KEY_WIDTH).max(1);
        let legend_rows = (self.legend.len() as i32 + keys_a_row - 1) / keys_a_row;
        let head = TITLE + LEGEND_ROW * legend_rows;
        let height = head + self.panel.1 * rows as i32;
        let mut text = String::new();
        {
            let size = ((FINE * width) as u32, (FINE * height) as u32);
            let root = SVGBackend::with_string(&mut text, size).into_drawing_area();
            root.fill(&RGBColor(255, 255, 255))?;
            let (top, rest) = root.split_vertically(FINE * head);
            self.head(&top, keys_a_row)?;
            for (panel, area) in self.panels.iter().zip(rest.split_evenly((rows, columns))) {
                panel.draw(&area, self.panel)?;
            }
            root.present()?;
        }
        let fine = format!(r#"width="{}" height="{}""#, FINE * width, FINE * height);
        Ok(text.replacen(&fine, &format!(r#"width="{width}" height="{height}""#), 1))
    }

    fn head(&self, area: &Area<'_>, keys_a_row: i32) -> Drawn {
        let title = lettering(17).pos(Pos::new(HPos::Left, VPos::Center));
        area.draw(&Text::new(self.title.as_str(), (FINE * 12, FINE * 20), title))?;
        for (i, key) in (0..).zip(&self.legend) {
            let (x, y) = (12 + KEY_WIDTH * (i % keys_a_row), TITLE + LEGEND_ROW * (i / keys_a_row));
            let line = [(FINE * x, FINE * y), (FINE * (x + 22), FINE * y)];
            area.draw(&PathElement::new(line, key.colour.rgb().stroke_width(2 * FINE as u32)))?;
            let name = lettering(14).pos(Pos::new(HPos::Left, VPos::Center));
            area.draw(&Text::new(key.name.as_str(), (FINE * (x + 30), FINE * y), name))?;
        }
        Ok(())
    }
}

fn lettering<'a>(pixels: i32) -> TextStyle<'a> {
    ("sans-serif", FINE * pixels).into_font().color(&INK)
}

impl Curve {
    fn draw<X, Y>(&self, chart: &mut Chart<'_, X, Y>) -> Drawn
    where
        X: Ranged<ValueType = f64>,
        Y: Ranged<ValueType = f64>,
    {
        let style = self.colour.rgb().stroke_width((3 * FINE / 2) as u32);
        let dot = |&at: &(f64, f64)| EmptyElement::at(at) + Circle::new((0, 0), FINE * 2, style.filled());
        if self.pen == Pen::Dots {
            chart.draw_series(self.points.iter().map(dot))?;
            return Ok(());
        }
        for run in self.points.split(|p| p.1.is_nan()) {
            let run = run.iter().copied();
            if self.pen == Pen::Dashed {
                chart.draw_series(DashedLineSeries::new(run, FINE * 5, FINE * 3, style))?;
            } else {
                chart.draw_series(LineSeries::new(run, style))?;
            }
        }
        Ok(())
    }
}

impl Panel {
    fn draw(&self, area: &Area<'_>, size: (i32, i32)) -> Drawn {
        let (x, y) = self.ranges(size);
        let mut chart = ChartBuilder::on(area);
        chart
            .margin(FINE * 8)
            .margin_right(FINE * 20)
            .x_label_area_size(FINE * 40)
            .y_label_area_size(FINE * 64);
        if self.scale == Scale::Log {
            let (x, y) = ((x.low..x.high).log_scale(), (y.low..y.high).log_scale());
            self.fill(chart.build_cartesian_2d(x, y)?)
        } else {
            self.fill(chart.build_cartesian_2d(x.low..x.high, y.low..y.high)?)
        }
    }

    fn fill<X, Y>(&self, mut chart: Chart<'_, X, Y>) -> Drawn
    where
        X: Ranged<ValueType = f64> + ValueFormatter<f64>,
        Y: Ranged<ValueType = f64> + ValueFormatter<f64>,
    {
        chart
            .configure_mesh()
            .x_labels(6)
            .y_labels(6)
            .max_light_lines(0)
            .bold_line_style(FAINT.stroke_width(FINE as u32))
            .axis_style(INK.stroke_width(FINE as u32))
            .label_style(lettering(13))
            .axis_desc_style(lettering(14))
            .x_label_formatter(&|v| label(*v))
            .y_label_formatter(&|v| label(*v))
            .set_all_tick_mark_size(FINE * 4)
            .x_desc(self.x_title.as_str())
            .y_desc(self.y_title.as_str())
            .draw()?;
        let x = chart.x_range();
        for &level in &self.levels {
            let line = [(x.start, level), (x.end, level)];
            let dashes = DashedLineSeries::new(line, FINE * 6, FINE * 4, INK.stroke_width(FINE as u32));
            chart.draw_series(dashes)?;
        }
        for curve in &self.curves {
            curve.draw(&mut chart)?;
        }
        Ok(())
    }

    fn ranges(&self, size: (i32, i32)) -> (Range, Range) {
        let log = self.scale == Scale::Log;
        let shown = move |p: &&(f64, f64)| !log || (p.0 > 0.0 && p.1 > 0.0);
        let points = || self.curves.iter().flat_map(|curve| &curve.points).filter(shown);
        let mut x = Range::of(points().map(|p| p.0));
        let mut y = Range::of(points().map(|p| p.1).chain(self.levels.iter().copied()));
        if self.scale == Scale::Log {
            (x, y) = (x.decades(), y.decades());
        } else if self.scale == Scale::Even {
            // what is left of a panel for its curves
            let (width, height) = (f64::from(size.0 - 90), f64::from(size.1 - 54));
            let unit = f64::max(x.span() / width, y.span() / height);
            x.widen(unit * width);
            y.widen(unit * height);
        } else {
            y.widen(1.08 * y.span());
        }
        (x, y)
    }
}

/// What an axis shows.
#[derive(Clone, Copy, Debug)]
struct Range {
    low: f64,
    high: f64,
}

impl Range {
    /// From the least to the greatest of some values, with some room where they are all one.
    fn of(values: impl Iterator<Item = f64>) -> Self {
        let seen = values.filter(|v| v.is_finite());
        let (low, high) = seen.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
        let size = low.abs().max(high.abs());
        match (low.is_finite(), high - low) {
            (true, span) if span > 1e-9 * size => Self { low, high },
            (true, _) => Self { low: low - 0.5 * size.max(1e-3), high: high + 0.5 * size.max(1e-3) },
            (false, _) => Self { low: 0.0, high: 1.0 },
        }
    }

    /// Somewhat wider on a logarithmic axis.
    fn decades(&self) -> Self {
        Self { low: 0.8 * self.low, high: 1.25 * self.high }
    }

    fn span(&self) -> f64 {
        self.high - self.low
    }

    fn widen(&mut self, span: f64) {
        let more = 0.5 * (span - self.span()).max(0.0);
        (self.low, self.high) = (self.low - more, self.high + more);
    }
}

/// A label without idle zeros, and with a true minus sign.
fn label(value: f64) -> String {
    let text = format!("{value:.6}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if matches!(text, "-0" | "0") { "0".to_owned() } else { text.replace('-', "−") }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn panel(points: Vec<(f64, f64)>) -> Panel {
        let curve = Curve { colour: Colour::Blue, pen: Pen::Solid, points };
        Panel {
            x_title: "t, s".into(),
            y_title: "<v>".into(),
            curves: vec![curve],
            levels: vec![],
            scale: Scale::Free,
        }
    }

    fn svg(panels: Vec<Panel>) -> String {
        let legend = vec![Key { colour: Colour::Blue, name: "a & b".into() }];
        Figure { title: "A title".into(), legend, panels, columns: 2, panel: (400, 250) }.svg().unwrap()
    }

    #[test]
    fn a_figure_is_one_svg_with_its_words_escaped() {
        let svg = svg(vec![panel(vec![(0.0, 0.0), (1.0, 2.0)]), panel(vec![(0.0, 1.0), (1.0, 1.0)])]);
        assert!(svg.starts_with("<svg width=\"800\""), "{}", &svg[..80]);
        assert!(svg.contains("a &amp; b") && svg.contains("&lt;v&gt;") && svg.trim_end().ends_with("</svg>"));
    }

    #[test]
    fn nothing_and_nonsense_are_drawn_too() {
        for points in [vec![], vec![(0.0, f64::NAN)], vec![(1.0, 1.0); 3], vec![(0.0, 1e300), (1.0, -1e300)]]
        {
            assert!(svg(vec![panel(points)]).contains("</svg>"));
        }
    }

    #[test]
    fn labels_have_no_idle_zeros() {
        let labels = [0.1 + 0.2, -0.25, -1e-9, 2000.0].map(label);
        assert_eq!(labels, ["0.3", "−0.25", "0", "2000"]);
    }
}
