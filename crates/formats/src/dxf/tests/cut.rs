use super::*;

const ENTITIES: &str =
    "0 LINE, 8 a, 10 0, 20 0, 11 60, 21 0, 0 ARC, 8 b, 62 1, 10 5.5, 20 5, 40 3, 50 10, 51 200,
    0 LWPOLYLINE, 90 3, 70 1, 10 0, 20 0, 42 0.5, 10 9, 20 0, 10 9, 20 7, 330 1F";

/// A binary file with the groups of an ASCII one, written as Autodesk's reference says.
fn binary(text: &str, is_wide: bool) -> Vec<u8> {
    let mut bytes = b"AutoCAD Binary DXF\r\n\x1a\x00".to_vec();
    let lines: Vec<&str> = text.lines().map(str::trim).collect();
    for group in lines.chunks_exact(2) {
        let code: u16 = group[0].parse().unwrap();
        match (is_wide, code) {
            (true, _) => bytes.extend(code.to_le_bytes()),
            (false, 255..) => {
                bytes.push(255);
                bytes.extend(code.to_le_bytes());
            }
            (false, _) => bytes.push(code as u8),
        }
        match code {
            10..=59 | 210..=239 | 1010..=1059 => bytes.extend(group[1].parse::<f64>().unwrap().to_le_bytes()),
            60..=79 | 1060..=1070 => bytes.extend(group[1].parse::<i16>().unwrap().to_le_bytes()),
            90..=99 | 420..=429 => bytes.extend(group[1].parse::<i32>().unwrap().to_le_bytes()),
            290..=299 => bytes.push(group[1].parse().unwrap()),
            310..=319 => bytes.extend([&[2], &[7, 0][..]].concat()),
            _ => bytes.extend([group[1].as_bytes(), &[0]].concat()),
        }
    }
    bytes
}

#[test]
fn binary_files_are_read_as_ascii_ones() {
    let text = file(&format!(
        "{ENTITIES}, 290 1, 310 chunk, 0 LINE, 1000 note, 1070 -3, 1040 0.5, 420 255, 10 1, 20 1, 11 -2.5, 21 7"
    ));
    let unnumbered = |mut reading: Reading| {
        reading.sheet.drawing.strokes.iter_mut().for_each(|stroke| stroke.entity = None);
        reading
    };
    let wanted = unnumbered(reading(&text));
    assert_eq!(wanted.sheet.drawing.strokes.len(), 4);
    for is_wide in [false, true] {
        let bytes = binary(&text, is_wide);
        assert_eq!(unnumbered(read(&bytes).unwrap()), wanted, "but for the lines of a text");
        // cut anywhere, it is refused, or what is whole is drawn
        for cut in 0..bytes.len() - 3 {
            if let Ok(part) = read(&bytes[..cut]) {
                assert!(part.remarks.iter().any(|r| r.contains("EOF") || r.contains("cut off")), "{cut}");
                assert!(part.sheet.drawing.strokes.len() <= wanted.sheet.drawing.strokes.len());
            }
        }
    }
}

#[test]
fn what_is_wrong_in_a_binary_file_is_named_with_its_byte() {
    let mut bytes = binary(&file("0 LINE, 10 0, 20 0, 11 1, 21 1"), true);
    let last = bytes.windows(2).rposition(|w| w == 21_u16.to_le_bytes()).unwrap();
    bytes[last + 2..last + 10].copy_from_slice(&f64::NAN.to_le_bytes());
    let found = read(&bytes).unwrap_err().to_string();
    assert!(found.contains(&format!("byte {}: a y coordinate is NaN", last + 2)), "{found}");
    bytes[last] = 250;
    let found = read(&bytes).unwrap_err().to_string();
    assert!(found.contains("250 is no group code"), "{found}");
}

#[test]
fn what_is_whole_of_a_file_that_is_cut_off_is_drawn_and_that_is_said() {
    let text = file(ENTITIES);
    let end = text.find("0\nENDSEC\n0\nEOF").unwrap();
    let check = |length: usize, strokes: usize, said: &str| {
        let found = reading(&text[..length]);
        assert_eq!(found.sheet.drawing.strokes.len(), strokes, "{length}");
        assert_eq!(found.remarks.len(), 1, "{:?}", found.remarks);
        assert!(found.remarks[0].contains(said), "{:?}", found.remarks);
    };
    check(end + 9, 3, "ends without EOF");
    check(end + 2, 2, "its last entity is not");
    check(end - 6, 2, "its last entity is not");
    check(text.find("0\nLWPOLYLINE").unwrap() + 4, 2, "its last entity is not");
    for cut in 0..text.find("0\nARC").unwrap() {
        assert!(read(&text.as_bytes()[..cut]).unwrap_err().to_string().contains("not valid DXF"), "{cut}");
    }
}

#[test]
fn decimal_commas_are_read_where_all_numbers_have_them() {
    let text = file("0 LINE, 10 0;0, 20 0;0, 11 60;25, 21 1;5").replace(';', ",");
    assert!((reading(&text).sheet.width - 60.25).abs() < 1e-9);
    let mixed = file("0 LINE, 10 0.0, 20 0;0, 11 60;25, 21 1;5").replace(';', ",");
    let found = read(mixed.as_bytes()).unwrap_err().to_string();
    assert!(found.contains("a y coordinate is \"0,0\", expected a number"), "{found}");
}
