//! Images over HTTP: MJPEG streams (`multipart/x-mixed-replace`, as IP cameras, mjpg-streamer and phones send) and single images.

use std::io::{BufRead, BufReader, Read};
use std::sync::Arc;
use std::time::Instant;

use tracelight_task::Failure;

use crate::latest::Latest;
use crate::net::{Limits, MOST_BYTES, Net};
use tracelight_eye::{Looks, Shot};

/// Longest line of a header, bytes, and most lines.
const MOST_LINE: u64 = 8192;
const MOST_LINES: usize = 100;

/// A camera that is asked by HTTP.
pub(crate) struct Stream {
    net: Net,
    limits: Limits,
    /// What a stream brought last; `None` of a camera that sends one image each time it is asked.
    latest: Option<Arc<Latest<Vec<u8>>>>,
    opened: Instant,
}

impl Stream {
    pub(crate) fn open(url: &str) -> Result<Self, Failure> {
        Self::with(url, Limits::USUAL)
    }

    pub(crate) fn with(url: &str, limits: Limits) -> Result<Self, Failure> {
        let mut stream = Self { net: Net::new(url, limits), limits, latest: None, opened: Instant::now() };
        let answer = stream.net.open().map_err(|why| stream.failed(&why))?;
        if let Some(boundary) = boundary_of(&answer.kind) {
            let latest = Arc::new(Latest::default());
            let to = Arc::clone(&latest);
            // ends with its connection, when nothing comes any more, or with the process
            std::thread::spawn(move || read_all(BufReader::new(answer.body), &boundary, &to));
            stream.latest = Some(latest);
        } else if !answer.kind.starts_with("image/") {
            return Err(stream.failed(&format!(
                "it sends {}, and neither images nor a stream of them (multipart/x-mixed-replace)",
                answer.kind
            )));
        }
        Ok(stream)
    }

    fn failed(&self, why: &str) -> Failure {
        Failure::failed("no-image", format!("the camera at {}: {why}", self.net.shown()))
    }
}

impl Looks for Stream {
    fn take(&mut self, _: f64) -> Result<Shot, Failure> {
        let bytes = match &self.latest {
            None => self.net.image(),
            Some(latest) => latest.next(self.limits.patience),
        };
        let bytes = bytes.map_err(|why| self.failed(&why))?;
        Ok(Shot::encoded(&self.net.shown(), bytes, self.opened.elapsed().as_secs_f64()))
    }

    fn longest(&self) -> Option<f64> {
        None
    }
}

/// What parts of a stream are told apart by.
fn boundary_of(kind: &str) -> Option<String> {
    let rest = kind.strip_prefix("multipart/")?;
    let value = rest.split(';').filter_map(|part| part.trim().strip_prefix("boundary=")).next()?;
    // some cameras give it with the dashes that go before it
    let boundary = value.trim_matches('"').trim_start_matches('-');
    (!boundary.is_empty()).then(|| boundary.to_owned())
}

fn read_all(mut body: impl BufRead, boundary: &str, latest: &Latest<Vec<u8>>) {
    loop {
        match read_part(&mut body, boundary) {
            Ok(image) => latest.put(image),
            Err(why) => return latest.end(why),
        }
    }
}

/// The next part of a stream (RFC 2046, §5.1), by its length where that is told, up to the next boundary where it is not.
fn read_part(body: &mut impl BufRead, boundary: &str) -> Result<Vec<u8>, String> {
    // any number of dashes goes before it, two at least
    let is_boundary = |line: &[u8]| {
        let dashes = line.iter().take_while(|byte| **byte == b'-').count();
        dashes >= 2 && line[dashes..].starts_with(boundary.as_bytes())
    };
    let mut length = None;
    // a boundary may have been read at the end of the part before: then headers come at once
    for _ in 0..MOST_LINES {
        let line = read_line(body)?;
        if is_boundary(&line) {
            continue;
        }
        let text = String::from_utf8_lossy(&line);
        let text = text.trim_end();
        if text.is_empty() {
            match length {
                Some(_) => break,
                None => continue,
            }
        }
        let (name, value) = text.split_once(':').ok_or("its stream is none: a header without a colon")?;
        if name.eq_ignore_ascii_case("content-length") {
            length = Some(
                value.trim().parse::<u64>().map_err(|_| format!("its stream tells a length of {value}"))?,
            );
        } else if name.eq_ignore_ascii_case("content-type") && length.is_none() {
            length = Some(0);
        }
    }
    match length {
        Some(length) if length > MOST_BYTES => {
            Err(format!("its stream tells an image of {length} bytes, at most {MOST_BYTES} are taken"))
        }
        Some(length) if length > 0 => {
            let mut image = Vec::new();
            body.take(length).read_to_end(&mut image).map_err(|e| e.to_string())?;
            if image.len() as u64 == length { Ok(image) } else { Err("its stream ended".to_owned()) }
        }
        Some(_) => read_to_boundary(body, is_boundary),
        None => Err("its stream has parts without headers".to_owned()),
    }
}

fn read_to_boundary(body: &mut impl BufRead, is_boundary: impl Fn(&[u8]) -> bool) -> Result<Vec<u8>, String> {
    let mut image = Vec::new();
    loop {
        let mut line = Vec::new();
        let left = (MOST_BYTES + 1).saturating_sub(image.len() as u64);
        if left == 0 {
            return Err(format!(
                "its stream sends an image of more than {MOST_BYTES} bytes, the most that are taken, and does not tell its length"
            ));
        }
        let read = body.take(left).read_until(b'\n', &mut line).map_err(|e| e.to_string())?;
        if read == 0 {
            return Err("its stream ended".to_owned());
        }
        if is_boundary(&line) {
            // the line's end before a boundary is the boundary's
            let end =
                image.strip_suffix(b"\r\n").or(image.strip_suffix(b"\n")).map_or(image.len(), <[u8]>::len);
            image.truncate(end);
            return Ok(image);
        }
        image.append(&mut line);
    }
}

fn read_line(body: &mut impl BufRead) -> Result<Vec<u8>, String> {
    let mut line = Vec::new();
    let read = body.take(MOST_LINE).read_until(b'\n', &mut line).map_err(|e| e.to_string())?;
    if read == 0 { Err("its stream ended".to_owned()) } else { Ok(line) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parts(stream: &[u8], boundary: &str) -> (Vec<Vec<u8>>, String) {
        let mut body = stream;
        let mut found = Vec::new();
        loop {
            match read_part(&mut body, boundary) {
                Ok(part) => found.push(part),
                Err(why) => return (found, why),
            }
        }
    }

    #[test]
    fn parts_are_read_by_their_length_or_up_to_the_boundary() {
        let with = b"--b\r\nContent-Type: image/jpeg\r\nContent-Length: 4\r\n\r\na\nbc\r\n--b\r\ncontent-length: 2\r\n\r\nde\r\n--b--\r\n";
        assert_eq!(parts(with, "b").0, [b"a\nbc".to_vec(), b"de".to_vec()]);
        let without = b"--b\r\nContent-Type: image/jpeg\r\n\r\na\nbc\r\n--b\r\nContent-Type: image/jpeg\r\n\r\nde\r\n--b\r\n";
        assert_eq!(parts(without, "b").0, [b"a\nbc".to_vec(), b"de".to_vec()]);
    }

    #[test]
    fn a_stream_that_is_none_ends_with_a_reason() {
        for (stream, what) in [
            (&b""[..], "ended"),
            (b"--b\r\nContent-Length: 99\r\n\r\nabc", "ended"),
            (b"--b\r\nContent-Length: 99999999999\r\n\r\nabc", "at most"),
            (b"--b\r\nContent-Length: many\r\n\r\nabc", "a length of"),
            (b"<html>\r\n<body>\r\n", "colon"),
            (&[b'\n'; 500], "without headers"),
        ] {
            let (found, why) = parts(stream, "b");
            assert!(found.is_empty() && why.contains(what), "{found:?} {why}");
        }
    }

    #[test]
    fn a_boundary_is_read_from_the_kind_of_a_stream() {
        let of = |kind| boundary_of(kind).unwrap_or_default();
        assert_eq!(of("multipart/x-mixed-replace; boundary=frame"), "frame");
        assert_eq!(of("multipart/x-mixed-replace;boundary=\"--cut here\""), "cut here");
        assert_eq!(boundary_of("image/jpeg"), None);
        assert_eq!(boundary_of("multipart/x-mixed-replace"), None);
    }
}
