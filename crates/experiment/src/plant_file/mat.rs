//! MATLAB's .mat files: version 5 to 7, as far as numbers, texts, structures and cells go, and version 4.

use miniz_oxide::inflate::decompress_to_vec_zlib_with_limit;
use tracelight_linear::{Complex, Matrix};

use crate::plant_file::mat_four;
use crate::plant_file::mat_four::text;
use crate::plant_file::node::{Node, Table, Value, Wrong};

/// Bytes of a file, and of its variables once they are unpacked: 10⁶ frequencies with complex values are 24 MB.
const MOST_UNPACKED: usize = 32 << 20;
/// Structures within structures.
const MOST_DEPTH: usize = 8;
/// Variables of a file, and fields and cells of one of them.
const MOST_PARTS: usize = 1024;
/// Bytes of the header.
const HEADER: usize = 128;

const MATRIX: u32 = 14;
const COMPRESSED: u32 = 15;

/// Reads the variables of a file by name.
pub(super) fn read(bytes: &[u8]) -> Result<Node, Wrong> {
    let is_later = bytes.starts_with(b"MATLAB 7.3") || bytes.starts_with(b"\x89HDF");
    if is_later {
        return Err(wrong(
            "it is a .mat file of version 7.3 (HDF5), which is not read: save it with save(…, '-v7')",
        ));
    }
    if bytes.len() > MOST_UNPACKED {
        return Err(wrong(format!(
            "{} bytes; a .mat file of a system has at most {MOST_UNPACKED}",
            bytes.len()
        )));
    }
    if bytes.len() < HEADER || !(bytes[..4].iter().all(|b| *b != 0)) {
        return mat_four::read(bytes);
    }
    let swapped = match &bytes[126..HEADER] {
        b"IM" => false,
        b"MI" => true,
        _ => return Err(wrong("it is no .mat file: bytes 126 and 127 are neither IM nor MI")),
    };
    let mut parts = Parts { bytes: &bytes[HEADER..], swapped };
    let mut variables = Table::new();
    let mut left = MOST_UNPACKED;
    while let Some(part) = parts.next()? {
        if variables.len() >= MOST_PARTS {
            return Err(wrong(format!("it holds more than {MOST_PARTS} variables")));
        }
        let variable = match part.kind {
            MATRIX => Some(array(part.body, swapped, 0)?),
            COMPRESSED => {
                let unpacked = decompress_to_vec_zlib_with_limit(part.body, left).map_err(|e| {
                    wrong(format!("a compressed variable is damaged or larger than {left} bytes ({e})"))
                })?;
                left -= unpacked.len();
                let inner = Parts { bytes: &unpacked, swapped }.next()?;
                inner
                    .filter(|part| part.kind == MATRIX)
                    .map(|part| array(part.body, swapped, 0))
                    .transpose()?
            }
            _ => None,
        };
        variables.extend(variable.filter(|(name, _)| !name.is_empty()));
    }
    Ok(Node::bare(Value::Table(variables)))
}

fn wrong(what: impl Into<String>) -> Wrong {
    Wrong::new(None, what)
}

/// A data element: what it is of, and its bytes.
struct Part<'a> {
    kind: u32,
    body: &'a [u8],
}

/// Elements one after the other.
struct Parts<'a> {
    bytes: &'a [u8],
    swapped: bool,
}

impl<'a> Parts<'a> {
    fn next(&mut self) -> Result<Option<Part<'a>>, Wrong> {
        if self.bytes.len() < 8 {
            return Ok(None);
        }
        let first = whole(&self.bytes[..4], self.swapped);
        // small ones have their size and their bytes in the tag
        let (kind, start, size) = match first >> 16 {
            0 => (first, 8, whole(&self.bytes[4..8], self.swapped) as usize),
            size => (first & 0xffff, 4, size as usize),
        };
        let body = self.bytes.get(start..).and_then(|rest| rest.get(..size));
        let body = body.filter(|_| start == 8 || size <= 4).ok_or_else(|| {
            wrong(format!(
                "it is cut off: an element of {size} bytes has {} left",
                self.bytes.len() - start.min(8)
            ))
        })?;
        // compressed ones are not padded
        let end = if kind == COMPRESSED { start + size } else { (start + size).next_multiple_of(8) };
        self.bytes = self.bytes.get(end..).unwrap_or_default();
        Ok(Some(Part { kind, body }))
    }

    fn must(&mut self, what: &str) -> Result<Part<'a>, Wrong> {
        self.next()?.ok_or_else(|| wrong(format!("an array without {what}")))
    }
}

fn whole(bytes: &[u8], swapped: bool) -> u32 {
    let mut own = [0; 4];
    own.copy_from_slice(&bytes[..4]);
    if swapped { u32::from_be_bytes(own) } else { u32::from_le_bytes(own) }
}

/// An array with its name.
fn array(body: &[u8], swapped: bool, depth: usize) -> Result<(String, Node), Wrong> {
    if depth > MOST_DEPTH {
        return Err(wrong(format!("structures are nested more than {MOST_DEPTH} deep")));
    }
    let mut parts = Parts { bytes: body, swapped };
    if body.is_empty() {
        return Ok((String::new(), Node::bare(Value::Nothing)));
    }
    let flags = parts.must("flags")?.body;
    if flags.len() < 4 {
        return Err(wrong("an array without flags"));
    }
    let flags = whole(flags, swapped);
    if flags & 0xff == 17 {
        // an opaque object has no dimensions: its name comes next
        let name = text(parts.must("name")?.body);
        return Ok((name, Node::bare(Value::Unreadable(OPAQUE.into()))));
    }
    let sizes: Vec<usize> =
        parts.must("dimensions")?.body.chunks_exact(4).map(|size| whole(size, swapped) as usize).collect();
    let name = text(parts.must("name")?.body);
    let of = Array { swapped, depth, sizes, is_complex: flags & 0x800 != 0 };
    let value = match flags & 0xff {
        1 => of.cells(&mut parts)?,
        2 => of.structure(&mut parts)?,
        3 => Value::Unreadable(OPAQUE.into()),
        4 => Value::Text(characters(&parts.must("characters")?, swapped)),
        5 => Value::Unreadable("a sparse matrix: save full(…) of it".into()),
        6..=15 => of.numbers(&mut parts)?,
        other => Value::Unreadable(format!("an array of class {other}")),
    };
    Ok((name, Node::bare(value)))
}

const OPAQUE: &str = "a MATLAB object (ss, tf, zpk …), which only MATLAB can read: there do \
                      [A,B,C,D] = ssdata(sys); Ts = sys.Ts; save('p.mat','A','B','C','D','Ts')";

struct Array {
    swapped: bool,
    depth: usize,
    sizes: Vec<usize>,
    is_complex: bool,
}

impl Array {
    fn count(&self) -> Option<usize> {
        self.sizes.iter().try_fold(1_usize, |product, size| product.checked_mul(*size))
    }

    fn numbers(&self, parts: &mut Parts<'_>) -> Result<Value, Wrong> {
        // a frequency response of one channel may be 1 × 1 × n
        let sizes: Vec<usize> = match self.sizes.as_slice() {
            [rows, columns] => vec![*rows, *columns],
            [1, 1, pages] => vec![1, *pages],
            sizes => return Ok(Value::Unreadable(format!("an array of {} dimensions", sizes.len()))),
        };
        let count = self.count().unwrap_or(usize::MAX);
        let take = |part: Part<'_>| {
            let numbers = numbers(&part, self.swapped)?;
            if numbers.len() == count {
                return Ok(numbers);
            }
            Err(wrong(format!("an array of {} × {} holds {} numbers", sizes[0], sizes[1], numbers.len())))
        };
        let real = take(parts.must("numbers")?)?;
        if !self.is_complex {
            return Ok(Value::Grid(Matrix::from_vec(sizes[0], sizes[1], real)));
        }
        let imaginary = take(parts.must("imaginary numbers")?)?;
        let both = real.into_iter().zip(imaginary).map(|(re, im)| Complex::new(re, im)).collect();
        Ok(Value::ComplexGrid(sizes[0], sizes[1], both))
    }

    fn cells(&self, parts: &mut Parts<'_>) -> Result<Value, Wrong> {
        let count = self.count().filter(|count| *count <= MOST_PARTS);
        let count = count.ok_or_else(|| wrong(format!("a cell array has more than {MOST_PARTS} cells")))?;
        (0..count).map(|_| Ok(self.part(parts)?.1)).collect::<Result<_, _>>().map(Value::List)
    }

    fn structure(&self, parts: &mut Parts<'_>) -> Result<Value, Wrong> {
        if self.count() != Some(1) {
            return Ok(Value::Unreadable("an array of structures".into()));
        }
        let length = parts.must("length of its names")?.body;
        let length = if length.len() >= 4 { whole(length, self.swapped) as usize } else { 0 };
        let names = parts.must("names")?.body;
        if length == 0 || length > 256 || names.len() / length > MOST_PARTS {
            return Err(wrong("a structure whose names make no sense"));
        }
        let fields = names.chunks_exact(length).map(|name| Ok((text(name), self.part(parts)?.1)));
        fields.collect::<Result<_, Wrong>>().map(Value::Table)
    }

    fn part(&self, parts: &mut Parts<'_>) -> Result<(String, Node), Wrong> {
        let part = parts.must("all of its parts")?;
        if part.kind != MATRIX {
            return Err(wrong(format!("a part of kind {} where an array is expected", part.kind)));
        }
        array(part.body, self.swapped, self.depth + 1)
    }
}

fn characters(part: &Part<'_>, swapped: bool) -> String {
    match part.kind {
        // units of 16 bits
        4 | 17 => {
            let units = part.body.chunks_exact(2);
            let order = |u: &[u8]| {
                if swapped { u16::from_be_bytes([u[0], u[1]]) } else { u16::from_le_bytes([u[0], u[1]]) }
            };
            String::from_utf16_lossy(&units.map(order).collect::<Vec<_>>())
        }
        _ => String::from_utf8_lossy(part.body).into_owned(),
    }
}

/// Numbers as the element stores them: of a matrix in double precision they may be bytes.
fn numbers(part: &Part<'_>, swapped: bool) -> Result<Vec<f64>, Wrong> {
    macro_rules! each {
        ($of:ty, $size:literal) => {
            part.body
                .chunks_exact($size)
                .map(|bytes| {
                    let mut own = [0; $size];
                    own.copy_from_slice(bytes);
                    (if swapped { <$of>::from_be_bytes(own) } else { <$of>::from_le_bytes(own) }) as f64
                })
                .collect()
        };
    }
    Ok(match part.kind {
        1 => each!(i8, 1),
        2 => each!(u8, 1),
        3 => each!(i16, 2),
        4 => each!(u16, 2),
        5 => each!(i32, 4),
        6 => each!(u32, 4),
        7 => each!(f32, 4),
        9 => each!(f64, 8),
        12 => each!(i64, 8),
        13 => each!(u64, 8),
        kind => return Err(wrong(format!("numbers of kind {kind}, which is none of the format's"))),
    })
}
