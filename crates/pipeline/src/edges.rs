//! From where on a wall places are measured.

use tracelight_stroke::{Point, Rect, Vec2};

/// The point of a wall, and of a drawing, that lengths are measured from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Corner {
    /// From the floor and the left edge: right and up.
    BottomLeft,
    /// Left and up.
    BottomRight,
    /// Right and down.
    TopLeft,
    /// Left and down.
    TopRight,
    /// Right and up of the middle.
    #[default]
    Centre,
}

/// From where on a wall places are measured, and where that is on the target.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Origin {
    /// Which corner.
    pub corner: Corner,
    /// Where on the target it is, m; straight ahead of the head where nobody says it.
    pub at: Option<Point>,
}

impl Corner {
    /// How it is called on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::BottomLeft => "bottom-left",
            Self::BottomRight => "bottom-right",
            Self::TopLeft => "top-left",
            Self::TopRight => "top-right",
            Self::Centre => "centre",
        }
    }

    /// Which way lengths go from it: right or left, up or down.
    const fn signs(self) -> (f64, f64) {
        match self {
            Self::BottomLeft | Self::Centre => (1.0, 1.0),
            Self::BottomRight => (-1.0, 1.0),
            Self::TopLeft => (1.0, -1.0),
            Self::TopRight => (-1.0, -1.0),
        }
    }

    /// Where it is of a rectangle of a width and height about the target's middle.
    #[must_use]
    pub fn of_centred(self, (width, height): (f64, f64)) -> Point {
        self.of(Rect::new(-0.5 * width, -0.5 * height, 0.5 * width, 0.5 * height))
    }

    /// Where it is of a rectangle.
    #[must_use]
    pub fn of(self, rect: Rect) -> Point {
        let (right, up) = self.signs();
        match self {
            Self::Centre => rect.center(),
            _ => Point::new(
                if right > 0.0 { rect.x0 } else { rect.x1 },
                if up > 0.0 { rect.y0 } else { rect.y1 },
            ),
        }
    }
}

impl Origin {
    /// Says that nobody told where the corner is.
    pub(crate) fn remark(&self) -> Option<String> {
        (self.at.is_none() && self.corner != Corner::Centre).then(|| {
            format!(
                "nobody says where the {} corner of the wall is: it is taken to be the point straight ahead of the head; --origin tells it",
                self.corner.name()
            )
        })
    }

    /// Where on the target a place is that is so far from the edges, m.
    #[must_use]
    pub fn place(&self, from_edges: Vec2) -> Point {
        let (right, up) = self.corner.signs();
        self.at.unwrap_or(Point::ORIGIN) + Vec2::new(right * from_edges.x, up * from_edges.y)
    }

    /// An area of a size whose corner towards the edges is so far from them, m; of the middle, its lower left one.
    #[must_use]
    pub fn area(&self, from_edges: Vec2, size: Vec2) -> Rect {
        Rect::from_points(self.place(from_edges), self.place(from_edges + size))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_measured_inwards_from_the_edges() {
        let from = |corner| Origin { corner, at: Some(Point::new(-1.5, 1.2)) };
        let check = |corner, at: (f64, f64)| {
            let place = from(corner).place(Vec2::new(0.4, 0.1));
            assert!(place.distance(Point::from(at)) < 1e-12, "{corner:?}: {place}");
        };
        check(Corner::BottomLeft, (-1.1, 1.3));
        check(Corner::BottomRight, (-1.9, 1.3));
        check(Corner::TopLeft, (-1.1, 1.1));
        check(Corner::TopRight, (-1.9, 1.1));
        check(Corner::Centre, (-1.1, 1.3));
        let area = from(Corner::TopRight).area(Vec2::new(0.1, 0.2), Vec2::new(0.5, 0.3));
        assert!((area.x1 + 1.6).abs() < 1e-12 && (area.x0 + 2.1).abs() < 1e-12, "{area:?}");
        assert!((area.y1 - 1.0).abs() < 1e-12 && (area.y0 - 0.7).abs() < 1e-12, "{area:?}");
    }
}
