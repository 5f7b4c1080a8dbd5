//! Makes the files of `examples/` that need the simulated rig, camera or wall: photographs, a film, drawings, logs, a rig file.
//!
//! ```text
//! cargo run --release -p tracelight --example make_examples -- examples
//! ```
//!
//! The pictures with exact truth are made by `draw_examples` of `tracelight-vision`. Seeds are fixed: equal code, equal bytes.

#[path = "../../../vision/examples/draw_examples/grain.rs"]
mod grain;
mod logs;
mod pen;
mod photograph;
mod plan;
mod rig;
mod sheet;
mod sign;
mod wall;

use std::{error::Error, fs, path::Path};

/// A file's path below `examples/`, and its bytes.
pub(crate) type Example = (&'static str, Vec<u8>);

/// All files that this program makes.
pub(crate) fn files() -> Result<Vec<Example>, Box<dyn Error>> {
    let mut files = vec![
        ("sheet.jpg", sheet::jpeg()?),
        ("sign.svg", sign::svg().into_bytes()),
        ("wall.dxf", plan::dxf().into_bytes()),
        ("rig.toml", rig::toml().into_bytes()),
    ];
    files.extend(wall::images()?);
    files.extend(logs::logs()?);
    Ok(files)
}

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args_os().nth(1).ok_or("name the folder for the files, for example `examples`")?;
    for (name, bytes) in files()? {
        let path = Path::new(&folder).join(name);
        path.parent().map_or(Ok(()), fs::create_dir_all)?;
        fs::write(path, bytes)?;
    }
    Ok(())
}
