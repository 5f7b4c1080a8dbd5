//! How a quantity is made of a column: `NAME`, `"NAME"`, a column's number or `row`, then `*k`, `/k`, `+k`, `-k`, and `:unit`.

use super::quantity::Quantity;

/// Where numbers come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Source {
    /// A column, counted from 0.
    Column(usize),
    /// The number of the row, from 0: of logs with a row each so much time.
    Row,
}

/// A column, and what is made of its numbers.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Expression {
    pub(super) source: Source,
    /// What is added to the column, once multiplied.
    plus: f64,
    times: f64,
    /// Name of the unit that it then has, and what one of it is in SI; `None` if nobody said.
    pub(super) unit: Option<(&'static str, f64)>,
    /// A size without a sign, which is that of the motion.
    pub(super) unsigned: bool,
    /// As it is said to people, without the unit.
    pub(super) said: String,
}

impl Expression {
    /// A column as it is.
    pub(super) fn column(place: usize, names: &[String], unit: Option<(&'static str, f64)>) -> Self {
        let (source, said) = (Source::Column(place), title(names, place));
        Self { source, plus: 0.0, times: 1.0, unit, unsigned: false, said }
    }

    /// What was typed for a quantity, of a table with these names above its columns (none if it has no header) and so many columns.
    ///
    /// # Errors
    /// A column that is not there or could be two, and what is no factor, sum or unit.
    pub(super) fn parse(
        text: &str,
        quantity: Quantity,
        names: &[String],
        columns: usize,
    ) -> Result<Self, String> {
        let (sign, body) = text.strip_prefix('-').map_or((1.0, text), |rest| (-1.0, rest.trim_start()));
        let (source, rest, unsigned) = sized(body, quantity, names, columns)?;
        let place = if let Source::Column(place) = source { Some(place) } else { None };
        let mut made = Self {
            source,
            plus: 0.0,
            times: sign,
            unit: None,
            unsigned,
            said: place.map_or("the row's number".into(), |place| title(names, place)),
        };
        if unsigned {
            made.said = format!("|{}|, signed as the motion,", made.said);
        }
        if sign < 0.0 {
            made.said.insert(0, '−');
        }
        let mut rest = rest.trim_start();
        let mut added = false;
        while let Some(sign) = rest.chars().next().filter(|c| "*/+-".contains(*c)) {
            let (number, after) = leading_number(rest[1..].trim_start())
                .ok_or_else(|| format!("{text}: no number follows {sign}"))?;
            made.step(sign, number, &mut added).map_err(|what| format!("{text}: {what}"))?;
            rest = after.trim_start();
        }
        if let Some(unit) = rest.strip_prefix(':') {
            made.unit = Some(quantity.unit(unit).ok_or_else(|| no_unit(text, quantity, unit))?);
            rest = "";
        }
        if rest.is_empty() {
            Ok(made)
        } else {
            Err(format!("{text}: what is {rest:?}? After a column come *k, /k, +k or -k, and :unit"))
        }
    }

    fn step(&mut self, sign: char, number: f64, added: &mut bool) -> Result<(), String> {
        match sign {
            '*' | '/' if *added => {
                return Err("write factors before sums, so that it is clear what they multiply".into());
            }
            '/' if number == 0.0 => return Err("nothing can be divided by 0".into()),
            '*' => self.times *= number,
            '/' => self.times /= number,
            _ => {
                *added = true;
                self.plus += if sign == '+' { number } else { -number };
            }
        }
        let shown = match sign {
            '*' => "×",
            '-' => "−",
            '/' => "/",
            _ => "+",
        };
        self.said += &format!(" {shown} {number}");
        Ok(())
    }

    /// Of a number of the column, without its unit.
    pub(super) fn of(&self, number: f64) -> f64 {
        self.times * number + self.plus
    }
}

fn no_unit(text: &str, quantity: Quantity, unit: &str) -> String {
    let (name, fits) = (quantity.name(), quantity.unit_names());
    if fits.is_empty() {
        format!("{text}: {name} is a number and has no unit")
    } else {
        format!("{text}: the unit {unit} does not fit {name}; use one of {fits}")
    }
}

/// What a column is called to people.
pub(super) fn title(names: &[String], place: usize) -> String {
    names.get(place).map_or_else(|| format!("column {}", place + 1), |name| format!("\"{name}\""))
}

/// All columns, for people.
pub(super) fn titles(names: &[String], columns: usize) -> String {
    (0..columns).map(|place| title(names, place)).collect::<Vec<_>>().join(", ")
}

/// The column that a text begins with, what follows it, and whether it stands between bars: then it is the size of a drive, whose sign
/// nobody wrote down.
fn sized<'a>(
    text: &'a str,
    quantity: Quantity,
    names: &[String],
    columns: usize,
) -> Result<(Source, &'a str, bool), String> {
    let Some((inside, rest)) = text.strip_prefix('|').and_then(|text| text.split_once('|')) else {
        return source(text, names, columns).map(|(source, rest)| (source, rest, false));
    };
    if quantity != Quantity::Volt {
        return Err(format!("{text}: only a drive, volt, may have no sign; {} has one", quantity.name()));
    }
    match source(inside, names, columns)? {
        (source, "") => Ok((source, rest, true)),
        (_, more) => Err(format!("{text}: what is {more:?} between the bars? A column alone")),
    }
}

/// The column that a text begins with, and what follows it.
fn source<'a>(text: &'a str, names: &[String], columns: usize) -> Result<(Source, &'a str), String> {
    if let Some(quoted) = text.strip_prefix('"') {
        let (name, rest) = quoted.split_once('"').ok_or_else(|| format!("{text}: a quote is open"))?;
        return named(name, names)?
            .map(|place| (Source::Column(place), rest))
            .ok_or_else(|| missing(name, names, columns));
    }
    let found = longest(text, names)?;
    let numbered = leading_digits(text);
    match (found, numbered) {
        (Some((place, rest)), Some((number, after))) if place + 1 != number && rest == after => Err(format!(
            "{text} could be column {number} or the column that is called so, which is column {}: write the number of \
             the one you mean, or \"{number}\" in quotes for the name",
            place + 1
        )),
        (Some((place, rest)), _) => Ok((Source::Column(place), rest)),
        (None, Some((number, after))) if (1..=columns).contains(&number) => {
            Ok((Source::Column(number - 1), after))
        }
        (None, Some((number, _))) => Err(format!("there is no column {number}; there are {columns}")),
        (None, None) => match text.strip_prefix("row").filter(|rest| ends(rest)) {
            Some(rest) => Ok((Source::Row, rest)),
            None => Err(missing(text, names, columns)),
        },
    }
}

fn missing(text: &str, names: &[String], columns: usize) -> String {
    if names.is_empty() {
        return format!("no column {text:?}: the log has no header; give columns by number, 1 to {columns}");
    }
    format!("no column {text:?}; there are {}", titles(names, columns))
}

/// Whether a name may end here.
fn ends(rest: &str) -> bool {
    rest.trim_start().chars().next().is_none_or(|c| "*/+-:".contains(c))
}

/// The longest name that a text begins with, as it is or in other capitals; of several columns with it none is taken.
fn longest<'a>(text: &'a str, names: &[String]) -> Result<Option<(usize, &'a str)>, String> {
    let begins = |name: &&String| {
        text.get(..name.len()).is_some_and(|head| head.eq_ignore_ascii_case(name))
            && ends(&text[name.len()..])
    };
    let Some(best) =
        names.iter().filter(|name| !name.is_empty()).filter(begins).max_by_key(|name| name.len())
    else {
        return Ok(None);
    };
    let typed = &text[..best.len()];
    Ok(named(typed, names)?.map(|place| (place, &text[best.len()..])))
}

/// The column of a name: as it is typed, or else in other capitals.
fn named(name: &str, names: &[String]) -> Result<Option<usize>, String> {
    let places = |same: &dyn Fn(&str) -> bool| -> Vec<usize> {
        names.iter().enumerate().filter(|(_, other)| same(other)).map(|(place, _)| place).collect()
    };
    let exact = places(&|other| other == name);
    let found = if exact.is_empty() { places(&|other| other.eq_ignore_ascii_case(name)) } else { exact };
    match found.as_slice() {
        [] => Ok(None),
        &[place] => Ok(Some(place)),
        several => {
            let numbers =
                several.iter().map(|place| (place + 1).to_string()).collect::<Vec<_>>().join(" and ");
            Err(format!("columns {numbers} are both called {name:?}: give the number of the one you mean"))
        }
    }
}

/// A whole number that a name ends after.
fn leading_digits(text: &str) -> Option<(usize, &str)> {
    let end = text.find(|c: char| !c.is_ascii_digit()).unwrap_or(text.len());
    let number = text[..end].parse().ok()?;
    ends(&text[end..]).then_some((number, &text[end..]))
}

/// A number, and what follows it.
fn leading_number(text: &str) -> Option<(f64, &str)> {
    let bytes = text.as_bytes();
    let mut end = 0;
    while end < bytes.len() {
        let exponent = end > 0 && matches!(bytes[end - 1], b'e' | b'E');
        match bytes[end] {
            b'0'..=b'9' | b'.' => {}
            b'e' | b'E' if end > 0 => {}
            b'+' | b'-' if exponent => {}
            _ => break,
        }
        end += 1;
    }
    let number: f64 = text[..end].parse().ok().filter(|number: &f64| number.is_finite())?;
    Some((number, &text[end..]))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(all: &[&str]) -> Vec<String> {
        all.iter().map(|name| (*name).to_owned()).collect()
    }

    fn parse(text: &str, quantity: Quantity, all: &[&str]) -> Result<Expression, String> {
        Expression::parse(text, quantity, &names(all), all.len().max(4))
    }

    #[test]
    fn a_column_is_scaled_shifted_and_has_a_unit() {
        let all = ["Timestamp(ms)", "PWM", "Speed (rad/s)", "rad", "a-b"];
        for (text, place, of_ten) in [
            ("PWM*12/255", 1, 120.0 / 255.0),
            ("pwm * 2 - 1.5", 1, 18.5),
            ("-PWM/1e1", 1, -1.0),
            ("PWM+3", 1, 13.0),
            ("Speed (rad/s)*2", 2, 20.0),
            ("\"Speed (rad/s)\"", 2, 10.0),
            ("a-b-1", 4, 9.0),
            ("|PWM|*2", 1, 20.0),
            ("2*0.5", 1, 5.0),
        ] {
            let found = parse(text, Quantity::Volt, &all).unwrap();
            assert_eq!(found.source, Source::Column(place), "{text}");
            assert!((found.of(10.0) - of_ten).abs() < 1e-12, "{text}: {}", found.of(10.0));
        }
        assert_eq!(parse("Timestamp(ms):ms", Quantity::Time, &all).unwrap().unit, Some(("ms", 1e-3)));
        assert_eq!(parse("row*5:ms", Quantity::Time, &[]).unwrap().source, Source::Row);
        assert_eq!(parse("3:rpm", Quantity::Speed, &[]).unwrap().source, Source::Column(2));
    }

    #[test]
    fn what_could_be_two_things_or_none_is_refused() {
        for (text, all, wanted) in [
            ("PWM", &["a", "b"][..], "there are \"a\", \"b\""),
            ("PWM", &[][..], "no header; give columns by number, 1 to 4"),
            ("7", &["a"][..], "no column 7; there are 4"),
            ("a", &["a", "a"][..], "columns 1 and 2 are both called"),
            ("1", &["2", "1"][..], "could be column 1 or the column that is called so"),
            ("a*", &["a"][..], "no number follows *"),
            ("a+1*2", &["a"][..], "factors before sums"),
            ("a/0", &["a"][..], "divided by 0"),
            ("a:rpm", &["a"][..], "the unit rpm does not fit volt; use one of V, mV"),
            ("a 2", &["a"][..], "no column"),
            ("\"a", &["a"][..], "a quote is open"),
            ("|a*2|", &["a"][..], "between the bars"),
        ] {
            let error = parse(text, Quantity::Volt, all).unwrap_err();
            assert!(error.contains(wanted), "{text}: {error}");
        }
    }
}
