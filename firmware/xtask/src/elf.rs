//! What of an ELF file of a 32-bit processor goes into flash.

/// Where flash begins.
const FLASH: u32 = 0x1000_0000;
/// Where memory begins.
const MEMORY: u32 = 0x2000_0000;
const LOADED: u32 = 1;
const SYMBOLS: u32 = 2;

/// What is needed of it.
pub struct Elf {
    /// Flash from its beginning on.
    pub image: Vec<u8>,
    /// Bytes of memory that are taken when it starts.
    pub memory: usize,
    /// All symbols: name, and where it is.
    pub symbols: Vec<(String, u32)>,
}

/// Reads one.
///
/// # Errors
/// It is none, or cut short.
pub fn read(file: &[u8]) -> Result<Elf, String> {
    if !file.starts_with(b"\x7fELF\x01\x01") {
        return Err("this is no ELF file of a 32-bit processor".to_owned());
    }
    let mut parts = Vec::new();
    let mut memory = 0;
    for at in table(file, 28, 42, 44)? {
        let [kind, offset, address, load, length, in_memory] =
            [0, 4, 8, 12, 16, 20].map(|field| word(file, at + field));
        let (length, in_memory) = (length? as usize, in_memory? as usize);
        if kind? != LOADED || in_memory == 0 {
            continue;
        }
        if address? >= MEMORY {
            memory += in_memory;
        }
        if length > 0 {
            parts.push((load?, slice(file, offset? as usize, length)?));
        }
    }
    let mut image = Vec::new();
    for (load, part) in parts {
        let from = load.checked_sub(FLASH).ok_or("it lies where no flash is")? as usize;
        let to = from + part.len();
        if image.len() < to {
            image.resize(to, 0xff);
        }
        image[from..to].copy_from_slice(part);
    }
    Ok(Elf { image, memory, symbols: symbols(file)? })
}

/// Its symbols.
fn symbols(file: &[u8]) -> Result<Vec<(String, u32)>, String> {
    let sections: Vec<usize> = table(file, 32, 46, 48)?.collect();
    let mut found = Vec::new();
    for &at in &sections {
        if word(file, at + 4)? != SYMBOLS {
            continue;
        }
        let text = sections.get(word(file, at + 24)? as usize).ok_or("its symbols have no names")?;
        let text = slice(file, word(file, text + 16)? as usize, word(file, text + 20)? as usize)?;
        let symbols = slice(file, word(file, at + 16)? as usize, word(file, at + 20)? as usize)?;
        for symbol in symbols.chunks_exact(16) {
            let name = text.get(word(symbol, 0)? as usize..).unwrap_or_default();
            let name = name.split(|&byte| byte == 0).next().unwrap_or_default();
            found.push((String::from_utf8_lossy(name).into_owned(), word(symbol, 4)?));
        }
    }
    Ok(found)
}

/// Offsets of a table's entries, by where the header has its offset, the length of an entry and their number.
fn table(
    file: &[u8],
    offset: usize,
    length: usize,
    number: usize,
) -> Result<impl Iterator<Item = usize> + use<>, String> {
    let half = |at| Ok::<_, String>(u16::from_le_bytes([slice(file, at, 2)?[0], slice(file, at, 2)?[1]]));
    let (from, length) = (word(file, offset)? as usize, half(length)? as usize);
    Ok((0..half(number)? as usize).map(move |n| from + n * length))
}

fn word(file: &[u8], at: usize) -> Result<u32, String> {
    let bytes = slice(file, at, 4)?;
    Ok(u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]))
}

fn slice(file: &[u8], from: usize, length: usize) -> Result<&[u8], String> {
    from.checked_add(length).and_then(|to| file.get(from..to)).ok_or_else(|| "it is cut short".to_owned())
}
