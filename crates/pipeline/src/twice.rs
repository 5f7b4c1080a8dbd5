//! What of a drawing is drawn twice, in words.

use tracelight_formats::length;
use tracelight_stroke::Doubles;
use tracelight_task::counted;

/// Says what was left out because it lies on earlier lines, and where that was not looked for. Lengths are in millimetres where the
/// drawing's unit has a size.
pub(crate) fn remarks(doubles: &Doubles, metres_per_unit: Option<f64>) -> Vec<String> {
    let Doubles { strokes, length: again, unsearched } = *doubles;
    let left_out = (strokes > 0).then(|| {
        let (lines, length) = (counted(strokes, "line"), length(again, metres_per_unit));
        format!("not drawn again: {lines}, {length}, on top of earlier lines")
    });
    let unsearched = (unsearched > 0).then(|| {
        format!(
            "not looked at for whether they are drawn twice: {}; too many lie close together",
            counted(unsearched, "line")
        )
    });
    left_out.into_iter().chain(unsearched).collect()
}

#[cfg(test)]
mod tests {
    use tracelight_picture::decode;
    use tracelight_stroke::Drawing;

    use crate::choice::Choice;
    use crate::sketch::{Sketch, sketch_at};
    use crate::tracing::Tracing;

    fn sketch(name: &str, bytes: &str, layers: &[&str]) -> Sketch {
        let choice = Choice { layers: layers.iter().map(|&l| l.to_owned()).collect(), ..Choice::default() };
        let source = decode(name, bytes.as_bytes()).unwrap();
        sketch_at(name, source, &Tracing::default(), &choice, &|_, _| 1e-3).unwrap()
    }

    /// Lengths in the order of the strokes, to hundredths of a millimetre.
    fn lengths(sketch: &Sketch) -> Vec<f64> {
        let Drawing { strokes } = &sketch.drawing;
        strokes.iter().map(|s| (s.path.length(1e-6) * 1e2).round() / 1e2).collect()
    }

    fn dxf(entities: &str) -> String {
        let groups = entities.split(',').flat_map(|group| group.trim().split_once(' '));
        let groups: String = groups.map(|(code, value)| format!("{code}\n{value}\n")).collect();
        let header = "0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n4\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n";
        format!("{header}{groups}0\nENDSEC\n0\nEOF\n")
    }

    fn check(entities: &str, layers: &[&str], wanted: &[f64], told: &str) {
        let found = sketch("a.dxf", &dxf(entities), layers);
        assert_eq!(lengths(&found), wanted, "{entities}");
        let remarks = found.remarks.join("; ");
        let is_told = if told.is_empty() { !remarks.contains("again") } else { remarks.contains(told) };
        assert!(is_told, "{entities}: {remarks}");
    }

    const LINE: &str = "0 LINE, 8 A, 10 0, 20 0, 11 100, 21 0";

    #[test]
    fn what_a_dxf_has_twice_is_drawn_once_and_told() {
        let with = |more: &str| format!("{LINE}, {more}");
        check(&with("0 LINE, 8 A, 10 0, 20 0, 11 100, 21 0"), &[], &[100.0], "again: 1 line, 100 mm");
        check(&with("0 LINE, 8 A, 10 100, 20 0, 11 0, 21 0"), &[], &[100.0], "again: 1 line, 100 mm");
        check(&with("0 LINE, 8 A, 10 60, 20 0, 11 140, 21 0"), &[], &[140.0], "again: 1 line, 40 mm");
        let quarter = std::f64::consts::FRAC_PI_2 * 50.0;
        let arcs = "0 ARC, 8 A, 10 0, 20 0, 40 50, 50 0, 51 90, 0 CIRCLE, 8 A, 10 0, 20 0, 40 50";
        let rounded = |length: f64| (length * 1e2).round() / 1e2;
        check(arcs, &[], &[rounded(4.0 * quarter)], "again: 1 line, 78.5 mm");
        // there and back within one polyline
        let back = "0 LWPOLYLINE, 8 A, 90 3, 70 0, 10 0, 20 0, 10 50, 20 30, 10 0, 20 0";
        check(back, &[], &[rounded(3400f64.sqrt())], "again: 1 line, 58.3 mm");
        check(&with("0 LINE, 8 A, 10 50, 20 -50, 11 50, 21 50"), &[], &[100.0, 100.0], "");
    }

    #[test]
    fn an_outline_that_is_drawn_twice_is_still_one_stroke() {
        let corners = [(0, 0), (100, 0), (100, 100), (0, 100), (0, 0)];
        let side = |pair: &[(i32, i32)]| {
            format!("0 LINE, 8 A, 10 {}, 20 {}, 11 {}, 21 {}", pair[0].0, pair[0].1, pair[1].0, pair[1].1)
        };
        let once: Vec<String> = corners.windows(2).map(side).collect();
        let twice = [once.clone(), once].concat().join(", ");
        check(&twice, &[], &[400.0], "again: 4 lines, 400 mm");
        assert!(sketch("a.dxf", &dxf(&twice), &[]).drawing.strokes[0].path.is_closed());
    }

    #[test]
    fn a_line_that_two_layers_share_is_drawn_with_either() {
        let both = format!(
            "{LINE}, 0 LINE, 8 B, 10 0, 20 0, 11 100, 21 0, 0 LINE, 8 B, 10 100, 20 0, 11 100, 21 50"
        );
        check(&both, &["A"], &[100.0], "");
        check(&both, &["B"], &[150.0], "");
        check(&both, &[], &[100.0, 50.0], "again: 1 line, 100 mm");
        let svg = "<svg xmlns='http://www.w3.org/2000/svg' width='100mm' height='100mm' viewBox='0 0 100 100' fill='none' stroke='#000'>\
            <g id='A'><path d='M10 60H90'/></g><g id='B'><path d='M90 60H10'/></g></svg>";
        assert_eq!(lengths(&sketch("a.svg", svg, &["B"])).len(), 1);
        let all = sketch("a.svg", svg, &[]);
        assert_eq!(all.drawing.strokes.len(), 1);
        assert!(all.remarks[0].contains("again: 1 line, 80 mm"), "{:?}", all.remarks);
    }

    #[test]
    fn a_list_of_strokes_is_drawn_as_it_stands() {
        let csv = "stroke,x_m,y_m\n1,0,0\n1,0.1,0\n2,0,0\n2,0.1,0\n";
        assert_eq!(sketch("a.csv", csv, &[]).drawing.strokes.len(), 2);
    }

    #[test]
    fn what_is_drawn_twice_is_found_in_time_that_grows_with_the_lines() {
        let seconds = |lines: usize| {
            let line = |i: usize| {
                let (x, y) = (i % 317, i / 317);
                format!("0 LINE, 8 A, 10 {x}, 20 {y}, 11 {}, 21 {y}.7", x + 1)
            };
            let text = dxf(&(0..lines).chain(0..lines).map(line).collect::<Vec<_>>().join(","));
            let began = std::time::Instant::now();
            let found = sketch("a.dxf", &text, &[]);
            assert!(
                found.remarks.iter().any(|r| r.contains(&format!("again: {lines} lines"))),
                "{:?}",
                found.remarks
            );
            began.elapsed().as_secs_f64()
        };
        let (few, many) = (seconds(10_000), seconds(50_000));
        assert!(many < 5.0 && many < 12.0 * few, "10 000 lines twice: {few} s, 50 000: {many} s");
    }
}
