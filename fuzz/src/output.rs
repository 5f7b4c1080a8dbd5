/// Stands for the program's raster, which draws and shrinks too.
pub(crate) struct Raster {
    width: u32,
    height: u32,
}

impl Raster {
    /// `None` where the number of bytes does not fit the size or there is no pixel.
    pub(crate) fn new(width: u32, height: u32, rgb: Vec<u8>) -> Option<Self> {
        let wanted = u64::from(width) * u64::from(height) * 3;
        (wanted > 0 && wanted == rgb.len() as u64).then_some(Self { width, height })
    }

    /// Columns and rows.
    pub(crate) const fn size(&self) -> (usize, usize) {
        (self.width as usize, self.height as usize)
    }
}
