//! `seen.csv`: what a camera saw of the spot while it drew.

use std::fmt::Write;

use tracelight_eye::seen::SeenMark;

/// `seen.csv`: where the spot was seen, a row an image.
#[must_use]
pub fn seen_csv(marks: &[SeenMark]) -> String {
    let mut text = String::from("t_s,seen_x_m,seen_y_m,asked_x_m,asked_y_m,off_mm\n");
    for mark in marks {
        let SeenMark { time_s, seen, asked } = mark;
        // writing to a String cannot fail
        let _ = writeln!(
            text,
            "{time_s:.4},{:.6},{:.6},{:.6},{:.6},{:.3}",
            seen.x,
            seen.y,
            asked.x,
            asked.y,
            mark.off_mm()
        );
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use tracelight_stroke::Point;

    #[test]
    fn a_row_tells_where_it_was_seen_and_how_far_off() {
        let mark = SeenMark { time_s: 1.5, seen: Point::new(0.1, -0.2), asked: Point::new(0.1, -0.2003) };
        let text = seen_csv(&[mark]);
        assert_eq!(text.lines().nth(1), Some("1.5000,0.100000,-0.200000,0.100000,-0.200300,0.300"));
    }
}
