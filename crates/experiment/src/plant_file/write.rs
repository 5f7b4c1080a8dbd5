//! A linear system as a file that is read back to the bit.

use std::fmt::Write;

use tracelight_linear::{Matrix, StateSpace, Time};

/// How a system is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlantFormat {
    /// TOML with A, B, C, D and `period_s`.
    Toml,
    /// JSON likewise.
    Json,
    /// Blocks of rows under A, B, C, D and `period_s`.
    Csv,
    /// MATLAB's, version 5: variables A, B, C, D, Ts.
    Mat,
}

impl PlantFormat {
    /// By the ending of a file's name.
    #[must_use]
    pub fn of(name: &str) -> Option<Self> {
        Some(match name.rsplit_once('.')?.1.to_ascii_lowercase().as_str() {
            "toml" => Self::Toml,
            "json" => Self::Json,
            "csv" => Self::Csv,
            "mat" => Self::Mat,
            _ => return None,
        })
    }
}

/// A system as a file; 0 s is the period of continuous time.
#[must_use]
pub fn write(system: &StateSpace, format: PlantFormat) -> Vec<u8> {
    let period_s = match system.time() {
        Time::Continuous => 0.0,
        Time::Sampled(period_s) => period_s,
    };
    let matrices = [("A", system.a()), ("B", system.b()), ("C", system.c()), ("D", system.d())];
    match format {
        PlantFormat::Toml => toml(&matrices, period_s).into_bytes(),
        PlantFormat::Json => json(&matrices, period_s).into_bytes(),
        PlantFormat::Csv => csv(&matrices, period_s).into_bytes(),
        PlantFormat::Mat => mat(&matrices, period_s),
    }
}

/// All digits that tell a number from its neighbours: what Rust prints is the shortest that reads back the same.
fn row(matrix: &Matrix, i: usize, between: &str) -> String {
    matrix.row(i).iter().map(|entry| format!("{entry:?}")).collect::<Vec<_>>().join(between)
}

fn rows(matrix: &Matrix, before: &str) -> String {
    let rows: Vec<String> = (0..matrix.nrows()).map(|i| format!("[{}]", row(matrix, i, ", "))).collect();
    rows.join(&format!(",\n{before}"))
}

fn toml(matrices: &[(&str, &Matrix); 4], period_s: f64) -> String {
    let mut text = format!("period_s = {period_s:?} # from sample to sample; 0 in continuous time\n");
    for (name, matrix) in matrices {
        // writing to a String cannot fail
        let _ = writeln!(text, "{name} = [\n    {},\n]", rows(matrix, "    "));
    }
    text.replace("[\n    ,\n]", "[]")
}

fn json(matrices: &[(&str, &Matrix); 4], period_s: f64) -> String {
    let mut text = format!("{{\n\"period_s\": {period_s:?}");
    for (name, matrix) in matrices {
        let _ = write!(text, ",\n\"{name}\": [{}]", rows(matrix, " "));
    }
    text + "\n}\n"
}

fn csv(matrices: &[(&str, &Matrix); 4], period_s: f64) -> String {
    let mut text = format!("period_s,{period_s:?}\n");
    for (name, matrix) in matrices {
        let _ = writeln!(text, "{name}");
        for i in 0..matrix.nrows() {
            let _ = writeln!(text, "{}", row(matrix, i, ","));
        }
    }
    text
}

/// The header, then an element for each matrix, in the order of bytes of most processors.
fn mat(matrices: &[(&str, &Matrix); 4], period_s: f64) -> Vec<u8> {
    let mut bytes = b"MATLAB 5.0 MAT-file, a linear system A, B, C, D, Ts".to_vec();
    bytes.resize(124, b' ');
    bytes.extend([0, 1, b'I', b'M']);
    for (name, matrix) in matrices {
        bytes.extend(element(name, matrix));
    }
    bytes.extend(element("Ts", &Matrix::from_element(1, 1, period_s)));
    bytes
}

fn element(name: &str, matrix: &Matrix) -> Vec<u8> {
    // kinds of the parts, and the class of a matrix of f64
    const I8: u32 = 1;
    const I32: u32 = 5;
    const U32: u32 = 6;
    const F64: u32 = 9;
    const MATRIX: u32 = 14;
    const DOUBLE: u32 = 6;
    let part = |kind: u32, body: &[u8]| {
        let mut bytes = [kind.to_le_bytes(), (body.len() as u32).to_le_bytes()].concat();
        bytes.extend(body);
        bytes.resize(bytes.len().next_multiple_of(8), 0);
        bytes
    };
    let whole = |numbers: [u32; 2]| numbers.map(u32::to_le_bytes).concat();
    let numbers: Vec<u8> = matrix.iter().flat_map(|entry| entry.to_le_bytes()).collect();
    let body = [
        part(U32, &whole([DOUBLE, 0])),
        part(I32, &whole([matrix.nrows() as u32, matrix.ncols() as u32])),
        part(I8, name.as_bytes()),
        part(F64, &numbers),
    ];
    part(MATRIX, &body.concat())
}
