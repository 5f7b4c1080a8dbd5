//! What a board says, a line at a time.

/// Longest line that is kept; a longer one is cut.
const MOST_LINE: usize = 512;

/// A line of a board.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Said {
    /// A board has just started, or was reset.
    Welcome(String),
    /// A line was taken.
    Ok,
    /// A line was refused.
    Error(u16),
    /// A board lost its place, or something was hit.
    Alarm(u16),
    /// How it stands.
    Status(Status),
    /// A setting and its value.
    Setting(u16, f64),
    /// What is in brackets: the word before the colon, and what follows.
    Told(String, String),
    /// Something else.
    Other(String),
}

/// How a board stands, by its own report.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Status {
    /// What it does.
    pub(crate) state: Doing,
    /// Places of its axes, and whether they are those of the machine and not of a workpiece.
    pub(crate) place: Vec<f64>,
    pub(crate) is_machine: bool,
    /// Moves that it has room for.
    pub(crate) moves_free: Option<usize>,
    /// Overrides of feed, rapids and spindle, %.
    pub(crate) overrides: Option<[u16; 3]>,
    /// Letters of the inputs that are on.
    pub(crate) pins: String,
}

/// What a board does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Doing {
    /// Nothing.
    #[default]
    Idle,
    /// Moves.
    Run,
    /// Comes to a hold.
    Holding,
    /// Stands in a hold.
    Held,
    /// Is locked, and does not know where it stands.
    Alarm,
    /// Has an open door.
    Door,
    /// Homes.
    Home,
    /// Checks programs and does not move.
    Check,
    /// Something else.
    Else,
}

impl Doing {
    fn named(text: &str) -> Self {
        let (name, detail) = text.split_once(':').unwrap_or((text, ""));
        match name {
            "Idle" => Self::Idle,
            "Run" | "Jog" => Self::Run,
            "Hold" if detail == "0" => Self::Held,
            "Hold" => Self::Holding,
            "Alarm" => Self::Alarm,
            "Door" => Self::Door,
            "Home" => Self::Home,
            "Check" => Self::Check,
            _ => Self::Else,
        }
    }
}

impl Said {
    /// What a line means.
    pub(crate) fn read(line: &str) -> Self {
        let other = || Self::Other(line.to_owned());
        let number = |text: &str| text.trim().parse().ok();
        if line == "ok" {
            return Self::Ok;
        }
        if let Some(code) = line.strip_prefix("error:") {
            return number(code).map_or_else(other, Self::Error);
        }
        if let Some(code) = line.strip_prefix("ALARM:") {
            return number(code).map_or_else(other, Self::Alarm);
        }
        if line.starts_with("Grbl") {
            return Self::Welcome(line.to_owned());
        }
        if let Some(inner) = line.strip_prefix('<').and_then(|rest| rest.strip_suffix('>')) {
            return Self::Status(Status::read(inner));
        }
        if let Some(inner) = line.strip_prefix('[').and_then(|rest| rest.strip_suffix(']')) {
            let (head, rest) = inner.split_once(':').unwrap_or((inner, ""));
            return Self::Told(head.to_owned(), rest.to_owned());
        }
        let setting = || {
            let (key, value) = line.strip_prefix('$')?.split_once('=')?;
            // some add what it is, in brackets
            let value = value.split_whitespace().next()?;
            Some(Self::Setting(key.parse().ok()?, value.parse().ok()?))
        };
        setting().unwrap_or_else(other)
    }
}

impl Status {
    fn read(inner: &str) -> Self {
        let mut fields = inner.split('|');
        let state = fields.next().map(Doing::named).unwrap_or_default();
        let mut status = Self { state, ..Self::default() };
        for field in fields {
            let (name, value) = field.split_once(':').unwrap_or((field, ""));
            match name {
                "MPos" | "WPos" => (status.place, status.is_machine) = (numbers(value), name == "MPos"),
                "Bf" => status.moves_free = value.split(',').next().and_then(|free| free.parse().ok()),
                "Ov" => {
                    let shares: Vec<u16> = value.split(',').filter_map(|share| share.parse().ok()).collect();
                    status.overrides = shares.try_into().ok();
                }
                "Pn" => value.clone_into(&mut status.pins),
                _ => {}
            }
        }
        status
    }
}

/// Numbers between commas; the list ends with the first that is none.
pub(crate) fn numbers(text: &str) -> Vec<f64> {
    let read = |part: &str| part.trim().parse::<f64>().ok().filter(|number| number.is_finite());
    text.split(',').map_while(read).collect()
}

/// Bytes of a board, cut into lines.
#[derive(Clone, Debug, Default)]
pub(crate) struct Lines(Vec<u8>);

impl Lines {
    /// Takes a byte; a line that it ends, if that is not empty.
    pub(crate) fn push(&mut self, byte: u8) -> Option<Said> {
        if byte != b'\n' && byte != b'\r' {
            if self.0.len() < MOST_LINE {
                self.0.push(byte);
            }
            return None;
        }
        let line = String::from_utf8_lossy(&std::mem::take(&mut self.0)).trim().to_owned();
        (!line.is_empty()).then(|| Said::read(&line))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_of_boards_are_read() {
        let told = |head: &str, rest: &str| Said::Told(head.to_owned(), rest.to_owned());
        assert_eq!(Said::read("ok"), Said::Ok);
        assert_eq!(Said::read("error:9"), Said::Error(9));
        assert_eq!(Said::read("ALARM:3"), Said::Alarm(3));
        assert_eq!(Said::read("$100=88.889"), Said::Setting(100, 88.889));
        assert_eq!(Said::read("$30=1000. (rpm max)"), Said::Setting(30, 1000.0));
        assert_eq!(Said::read("[OPT:V,15,128]"), told("OPT", "V,15,128"));
        assert_eq!(Said::read("[MSG:Caution: Unlocked]"), told("MSG", "Caution: Unlocked"));
        assert_eq!(Said::read("$G=x"), Said::Other("$G=x".to_owned()));
        assert!(matches!(Said::read("Grbl 1.1h ['$' for help]"), Said::Welcome(_)));
        assert!(matches!(Said::read("error:what"), Said::Other(_)));
    }

    #[test]
    fn a_report_is_read_field_by_field() {
        let line = "<Hold:1|MPos:1.250,-3.000,0.000|Bf:12,100|FS:500,1000|Pn:D|Ov:100,100,90|A:S>";
        let Said::Status(status) = Said::read(line) else { unreachable!() };
        let place = vec![1.25, -3.0, 0.0];
        let pins = "D".to_owned();
        assert_eq!(
            status,
            Status {
                state: Doing::Holding,
                place,
                is_machine: true,
                moves_free: Some(12),
                overrides: Some([100, 100, 90]),
                pins
            }
        );
        let Said::Status(status) = Said::read("<Idle|WPos:1,nan,3|Bf:x>") else { unreachable!() };
        assert_eq!((status.place, status.is_machine, status.moves_free), (vec![1.0], false, None));
    }

    #[test]
    fn bytes_become_lines_however_they_end() {
        let mut lines = Lines::default();
        let said: Vec<Said> =
            b"ok\r\nerror:1\n\r\n\nok\r".iter().filter_map(|&byte| lines.push(byte)).collect();
        assert_eq!(said, [Said::Ok, Said::Error(1), Said::Ok]);
        assert!((0..1_000_000).all(|_| lines.push(b'x').is_none()));
        assert!(lines.0.len() <= MOST_LINE);
    }
}
