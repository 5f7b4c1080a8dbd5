use kurbo::Point;

/// Length of the polyline through the points, in the points' unit.
pub fn polyline_length(points: &[Point]) -> f64 {
    points.windows(2).map(|w| w[0].distance(w[1])).sum()
}
