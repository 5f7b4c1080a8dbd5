//! Block diagrams: boxes in rows, and arrows between them.

use std::fmt::Write;

use tracelight_report::html::escaped;

/// A box: its name and what it is, where it stands on a grid.
pub(crate) struct Block {
    pub(crate) at: (i32, i32),
    pub(crate) name: &'static str,
    pub(crate) what: &'static str,
}

/// From a block to another by their numbers, and what passes.
pub(crate) struct Arrow {
    pub(crate) from: usize,
    pub(crate) to: usize,
    pub(crate) what: &'static str,
}

/// From the way out of a block, right of it, round all others to the sides of blocks that face it: below, or above.
pub(crate) struct Wire {
    pub(crate) from: usize,
    /// Which blocks, and how far from their middle it comes in, in steps to the right.
    pub(crate) to: &'static [(usize, i32)],
    /// Which way round: from 0 below all blocks, from −1 above.
    pub(crate) level: i32,
    pub(crate) what: &'static str,
}

const WIDTH: i32 = 150;
const HEIGHT: i32 = 62;
const ACROSS: i32 = 215;
const DOWN: i32 = 118;
const EDGE: i32 = 16;
/// Between wires that go round.
const AROUND: i32 = 30;

/// The diagram as SVG, in the page's own colours.
pub(crate) fn svg(name: &str, blocks: &[Block], arrows: &[Arrow], wires: &[Wire]) -> String {
    let columns = blocks.iter().map(|b| b.at.0).max().unwrap_or(0);
    let rows = blocks.iter().map(|b| b.at.1).max().unwrap_or(0);
    let bottom = rows * DOWN + HEIGHT + EDGE;
    let below = wires.iter().map(|w| w.level + 1).max().unwrap_or(0);
    let above = wires.iter().map(|w| -w.level).max().unwrap_or(0).max(0);
    let right = if wires.is_empty() { 0 } else { ACROSS - WIDTH };
    let (width, top) = (columns * ACROSS + WIDTH + 2 * EDGE + right, -above * AROUND);
    let height = bottom + EDGE + below * AROUND - top;
    let boxes: Vec<&str> = blocks.iter().map(|b| b.name).collect();
    let way = |arrow: &Arrow| {
        let passes = if arrow.what.is_empty() { String::new() } else { format!(" by {}", arrow.what) };
        format!("{} to {}{passes}", blocks[arrow.from].name, blocks[arrow.to].name)
    };
    let round = |wire: &Wire| {
        let goes = |(to, _): &(usize, i32)| {
            format!("{} to {} by {}", blocks[wire.from].name, blocks[*to].name, wire.what)
        };
        wire.to.iter().map(goes).collect::<Vec<_>>()
    };
    let ways: Vec<String> = arrows.iter().map(way).chain(wires.iter().flat_map(round)).collect();
    let mut text = format!(
        "<svg class=\"blocks\" width=\"{width}\" height=\"{height}\" viewBox=\"0 {top} {width} {height}\" role=\"img\" \
         xmlns=\"http://www.w3.org/2000/svg\"><title>{}</title><desc>{}</desc>\
         <defs><marker id=\"tip-{name}\" viewBox=\"0 0 8 8\" refX=\"7\" refY=\"4\" markerWidth=\"8\" markerHeight=\"8\" orient=\"auto\">\
         <path d=\"M0 0L8 4L0 8Z\"/></marker></defs>",
        escaped(&format!("Block diagram: {}", boxes.join(", "))),
        escaped(&ways.join("; "))
    );
    for arrow in arrows {
        text += &line(&blocks[arrow.from], &blocks[arrow.to], arrow.what, name);
    }
    for wire in wires {
        text += &around(wire, blocks, bottom, name);
    }
    for block in blocks {
        let (x, y) = corner(block);
        // writing to a String cannot fail
        let _ = write!(
            text,
            "<rect x=\"{x}\" y=\"{y}\" width=\"{WIDTH}\" height=\"{HEIGHT}\" rx=\"6\"/>\
             <text x=\"{}\" y=\"{}\" class=\"name\">{}</text><text x=\"{}\" y=\"{}\" class=\"what\">{}</text>",
            x + WIDTH / 2,
            y + 26,
            escaped(block.name),
            x + WIDTH / 2,
            y + 46,
            escaped(block.what)
        );
    }
    text + "</svg>"
}

fn corner(block: &Block) -> (i32, i32) {
    (EDGE + block.at.0 * ACROSS, EDGE + block.at.1 * DOWN)
}

/// From the side of a box to the next one's: across, or down and across.
fn line(from: &Block, to: &Block, what: &str, name: &str) -> String {
    let ((fx, fy), (tx, ty)) = (corner(from), corner(to));
    let (across, down) = ((tx - fx).signum(), (ty - fy).signum());
    let path;
    let label;
    if down == 0 {
        let (x0, x1) = if across > 0 { (fx + WIDTH, tx) } else { (fx, tx + WIDTH) };
        let y = fy + HEIGHT / 2;
        path = format!("M{x0} {y}L{x1} {y}");
        label = ((x0 + x1) / 2, y - 7);
    } else {
        let (y0, y1) = if down > 0 { (fy + HEIGHT, ty) } else { (fy, ty + HEIGHT) };
        let (x0, x1) = (fx + WIDTH / 2 + 12 * across, tx + WIDTH / 2 - 12 * across);
        let middle = (y0 + y1) / 2;
        path = format!("M{x0} {y0}L{x0} {middle}L{x1} {middle}L{x1} {y1}");
        label = ((x0 + x1) / 2 + if x0 == x1 { 8 } else { 0 }, middle - 6);
    }
    let anchor = if down != 0 && across == 0 { " class=\"beside\"" } else { "" };
    format!(
        "<path d=\"{path}\" class=\"arrow\" marker-end=\"url(#tip-{name})\"/><text x=\"{}\" y=\"{}\"{anchor}>{}</text>",
        label.0,
        label.1,
        escaped(what)
    )
}

/// Out of a block to the right, then below or above all of them, and into each goal.
fn around(wire: &Wire, blocks: &[Block], bottom: i32, name: &str) -> String {
    const ASIDE: i32 = 28;
    let (x, y) = corner(&blocks[wire.from]);
    // wires out of one block leave side by side
    let out = x + WIDTH + ASIDE;
    let start = y + HEIGHT / 2;
    let is_below = wire.level >= 0;
    let pass = if is_below { bottom + EDGE / 2 + wire.level * AROUND } else { EDGE + wire.level * AROUND };
    let mut text = format!("<path d=\"M{} {start}L{out} {start}L{out} {pass}\" class=\"arrow\"/>", x + WIDTH);
    for &(to, aside) in wire.to {
        let (bx, by) = corner(&blocks[to]);
        let (bx, by) = (bx + WIDTH / 2 + aside * ASIDE, if is_below { by + HEIGHT } else { by });
        // writing to a String cannot fail
        let _ = write!(
            text,
            "<path d=\"M{out} {pass}L{bx} {pass}L{bx} {by}\" class=\"arrow\" marker-end=\"url(#tip-{name})\"/>"
        );
    }
    let label = if is_below { pass - 6 } else { pass + 16 };
    text + &format!("<text x=\"{}\" y=\"{label}\">{}</text>", out - 14, escaped(wire.what))
}
