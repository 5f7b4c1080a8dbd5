//! A drawing on the target as CSV: `stroke,x_m,y_m`, metres, y up, origin at the picture's centre.

use std::fmt::Write;

use tracelight_stroke::{Drawing, Point, Stroke};

use crate::options::LengthUnit;
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

/// Reads what [`write`] writes, and tables like it: columns `x` and `y` (`x_m`, `x_mm`, `x_cm`, `x_in` and `x_ft` say
/// the unit, metres without), a column `stroke` or none, in any order. Fields are divided by commas, semicolons or tabs;
/// with the latter two numbers may have a decimal comma. Without a header the columns are `x,y`, or `stroke,x,y` where
/// there are three or more. Consecutive rows of one number are a stroke; without numbers an empty line ends one. A stroke
/// is closed when its last point is its first.
///
/// # Errors
/// The line, field and value of the first row that cannot be read; strokes of one point; files of none.
pub fn read(bytes: &[u8]) -> Result<Drawing, FormatError> {
    check_size(bytes)?;
    let text = text(bytes)?;
    let rows = text.lines().enumerate().map(|(i, row)| (i + 1, row.trim_end()));
    let mut rows = rows.skip_while(|(_, row)| row.is_empty()).peekable();
    let Some(&(line, first)) = rows.peek() else {
        return Err(FormatError::Nothing { hint: "the CSV is empty" });
    };
    let (table, has_header) = Table::of(line, first)?;
    let mut drawing = Drawing::default();
    let mut stroke = Gathered { line: 0, number: 0, points: Vec::new() };
    for (line, row) in rows.skip(usize::from(has_header)) {
        if row.is_empty() {
            if table.stroke.is_none() {
                drawing.strokes.extend(stroke.finish()?);
                stroke = Gathered { line, number: 0, points: Vec::new() };
            }
            continue;
        }
        let (number, point) = table.row(line, row)?;
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

/// Whether a file's first line is the header of a drawing.
#[must_use]
pub fn is_header(line: &str) -> bool {
    let divider = divider_of(line);
    Table::by_header(line.trim_end().split(divider), divider).is_some()
}

/// What divides the fields of a row.
fn divider_of(row: &str) -> char {
    [';', '\t'].into_iter().find(|&divider| row.contains(divider)).unwrap_or(',')
}

/// Where the fields of a row are.
struct Table {
    divider: char,
    stroke: Option<usize>,
    x: usize,
    y: usize,
    metres_per_unit: f64,
}

impl Table {
    /// The columns of a table by its first row, and whether that is a header.
    fn of(line: usize, row: &str) -> Result<(Self, bool), FormatError> {
        let divider = divider_of(row);
        let fields = || row.split(divider);
        if let Some(table) = Self::by_header(fields(), divider) {
            return Ok((table, true));
        }
        let is_number = |field: &str| number(field.trim(), divider).is_some();
        let count = fields().count();
        let stroke = (count > 2).then_some(0);
        let first = usize::from(count > 2);
        match count >= 2 && fields().take(first + 2).all(is_number) {
            true => Ok((Self { divider, stroke, x: first, y: first + 1, metres_per_unit: 1.0 }, false)),
            false => Err(value(line, "header", row, "stroke,x_m,y_m, or x and y, or numbers")),
        }
    }

    fn by_header<'a>(fields: impl Iterator<Item = &'a str>, divider: char) -> Option<Self> {
        const MOST_FIELDS: usize = 100;
        let names: Vec<String> = fields.take(MOST_FIELDS).map(|f| f.trim().to_ascii_lowercase()).collect();
        let at = |name: &str| names.iter().position(|own| own == name);
        let units = LengthUnit::ALL.map(|unit| (format!("_{}", unit.symbol()), unit.metres()));
        let plain = std::iter::once((String::new(), 1.0));
        plain.chain(units).find_map(|(suffix, metres_per_unit)| {
            let (x, y) = (at(&format!("x{suffix}"))?, at(&format!("y{suffix}"))?);
            Some(Self { divider, stroke: at("stroke"), x, y, metres_per_unit })
        })
    }

    fn row(&self, line: usize, row: &str) -> Result<(i64, Point), FormatError> {
        let field = |i: usize| row.split(self.divider).nth(i).unwrap_or_default().trim();
        let number = match self.stroke.map(field) {
            Some(text) => text.parse().map_err(|_| value(line, "stroke", text, "a whole number"))?,
            None => 0,
        };
        let point =
            Point::new(self.length(line, "x_m", field(self.x))?, self.length(line, "y_m", field(self.y))?);
        match is_sound(point) {
            true => Ok((number, point)),
            false => Err(FormatError::Far { place: format!("line {line}"), x: point.x, y: point.y }),
        }
    }

    fn length(&self, line: usize, field: &'static str, text: &str) -> Result<f64, FormatError> {
        let found = number(text, self.divider).map(|v| v * self.metres_per_unit);
        found.ok_or_else(|| value(line, field, text, "a number of metres, such as 0.125"))
    }
}

/// A number, whose decimals may follow a comma where fields are divided by something else.
fn number(text: &str, divider: char) -> Option<f64> {
    let plain = text.parse::<f64>();
    let number = plain.ok().or_else(|| match text.matches(',').count() {
        1 if divider != ',' && !text.contains('.') => text.replace(',', ".").parse().ok(),
        _ => None,
    });
    number.filter(|v| !v.is_nan())
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
    fn tables_of_other_programs_are_read() {
        let check = |csv: &str, wanted: &[&[(f64, f64)]]| {
            let found: Vec<Vec<(f64, f64)>> = read(csv.as_bytes())
                .unwrap()
                .strokes
                .iter()
                .map(|s| s.path.flatten(1.0).iter().map(|p| (p.x, p.y)).collect())
                .collect();
            assert_eq!(found, wanted, "{csv}");
        };
        let two: [&[(f64, f64)]; 2] = [&[(0.5, 1.0), (0.25, -2.0)], &[(3.0, 3.0), (4.0, 3.0)]];
        check("stroke;x_m;y_m\r\n0;0,5;1\r\n0;0,25;-2,0\r\n1;3;3\r\n1;4;3", &two);
        check("0;0,5;1\n0;0,25;-2\n1;3;3\n1;4;3", &two);
        check("X,Y\n0.5,1\n0.25,-2\n\n3,3\n4,3\n", &two);
        check("0.5\t1\n2,5e-1\t-2\n\n\n3\t3\n4\t3\n", &two);
        check("y_mm,note,x_mm\n1000,a,500\n-2000,b,250\n", &two[..1]);
        assert!(is_header("x;y") && is_header("stroke,x_m,y_m") && is_header(" Y_mm , X_mm"));
        assert!(!is_header("0,0") && !is_header("x") && !is_header("<svg x,y"));
    }

    #[test]
    fn each_broken_row_is_named() {
        let check = |csv: &str, message: &str| {
            let found = read(csv.as_bytes()).unwrap_err().to_string();
            assert!(found.contains(message), "{csv:?}: {found}");
        };
        check("", "empty");
        check("x,z\n0,0\n", "line 1: header is \"x,z\", expected stroke,x_m,y_m");
        check("x;y\n0,5;1\n0,7.5;1\n", "line 3: x_m is \"0,7.5\"");
        check("x,y\n0,5,1\n0;5,1\n", "line 3: x_m is \"0;5\"");
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
