//! A file's bytes are what its extension says, or the command refuses the name: every command that writes a file, every extension.

use std::path::Path;

use serde_json::Value;

use crate::support::{folder, run};

/// Commands up to the name of the file they write.
const COMMANDS: &[&str] = &[
    "strokes examples/star.png -o",
    "strokes examples/star.png --stages",
    "plan examples/star.png -o",
    "plan examples/star.png --axes X=pan,Y=tilt -o",
    "plan examples/star.png --preview",
    "calibrate sheet -o",
    "calibrate markers examples/lens/near.jpg -o",
    "calibrate corners --size 2.4m,1.2m --simulate -o",
    "calibrate head --camera sim -o",
    "recover @/dark/run.mcap -o",
    "lab profile --distance 180deg -o",
    "lab move line -o",
    "lab step --axis tilt -o",
    "lab simulate --random -o",
    "lab velocity --speeds 1ft/s -o",
    "lab frequency --axis tilt -o",
    "lab linearize -o",
    "lab locus G11 -o",
    "lab bode G11 -o",
    "lab nyquist G11 -o",
    "lab gang G11 --controller K11 -o",
    "lab nichols G11 -o",
    "lab pzmap G11 -o",
    "lab response G11 -o",
    "lab design pid G11 --crossover 60rad/s --phase-margin 55deg -o",
    "lab relay --axis tilt -o",
    "lab lesson 1 --answer kp=10,sticks=4 -o",
    "lab montecarlo --plants 1 --shape line -o",
];

/// Extensions that somebody may ask for, whether anything writes them or not.
const EXTENSIONS: [&str; 21] = [
    "svg", "png", "csv", "json", "dxf", "gcode", "gc", "nc", "ngc", "ild", "hpgl", "plt", "pdf", "toml",
    "mat", "mcap", "html", "txt", "jpg", "svgz", "SVG",
];

/// Whether bytes are of the kind that an extension names.
fn fits(extension: &str, bytes: &[u8]) -> bool {
    let text = std::str::from_utf8(bytes);
    let is_text = |holds: &dyn Fn(&str) -> bool| text.is_ok_and(holds);
    match extension.to_ascii_lowercase().as_str() {
        "svg" => is_text(&|t| t.contains("<svg") && t.trim_end().ends_with("</svg>")),
        "png" => bytes.starts_with(b"\x89PNG\r\n\x1a\n"),
        "json" => serde_json::from_slice::<Value>(bytes).is_ok(),
        "dxf" => is_text(&|t| t.contains("SECTION") && t.trim_end().ends_with("EOF")),
        "gcode" | "gc" | "nc" | "ngc" => is_text(&|t| t.contains("\nG21 G90") && t.contains("\nM5")),
        "ild" => bytes.starts_with(b"ILDA"),
        "hpgl" | "plt" => bytes.starts_with(b"IN;"),
        "pdf" => bytes.starts_with(b"%PDF-"),
        "toml" => is_text(&|t| t.parse::<toml_edit::DocumentMut>().is_ok()),
        "mat" => bytes.starts_with(b"MATLAB 5.0"),
        "mcap" => bytes.starts_with(b"\x89MCAP0\r\n"),
        // a table: as many columns in its last row as in its first, or matrices, each with its name
        "csv" => is_text(&|t| {
            // a comma within quotes separates nothing
            let bare = |line: &str| line.split('"').step_by(2).collect::<String>();
            let columns = |line: &str| bare(line).split(',').count();
            let rows: Vec<&str> = t.lines().filter(|line| !line.starts_with('#')).collect();
            !t.contains(['<', '{'])
                && rows
                    .first()
                    .zip(rows.last())
                    .is_some_and(|(a, b)| columns(a) == columns(b) || columns(a) <= 2)
        }),
        _ => false,
    }
}

#[test]
fn what_a_file_holds_is_what_its_name_says_or_the_name_is_refused() {
    let place = folder("extensions");
    let dark = place.join("dark");
    let made = run(&["trace", "examples/star.png", "--dry-run", "--out", &dark.to_string_lossy()]);
    assert!(made.status.success());
    let mut wrong = Vec::new();
    for (i, command) in COMMANDS.iter().enumerate() {
        let command = command.replace('@', &place.to_string_lossy());
        let mut accepted = 0;
        for extension in EXTENSIONS {
            let path = place.join(format!("{i}.{extension}"));
            accepted += usize::from(is_written(&command, &path, extension, &mut wrong));
        }
        if accepted == 0 {
            wrong.push(format!("{command}: no extension is accepted"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Whether a command writes such a file; what is wrong with it, or with the way it is refused.
fn is_written(command: &str, path: &Path, extension: &str, wrong: &mut Vec<String>) -> bool {
    let name = path.to_string_lossy();
    let arguments: Vec<&str> = command.split(' ').chain([&*name, "--quiet"]).collect();
    let output = run(&arguments);
    match (output.status.code(), std::fs::read(path)) {
        // 1: the answer to a lesson that is not right yet is plotted all the same
        (Some(0 | 1), Ok(bytes)) if fits(extension, &bytes) => return true,
        (Some(0), Ok(_)) => wrong.push(format!("{command} {name}: what is written is no .{extension}")),
        (Some(2), Err(_)) => {}
        (status, file) => wrong.push(format!(
            "{command} {name}: exit {status:?}, a file: {}: {}",
            file.is_ok(),
            String::from_utf8_lossy(&output.stderr)
        )),
    }
    false
}

#[test]
fn no_command_writes_over_what_it_reads() {
    let place = folder("over_input");
    let file = |name: &str| place.join(name).to_string_lossy().into_owned();
    let check = |input: &str, command: &str| {
        std::fs::copy("../../examples/star.png", file("a.png")).unwrap();
        std::fs::write(file("plate.svg"), include_str!("../../../formats/tests/data/plate.svg")).unwrap();
        let before = std::fs::read(file(input)).unwrap();
        let command = command.replace('@', &place.to_string_lossy());
        let output = run(&command.split(' ').collect::<Vec<_>>());
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(std::fs::read(file(input)).unwrap(), before, "{command}");
        assert!(!output.status.success() && said.contains("over"), "{command}: {said}");
    };
    check("plate.svg", "strokes @/plate.svg -o @/plate.svg");
    check("plate.svg", "plan @/plate.svg --preview @/./plate.svg");
    check("plate.svg", "strokes @/plate.svg -o @/ --format svg");
    check("plate.svg", "strokes @/a.png @/plate.svg -o @/");
    // a folder of results whose strokes are the drawing
    let results = place.join("results");
    std::fs::create_dir_all(&results).unwrap();
    std::fs::copy("../../crates/formats/tests/data/plate.svg", results.join("strokes.svg")).unwrap();
    check("results/strokes.svg", "trace @/results/strokes.svg --width 30cm --out @/results");
}
