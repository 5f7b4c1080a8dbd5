//! Pen lines: strokes down their middle.

use tracelight_stroke::{Element, Path, Point, Stroke, Vec2};

use crate::Options;
use crate::follow;
use crate::graph::Graph;
use crate::junction::{self, Joint};
use crate::line::Line;
use crate::plane::Plane;
use crate::region::Region;
use crate::ridge::median;

/// A row of points to be fitted, and the pen that drew it.
struct Row {
    points: Vec<Point>,
    closed: bool,
    width: f64,
}

/// The strokes of one region's graph.
pub(crate) fn strokes(dark: &Plane<u8>, region: &Region, graph: &Graph, options: &Options) -> Vec<Stroke> {
    if is_dot(graph) {
        return vec![dot(dark, region)];
    }
    let (mut cluster, bridges) = junction::clusters(graph);
    let real = graph.branches.iter().zip(bridges).filter(|(_, bridge)| !bridge);
    let mut lines: Vec<Line> = real.map(|(branch, _)| Line::of(dark, graph, branch)).collect();
    junction::merge_acute(&mut lines, &mut cluster);
    let junctions = junction::join(dark, &lines, &cluster);
    for (port, stop) in &junctions.ends {
        lines[port.line].end_at(port.end, *stop);
    }
    let found: Vec<Stroke> =
        rows(&lines, &junctions.joints).iter().filter_map(|row| stroke(dark, row, options)).collect();
    // a knot of nothing but junctions is a blot
    if found.is_empty() { vec![dot(dark, region)] } else { found }
}

fn stroke(dark: &Plane<u8>, row: &Row, options: &Options) -> Option<Stroke> {
    // a line that was carried on out of the picture ends at its border
    let points: Vec<Point> = row.points.iter().map(|&p| dark.clamp(p)).collect();
    let path = follow::path(&points, row.closed, 0.5 * row.width, options)?;
    Some(Stroke { pen: Some(row.width), ..Stroke::new(path) })
}

/// Lines strung together through the joints.
fn rows(lines: &[Line], joints: &[Joint]) -> Vec<Row> {
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
    let mut row = Row { points: Vec::new(), closed: lines[start].ring, width: 0.0 };
    let mut widths = Vec::new();
    let (mut line, mut entry) =
        (start, usize::from(joint_at[start][0].is_some() && joint_at[start][1].is_none()));
    while !used[line] {
        used[line] = true;
        widths.push(lines[line].width);
        let forward = lines[line].points.iter().copied();
        match entry {
            0 => row.points.extend(forward),
            _ => row.points.extend(forward.rev()),
        }
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
fn is_dot(graph: &Graph) -> bool {
    let length: f64 = graph.branches.iter().map(|b| b.length()).sum();
    let radius = graph.branches.iter().flat_map(|b| &b.radii).copied().fold(0.5, f64::max);
    graph.branches.len() <= 1 && graph.branches.iter().all(|b| !b.ring) && length <= 3.0 * radius
}

/// A short straight stroke along a region's longer axis, at least half the pen's width long, so that light falls on
/// it at all.
fn dot(dark: &Plane<u8>, region: &Region) -> Stroke {
    let (centre, axis, length, width) = extent(dark, region);
    let half = 0.5 * (length - width).max(0.5 * width).max(0.5);
    let mut path = Path::new(dark.clamp(centre - axis * half));
    path.push(Element::Line { to: dark.clamp(centre + axis * half) });
    Stroke { pen: Some(width), ..Stroke::new(path) }
}

/// Centre, long axis, length and width of a region, from the moments of its darkness. A stadium's are those of its
/// second moments to within some percent.
fn extent(dark: &Plane<u8>, region: &Region) -> (Point, Vec2, f64, f64) {
    let weighted =
        || region.pixels(dark.width).map(|i| (dark.centre(i).to_vec2(), f64::from(dark.values[i])));
    let mass = weighted().map(|(_, w)| w).sum::<f64>().max(1e-9);
    let centre = weighted().map(|(p, w)| p * w).sum::<Vec2>() / mass;
    let moment = |f: fn(Vec2) -> f64| weighted().map(|(p, w)| w * f(p - centre)).sum::<f64>() / mass;
    let (xx, xy, yy) = (moment(|v| v.x * v.x), moment(|v| v.x * v.y), moment(|v| v.y * v.y));
    let spread = (0.25 * (xx - yy).powi(2) + xy * xy).sqrt();
    let (long, short) = (0.5 * (xx + yy) + spread, (0.5 * (xx + yy) - spread).max(0.0));
    let axis = Vec2::from_angle(0.5 * (2.0 * xy).atan2(xx - yy));
    // a disc of diameter d has a variance of d²/16 about each axis
    (centre.to_point(), axis, 4.0 * long.sqrt(), 4.0 * short.sqrt())
}
