//! What a DXF says of itself: the size of its unit, and how long its dashes are, in which encoding its texts.

use encoding_rs::Encoding;

use super::codes;
use super::groups::Record;

/// Metres of each `$INSUNITS`, from 1 on.
const UNITS_M: [f64; 24] = [
    0.0254,
    0.3048,
    1609.344,
    1e-3,
    1e-2,
    1.0,
    1e3, // in, ft, mi, mm, cm, m, km
    25.4e-9,
    25.4e-6,
    0.9144,
    1e-10,
    1e-9,
    1e-6, // µin, mil, yd, Å, nm, µm
    0.1,
    10.0,
    100.0,
    1e9, // dm, dam, hm, Gm
    1.495_978_707e11,
    9.460_730_472_580_8e15,
    3.085_677_581_491_367e16, // astronomical unit, light year, parsec
    1200.0 / 3937.0,
    100.0 / 3937.0,
    3600.0 / 3937.0,
    6_336_000.0 / 3937.0, // US survey ft, in, yd, mi
];

/// Variables of the section HEADER.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Header {
    units: Option<i64>,
    /// Factor of all linetypes.
    pub(super) linetype_scale: f64,
    /// Of texts that are no UTF-8.
    pub(super) encoding: Option<&'static Encoding>,
}

impl Default for Header {
    fn default() -> Self {
        Self { units: None, linetype_scale: 1.0, encoding: None }
    }
}

impl Header {
    /// Takes what is needed from the section's one record: `9 $NAME` and the variable's value. A value that is no
    /// number says nothing.
    pub(super) fn of(record: &Record) -> Self {
        let mut header = Self::default();
        let mut name: &[u8] = b"";
        for group in &record.groups {
            match (group.code, name) {
                (9, _) => name = group.bytes(),
                (70, b"$INSUNITS") => header.units = group.whole().ok(),
                (3, b"$DWGCODEPAGE") => header.encoding = codes::encoding(group.bytes()),
                (40, b"$LTSCALE") => {
                    header.linetype_scale = group.number().ok().filter(|&s| s > 0.0).unwrap_or(1.0);
                }
                _ => {}
            }
        }
        header
    }

    /// Size of the drawing's unit by `$INSUNITS`, m; `None` where that is missing or says "none". `$MEASUREMENT` is
    /// about hatches and linetypes, and says nothing of the unit.
    pub(super) fn metres_per_unit(self) -> Option<f64> {
        let number = self.units.and_then(|u| usize::try_from(u).ok()).unwrap_or(0);
        number.checked_sub(1).and_then(|i| UNITS_M.get(i).copied())
    }
}
