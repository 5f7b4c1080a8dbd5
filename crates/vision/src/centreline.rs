//! Traces pen lines along their middle.

use tracelight_image::median::median;
use tracelight_image::{Mask, Plane, Region, long_axis};
use tracelight_maths::powi;
use tracelight_stroke::{Path, Point, Stroke, Vec2, polyline_length};

use crate::follow;
use crate::graph::Graph;
use crate::junction::{self, Joint, Junctions};
use crate::line::Line;
use crate::near::Near;
use crate::options::Options;
use crate::row::Row;

/// The rows of one patch's graph; lines end where they meet `shapes`.
pub(crate) fn rows(dark: &Plane<u8>, shapes: &Mask, region: &Region, graph: &Graph) -> Vec<Row> {
    if is_dot(graph) {
        return vec![dot(dark, region)];
    }
    let mut drawn = Drawn::of(dark, shapes, graph, &[]);
    let bars = drawn.bars(graph);
    if !bars.is_empty() {
        drawn = Drawn::of(dark, shapes, graph, &bars);
    }
    let Drawn { mut lines, junctions, .. } = drawn;
    for (port, way) in &junctions.ends {
        lines[port.line].end_along(port.end, way);
    }
    let mut found = strung_together(&lines, &junctions.joints);
    if found.len() > 1 {
        let pen = pen_of(&found);
        found.retain(|row| !is_stub(row, pen));
    }
    // a knot of nothing but junctions is a blot
    if found.is_empty() { vec![dot(dark, region)] } else { found }
}

/// The lines of a graph and what became of them at its junctions.
struct Drawn {
    lines: Vec<Line>,
    junctions: Junctions,
    /// Branches that are part of a junction.
    bridges: Vec<usize>,
}

impl Drawn {
    /// Branches `bars` are lines, however short they are.
    fn of(dark: &Plane<u8>, shapes: &Mask, graph: &Graph, bars: &[usize]) -> Self {
        let (mut cluster, bridges) = junction::clusters(graph, bars);
        let (bridges, real): (Vec<usize>, Vec<usize>) =
            (0..graph.branches.len()).partition(|&branch| bridges[branch]);
        let pen = graph.pen_radius();
        let line = |&branch: &usize| Line::of(dark, shapes, graph, pen, &graph.branches[branch]);
        let mut lines: Vec<Line> = real.iter().map(line).collect();
        junction::merge_acute(&mut lines, &mut cluster);
        let junctions = junction::join(dark, &lines, &cluster);
        Self { lines, junctions, bridges }
    }

    /// The bridges that nothing leads over: bars between two lines beside each other, shorter than the discs of ink at
    /// their ends, such as an R's.
    fn bars(&self, graph: &Graph) -> Vec<usize> {
        if self.bridges.is_empty() {
            return Vec::new();
        }
        let pen = graph.pen_radius();
        let mut followed = self.junctions.ways();
        followed.extend(self.lines.iter().flat_map(|line| &line.points));
        let followed = Near::of(followed.into_iter().map(|p| (p, ())), BARE_RADII * pen + 0.5);
        let bare = |&branch: &usize| {
            let points = graph.branches[branch].points.iter();
            points.filter(|&&p| followed.around(p).next().is_none()).count() as f64
        };
        self.bridges.iter().copied().filter(|branch| bare(branch) >= (0.5 * pen).max(2.0)).collect()
    }
}

/// Ink this far from every line, in half widths of the pen, no line drew: one is its edge, the rest is blur.
const BARE_RADII: f64 = 1.2;

/// A row is at least so long, in pen widths, beside others of its patch: what is shorter is the bump of a blot.
const LEAST_ROW_PENS: f64 = 0.5;

/// What is so much thinner than the pen of the others, and no longer than it is wide, is what was left at a line's edge.
const THIN_ROW: f64 = 0.6;

fn is_stub(row: &Row, pen: f64) -> bool {
    let length = polyline_length(&row.points);
    let is_left = row.width < THIN_ROW * pen && length < pen;
    !row.closed && (is_left || length < LEAST_ROW_PENS * row.width)
}

/// The width of the longest row, px.
fn pen_of(rows: &[Row]) -> f64 {
    let longest = rows.iter().map(|row| (polyline_length(&row.points), row.width));
    longest.max_by(|a, b| a.0.total_cmp(&b.0)).map_or(0.0, |longest| longest.1)
}

/// The stroke along a row.
pub(crate) fn stroke(dark: &Plane<u8>, row: &Row, options: &Options) -> Option<Stroke> {
    // a line that was carried on out of the picture ends at its border
    let points: Vec<Point> = row.points.iter().map(|&p| dark.clamp(p)).collect();
    let path = follow::path(
        &points,
        row.closed,
        follow::noise_px(&points),
        0.5 * row.width,
        |p| dark.at(p),
        options,
    )?;
    Some(Stroke { pen: Some(row.width), ..Stroke::new(path) })
}

/// A row as it lies, not made a path of lines and curves: to paint, not to draw.
pub(crate) fn unfitted(row: &Row) -> Option<Stroke> {
    Some(Stroke { pen: Some(row.width), ..Stroke::new(Path::polyline(&row.points, row.closed)?) })
}

/// Lines strung together through the joints.
fn strung_together(lines: &[Line], joints: &[Joint]) -> Vec<Row> {
    let mut joint_at: Vec<[Option<(usize, usize)>; 2]> = vec![[None; 2]; lines.len()];
    for (number, joint) in joints.iter().enumerate() {
        for (side, port) in joint.ports.iter().enumerate() {
            joint_at[port.line][port.end] = Some((number, side));
        }
    }
    let mut used = vec![false; lines.len()];
    let mut rows = Vec::new();
    // from the free ends first; what is left then goes round
    let free = |i: &usize| joint_at[*i].iter().any(Option::is_none);
    let order: Vec<usize> =
        (0..lines.len()).filter(free).chain((0..lines.len()).filter(|i| !free(i))).collect();
    for start in order {
        if !used[start] {
            rows.push(strung(start, lines, joints, &joint_at, &mut used));
        }
    }
    rows
}

/// The row that begins with line `start`.
fn strung(
    start: usize,
    lines: &[Line],
    joints: &[Joint],
    joint_at: &[[Option<(usize, usize)>; 2]],
    used: &mut [bool],
) -> Row {
    let mut row =
        Row { points: Vec::new(), closed: lines[start].ring, width: 0.0, free: [false; 2], dot: false };
    let mut widths = Vec::new();
    let (mut line, mut entry) =
        (start, usize::from(joint_at[start][0].is_some() && joint_at[start][1].is_none()));
    row.free[0] = lines[line].free[entry];
    while !used[line] {
        used[line] = true;
        widths.push(lines[line].width);
        let forward = lines[line].points.iter().copied();
        match entry {
            0 => row.points.extend(forward),
            _ => row.points.extend(forward.rev()),
        }
        row.free[1] = lines[line].free[1 - entry];
        let Some((number, side)) = joint_at[line][1 - entry] else { break };
        let bridge = joints[number].bridge.iter().copied();
        match side {
            0 => row.points.extend(bridge),
            _ => row.points.extend(bridge.rev()),
        }
        let next = joints[number].ports[1 - side];
        (line, entry) = (next.line, next.end);
        row.closed |= line == start && used[line];
    }
    row.width = median(&widths);
    row
}

/// Whether a region is no longer than one and a half times its width: a dot or a dash of the pen.
pub(crate) fn is_dot(graph: &Graph) -> bool {
    let length: f64 = graph.branches.iter().map(|b| b.length()).sum();
    let radius = graph.branches.iter().flat_map(|b| &b.radii).copied().fold(0.5, f64::max);
    graph.branches.len() <= 1 && graph.branches.iter().all(|b| !b.ring) && length <= 3.0 * radius
}

/// A dash is this much longer than wide; what is shorter is a dot.
const DASH: f64 = 1.5;

/// A short straight stroke along a region's longer axis, at least half the pen's width long, so that light falls on
/// it at all.
fn dot(dark: &Plane<u8>, region: &Region) -> Row {
    let (centre, axis, length, width) = extent(dark, region);
    let half = 0.5 * (length - width).max(0.5 * width).max(0.5);
    let points = vec![dark.clamp(centre - axis * half), dark.clamp(centre + axis * half)];
    Row { points, closed: false, width, free: [true; 2], dot: length < DASH * width }
}

/// Centre, long axis, length and width of a region, from the moments of its darkness. A stadium's are those of its
/// second moments to within some percent.
fn extent(dark: &Plane<u8>, region: &Region) -> (Point, Vec2, f64, f64) {
    let (centre, variances) = region.moments(|x, y| f64::from(dark.row(y)[x]));
    let [xx, xy, yy] = variances;
    let spread = (0.25 * powi(xx - yy, 2) + xy * xy).sqrt();
    let (long, short) = (0.5 * (xx + yy) + spread, (0.5 * (xx + yy) - spread).max(0.0));
    // a disc of diameter d has a variance of d²/16 about each axis
    (centre, long_axis(variances), 4.0 * long.sqrt(), 4.0 * short.sqrt())
}
