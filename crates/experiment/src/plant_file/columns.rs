//! Columns of a frequency response by their names: which is what, and in which unit.

use std::f64::consts::TAU;

use tracelight_linear::{Complex, FrequencyData};
use tracelight_maths::{complex, powf};

/// Numbers by name.
pub(super) struct Column {
    pub(super) name: String,
    pub(super) values: Vec<f64>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Frequency,
    Magnitude,
    Phase,
    Real,
    Imaginary,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Unit {
    /// So many rad/s each.
    RadS(f64),
    Decibels,
    Absolute,
    /// So many rad each.
    Rad(f64),
    /// The name has none.
    Missing,
}

/// What a column's name says.
#[derive(Debug, PartialEq)]
struct Header {
    kind: Kind,
    unit: Unit,
    /// The rest of the name: which channel it is of.
    channel: String,
}

/// The columns that are taken.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Picked {
    pub(super) frequency: usize,
    rad_s: f64,
    values: Values,
    coherence: Option<usize>,
}

/// Points of a smaller coherence are left out: their values are mostly noise. Of `lab frequency` the same.
pub(crate) const LEAST_COHERENCE: f64 = 0.9;

#[derive(Clone, Debug, PartialEq)]
enum Values {
    /// Magnitude, whether in dB, phase, rad each.
    Polar(usize, bool, usize, f64),
    /// Real and imaginary part.
    Parts(usize, usize),
}

impl Header {
    /// None of a column that is something else.
    fn of(name: &str) -> Option<Self> {
        let name = name.trim().trim_matches(['#', '%', '"', '\'', ' ']).to_lowercase();
        let (words, unit) = split_unit(&name);
        if ["model", "coherence", "deviation", "input ", "source", "drive"]
            .iter()
            .any(|other| words.starts_with(other))
        {
            return None;
        }
        let parts: Vec<&str> = words
            .split(|c: char| !(c.is_alphanumeric() || "|∠".contains(c)))
            .filter(|p| !p.is_empty())
            .collect();
        let is = |names: &[&str]| parts.iter().any(|part| names.contains(part));
        let begins = |start: &str| parts.iter().any(|part| part.starts_with(start));
        let kind = if begins("phase") || is(&["arg", "argument", "∠", "angle"]) {
            Kind::Phase
        } else if is(&["real", "re"]) {
            Kind::Real
        } else if begins("imag") || is(&["im", "img"]) {
            Kind::Imaginary
        } else if begins("magn")
            || begins("ampli")
            || is(&["mag", "gain", "abs", "ratio", "modulus"])
            || words.contains("|")
        {
            Kind::Magnitude
        } else if begins("freq") || is(&["omega", "w", "ω", "f"]) {
            Kind::Frequency
        } else {
            match unit {
                Some("hz" | "khz" | "mhz" | "ghz" | "rad/s" | "rad_s") if parts.is_empty() => Kind::Frequency,
                Some("db") if parts.is_empty() => Kind::Magnitude,
                Some("deg" | "°") if parts.is_empty() => Kind::Phase,
                _ => return None,
            }
        };
        let unit = unit_of(kind, unit, &parts)?;
        let is_kind = |part: &str| {
            const WORDS: [&str; 20] = [
                "arg", "argument", "angle", "∠", "real", "re", "im", "img", "mag", "gain", "abs", "ratio",
                "modulus", "omega", "w", "ω", "f", "part", "angular", "g",
            ];
            WORDS.contains(&part)
                || ["phase", "imag", "magn", "ampli", "freq"].iter().any(|start| part.starts_with(start))
                || part.contains('|')
        };
        let channel = parts.into_iter().filter(|part| !is_kind(part)).collect::<Vec<_>>().join(" ");
        Some(Self { kind, unit, channel })
    }
}

/// A name without its unit, and this: in brackets, after "in", or at its end.
fn split_unit(name: &str) -> (String, Option<&str>) {
    for (open, close) in [('(', ')'), ('[', ']')] {
        if let (Some(at), true) = (name.rfind(open), name.ends_with(close)) {
            return (name[..at].to_owned(), Some(name[at + 1..name.len() - 1].trim()));
        }
    }
    if let Some((words, unit)) = name.rsplit_once(" in ") {
        return (words.to_owned(), Some(unit.trim()));
    }
    // magnitude_db_2: which system comes last
    let (front, number) = match name.rsplit_once('_') {
        Some((front, number)) if !number.is_empty() && number.chars().all(|c| c.is_ascii_digit()) => {
            (front, number)
        }
        _ => (name, ""),
    };
    if let Some(at) = front.find("_per_") {
        let start = front[..at].rfind('_').unwrap_or(0);
        return (format!("{} {number}", &front[..start]), Some(front[start..].trim_matches('_')));
    }
    const ENDINGS: [&str; 14] = [
        "rad/s", "rad_s", "khz", "mhz", "ghz", "hz", "db", "degrees", "degree", "deg", "°", "radians", "rad",
        "abs",
    ];
    for ending in ENDINGS {
        if let Some(words) =
            front.strip_suffix(ending).filter(|words| !words.ends_with(char::is_alphanumeric))
        {
            return (format!("{words} {number}"), Some(&front[front.len() - ending.len()..]));
        }
    }
    (name.to_owned(), None)
}

/// The unit of a column of that kind; none where it shows that the column is something else.
fn unit_of(kind: Kind, unit: Option<&str>, words: &[&str]) -> Option<Unit> {
    let unit = unit.map(|unit| unit.trim().trim_end_matches('.'));
    Some(match (kind, unit) {
        (Kind::Frequency, Some("hz")) => Unit::RadS(TAU),
        (Kind::Frequency, Some("khz")) => Unit::RadS(TAU * 1e3),
        (Kind::Frequency, Some("mhz")) => Unit::RadS(TAU * 1e6),
        (Kind::Frequency, Some("ghz")) => Unit::RadS(TAU * 1e9),
        (Kind::Frequency, Some("rad/s" | "rad_s" | "rad/sec" | "rad s-1" | "1/s" | "radians/s")) => {
            Unit::RadS(1.0)
        }
        (Kind::Frequency, None) if ["omega", "w", "ω", "angular"].iter().any(|word| words.contains(word)) => {
            Unit::RadS(1.0)
        }
        (Kind::Magnitude, Some("db")) => Unit::Decibels,
        // what was put in, or a level
        (
            Kind::Magnitude,
            Some("vpp" | "v" | "mv" | "vrms" | "mvpp" | "v pp" | "dbm" | "dbv" | "dbu" | "a" | "ma"),
        ) => return None,
        (Kind::Magnitude, Some(_)) => Unit::Absolute,
        (Kind::Magnitude, None) if ["abs", "ratio", "modulus"].iter().any(|word| words.contains(word)) => {
            Unit::Absolute
        }
        (Kind::Magnitude, None) if words.iter().any(|word| word.contains('|')) => Unit::Absolute,
        (Kind::Phase, Some("deg" | "degree" | "degrees" | "°" | "º" | "*" | "\u{fffd}" | "â°" | "grad")) => {
            Unit::Rad(TAU / 360.0)
        }
        (Kind::Phase, Some("rad" | "radian" | "radians")) => Unit::Rad(1.0),
        (Kind::Real | Kind::Imaginary, Some("db")) => return None,
        (Kind::Real | Kind::Imaginary, _) => Unit::Absolute,
        _ => Unit::Missing,
    })
}

fn headers(names: &[&str]) -> Vec<(usize, Header)> {
    names.iter().enumerate().filter_map(|(at, name)| Some((at, Header::of(name)?))).collect()
}

/// Whether columns of these names may be a frequency response.
pub(super) fn are_header(names: &[&str]) -> bool {
    let headers = headers(names);
    let has = |kind: Kind| headers.iter().any(|(_, header)| header.kind == kind);
    has(Kind::Frequency)
        && (has(Kind::Magnitude) || has(Kind::Phase) || has(Kind::Real) || has(Kind::Imaginary))
}

pub(super) fn are_frequencies(columns: &[Column]) -> bool {
    are_header(&columns.iter().map(|column| column.name.as_str()).collect::<Vec<_>>())
}

/// Which of the columns are the response, of that channel if one is chosen.
///
/// # Errors
/// What is missing or left open, with the choices.
pub(super) fn pick(names: &[&str], choice: Option<&str>) -> Result<Picked, String> {
    let headers = headers(names);
    let of = |kind: Kind| headers.iter().filter(move |(_, header)| header.kind == kind);
    let (frequency, rad_s) = frequency(names, &headers)?;
    let mut found: Vec<(String, Values)> = Vec::new();
    for (im, header) in of(Kind::Imaginary) {
        if let Some((re, _)) = of(Kind::Real).find(|(_, other)| other.channel == header.channel) {
            found.push((header.channel.clone(), Values::Parts(*re, *im)));
        }
    }
    let (magnitudes, phases) = (of(Kind::Magnitude).count(), of(Kind::Phase).count());
    for (phase, header) in of(Kind::Phase) {
        let same =
            |other: &&(usize, Header)| other.1.channel == header.channel || (magnitudes, phases) == (1, 1);
        let mut own: Vec<_> = of(Kind::Magnitude).filter(same).collect();
        // in decibels before bare factors, and what has a unit before what has none
        own.sort_by_key(|(_, header)| match header.unit {
            Unit::Decibels => 0,
            Unit::Missing => 2,
            _ => 1,
        });
        let Some((magnitude, size)) = own.first() else { continue };
        if choice.is_none_or(|choice| is_chosen(choice, &header.channel, names[*phase])) {
            let Unit::Rad(rad) = header.unit else {
                return Err(format!(
                    "column {:?} has no unit: name it \"{1} (deg)\" or \"{1} (rad)\"",
                    names[*phase],
                    names[*phase].trim()
                ));
            };
            if size.unit == Unit::Missing {
                return Err(format!(
                    "column {:?} has no unit: name it \"{1} (dB)\" or \"{1} (abs)\"",
                    names[*magnitude],
                    names[*magnitude].trim()
                ));
            }
            found.push((
                header.channel.clone(),
                Values::Polar(*magnitude, size.unit == Unit::Decibels, *phase, rad),
            ));
        }
    }
    if let Some(choice) = choice {
        found.retain(|(channel, values)| is_chosen(choice, channel, names[values.first()]));
    }
    match found.as_slice() {
        [(_, values)] => Ok(Picked { frequency, rad_s, values: values.clone(), coherence: coherence(names) }),
        [] => Err(format!(
            "no columns are the values{}: magnitude (dB or abs) and phase (deg or rad) of one channel, or real and imaginary part; there are {}",
            choice.map_or(String::new(), |choice| format!(" of {choice:?}")),
            names.join(", ")
        )),
        several => {
            let channels: Vec<String> = several.iter().map(|(channel, _)| format!("{channel:?}")).collect();
            Err(format!("it holds {} responses: choose one of {}", several.len(), channels.join(", ")))
        }
    }
}

/// Which column is the coherence, if just one is.
fn coherence(names: &[&str]) -> Option<usize> {
    let is_coherence = |name: &str| {
        name.trim().trim_matches(['#', '%', '"', '\'', ' ']).to_lowercase().starts_with("coherence")
    };
    let mut all = names.iter().enumerate().filter(|(_, name)| is_coherence(name)).map(|(at, _)| at);
    all.next().filter(|_| all.next().is_none())
}

/// Which column is the frequency, and how many rad/s one of its units is.
fn frequency(names: &[&str], headers: &[(usize, Header)]) -> Result<(usize, f64), String> {
    let frequencies: Vec<_> = headers.iter().filter(|(_, header)| header.kind == Kind::Frequency).collect();
    let known: Vec<_> = frequencies.iter().filter(|(_, header)| header.unit != Unit::Missing).collect();
    match (known.first(), frequencies.first()) {
        (Some((at, Header { unit: Unit::RadS(rad_s), .. })), _) => Ok((*at, *rad_s)),
        (_, Some((at, _))) => Err(format!(
            "column {:?} has no unit: name it \"{1} (Hz)\" or \"{1} (rad/s)\"",
            names[*at],
            names[*at].trim()
        )),
        _ => Err(format!(
            "no column is a frequency: name one \"frequency (Hz)\" or \"frequency (rad/s)\"; there are {}",
            names.join(", ")
        )),
    }
}

fn is_chosen(choice: &str, channel: &str, name: &str) -> bool {
    let choice = choice.to_lowercase();
    channel == choice || name.to_lowercase().trim() == choice
}

impl Values {
    const fn first(&self) -> usize {
        match self {
            Self::Polar(magnitude, ..) => *magnitude,
            Self::Parts(re, _) => *re,
        }
    }
}

impl Picked {
    /// The columns that are read; without a coherence the frequency's stands again in its place.
    pub(super) fn all(&self) -> [usize; 4] {
        let coherence = self.coherence.unwrap_or(self.frequency);
        match self.values {
            Values::Polar(magnitude, _, phase, _) => [self.frequency, magnitude, phase, coherence],
            Values::Parts(re, im) => [self.frequency, re, im, coherence],
        }
    }

    /// How they are understood.
    pub(super) fn in_words(&self, names: &[&str]) -> String {
        let unit = match self.rad_s {
            1.0 => "rad/s",
            _ => "Hz, kHz, MHz or GHz as named",
        };
        let name = |at: usize| names[at].trim();
        match self.values {
            Values::Polar(magnitude, is_db, phase, rad) => format!(
                "frequency: {:?}, {unit}; magnitude: {:?}, {}; phase: {:?}, {}",
                name(self.frequency),
                name(magnitude),
                if is_db { "dB" } else { "absolute" },
                name(phase),
                if rad == 1.0 { "rad" } else { "degrees" }
            ),
            Values::Parts(re, im) => {
                format!(
                    "frequency: {:?}, {unit}; real part: {:?}; imaginary part: {:?}",
                    name(self.frequency),
                    name(re),
                    name(im)
                )
            }
        }
    }

    /// The response of so many rows, in the order of their frequencies if that falls throughout; without those of too small a
    /// coherence, which go along as left out.
    pub(super) fn data(
        &self,
        number: impl Fn(usize, usize) -> Option<f64>,
        rows: usize,
    ) -> Result<FrequencyData, String> {
        if rows > FrequencyData::MOST {
            return Err(format!("{rows} frequencies; at most {} are taken", FrequencyData::MOST));
        }
        let mut points = Vec::with_capacity(rows);
        for row in 0..rows {
            let get =
                |column: usize| number(column, row).ok_or_else(|| format!("point {} has no value", row + 1));
            let [w, first, second, coherence] = self.all().map(get);
            // also what is no number is too small
            let is_good = self.coherence.is_none() || coherence? >= LEAST_COHERENCE;
            points.push((w? * self.rad_s, self.value(first?, second?), is_good));
        }
        if points.windows(2).all(|pair| pair[1].0 < pair[0].0) {
            points.reverse();
        }
        let (good, bad): (Vec<_>, Vec<_>) = points.into_iter().partition(|(_, _, is_good)| *is_good);
        let left_out: Vec<(f64, Complex)> = bad.into_iter().map(|(w, value, _)| (w, value)).collect();
        if good.len() < 2 && !left_out.is_empty() {
            return Err(format!(
                "{} of {rows} points have a coherence below {LEAST_COHERENCE}: what is left is no response; measure with more amplitude, or \
                 for longer",
                left_out.len()
            ));
        }
        let (rad_s, values) = good.into_iter().map(|(w, value, _)| (w, value)).unzip();
        let data = FrequencyData::new(rad_s, values).map_err(|e| e.to_string())?;
        Ok(data.with_left_out(left_out))
    }

    fn value(&self, first: f64, second: f64) -> Complex {
        match self.values {
            Values::Parts(..) => Complex::new(first, second),
            Values::Polar(_, is_db, _, rad) => {
                let size = if is_db { powf(10.0, first / 20.0) } else { first };
                complex::from_polar(size, second * rad)
            }
        }
    }
}
