//! The page's own files, as they are in the program.

use std::io::Write as _;
use std::sync::OnceLock;

use flate2::Compression;
use flate2::write::GzEncoder;

/// A file of the page.
pub(crate) struct Asset {
    pub(crate) name: &'static str,
    pub(crate) kind: &'static str,
    pub(crate) text: &'static str,
}

macro_rules! asset {
    ($name:literal, $kind:literal) => {
        Asset { name: $name, kind: $kind, text: include_str!(concat!("../page/", $name)) }
    };
}

const SCRIPT: &str = "text/javascript; charset=utf-8";

macro_rules! script {
    ($name:literal) => {
        Asset { name: $name, kind: SCRIPT, text: include_str!(concat!("../page/", $name)) }
    };
}

/// The page first.
pub(crate) static ASSETS: [Asset; 43] = [
    asset!("index.html", "text/html; charset=utf-8"),
    asset!("style.css", "text/css; charset=utf-8"),
    asset!("views.html", "text/html; charset=utf-8"),
    asset!("views.css", "text/css; charset=utf-8"),
    asset!("icon.svg", "image/svg+xml"),
    script!("main.js"),
    script!("api.js"),
    script!("arrive.js"),
    script!("figures.js"),
    script!("dom.js"),
    script!("store.js"),
    script!("wall.js"),
    script!("paint.js"),
    script!("timeline.js"),
    script!("fields.js"),
    script!("runs.js"),
    script!("run.js"),
    script!("live.js"),
    script!("jobs.js"),
    script!("hold.js"),
    script!("words.js"),
    script!("kept.js"),
    script!("devices.js"),
    script!("compare.js"),
    script!("head.js"),
    script!("rigs.js"),
    script!("camera.js"),
    script!("cameras.js"),
    script!("calibrated.js"),
    script!("calibrations.js"),
    script!("head-corners.js"),
    script!("lab.js"),
    script!("locus.js"),
    script!("pictures.js"),
    script!("beneath.js"),
    script!("corners.js"),
    script!("dark.js"),
    script!("marks.js"),
    script!("place.js"),
    script!("scale.js"),
    script!("sheet.js"),
    script!("unit.js"),
    script!("views.js"),
];

/// A file in both forms, and what tells one version from another.
pub(crate) struct Packed {
    pub(crate) asset: &'static Asset,
    pub(crate) zipped: Vec<u8>,
    pub(crate) tag: String,
}

/// The file of a name.
pub(crate) fn packed(name: &str) -> Option<&'static Packed> {
    static ALL: OnceLock<Vec<Packed>> = OnceLock::new();
    ALL.get_or_init(|| ASSETS.iter().map(pack).collect()).iter().find(|packed| packed.asset.name == name)
}

fn pack(asset: &'static Asset) -> Packed {
    let mut zip = GzEncoder::new(Vec::new(), Compression::best());
    // writing to memory cannot fail; nothing zipped is served as it is
    let zipped = zip.write_all(asset.text.as_bytes()).and_then(|()| zip.finish()).unwrap_or_default();
    let sum = asset
        .text
        .bytes()
        .fold(0xcbf2_9ce4_8422_2325_u64, |sum, byte| (sum ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3));
    Packed { asset, zipped, tag: format!("\"{sum:016x}\"") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_view_is_light_and_everything_it_imports_is_there() {
        let bytes = |name: &&str| packed(name).unwrap_or_else(|| panic!("no {name}")).zipped.len();
        let page = packed("index.html").unwrap().asset.text;
        let mut first = vec!["index.html", "style.css", "icon.svg", "main.js"];
        for at in 3.. {
            let Some(name) = first.get(at) else { break };
            for line in packed(name).unwrap().asset.text.lines().filter(|line| line.starts_with("import ")) {
                let from = line.rsplit('\'').nth(1).unwrap().trim_start_matches("./");
                if !first.contains(&from) {
                    first.push(from);
                }
            }
        }
        // asked for at once, and not one after the other
        for name in &first[3..] {
            assert!(page.contains(&format!("modulepreload\" href=\"/page/{name}\"")), "{name}");
        }
        let first: usize = first.iter().map(bytes).sum();
        assert!((1000..=60 * 1024).contains(&first), "{first} bytes");
        let all: usize = ASSETS.iter().map(|asset| bytes(&asset.name)).sum();
        assert!((first..=160 * 1024).contains(&all), "{all} bytes");
        for asset in &ASSETS {
            for line in asset.text.lines().filter(|line| line.starts_with("import ")) {
                let from = line.rsplit('\'').nth(1).unwrap().trim_start_matches("./");
                assert!(packed(from).is_some(), "{}: {from}", asset.name);
            }
            for part in asset.text.split("import('./").skip(1) {
                let name = part.split('\'').next().unwrap();
                assert!(packed(name).is_some(), "{}: {name}", asset.name);
            }
        }
        assert!(packed("../Cargo.toml").is_none());
    }

    #[test]
    fn nothing_of_it_comes_from_elsewhere() {
        for asset in &ASSETS {
            let found = asset.text.find("http://").or_else(|| asset.text.find("https://"));
            let is_name = |at: usize| asset.text[at..].starts_with("http://www.w3.org/");
            assert!(found.is_none_or(is_name), "{} asks another server", asset.name);
            assert!(!asset.text.contains("innerHTML"), "{} makes markup of text", asset.name);
        }
    }
}
