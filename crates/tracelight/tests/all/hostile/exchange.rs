//! DXF files that are broken or hostile.

use crate::hostile::drawings::File;
use crate::hostile::program::Exit::{Refused, Wrong};

/// DXF: bombs of blocks, numbers that are none, files that end too early.
pub(crate) fn files() -> Vec<File> {
    let file = |entities: &str| -> Vec<u8> { section("ENTITIES", entities).into() };
    let line = "0\nLINE\n10\n0\n20\n0\n11\n9\n21\n9\n";
    vec![
        ("empty.dxf", vec![], Wrong),
        ("bare.dxf", file(""), Refused),
        ("words.dxf", file("0\nATTDEF\n1\nonly words\n"), Refused),
        ("still.dxf", file("0\nCIRCLE\n10\n1\n20\n1\n40\n0\n"), Refused),
        ("cut.dxf", "0\nSECTION\n2\nENTITIES\n0\nLI".into(), Wrong),
        ("binary.dxf", b"AutoCAD Binary DXF\r\n\x1a\x00\x00\x00SECTION\x00".to_vec(), Wrong),
        ("plan.dwg", b"AC1032\x00\x00\x00\x00\x00".to_vec(), Wrong),
        ("codes.dxf", file("0\nLINE\nten\n0\n"), Wrong),
        ("nan.dxf", file("0\nLINE\n10\nnan\n20\n0\n11\n1\n21\n1\n"), Wrong),
        ("infinite.dxf", file("0\nLINE\n10\ninf\n20\n0\n11\n1\n21\n1\n"), Wrong),
        ("far.dxf", file("0\nLINE\n10\n1e300\n20\n0\n11\n1\n21\n1\n"), Wrong),
        ("circle.dxf", circular_blocks(), Wrong),
        ("copies.dxf", block_bomb(line), Wrong),
        ("nothings.dxf", block_bomb(""), Wrong),
        ("array.dxf", array_bomb(line), Wrong),
        ("degree.dxf", file(&format!("0\nSPLINE\n71\n99\n{}", "10\n1\n20\n2\n".repeat(120))), Wrong),
        (
            "knots.dxf",
            file("0\nSPLINE\n71\n1\n40\n0\n40\n-1\n40\n0\n40\n1\n10\n0\n20\n0\n10\n5\n20\n5\n"),
            Wrong,
        ),
        ("zeros.dxf", b"0\n\n".repeat(8_000_000), Wrong),
        ("groups.dxf", file(&("0\nLINE\n".to_owned() + &"9\n\n".repeat(6_000_000))), Wrong),
        (
            "kinds.dxf",
            file(&(0..200_000).map(|i| format!("0\nKIND{i}\n8\nL{i}\n")).collect::<String>()),
            Refused,
        ),
        ("junk.dxf", (0..=255).cycle().take(1 << 20).collect(), Wrong),
    ]
}

fn section(name: &str, content: &str) -> String {
    format!("0\nSECTION\n2\n{name}\n{content}0\nENDSEC\n0\nEOF\n")
}

fn with_blocks(blocks: &str, insert: &str) -> Vec<u8> {
    format!("0\nSECTION\n2\nBLOCKS\n{blocks}0\nENDSEC\n{}", section("ENTITIES", insert)).into()
}

fn block(name: &str, content: &str) -> String {
    format!("0\nBLOCK\n2\n{name}\n{content}0\nENDBLK\n")
}

/// Two blocks that hold each other.
fn circular_blocks() -> Vec<u8> {
    let [a, b] = [("a", "b"), ("b", "a")].map(|(own, other)| block(own, &format!("0\nINSERT\n2\n{other}\n")));
    with_blocks(&(a + &b), "0\nINSERT\n2\na\n")
}

/// Ten copies of ten copies, twelve deep.
fn block_bomb(content: &str) -> Vec<u8> {
    let level = |i: u32| block(&format!("b{}", i + 1), &format!("0\nINSERT\n2\nb{i}\n10\n1\n").repeat(10));
    let levels: String = (0..12).map(level).collect();
    with_blocks(&(block("b0", content) + &levels), "0\nINSERT\n2\nb12\n")
}

/// A million million copies by one insert.
fn array_bomb(content: &str) -> Vec<u8> {
    let insert = "0\nINSERT\n2\na\n70\n1000000\n71\n1000000\n44\n1\n45\n1\n";
    with_blocks(&block("a", content), insert)
}
