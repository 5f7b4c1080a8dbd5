//! Names of files to write: what is in a file is what its name says.

use std::path::Path;

/// The name, if it ends so, in small letters or capitals, or says nothing; else an error that says what to do.
pub(crate) fn ends_in(name: &str, ending: &str, way: &str) -> Result<String, String> {
    let is_so = Path::new(name).extension().is_none_or(|own| own.eq_ignore_ascii_case(ending));
    if is_so { Ok(name.to_owned()) } else { Err(way.to_owned()) }
}

/// Of what `calibrate` has found.
pub(crate) fn toml(name: &str) -> Result<String, String> {
    ends_in(name, "toml", "what is found is written as TOML: end it in .toml")
}
