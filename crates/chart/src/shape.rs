//! What a diagram is made of: curves, grids that are not straight, marks and bands, and how each is drawn.

use plotters::chart::ChartContext;
use plotters::coord::ranged1d::Ranged;
use plotters::prelude::{
    Cartesian2d, Circle, DashedLineSeries, EmptyElement, LineSeries, PathElement, Rectangle, SVGBackend, Text,
};
use plotters::style::Color;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use crate::colour::Colour;
use crate::label::Rect;
use crate::lettering::{FINE, SMALL, lettering};
use crate::range::{Range, inside};
use crate::theme::Theme;

/// Nothing goes wrong in drawing into a text; the backend's interface says it might.
pub(crate) type Drawn = Result<(), Box<dyn std::error::Error>>;

/// A diagram that is being drawn.
pub(crate) type Chart<'a, X, Y> = ChartContext<'a, SVGBackend<'a>, Cartesian2d<X, Y>>;

/// Where a place of a diagram is drawn: pixels from the left and from the top of what is inside its axes.
pub(crate) fn pixel<X, Y>(chart: &Chart<'_, X, Y>, at: (f64, f64)) -> (f64, f64)
where
    X: Ranged<ValueType = f64>,
    Y: Ranged<ValueType = f64>,
{
    let area = chart.plotting_area();
    let (across, down) = area.get_pixel_range();
    let fine = area.map_coordinate(&at);
    let pixels = |units: i32| f64::from(units) / f64::from(FINE);
    (pixels(fine.0 - across.start), pixels(fine.1 - down.start))
}

/// A range of y.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Band {
    /// From here.
    pub low: f64,
    /// To here.
    pub high: f64,
}

/// A line of a grid that is not straight.
#[derive(Clone, Debug)]
pub struct Guide {
    /// Its way.
    pub points: Vec<(f64, f64)>,
    /// At the last of its points that is shown; empty for none.
    pub label: String,
}

/// A single place.
#[derive(Clone, Debug)]
pub struct Mark {
    /// Of the sign.
    pub colour: Colour,
    /// What is put there.
    pub sign: Sign,
    /// x and y.
    pub at: (f64, f64),
}

/// What a place is marked with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sign {
    /// A pole.
    Cross,
    /// A zero.
    Ring,
    /// What was measured.
    Dot,
    /// A place on a curve that is written at.
    Point,
}

/// One line of a diagram.
#[derive(Clone, Debug)]
pub struct Curve {
    /// As in the legend.
    pub colour: Colour,
    /// How it is drawn.
    pub pen: Pen,
    /// NaN lifts the pen.
    pub points: Vec<(f64, f64)>,
}

/// How a curve is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pen {
    /// A line.
    Solid,
    /// A broken line.
    Dashed,
    /// Points, not joined.
    Dots,
    /// A see-through line.
    Faint,
    /// A see-through broken line.
    FaintDashed,
}

impl Curve {
    pub(crate) fn draw<X, Y>(
        &self,
        chart: &mut Chart<'_, X, Y>,
        (x, y): (Range, Range),
        theme: Theme,
    ) -> Drawn
    where
        X: Ranged<ValueType = f64>,
        Y: Ranged<ValueType = f64>,
    {
        let is_faint = matches!(self.pen, Pen::Faint | Pen::FaintDashed);
        let colour = self.colour.rgb(theme).plotted().mix(if is_faint { 0.5 } else { 1.0 });
        let style = colour.stroke_width((3 * FINE / 2) as u32);
        let dot = |&at: &(f64, f64)| EmptyElement::at(at) + Circle::new((0, 0), FINE * 2, style.filled());
        if self.pen == Pen::Dots {
            let shown = |p: &&(f64, f64)| x.holds(p.0) && y.holds(p.1);
            chart.draw_series(self.points.iter().filter(shown).map(dot))?;
            return Ok(());
        }
        for run in inside(&self.points, x, y) {
            let run = run.into_iter();
            if matches!(self.pen, Pen::Dashed | Pen::FaintDashed) {
                chart.draw_series(DashedLineSeries::new(run, FINE * 5, FINE * 3, style))?;
            } else {
                chart.draw_series(LineSeries::new(run, style))?;
            }
        }
        Ok(())
    }
}

impl Band {
    pub(crate) fn draw<X, Y>(self, chart: &mut Chart<'_, X, Y>, (x, y): (Range, Range), theme: Theme) -> Drawn
    where
        X: Ranged<ValueType = f64>,
        Y: Ranged<ValueType = f64>,
    {
        let (low, high) = (self.low.max(y.low), self.high.min(y.high));
        if low < high {
            let shade = Rectangle::new([(x.low, low), (x.high, high)], theme.grid().plotted().filled());
            chart.draw_series(std::iter::once(shade))?;
        }
        Ok(())
    }
}

impl Guide {
    /// Where its label is: at the last place that is shown, to the left of it, or to the right, above it, or below: inwards from the
    /// edge that the line leaves at.
    fn written(&self, x: Range, y: Range) -> Option<((f64, f64), bool, bool)> {
        let end = *inside(&self.points, x, y).last()?.last()?;
        let is_left = end.0 > 0.5 * (x.low + x.high);
        (!self.label.is_empty()).then_some((end, is_left, end.1 <= 0.5 * (y.low + y.high)))
    }

    /// What its label covers, pixels; none without a label.
    pub(crate) fn words<X, Y>(&self, chart: &Chart<'_, X, Y>, (x, y): (Range, Range)) -> Option<Rect>
    where
        X: Ranged<ValueType = f64>,
        Y: Ranged<ValueType = f64>,
    {
        let (end, is_left, is_above) = self.written(x, y)?;
        Some(Rect::beside(&self.label, pixel(chart, end), is_left, is_above))
    }

    pub(crate) fn draw<X, Y>(
        &self,
        chart: &mut Chart<'_, X, Y>,
        (x, y): (Range, Range),
        (theme, has_words): (Theme, bool),
    ) -> Drawn
    where
        X: Ranged<ValueType = f64>,
        Y: Ranged<ValueType = f64>,
    {
        for run in inside(&self.points, x, y) {
            chart.draw_series(LineSeries::new(run, theme.rule().plotted().stroke_width(FINE as u32)))?;
        }
        if let Some((end, is_left, is_above)) = self.written(x, y).filter(|_| has_words) {
            let across = if is_left { HPos::Right } else { HPos::Left };
            let along = if is_above { VPos::Bottom } else { VPos::Top };
            let style = lettering(SMALL, theme.soft()).pos(Pos::new(across, along));
            chart.draw_series(std::iter::once(Text::new(self.label.clone(), end, style)))?;
        }
        Ok(())
    }
}

impl Mark {
    pub(crate) fn draw<X, Y>(&self, chart: &mut Chart<'_, X, Y>, theme: Theme) -> Drawn
    where
        X: Ranged<ValueType = f64>,
        Y: Ranged<ValueType = f64>,
    {
        const SIZE: i32 = 5;
        let style = self.colour.rgb(theme).plotted().stroke_width((2 * FINE) as u32);
        let here = || EmptyElement::at(self.at);
        let arm = |way: i32| {
            PathElement::new([(-SIZE * FINE, -way * SIZE * FINE), (SIZE * FINE, way * SIZE * FINE)], style)
        };
        match self.sign {
            Sign::Cross => {
                chart.draw_series(std::iter::once(here() + arm(1) + arm(-1)))?;
            }
            Sign::Ring => {
                let ring = Circle::new((0, 0), SIZE * FINE, style);
                chart.draw_series(std::iter::once(here() + ring))?;
            }
            Sign::Dot | Sign::Point => {
                let size = if self.sign == Sign::Dot { SIZE - 1 } else { SIZE - 2 };
                let dot = Circle::new((0, 0), size * FINE, style.filled());
                chart.draw_series(std::iter::once(here() + dot))?;
            }
        }
        Ok(())
    }
}
