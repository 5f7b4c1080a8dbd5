//! Columns as a command line names them.

use std::str::FromStr;

use super::quantity::Quantity;

/// Which columns of a log hold what, as a command line says it: `time=Timestamp(ms):ms,volt=PWM*12/255`. What is left out is told from
/// the headers.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Columns(pub(super) Vec<(Quantity, String)>);

impl Columns {
    /// How a quantity is to be had, if that was said.
    pub(super) fn of(&self, quantity: Quantity) -> Option<&str> {
        self.0.iter().find(|(asked, _)| *asked == quantity).map(|(_, text)| text.as_str())
    }

    /// Whether a quantity was spoken of.
    pub(crate) fn has(&self, quantity: Quantity) -> bool {
        self.of(quantity).is_some()
    }

    /// Nothing was said.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

impl FromStr for Columns {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let mut columns = Self::default();
        for part in parts(text) {
            let Some((name, how)) = part.split_once('=') else {
                return Err(format!(
                    "{part:?} names no column; write what it holds, =, and the column, such as time=1:ms,volt=PWM*12/255"
                ));
            };
            let quantity = Quantity::named(name.trim()).ok_or_else(|| {
                format!("a log holds no {:?} here; one of {}", name.trim(), Quantity::names())
            })?;
            if columns.of(quantity).is_some() {
                return Err(format!("{} is given twice", quantity.name()));
            }
            if how.trim().is_empty() {
                return Err(format!("no column is named for {}", quantity.name()));
            }
            columns.0.push((quantity, how.trim().to_owned()));
        }
        if columns.is_empty() { Err("no column is named".into()) } else { Ok(columns) }
    }
}

/// Parts between commas, but for those within quotes.
fn parts(text: &str) -> Vec<&str> {
    let mut quoted = false;
    let ends = |c: char| {
        quoted ^= c == '"';
        c == ',' && !quoted
    };
    text.split(ends).map(str::trim).filter(|part| !part.is_empty()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_read_as_they_are_typed() {
        let columns: Columns =
            r#"time=Timestamp(ms):ms, speed="Speed, rpm":rpm,volt=PWM*12/255"#.parse().unwrap();
        assert_eq!(columns.of(Quantity::Time), Some("Timestamp(ms):ms"));
        assert_eq!(columns.of(Quantity::Speed), Some("\"Speed, rpm\":rpm"));
        assert_eq!(columns.of(Quantity::Volt), Some("PWM*12/255"));
        assert_eq!(columns.of(Quantity::Count), None);
    }

    #[test]
    fn what_names_no_column_is_refused() {
        for (text, wanted) in [
            ("", "no column is named"),
            ("time", "write what it holds"),
            ("tension=1", "one of time, volt"),
            ("time=1,time=2", "given twice"),
            ("volt=", "named for volt"),
        ] {
            let error = text.parse::<Columns>().unwrap_err();
            assert!(error.contains(wanted), "{text}: {error}");
        }
    }
}
