//! Drawings and rig files that are broken or hostile.

use crate::hostile::program::Exit::{self, Either, Refused, Wrong};

/// A file and how it is to be refused.
pub(crate) type File = (&'static str, Vec<u8>, Exit);

/// SVG: XML's known bombs, and numbers that are none.
pub(crate) fn svgs() -> Vec<File> {
    let svg = |body: &str| {
        format!("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'>{body}</svg>").into()
    };
    let nested = |depth: usize| "<g transform='scale(1.0001)'>".repeat(depth) + &"</g>".repeat(depth);
    vec![
        ("empty.svg", vec![], Wrong),
        ("text.svg", b"no drawing at all".to_vec(), Wrong),
        ("cut.svg", b"<svg xmlns='http://www.w3.org/2000/svg'><path d='M0 0 L10".to_vec(), Wrong),
        (
            "latin1.svg",
            b"<svg xmlns='http://www.w3.org/2000/svg'><text>caf\xe9</text></svg>".to_vec(),
            Either,
        ),
        ("crossed.svg", svg("<g><path d='M0 0L9 9'></g></path>"), Wrong),
        ("bare.svg", svg(""), Refused),
        ("words.svg", svg("<text x='5' y='5' fill='none'>only words</text>"), Refused),
        ("still.svg", svg("<path d='M5 5'/>"), Refused),
        ("moves.svg", svg(&format!("<path d='{}'/>", "M1 1".repeat(300_000))), Refused),
        ("laughs.svg", entity_bomb(), Either),
        ("outside.svg", external_entity(), Either),
        ("nested.svg", svg(&nested(100_000)), Either),
        ("unclosed.svg", "<svg xmlns='http://www.w3.org/2000/svg'>".repeat(100_000).into(), Wrong),
        ("mirror.svg", svg("<g id='a'><use href='#a'/></g>"), Either),
        ("copies.svg", svg(&use_bomb()), Either),
        ("nan.svg", svg("<path d='M NaN 0 L 5 NaN'/>"), Either),
        ("infinite.svg", svg("<path d='M0 0 L1e999 5' stroke='#000'/>"), Either),
        ("huge.svg", svg("<path d='M-1e308 0 L1e308 1e308' stroke='#000'/>"), Either),
        (
            "flat.svg",
            "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 0 0'><path d='M0 0L9 9'/></svg>".into(),
            Either,
        ),
    ]
}

/// Ten entities of ten each, twelve deep: a terabyte when unfolded.
fn entity_bomb() -> Vec<u8> {
    let level = |i: u32| format!("<!ENTITY e{} '{}'>", i + 1, format!("&e{i};").repeat(10));
    let levels: String = (0..12).map(level).collect();
    format!("<!DOCTYPE svg [<!ENTITY e0 'ha'>{levels}]><svg xmlns='http://www.w3.org/2000/svg'><text>&e12;</text></svg>")
        .into()
}

/// Asks for a file of this machine.
fn external_entity() -> Vec<u8> {
    b"<!DOCTYPE svg [<!ENTITY x SYSTEM 'file:///etc/hostname'>]><svg xmlns='http://www.w3.org/2000/svg'>&x;</svg>".to_vec()
}

/// Ten copies of ten copies, twelve deep, of one line.
fn use_bomb() -> String {
    let level = |i: u32| format!("<g id='g{}'>{}</g>", i + 1, format!("<use href='#g{i}'/>").repeat(10));
    let levels: String = (0..12).map(level).collect();
    format!("<defs><path id='g0' d='M0 0L9 9' stroke='#000'/>{levels}</defs><use href='#g12'/>")
}

/// JSON, CSV and DXF, for `plan`.
pub(crate) fn tables() -> Vec<File> {
    let strokes = |points: &str| {
        format!("{{\"width_px\":9,\"height_px\":9,\"mode\":\"outline\",\"strokes\":[{{\"closed\":false,\"kind\":\"outline\",\"pen_px\":1,\"points\":{points}}}]}}")
            .into()
    };
    let csv = |rows: &str| format!("stroke,x_m,y_m\n{rows}").into();
    vec![
        ("empty.json", vec![], Wrong),
        ("cut.json", b"{\"strokes\":[{\"points\":[[0,0],[1".to_vec(), Wrong),
        ("array.json", b"[1,2,3]".to_vec(), Wrong),
        ("types.json", b"{\"width_px\":\"wide\",\"height_px\":9,\"strokes\":7}".to_vec(), Wrong),
        ("nan.json", strokes("[[0,0],[NaN,5]]"), Wrong),
        ("infinite.json", strokes("[[0,0],[1e999,5]]"), Either),
        ("three.json", strokes("[[0,0,0],[1,1,1]]"), Wrong),
        ("words.json", strokes("[[\"left\",\"top\"]]"), Wrong),
        ("deep.json", "[".repeat(1_000_000).into(), Wrong),
        ("still.json", strokes("[]"), Either),
        ("empty.csv", vec![], Wrong),
        ("headless.csv", b"one,two\n1,2\n".to_vec(), Wrong),
        ("words.csv", csv("0,left,0.1\n"), Wrong),
        ("ragged.csv", csv("0,0.1,0.1\n0,0.2\n"), Wrong),
        ("nan.csv", csv("0,nan,0\n0,0.1,0.1\n"), Wrong),
        ("infinite.csv", csv("0,0,0\n0,inf,0\n"), Wrong),
        ("bytes.csv", b"stroke,x_m,y_m\n0,\xff\xfe,0\n".to_vec(), Wrong),
        ("bare.csv", csv(""), Either),
        ("far.csv", csv("0,0,0\n0,1e300,0\n"), Either),
        ("text.dxf", b"not a drawing exchange file\n".to_vec(), Wrong),
        ("drawing.xyz", b"what is this\n".to_vec(), Wrong),
    ]
}

/// Rig files, made from a good one.
pub(crate) fn rigs(good: &str) -> Vec<(&'static str, Vec<u8>)> {
    vec![
        ("unknown_key.toml", format!("{good}\n[nonsense]\nwobble = 1\n").into()),
        ("misspelt.toml", good.replacen("\n[model", "\n[modle", 1).into()),
        ("wrong_unit.toml", with_first_quantity(good, "7 parsec").into()),
        ("no_unit.toml", with_first_quantity(good, "7").into()),
        ("endless.toml", with_first_quantity(good, "1e999").into()),
        ("types.toml", b"model = 7\n".to_vec()),
        ("twice.toml", format!("{good}\n{good}").into()),
        ("cut.toml", b"[model\n".to_vec()),
        ("junk.toml", (0..=255).cycle().take(4096).collect()),
        ("deep.toml", format!("a = {}", "[".repeat(200_000)).into()),
    ]
}

/// The first quoted value that begins with a figure, replaced.
fn with_first_quantity(rig: &str, value: &str) -> String {
    let starts = rig.match_indices('"').map(|(at, _)| at + 1);
    let is_figure = |at: &usize| rig[*at..].starts_with(|c: char| c.is_ascii_digit() || c == '-');
    let start = starts.into_iter().find(is_figure).expect("a rig file has quantities with units");
    let end = start + rig[start..].find('"').unwrap();
    [&rig[..start], value, &rig[end..]].concat()
}
