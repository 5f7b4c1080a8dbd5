//! A drawing on the target as CSV: `stroke,x_m,y_m`, metres, y up, origin at the picture's centre.

use std::fmt::Write;

use tracelight_stroke::{Drawing, Point, Stroke};

use crate::pen::polyline;
use crate::{FormatError, check_size, is_sound, text};

/// First line of a file.
const HEADER: [&str; 3] = ["stroke", "x_m", "y_m"];

/// One row a point, strokes numbered from 0 in tracing order; curves within `tolerance_m`. A closed stroke repeats
/// its first point. Numbers are the shortest that read back the same.
pub fn write(drawing: &Drawing, tolerance_m: f64) -> String {
    let mut csv = HEADER.join(",") + "\n";
    for (number, stroke) in drawing.strokes.iter().enumerate() {
        for point in stroke.path.flatten(tolerance_m) {
            let _ = writeln!(csv, "{number},{},{}", point.x, point.y);
        }
    }
    csv
}

/// Reads what [`write`] writes: consecutive rows of one number are a stroke, closed when its last point is its
/// first. Columns after the third are ignored, and so are empty lines.
///
/// # Errors
/// The line, field and value of the first row that cannot be read; strokes of one point; files of none.
pub fn read(bytes: &[u8]) -> Result<Drawing, FormatError> {
    check_size(bytes)?;
    let rows = text(bytes)?.lines().enumerate().map(|(i, row)| (i + 1, row.trim_end()));
    let mut rows = rows.filter(|(_, row)| !row.is_empty());
    match rows.next() {
        Some((line, header)) => check_header(line, header)?,
        None => return Err(FormatError::Nothing { hint: "the CSV is empty" }),
    }
    let mut drawing = Drawing::default();
    let mut stroke = Gathered { line: 0, number: 0, points: Vec::new() };
    for (line, row) in rows {
        let (number, point) = parse(line, row)?;
        if number != stroke.number || stroke.points.is_empty() {
            drawing.strokes.extend(stroke.finish()?);
            stroke = Gathered { line, number, points: Vec::new() };
        }
        stroke.points.push(point);
    }
    drawing.strokes.extend(stroke.finish()?);
    match drawing.strokes.is_empty() {
        true => Err(FormatError::Nothing { hint: "the CSV has no rows below its header" }),
        false => Ok(drawing),
    }
}

fn check_header(line: usize, header: &str) -> Result<(), FormatError> {
    match header.split(',').map(str::trim).take(3).eq(HEADER) {
        true => Ok(()),
        false => Err(value(line, "header", header, "stroke,x_m,y_m")),
    }
}

fn parse(line: usize, row: &str) -> Result<(i64, Point), FormatError> {
    let mut fields = row.split(',').map(str::trim);
    let mut next = || fields.next().unwrap_or_default();
    let (number, x, y) = (next(), next(), next());
    let number = number.parse().map_err(|_| value(line, "stroke", number, "a whole number"))?;
    let point = Point::new(metres(line, "x_m", x)?, metres(line, "y_m", y)?);
    match is_sound(point) {
        true => Ok((number, point)),
        false => Err(FormatError::Far { place: format!("line {line}"), x: point.x, y: point.y }),
    }
}

fn metres(line: usize, field: &'static str, text: &str) -> Result<f64, FormatError> {
    let number = text.parse::<f64>().ok().filter(|v| !v.is_nan());
    number.ok_or_else(|| value(line, field, text, "a number of metres, such as 0.125"))
}

fn value(line: usize, field: &'static str, found: &str, expected: &'static str) -> FormatError {
    // a file of one endless line must not become an endless message
    let value = match found.is_empty() {
        true => "missing".into(),
        false => format!("{:?}", found.chars().take(40).collect::<String>()),
    };
    FormatError::Value { place: format!("line {line}"), field, value, expected }
}

/// Rows of one stroke.
struct Gathered {
    /// The first one's.
    line: usize,
    number: i64,
    points: Vec<Point>,
}

impl Gathered {
    fn finish(self) -> Result<Option<Stroke>, FormatError> {
        if self.points.is_empty() {
            return Ok(None);
        }
        let closed = self.points.len() > 2 && self.points.first() == self.points.last();
        let path = polyline(&self.points, closed).ok_or_else(|| FormatError::Value {
            place: format!("line {}", self.line),
            field: "stroke",
            value: format!("{} with a single point", self.number),
            expected: "two or more different points",
        })?;
        Ok(Some(Stroke::new(path)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tracelight_stroke::{Element, Path};

    #[test]
    fn a_drawing_comes_back_from_csv() {
        let mut open = Path::new(Point::new(0.0, 0.1 + 0.2));
        open.line_to(Point::new(0.25, 0.5));
        let corners = [(0., 0.), (1., 0.), (0., 1.)].map(Point::from);
        let triangle = Path::polyline(&corners, true).unwrap();
        let drawing = Drawing { strokes: [open, triangle].map(Stroke::new).into() };
        let csv = write(&drawing, 1e-6);
        assert!(csv.starts_with("stroke,x_m,y_m\n0,0,0.30000000000000004\n"), "{csv}");
        assert_eq!(read(csv.as_bytes()).unwrap(), drawing);
    }

    #[test]
    fn curves_are_flattened_to_the_tolerance() {
        let mut arc = Path::new(Point::new(1.0, 0.0));
        arc.push(Element::Arc { centre: Point::ORIGIN, sweep: 3.0 });
        let back = read(write(&Drawing { strokes: vec![Stroke::new(arc)] }, 1e-4).as_bytes()).unwrap();
        assert!((back.length(1e-9) - 3.0).abs() < 1e-3);
    }

    #[test]
    fn spreadsheets_csv_is_read_too() {
        let csv = "\u{feff}stroke, x_m ,y_m,note\r\n7,0,0,a\r\n7,1,0,b\r\n\r\n9,1e-1,.5\r\n9,2,2\r\n";
        let drawing = read(csv.as_bytes()).unwrap();
        assert_eq!(drawing.strokes.len(), 2);
        assert_eq!(drawing.strokes[1].path.start(), Point::new(0.1, 0.5));
    }

    #[test]
    fn each_broken_row_is_named() {
        let check = |csv: &str, message: &str| {
            let found = read(csv.as_bytes()).unwrap_err().to_string();
            assert!(found.contains(message), "{csv:?}: {found}");
        };
        check("", "empty");
        check("x,y\n0,0\n", "line 1: header is \"x,y\", expected stroke,x_m,y_m");
        check("stroke,x_m,y_m\n", "no rows");
        check("stroke,x_m,y_m\n0,0,0\n0,1,zwei\n", "line 3: y_m is \"zwei\"");
        check("stroke,x_m,y_m\n0,0\n", "line 2: y_m is missing");
        check("stroke,x_m,y_m\n0.5,0,0\n", "line 2: stroke is \"0.5\", expected a whole number");
        check("stroke,x_m,y_m\n0,NaN,0\n", "line 2: x_m is \"NaN\"");
        check("stroke,x_m,y_m\n0,inf,0\n", "line 2: the point (inf, 0) lies beyond");
        check("stroke,x_m,y_m\n0,1e308,0\n", "line 2: the point (1000");
        check("stroke,x_m,y_m\n0,0,0\n1,0,0\n1,1,1\n", "line 2: stroke is 0 with a single point");
        let endless = "9".repeat(1 << 20);
        let message = read(format!("stroke,x_m,y_m\n{endless}").as_bytes()).unwrap_err().to_string();
        assert!(message.len() < 200);
        assert_eq!(read(b"stroke\xff"), Err(FormatError::NotText { offset: 6 }));
    }
}
