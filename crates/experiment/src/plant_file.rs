//! Systems from files: state space, transfer functions and frequency responses as TOML, JSON, CSV and .mat have them.
//!
//! Bytes and a name in, a system out. Nothing is guessed: what a file leaves open is refused with the choices there are.

mod columns;
mod described;
mod frequency_csv;
mod json;
mod mat;
mod mat_four;
mod matrices_csv;
mod node;
mod plant;
mod rows;
mod toml;
mod write;

use tracelight_task::Failure;

pub(crate) use crate::plant_file::columns::LEAST_COHERENCE;
use crate::plant_file::node::Wrong;
use crate::table::Log;

pub use crate::plant_file::plant::{MOST_BYTES, MOST_PORTS, MOST_STATES, Plant, PlantFile};
pub use crate::plant_file::write::{PlantFormat, write};

/// Whether a file of that name may hold a system, by its ending: .toml, .json, .csv, .tsv, .txt, .mat.
#[must_use]
pub fn is_plant_name(name: &str) -> bool {
    Ending::of(name).is_some()
}

#[derive(Clone, Copy)]
enum Ending {
    Toml,
    Json,
    Table,
    Mat,
}

impl Ending {
    fn of(name: &str) -> Option<Self> {
        let ending = name.rsplit_once('.')?.1.to_ascii_lowercase();
        Some(match ending.as_str() {
            "toml" => Self::Toml,
            "json" => Self::Json,
            "csv" | "tsv" | "txt" => Self::Table,
            "mat" => Self::Mat,
            _ => return None,
        })
    }
}

/// Reads the system in a file. Of several in one file, `choice` names one: a key such as `G11` or a variable of a .mat file, a number
/// from 1 on in a list of systems, a channel of a table of frequencies.
///
/// # Errors
/// `system-file`: the file, the line where lines are counted, what is wrong there and what to do.
pub fn read(file: &Log, choice: Option<&str>) -> Result<Plant, Failure> {
    let Log { name, bytes } = file;
    parsed(name, bytes, choice).map_err(|Wrong { line, what }| {
        let place = line.map_or(String::new(), |line| format!(":{line}"));
        Failure::usage("system-file", format!("{name}{place}: {what}"))
    })
}

fn parsed(name: &str, bytes: &[u8], choice: Option<&str>) -> Result<Plant, Wrong> {
    if bytes.len() > MOST_BYTES {
        return Err(Wrong::new(
            None,
            format!("{} bytes; a system file has at most {MOST_BYTES}", bytes.len()),
        ));
    }
    match Ending::of(name) {
        Some(Ending::Toml) => described::plant(&toml::read(&text(bytes))?, choice),
        Some(Ending::Json) => {
            described::plant(&json::read(bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes))?, choice)
        }
        Some(Ending::Mat) => described::plant(&mat::read(bytes)?, choice),
        Some(Ending::Table) => {
            let text = text(bytes);
            match matrices_csv::read(&text)? {
                Some(node) => described::plant(&node, choice),
                None => frequency_csv::read(&text, choice),
            }
        }
        None => Err(Wrong::new(None, "a system file ends in .toml, .json, .csv, .tsv, .txt or .mat")),
    }
}

/// Text as it is, or of one byte a letter where it is not UTF-8, as instruments write their degree signs.
fn text(bytes: &[u8]) -> String {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    match std::str::from_utf8(bytes) {
        Ok(text) => text.to_owned(),
        Err(_) => bytes.iter().map(|b| char::from(*b)).collect(),
    }
}
