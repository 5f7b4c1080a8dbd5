//! Films: files in which one JPEG image follows the other (Motion JPEG), whatever is between them. So webcams' own images are kept, in AVI, Matroska, QuickTime
//! or one after the other by themselves; what a container knows besides is not asked.

use std::fs::File;
use std::io::Read;
use std::ops::Range;
use std::path::Path;

use tracelight_files as files;
use tracelight_task::Failure;

use tracelight_eye::coding::as_file;
use tracelight_eye::{Looks, MOST_IMAGE_BYTES, Shot};

/// What is read at once, bytes.
const CHUNK: usize = 1 << 20;
/// Most beginnings of images without an end behind which another is looked for.
const MOST_ENDLESS: usize = 64;
/// Images a second, as far as anybody knows.
const A_SECOND: f64 = 30.0;
/// What names of films end in.
const ENDINGS: [&str; 11] = ["mjpeg", "mjpg", "avi", "mkv", "mov", "qt", "mp4", "m4v", "webm", "mpg", "mpeg"];

/// Images of a film, one after the other.
#[derive(Debug)]
pub(crate) struct Film<R> {
    path: String,
    reader: Images<R>,
    next: Option<Vec<u8>>,
    taken: u32,
}

/// Whether a file's name says that it is a film.
pub(crate) fn is_film(path: &str) -> bool {
    let ending = Path::new(path).extension().and_then(|ending| ending.to_str());
    ending.is_some_and(|ending| ENDINGS.iter().any(|known| ending.eq_ignore_ascii_case(known)))
}

impl Film<File> {
    pub(crate) fn open(path: &str) -> Result<Self, Failure> {
        let unread = |e| {
            Failure::usage(
                "unreadable",
                format!("cannot read {path}: {e}; check its name and who may read it"),
            )
        };
        let film = File::open(path).map_err(unread)?;
        files::protect(Path::new(path));
        Self::of(path, film)
    }
}

impl<R: Read> Film<R> {
    fn of(path: &str, from: R) -> Result<Self, Failure> {
        let mut reader = Images::new(from);
        let next = reader.next().map_err(|e| unread(path, &e))?;
        if next.is_none() {
            let message = format!(
                "{path} has no image of Motion JPEG; make a film of them of it (ffmpeg -i {path} -c:v mjpeg -q:v 2 film.avi)"
            );
            return Err(Failure::usage("not-a-picture", message));
        }
        Ok(Self { path: path.to_owned(), reader, next, taken: 0 })
    }
}

fn unread(path: &str, error: &std::io::Error) -> Failure {
    Failure::failed("no-image", format!("cannot read on in {path}: {error}"))
}

impl<R: Read> Looks for Film<R> {
    fn take(&mut self, _: f64) -> Result<Shot, Failure> {
        let first = self.next.take();
        let next = first.map_or_else(|| self.reader.next(), |first| Ok(Some(first)));
        let Some(bytes) = next.map_err(|e| unread(&self.path, &e))? else {
            return Err(Failure::failed(
                "no-image",
                format!(
                    "the film {0} has no image of Motion JPEG after its {1}; where it shows more, make one of them (ffmpeg -i {0} -c:v mjpeg -q:v 2 film.avi)",
                    self.path, self.taken
                ),
            ));
        };
        self.taken += 1;
        let from = format!("{}, image {}", self.path, self.taken);
        Ok(Shot::encoded(&from, as_file(&bytes).into_owned(), f64::from(self.taken) / A_SECOND))
    }

    fn longest(&self) -> Option<f64> {
        None
    }
}

/// JPEG images in a row of bytes.
#[derive(Debug)]
struct Images<R> {
    from: R,
    /// Read and not yet looked at, or not to its end.
    bytes: Vec<u8>,
    ended: bool,
    /// Beginnings of images without an end, after all was read.
    endless: usize,
}

impl<R: Read> Images<R> {
    const fn new(from: R) -> Self {
        Self { from, bytes: Vec::new(), ended: false, endless: 0 }
    }

    /// The next image; nothing after the last.
    fn next(&mut self) -> std::io::Result<Option<Vec<u8>>> {
        loop {
            match jpeg_in(&self.bytes) {
                Found::Image(Range { start, end }) => {
                    self.bytes.drain(..start);
                    return Ok(Some(self.bytes.drain(..end - start).collect()));
                }
                Found::Nothing { until } => {
                    self.bytes.drain(..until);
                }
                // what is larger is no image, nor is what never ends
                Found::Begun { at } if self.bytes.len() - at > MOST_IMAGE_BYTES => {
                    self.bytes.drain(..at + MOST_IMAGE_BYTES);
                    continue;
                }
                Found::Begun { at } if self.ended && self.endless < MOST_ENDLESS => {
                    self.bytes.drain(..at + 2);
                    self.endless += 1;
                    continue;
                }
                Found::Begun { at } => {
                    self.bytes.drain(..at);
                }
            }
            if self.ended {
                return Ok(None);
            }
            self.read()?;
        }
    }

    /// Reads as much as there is already, so that what is looked at anew each time is not much more than what is read.
    fn read(&mut self) -> std::io::Result<()> {
        let wanted = CHUNK.max(self.bytes.len()) as u64;
        let read = self.from.by_ref().take(wanted).read_to_end(&mut self.bytes)?;
        self.ended = read == 0;
        Ok(())
    }
}

/// What is in a row of bytes.
#[derive(Debug, PartialEq, Eq)]
enum Found {
    /// A whole image, there.
    Image(Range<usize>),
    /// The beginning of one, from there on.
    Begun { at: usize },
    /// No image begins before that place.
    Nothing { until: usize },
}

/// The first image in a row of bytes (ITU-T T.81, annex B: segments whose length they tell, and scans, in which no byte 0xFF stands by itself).
fn jpeg_in(bytes: &[u8]) -> Found {
    let mut from = 0;
    while let Some(at) = start_in(bytes, from) {
        match end_of(bytes, at) {
            Ok(end) => return Found::Image(at..end),
            Err(None) => return Found::Begun { at },
            // not one, or a spoilt one: nothing up to there
            Err(Some(wrong)) => from = wrong.max(at + 2),
        }
    }
    // a beginning may be cut in two
    Found::Nothing { until: bytes.len().saturating_sub(2).max(from.min(bytes.len())) }
}

/// Where the next start of an image is that a marker follows.
fn start_in(bytes: &[u8], from: usize) -> Option<usize> {
    let start = bytes.get(from..)?.windows(3).position(|three| three == [0xff, 0xd8, 0xff])?;
    Some(from + start)
}

/// Where an image ends that begins there; `Err(None)` if that is not there yet, `Err(Some(place))` where it is none, or breaks off.
fn end_of(bytes: &[u8], start: usize) -> Result<usize, Option<usize>> {
    let mut at = start + 2;
    let mut has_scan = false;
    loop {
        let &[first, mark] = bytes.get(at..at + 2).ok_or(None)? else { return Err(None) };
        match (first, mark) {
            // any number of 0xFF may stand before a marker
            (0xff, 0xff) => at += 1,
            (0xff, 0xd9) if has_scan => return Ok(at + 2),
            (0xff, 0xc0..=0xcf | 0xda..=0xdf | 0xe0..=0xef | 0xf0..=0xfe) => {
                let &[high, low] = bytes.get(at + 2..at + 4).ok_or(None)? else { return Err(None) };
                let length = usize::from(u16::from_be_bytes([high, low]));
                if length < 2 {
                    return Err(Some(at));
                }
                at += 2 + length;
                if mark == 0xda {
                    has_scan = true;
                    at = end_of_scan(bytes, at).ok_or(None)?;
                }
            }
            _ => return Err(Some(at)),
        }
    }
}

/// Where the data of a scan ends that begins there: with a marker that is none of those it may hold.
fn end_of_scan(bytes: &[u8], from: usize) -> Option<usize> {
    let is_marker = |two: &[u8]| two[0] == 0xff && !matches!(two[1], 0 | 0xd0..=0xd7 | 0xff);
    let marker = bytes.get(from..)?.windows(2).position(is_marker)?;
    Some(from + marker)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::VecDeque;
    use tracelight_picture::Raster;

    fn jpeg(width: u32, seed: u8) -> Vec<u8> {
        let levels = (0..3 * width * 8).map(|k| (k as u8).wrapping_mul(37).wrapping_add(seed)).collect();
        Raster::new(width, 8, levels).unwrap().jpeg(90).unwrap()
    }

    /// Something that gives a few bytes at a time.
    struct Slow(VecDeque<u8>, usize);

    impl Read for Slow {
        fn read(&mut self, to: &mut [u8]) -> std::io::Result<usize> {
            let count = self.1.min(to.len()).min(self.0.len());
            to.iter_mut().zip(self.0.drain(..count)).for_each(|(to, byte)| *to = byte);
            Ok(count)
        }
    }

    fn all(bytes: &[u8], at_once: usize) -> Vec<Vec<u8>> {
        let mut images = Images::new(Slow(bytes.iter().copied().collect(), at_once));
        std::iter::from_fn(|| images.next().unwrap()).collect()
    }

    #[test]
    fn images_are_found_whatever_is_between_them() {
        let images: Vec<Vec<u8>> = (0..5).map(|k| jpeg(16 + 8 * u32::from(k), k)).collect();
        let plain = images.concat();
        assert_eq!(all(&plain, usize::MAX), images);
        // as in a container: names, lengths, something that looks like a beginning
        let between = b"RIFF\x01\x02AVI LIST00dc\xff\xd8\xff\x00\x12\xff\xd8\xff";
        let held: Vec<u8> = images.iter().flat_map(|image| [&between[..], image].concat()).collect();
        for at_once in [1, 7, 4096] {
            assert_eq!(all(&held, at_once), images, "{at_once}");
        }
    }

    #[test]
    fn a_thumbnail_is_a_part_of_its_image_and_a_spoilt_image_is_passed_over() {
        let (own, small) = (jpeg(32, 1), jpeg(8, 2));
        let length = (small.len() as u16 + 2).to_be_bytes();
        let with = [&own[..2], &[0xff, 0xe1], &length, &small, &own[2..]].concat();
        assert_eq!(all(&[&with[..], &own].concat(), 4096), [with.clone(), own.clone()]);
        // broken off in its scan, another follows
        let broken = &own[..own.len() - 40];
        assert_eq!(all(&[broken, &small].concat(), 4096), std::slice::from_ref(&small));
        assert_eq!(all(broken, 4096), Vec::<Vec<u8>>::new());
        // a segment that would reach beyond the end, and an image after it
        let beyond = [&[0xff, 0xd8, 0xff, 0xe0, 0xff, 0xff][..], &small].concat();
        assert_eq!(all(&beyond, 4096), std::slice::from_ref(&small));
        assert_eq!(all(&[&[0xff, 0xd8, 0xff, 0xe0, 0, 1][..], &small].concat(), 4096), [small]);
    }

    #[test]
    fn what_has_no_images_ends_soon_however_much_it_looks_like_it() {
        for pattern in
            [&b"\xff\xd8\xff"[..], b"\xff\xd8\xff\xda\x00\x02", b"\xff", b"\x00\xff\xd8\xff\xe0\xff\xff"]
        {
            let bytes: Vec<u8> = pattern.iter().copied().cycle().take(3_000_000).collect();
            assert!(all(&bytes, usize::MAX).is_empty());
        }
        let none = Film::of("a.mp4", &b"no film"[..]).map(|_| ()).unwrap_err();
        assert!(none.message.contains("ffmpeg -i a.mp4"), "{}", none.message);
        assert!(is_film("a/b.MJPEG") && !is_film("a/mjpeg") && !is_film("a.jpg"));
    }
}
