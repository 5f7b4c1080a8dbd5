use nalgebra::Vector3;
use tracelight_stroke::Point;

/// Focal lengths of a camera, in longer sides of its picture: from the widest telephone to a portrait lens. What corners
/// say beyond that is their noise.
const FOCAL: std::ops::Range<f64> = 0.4..4.0;
/// What a telephone's main camera has (26 mm on 36 mm of film), where the corners do not tell: a tenth off, a sheet seen 40°
/// aside comes out four per cent too long or too short.
const USUAL_FOCAL: f64 = 0.72;
/// Opposite sides that would meet further away than so many longer sides of the picture are parallel.
const PARALLEL: f64 = 40.0;

/// Width over height of a rectangle from its four corners in a picture of that size, clockwise from the upper left;
/// `None` where they are no quadrilateral. The picture's pixels are square and its middle is on the lens's axis; a
/// picture that was cut is taken for whole.
///
/// Zhang & He, "Whiteboard scanning and image enhancement", *Digital Signal Processing* 17 (2007), §3.
pub fn proportions(corners: [Point; 4], (width, height): (f64, f64)) -> Option<f64> {
    let longer = width.max(height);
    let at = |p: Point| Vector3::new((p.x - 0.5 * width) / longer, (p.y - 0.5 * height) / longer, 1.0);
    let [upper_left, upper_right, lower_right, lower_left] = corners.map(at);
    let diagonal = upper_left.cross(&lower_right);
    let across = diagonal.dot(&lower_left) / upper_right.cross(&lower_right).dot(&lower_left);
    let down = diagonal.dot(&upper_right) / lower_left.cross(&lower_right).dot(&upper_right);
    // the directions of the rectangle's sides, up to the focal length
    let (along, aside) = (across * upper_right - upper_left, down * lower_left - upper_left);
    let flat = |v: &Vector3<f64>| v.x * v.x + v.y * v.y;
    // where opposite sides meet far away they say nothing of the focal length, and little depends on it
    let meets = |v: &Vector3<f64>| v.z.abs() * PARALLEL > flat(v).sqrt();
    let square = -(along.x * aside.x + along.y * aside.y) / (along.z * aside.z);
    let told = (meets(&along) && meets(&aside)).then(|| square.sqrt()).filter(|focal| FOCAL.contains(focal));
    let focal = told.unwrap_or(USUAL_FOCAL);
    let length = |v: &Vector3<f64>| (flat(v) / (focal * focal) + v.z * v.z).sqrt();
    let ratio = length(&along) / length(&aside);
    (ratio.is_finite() && ratio > 0.0).then_some(ratio)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Camera, CameraPose, Lens};

    #[test]
    fn a_sheet_seen_at_a_slant_has_its_own_proportions() {
        let size = [4000, 3000];
        for (eye, focal) in [
            ([0.0, 0.0, 0.6], 3000.0),
            ([0.2, 0.1, 0.5], 3000.0),
            ([-0.3, 0.25, 0.6], 2900.0),
            ([0.0, -0.4, 0.5], 3000.0),
            ([0.35, -0.1, 0.45], 5200.0),
        ] {
            let lens = Lens::ideal(size[0], size[1], focal);
            let camera = Camera { lens, pose: CameraPose::looking_at(eye, [0.0; 3]).unwrap() };
            for (width, height) in [(0.21, 0.297), (0.297, 0.21), (0.2, 0.2)] {
                let corner = |x: f64, y: f64| camera.pixel(Point::new(0.5 * x * width, 0.5 * y * height));
                let seen = [(-1.0, 1.0), (1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)];
                let corners = seen.map(|(x, y)| corner(x, y).unwrap());
                let found = proportions(corners, (4000.0, 3000.0)).unwrap();
                let off = found / (width / height) - 1.0;
                // where only two sides meet the focal length is guessed: a twentieth off brings two per cent
                assert!(off.abs() < 0.03, "{eye:?} {width} × {height}: {found}");
            }
        }
    }
}
