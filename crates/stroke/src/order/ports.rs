use std::ops::Range;

use kurbo::{Point, Vec2};
use tracelight_maths::cos;

use super::travel::StrokeEnd;
use crate::{Drawing, Path};

/// A joint counts as a corner when the direction turns by more than this there: 10°, below the 15° joints of a
/// circle drawn as 24 lines and above what a fitted curve leaves between its cubics.
const CORNER_RAD: f64 = 10.0 * std::f64::consts::PI / 180.0;

/// Where the strokes of a drawing can be entered: port `p` lies at `points[p]` and belongs to `stroke[p]`.
///
/// An open stroke has two ports and is left by the other one; a closed stroke has one for each joint it may begin
/// at and is left where it was entered.
pub(super) struct Ports {
    pub(super) points: Vec<Point>,
    outward: Vec<Vec2>,
    pub(super) stroke: Vec<u32>,
    /// Of a closed stroke: the element that starts at the port. Of an open one: 0 its start, 1 its end.
    pub(super) joint: Vec<u32>,
    closed: Vec<bool>,
    first: Vec<u32>,
}

impl Ports {
    pub(super) fn of(drawing: &Drawing) -> Self {
        let mut ports = Self {
            points: Vec::new(),
            outward: Vec::new(),
            stroke: Vec::new(),
            joint: Vec::new(),
            closed: Vec::new(),
            first: vec![0],
        };
        for (number, stroke) in drawing.strokes.iter().enumerate() {
            ports.add(number as u32, &stroke.path);
        }
        ports
    }

    fn add(&mut self, stroke: u32, path: &Path) {
        let entries = match path.is_closed() {
            true => start_joints(path)
                .into_iter()
                .map(|(joint, point)| (joint, StrokeEnd::resting(point)))
                .collect(),
            false => (0..).zip(StrokeEnd::of(path)).collect::<Vec<_>>(),
        };
        for (joint, end) in entries {
            self.points.push(end.point);
            self.outward.push(end.outward);
            self.stroke.push(stroke);
            self.joint.push(joint);
        }
        self.closed.push(path.is_closed());
        self.first.push(self.points.len() as u32);
    }

    pub(super) fn strokes(&self) -> usize {
        self.closed.len()
    }

    /// A port as the cost sees it.
    pub(super) fn end(&self, port: u32) -> StrokeEnd {
        StrokeEnd { point: self.points[port as usize], outward: self.outward[port as usize] }
    }

    /// The ports of one stroke.
    pub(super) fn range(&self, stroke: u32) -> Range<u32> {
        self.first[stroke as usize]..self.first[stroke as usize + 1]
    }

    /// Where a stroke is left that is entered at port `entry`.
    pub(super) fn exit(&self, entry: u32) -> u32 {
        let stroke = self.stroke[entry as usize];
        if self.closed[stroke as usize] {
            return entry;
        }
        let range = self.range(stroke);
        range.start + range.end - 1 - entry
    }

    /// Whether a stroke is closed.
    pub(super) fn is_closed(&self, stroke: u32) -> bool {
        self.closed[stroke as usize]
    }
}

/// The joints a closed path may begin at: its corners, or every joint of a smooth one.
fn start_joints(path: &Path) -> Vec<(u32, Point)> {
    let pieces: Vec<_> = path.pieces().collect();
    let before = pieces.iter().cycle().skip(pieces.len().saturating_sub(1));
    let joints = pieces.iter().zip(before).enumerate();
    let is_corner = |(_, (piece, last)): &(usize, (&crate::Piece, &crate::Piece))| {
        let cosine = piece.start_tangent().dot(last.end_tangent());
        cosine < cos(CORNER_RAD)
    };
    let named = |(number, (piece, _)): (usize, (&crate::Piece, &crate::Piece))| (number as u32, piece.from);
    let corners: Vec<_> = joints.clone().filter(is_corner).map(named).collect();
    match corners.is_empty() {
        true => joints.map(named).collect(),
        false => corners,
    }
}
