//! Which columns of a table are taken for what: those that were asked for, and those that its header tells.

use tracelight_rig::Joint;

use super::asked::Columns;
use super::dialect::{Dialect, text};
use super::expression::{Expression, Source, title, titles};
use super::guess::{self, guess};
use super::quantity::Quantity;
use crate::record::MOST_V;
use crate::table::Log;

/// Most of any number, in SI.
const MOST: f64 = 1e12;

/// What a log must hold for a command, and what it may.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Kind {
    /// The error code of its command.
    pub(crate) code: &'static str,
    /// One of each of these, the first that is there.
    pub(crate) must: &'static [&'static [Quantity]],
    /// Any of these.
    pub(crate) may: &'static [Quantity],
    /// This program's columns of such a log, for people.
    pub(crate) own: &'static str,
}

/// Whether a quantity was spoken of, or a log's header tells it.
pub(crate) fn tells(log: &Log, columns: &Columns, quantity: Quantity) -> bool {
    let by_header = || {
        let table = Dialect::of(&text(&log.bytes))?;
        Some(!matches!(guess(quantity, &table.names, &table.units), Ok(None)))
    };
    columns.has(quantity) || by_header() == Some(true)
}

/// A table's dialect, before anything is taken from it.
pub(super) struct Table(pub(super) Dialect);

/// A quantity, and how it is had.
pub(super) struct Taken {
    pub(super) quantity: Quantity,
    pub(super) how: Expression,
    /// Its header told it.
    pub(super) guessed: bool,
}

/// Everything that is taken from a table.
pub(super) struct Resolved {
    pub(super) table: Table,
    pub(super) taken: Vec<Taken>,
    /// The column that says which joint, or the joint.
    pub(super) joint: Result<usize, Joint>,
}

impl Table {
    pub(super) fn of(text: &str) -> Result<Self, String> {
        Dialect::of(text).map(Self).ok_or_else(|| {
            ": no separator (comma, semicolon, tab, spaces) makes rows of two numbers or more of it"
                .to_owned()
        })
    }

    pub(super) fn resolved(
        self,
        columns: &Columns,
        axis: Option<Joint>,
        kind: &Kind,
    ) -> Result<Resolved, String> {
        let all = || kind.must.iter().flat_map(|group| group.iter()).chain(kind.may).copied();
        let takes = |quantity: Quantity| quantity == Quantity::Axis || all().any(|one| one == quantity);
        if let Some((quantity, _)) = columns.0.iter().find(|(quantity, _)| !takes(*quantity)) {
            let names = all().map(Quantity::name).collect::<Vec<_>>().join(", ");
            return Err(format!(": {} is not asked here; a log of this kind holds {names}", quantity.name()));
        }
        let mut taken = Vec::new();
        for group in kind.must {
            taken.push(self.one_of(group, columns)?);
        }
        for &quantity in kind.may {
            if let Some(found) = self.one(quantity, columns)? {
                taken.push(found);
            }
        }
        let joint = match (self.one(Quantity::Axis, columns)?.map(|taken| taken.how.source), axis) {
            (Some(Source::Column(place)), _) => Ok(place),
            (_, Some(joint)) => Err(joint),
            (_, None) => {
                return Err(": no column says of which joint it is: give --axis pan or --axis tilt".into());
            }
        };
        Ok(Resolved { table: self, taken, joint })
    }

    /// The first of some quantities that is there.
    fn one_of(&self, group: &[Quantity], columns: &Columns) -> Result<Taken, String> {
        let asked: Vec<Quantity> = group.iter().copied().filter(|q| columns.of(*q).is_some()).collect();
        if let [one, other, ..] = asked.as_slice() {
            return Err(format!(": {} and {} are both given; one is enough", one.name(), other.name()));
        }
        let tried = if asked.is_empty() { group } else { asked.as_slice() };
        let mut unclear = None;
        for &quantity in tried {
            match self.one(quantity, columns) {
                Ok(Some(found)) => return Ok(found),
                Ok(None) => {}
                Err(what) => unclear = unclear.or(Some(what)),
            }
        }
        Err(unclear.unwrap_or_else(|| self.missing(group)))
    }

    /// What was asked for a quantity, or what a header tells of it.
    fn one(&self, quantity: Quantity, columns: &Columns) -> Result<Option<Taken>, String> {
        let Dialect { names, units, columns: count, .. } = &self.0;
        let told = |what: String| format!(": {what}");
        if let Some(asked) = columns.of(quantity) {
            let mut how = Expression::parse(asked, quantity, names, *count).map_err(told)?;
            if let (None, Source::Column(place)) = (how.unit, how.source) {
                how.unit = guess::unit(quantity, names, units, place);
            }
            // who names a column and no unit means SI, but for times, which are looked at
            if quantity != Quantity::Time {
                how.unit = how.unit.or(quantity.units().first().copied());
            }
            return Ok(Some(Taken { quantity, how, guessed: false }));
        }
        let Some(mut how) = guess(quantity, names, units).map_err(told)? else { return Ok(None) };
        match (how.unit, quantity) {
            (Some(_), _) | (None, Quantity::Time) => {}
            (None, Quantity::Volt) => how.unit = quantity.units().first().copied(),
            (None, _) if quantity.units().is_empty() => {}
            (None, _) => {
                let (name, said) = (quantity.name(), how.said);
                return Err(format!(
                    ": {said} looks like {name}, but nothing tells its unit: say --columns {name}={}:UNIT, one of {}",
                    said.trim_matches('"'),
                    quantity.unit_names()
                ));
            }
        }
        Ok(Some(Taken { quantity, how, guessed: true }))
    }

    /// Which column of a group is missing, and what to say.
    fn missing(&self, group: &[Quantity]) -> String {
        let Dialect { names, columns, .. } = &self.0;
        let wanted = group.iter().map(|q| q.name()).collect::<Vec<_>>().join(" or ");
        if group.contains(&Quantity::Volt)
            && let Some(place) = guess::drive(names)
        {
            let (column, name) = (title(names, place), &names[place]);
            return format!(
                ": {column} drives the motor, and nothing says how many volts that is: say it, such as \
                 --columns volt={name}*12/255 where 255 is 12 V"
            );
        }
        let there = titles(names, *columns);
        let header = if names.is_empty() { "it has no header: " } else { "" };
        format!(
            ": {header}no column tells {wanted}; say which, such as --columns {}=…; there are {there}",
            group.first().map_or("", |quantity| quantity.name())
        )
    }
}

impl Taken {
    /// A cell in SI; a time as it stands.
    pub(super) fn si(&self, cell: f64, line: u64) -> Result<f64, String> {
        if self.quantity == Quantity::Time {
            return Ok(cell);
        }
        let value = self.how.unit.map_or(1.0, |unit| unit.1) * self.how.of(cell);
        let (most, what) = if self.quantity == Quantity::Volt {
            (MOST_V, "any amplifier takes, V")
        } else {
            (MOST, "this can be")
        };
        if value.abs() <= most {
            return Ok(value);
        }
        Err(format!(":{line}: {} = {value} {} is more than {what}", self.quantity.name(), self.quantity.si()))
    }
}
