//! Panels of curves, and how they are drawn.

use plotters::coord::Shift;
use plotters::coord::ranged1d::{Ranged, ValueFormatter};
use plotters::prelude::{
    ChartBuilder, DashedLineSeries, DrawingArea, IntoDrawingArea, IntoLogRange, PathElement, SVGBackend, Text,
};
use plotters::style::Color;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use crate::arrow::{self, Arrows};
use crate::colour::Colour;
use crate::label::{self, Label, Rect, Taken};
use crate::legend;
use crate::lettering::{FINE, LARGE, NORMAL, SMALL, lettering};
use crate::linear::Linear;
use crate::range::{Range, inside};
use crate::shape::{Band, Chart, Curve, Drawn, Guide, Mark, Pen, pixel};
use crate::theme::Theme;
use crate::words::{Words, told};

/// A page of panels.
#[derive(Clone, Debug)]
pub struct Figure {
    /// Above all panels.
    pub title: String,
    /// What each colour stands for.
    pub legend: Vec<Key>,
    /// Row by row.
    pub panels: Vec<Panel>,
    /// Panels beside each other.
    pub columns: usize,
    /// Size of a panel, pixels.
    pub panel: (i32, i32),
    /// Its ground.
    pub theme: Theme,
}

/// An entry of the legend.
#[derive(Clone, Debug)]
pub struct Key {
    /// Of the curve.
    pub colour: Colour,
    /// What it is.
    pub name: String,
}

impl Key {
    /// Of a colour and a name.
    pub fn new(colour: Colour, name: impl Into<String>) -> Self {
        Self { colour, name: name.into() }
    }
}

/// One diagram.
#[derive(Clone, Debug, Default)]
pub struct Panel {
    /// With the unit.
    pub x_title: String,
    /// With the unit.
    pub y_title: String,
    /// From the one below to the one on top.
    pub curves: Vec<Curve>,
    /// Values of y that are marked by a line.
    pub levels: Vec<f64>,
    /// How values become places.
    pub scale: Scale,
    /// Faint lines behind the curves, and what is written at their ends.
    pub guides: Vec<Guide>,
    /// Single places.
    pub marks: Vec<Mark>,
    /// Ranges of y that are shaded.
    pub bands: Vec<Band>,
    /// Which way lines are gone along.
    pub arrows: Vec<Arrows>,
    /// Words beside places; those that matter most first.
    pub labels: Vec<Label>,
    /// What is shown: from and to on x, and on y; otherwise all there is.
    pub view: Option<[(f64, f64); 2]>,
    /// Distance of the lines across, where it should be another than the usual.
    pub y_step: Option<f64>,
}

/// How values become places.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Scale {
    /// Each axis as its values need.
    #[default]
    Free,
    /// A unit is as long on both axes.
    Even,
    /// Both axes logarithmic; what is not positive is not drawn.
    Log,
    /// Only x logarithmic.
    LogX,
}

/// What is above all panels, pixels.
const TITLE: i32 = 40;

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

impl Figure {
    /// The figure as an SVG file.
    ///
    /// # Errors
    /// What the drawing library says; into a text nothing goes wrong.
    pub fn svg(&self) -> Result<String, Box<dyn std::error::Error>> {
        let columns = self.columns.clamp(1, self.panels.len().max(1));
        let rows = self.panels.len().div_ceil(columns).max(1);
        let width = self.panel.0 * columns as i32;
        let names: Vec<&str> = self.legend.iter().map(|key| key.name.as_str()).collect();
        let keys = legend::places(&names, width);
        let legend_rows = keys.last().map_or(0, |place| place.1 + 1);
        let head = TITLE + legend::ROW * legend_rows;
        let height = head + self.panel.1 * rows as i32;
        let mut text = String::new();
        {
            let size = ((FINE * width) as u32, (FINE * height) as u32);
            let root = SVGBackend::with_string(&mut text, size).into_drawing_area();
            root.fill(&self.theme.ground().plotted())?;
            let (top, rest) = root.split_vertically(FINE * head);
            self.head(&top, &keys)?;
            let areas = rest.split_evenly((rows, columns));
            for (number, (panel, area)) in self.panels.iter().zip(areas).enumerate() {
                // of diagrams below each other the lowest names the axis they have in common
                let below = self.panels.get(number + columns);
                let names_x = below.is_none_or(|below| below.x_title != panel.x_title);
                panel.draw(&area, self.panel, (self.theme, names_x))?;
            }
            root.present()?;
        }
        let fine = format!(r#"width="{}" height="{}""#, FINE * width, FINE * height);
        let sized = text.replacen(&fine, &format!(r#"width="{width}" height="{height}""#), 1);
        let axes = self.panels.iter().map(|p| (p.x_title.as_str(), p.y_title.as_str())).collect();
        let marked = self.panels.iter().flat_map(|p| &p.labels).map(|label| label.text.as_str()).collect();
        Ok(told(&sized, &Words { title: &self.title, axes, names, marked }, self.theme == Theme::Light))
    }

    fn head(&self, area: &Area<'_>, keys: &[(i32, i32)]) -> Drawn {
        let title = lettering(LARGE, self.theme.ink()).pos(Pos::new(HPos::Left, VPos::Center));
        area.draw(&Text::new(self.title.as_str(), (FINE * legend::EDGE, FINE * 20), title))?;
        for (&(x, row), key) in keys.iter().zip(&self.legend) {
            let y = TITLE + legend::ROW * row;
            let line = [(FINE * x, FINE * y), (FINE * (x + legend::LINE), FINE * y)];
            let style = key.colour.rgb(self.theme).plotted().stroke_width(2 * FINE as u32);
            area.draw(&PathElement::new(line, style))?;
            let name = lettering(NORMAL, self.theme.ink()).pos(Pos::new(HPos::Left, VPos::Center));
            area.draw(&Text::new(key.name.as_str(), (FINE * (x + legend::TO_NAME), FINE * y), name))?;
        }
        Ok(())
    }
}

impl Panel {
    fn draw(&self, area: &Area<'_>, size: (i32, i32), how: (Theme, bool)) -> Drawn {
        let (x, y) = self.ranges(size);
        let (x, y) =
            (x.sane(matches!(self.scale, Scale::Log | Scale::LogX)), y.sane(self.scale == Scale::Log));
        let mut chart = ChartBuilder::on(area);
        chart
            .margin(FINE * 8)
            .margin_right(FINE * 20)
            .x_label_area_size(FINE * 40)
            .y_label_area_size(FINE * 70);
        let shown = (x, y);
        let (across, up) = (x.low..x.high, Linear::new(y, self.y_step));
        match self.scale {
            Scale::Log => {
                let up = (y.low..y.high).log_scale();
                self.fill(chart.build_cartesian_2d(across.log_scale(), up)?, shown, how)
            }
            Scale::LogX => self.fill(chart.build_cartesian_2d(across.log_scale(), up)?, shown, how),
            Scale::Free | Scale::Even => self.fill(chart.build_cartesian_2d(across, up)?, shown, how),
        }
    }

    fn fill<X, Y>(
        &self,
        mut chart: Chart<'_, X, Y>,
        shown: (Range, Range),
        (theme, names_x): (Theme, bool),
    ) -> Drawn
    where
        X: Ranged<ValueType = f64> + ValueFormatter<f64>,
        Y: Ranged<ValueType = f64> + ValueFormatter<f64>,
    {
        let (ink, grid) = (theme.ink().plotted(), theme.grid().plotted());
        chart
            .configure_mesh()
            .x_labels(6)
            .y_labels(if self.y_step.is_some() { 12 } else { 6 })
            .x_max_light_lines(if self.scale == Scale::LogX { 9 } else { 0 })
            .y_max_light_lines(0)
            .bold_line_style(grid.stroke_width(FINE as u32))
            .light_line_style(theme.fainter().plotted().stroke_width(FINE as u32))
            .axis_style(ink.stroke_width(FINE as u32))
            .label_style(lettering(SMALL, theme.ink()))
            .axis_desc_style(lettering(NORMAL, theme.ink()))
            .x_label_formatter(&|v| label(*v))
            .y_label_formatter(&|v| label(*v))
            .set_all_tick_mark_size(FINE * 4)
            .x_desc(if names_x { self.x_title.as_str() } else { "" })
            .y_desc(self.y_title.as_str())
            .draw()?;
        for band in &self.bands {
            band.draw(&mut chart, shown, theme)?;
        }
        let mut written: Vec<Rect> = Vec::new();
        for guide in &self.guides {
            let place = guide.words(&chart, shown);
            let is_free = place.is_some_and(|place| written.iter().all(|other| !other.meets(&place)));
            written.extend(place.filter(|_| is_free));
            guide.draw(&mut chart, shown, (theme, is_free))?;
        }
        let (x, y) = shown;
        for &level in self.levels.iter().filter(|level| y.holds(**level)) {
            let line = [(x.low, level), (x.high, level)];
            let dashes = DashedLineSeries::new(line, FINE * 6, FINE * 4, ink.stroke_width(FINE as u32));
            chart.draw_series(dashes)?;
        }
        for curve in &self.curves {
            curve.draw(&mut chart, shown, theme)?;
        }
        let marks = self.marks.iter().filter(|mark| x.holds(mark.at.0) && y.holds(mark.at.1));
        for mark in marks {
            mark.draw(&mut chart, theme)?;
        }
        self.explain(&chart, shown, (theme, written))
    }

    /// Arrows, and words where they cover nothing.
    fn explain<X, Y>(
        &self,
        chart: &Chart<'_, X, Y>,
        (x, y): (Range, Range),
        (theme, written): (Theme, Vec<Rect>),
    ) -> Drawn
    where
        X: Ranged<ValueType = f64>,
        Y: Ranged<ValueType = f64>,
    {
        if self.arrows.is_empty() && self.labels.is_empty() {
            return Ok(());
        }
        let area = chart.plotting_area();
        let (across, down) = area.get_pixel_range();
        let pixel = |at: &(f64, f64)| pixel(chart, *at);
        let pixels = |points: &[(f64, f64)]| -> Vec<Vec<(f64, f64)>> {
            inside(points, x, y).iter().map(|run| run.iter().map(pixel).collect()).collect()
        };
        let length = |range: &std::ops::Range<i32>| f64::from(range.end - range.start) / f64::from(FINE);
        let mut taken = Taken::new((length(&across), length(&down)));
        for curve in self.curves.iter().filter(|curve| curve.pen != Pen::Dots) {
            pixels(&curve.points).iter().for_each(|run| taken.line(run));
        }
        let shown = |at: &(f64, f64)| x.holds(at.0) && y.holds(at.1);
        for mark in self.marks.iter().filter(|mark| shown(&mark.at)) {
            taken.rect(Rect::about(pixel(&mark.at), 5.0));
        }
        for &level in &self.levels {
            pixels(&[(x.low, level), (x.high, level)]).iter().for_each(|run| taken.line(run));
        }
        written.into_iter().for_each(|words| taken.rect(words));
        let plain = area.strip_coord_spec();
        for arrows in &self.arrows {
            let heads = arrow::heads(&pixels(&arrows.points), arrows.count);
            heads.iter().for_each(|head| taken.rect(Rect::about(head.middle, 4.0)));
            arrow::draw(&plain, &heads, arrows, theme)?;
        }
        let labels = self.labels.iter().filter(|label| shown(&label.at));
        let labels: Vec<_> = labels.map(|label| (pixel(&label.at), label.text.as_str())).collect();
        label::draw(&plain, &labels, &mut taken, theme)
    }

    fn ranges(&self, size: (i32, i32)) -> (Range, Range) {
        if let Some([x, y]) = self.view {
            return (Range { low: x.0, high: x.1 }, Range { low: y.0, high: y.1 });
        }
        let (log_x, log_y) = (matches!(self.scale, Scale::Log | Scale::LogX), self.scale == Scale::Log);
        let shown = move |p: &&(f64, f64)| (!log_x || p.0 > 0.0) && (!log_y || p.1 > 0.0);
        let marks = self.marks.iter().map(|mark| &mark.at);
        let points = || self.curves.iter().flat_map(|curve| &curve.points).chain(marks.clone()).filter(shown);
        let mut x = Range::of(points().map(|p| p.0));
        let mut y = Range::of(points().map(|p| p.1).chain(self.levels.iter().copied()));
        if self.scale == Scale::Log {
            (x, y) = (x.decades(), y.decades());
        } else if self.scale == Scale::Even {
            // what is left of a panel for its curves
            let (width, height) = (f64::from(size.0 - 98), f64::from(size.1 - 54));
            let unit = f64::max(x.span() / width, y.span() / height);
            x.widen(unit * width);
            y.widen(unit * height);
        } else if self.y_step.is_none() {
            y.widen(1.08 * y.span());
        }
        if self.scale == Scale::LogX {
            x = Range { low: x.low, high: x.high.max(1.01 * x.low) };
        }
        if let Some(step) = self.y_step {
            // rounding beside a multiple is no reason for another
            y = Range {
                low: (y.low / step + 1e-6).floor() * step,
                high: (y.high / step - 1e-6).ceil() * step,
            };
            if y.high <= y.low {
                y = Range { low: y.low - step, high: y.low + step };
            }
        }
        (x, y)
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
        let curve = Curve { colour: Colour::Violet, pen: Pen::Solid, points };
        Panel {
            x_title: "t, s".into(),
            y_title: "<v>".into(),
            curves: vec![curve],
            levels: vec![],
            ..Panel::default()
        }
    }

    fn svg(panels: Vec<Panel>) -> String {
        let legend = vec![Key { colour: Colour::Violet, name: "a & b".into() }];
        Figure { title: "A title".into(), legend, panels, columns: 2, panel: (400, 250), theme: Theme::Light }
            .svg()
            .unwrap()
    }

    #[test]
    fn a_figure_is_one_svg_with_its_words_escaped() {
        let svg = svg(vec![panel(vec![(0.0, 0.0), (1.0, 2.0)]), panel(vec![(0.0, 1.0), (1.0, 1.0)])]);
        assert!(svg.starts_with("<svg width=\"800\""), "{}", &svg[..80]);
        assert!(svg.contains("<title>A title</title>\n<desc>Diagrams: &lt;v&gt; over t, s; &lt;v&gt; over t, s. Curves: a &amp; b.</desc>"));
        assert!(svg.contains("prefers-color-scheme:dark") && svg.contains("role=\"img\""));
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
