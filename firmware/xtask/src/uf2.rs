//! UF2: flash in blocks, as a boot loader takes them that looks like a disk.
//! <https://github.com/microsoft/uf2>

/// Where flash begins.
const FLASH: u32 = 0x1000_0000;
/// Bytes of flash in a block.
const PAYLOAD: usize = 256;
const BLOCK: usize = 512;
const HAS_FAMILY: u32 = 0x2000;

/// An image as blocks for a family of chips.
pub fn blocks(image: &[u8], family: u32) -> Vec<u8> {
    let number = image.len().div_ceil(PAYLOAD);
    let mut out = Vec::with_capacity(number * BLOCK);
    for (n, payload) in image.chunks(PAYLOAD).enumerate() {
        let address = FLASH + (n * PAYLOAD) as u32;
        let header =
            [0x0a32_4655, 0x9e5d_5157, HAS_FAMILY, address, PAYLOAD as u32, n as u32, number as u32, family];
        header.iter().for_each(|word| out.extend(word.to_le_bytes()));
        out.extend(payload);
        out.resize((n + 1) * BLOCK - 4, 0);
        out.extend(0x0ab1_6f30_u32.to_le_bytes());
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_image_is_told_block_by_block() {
        let image: Vec<u8> = (0..700).map(|n| n as u8).collect();
        let blocks = blocks(&image, 0xe48b_ff59);
        assert_eq!(blocks.len(), 3 * BLOCK);
        for (n, block) in blocks.chunks(BLOCK).enumerate() {
            assert_eq!(&block[..4], b"UF2\n");
            assert_eq!(block[12..16], (FLASH + 256 * n as u32).to_le_bytes());
            assert_eq!(block[20..28], [n as u8, 0, 0, 0, 3, 0, 0, 0]);
            assert_eq!(&block[508..], 0x0ab1_6f30_u32.to_le_bytes());
            let wanted = image.get(PAYLOAD * n..).unwrap().iter().take(PAYLOAD);
            assert!(block[32..].iter().zip(wanted).all(|(is, wanted)| is == wanted));
        }
    }
}
