//! What values by name describe: matrices, polynomials, zeros and poles, or frequencies.

use tracelight_linear::{Complex, LinearError, Matrix, Polynomial, StateSpace, Time, TransferFunction, Zpk};

use crate::plant_file::columns::{self, Column};
use crate::plant_file::node::{Node, Table, Value, Wrong, find};
use crate::plant_file::plant::{MOST_PORTS, MOST_STATES, Plant, PlantFile};

const NUMERATOR: [&str; 2] = ["num", "numerator"];
const DENOMINATOR: [&str; 2] = ["den", "denominator"];
const POLES: [&str; 2] = ["poles", "p"];
const ZEROS: [&str; 2] = ["zeros", "z"];
const GAIN: [&str; 2] = ["gain", "k"];
/// What would have to be taken into account, and is not read.
const DELAYS: [&str; 8] =
    ["delay_s", "dead_time_s", "delay", "dead_time", "inputdelay", "outputdelay", "iodelay", "internaldelay"];

/// The system of a file, or the one that is chosen of several.
pub(super) fn plant(root: &Node, choice: Option<&str>) -> Result<Plant, Wrong> {
    let table = root.table().ok_or_else(|| root.wrong("it holds no values by name"))?;
    let table = match choice {
        Some(choice) => chosen(root, table, choice)?,
        None => alone(root, table)?,
    };
    let kinds = kinds(table);
    match kinds.as_slice() {
        ["A, B, C, D", ..] if kinds.len() == 1 => state_space(root, table),
        ["num, den", ..] if kinds.len() == 1 => {
            checked(table)?;
            polynomials(root, table).map(|system| Plant::of(PlantFile::Transfer(system)))
        }
        ["gain, poles, zeros"] => {
            checked(table)?;
            factors(root, table).map(|system| Plant::of(PlantFile::Transfer(system)))
        }
        ["frequencies"] => frequencies(root, table, choice),
        _ => {
            Err(root
                .wrong(format!("it describes a system twice, by {}; leave one out", kinds.join(" and by "))))
        }
    }
}

/// In which ways a table describes a system.
fn kinds(table: &Table) -> Vec<&'static str> {
    let has = |names: &[&str]| find(table, names).is_some();
    let mut kinds = Vec::new();
    if has(&["A"]) && has(&["B"]) && has(&["C"]) {
        kinds.push("A, B, C, D");
    }
    if has(&NUMERATOR) && has(&DENOMINATOR) {
        kinds.push("num, den");
    }
    // with num and den, they are told for people
    if has(&GAIN) && has(&POLES) && !kinds.contains(&"num, den") {
        kinds.push("gain, poles, zeros");
    }
    if kinds.is_empty() && !columns_of(table).is_empty() {
        kinds.push("frequencies");
    }
    kinds
}

/// The tables in a table, by name: systems of a list by their number, too.
fn inside(table: &Table) -> Vec<(String, &Table)> {
    let mut all = Vec::new();
    for (name, node) in table {
        match &node.value {
            Value::Table(inner) => all.push((name.clone(), inner)),
            Value::List(list) if name == "systems" => {
                let numbered =
                    list.iter().zip(1..).filter_map(|(node, k)| Some((k.to_string(), node.table()?)));
                all.extend(numbered);
            }
            _ => {}
        }
    }
    all.retain(|(_, inner)| !kinds(inner).is_empty());
    all
}

fn alone<'a>(root: &Node, table: &'a Table) -> Result<&'a Table, Wrong> {
    if !kinds(table).is_empty() {
        return Ok(table);
    }
    match inside(table).as_slice() {
        [(_, inner)] => Ok(inner),
        [] => {
            let unreadable = table.iter().find_map(|(name, node)| match &node.value {
                Value::Unreadable(what) => Some(node.wrong(format!("{name} is {what}"))),
                _ => None,
            });
            Err(unreadable.unwrap_or_else(|| {
                let has: Vec<&str> = table.iter().take(20).map(|(name, _)| name.as_str()).collect();
                root.wrong(format!(
                    "it describes no system: it has to have A, B, C and D, or num and den, or gain, poles and zeros, or \
                     frequencies with their values; it has {}",
                    if has.is_empty() { "nothing".into() } else { has.join(", ") }
                ))
            }))
        }
        several => {
            let names: Vec<&str> = several.iter().map(|(name, _)| name.as_str()).collect();
            Err(root.wrong(format!("it holds {} systems: choose one of {}", names.len(), names.join(", "))))
        }
    }
}

fn chosen<'a>(root: &Node, table: &'a Table, choice: &str) -> Result<&'a Table, Wrong> {
    let all = inside(table);
    let named = |inner: &Table| matches!(find(inner, &["name"]), Some((_, Node { value: Value::Text(name), .. })) if name == choice);
    let found =
        all.iter().find(|(name, _)| name == choice).or_else(|| all.iter().find(|(_, inner)| named(inner)));
    match found {
        Some((_, inner)) => Ok(inner),
        // a channel of frequencies
        None if kinds(table) == ["frequencies"] => Ok(table),
        None => {
            let names: Vec<&str> = all.iter().map(|(name, _)| name.as_str()).collect();
            let there = if names.is_empty() { "none by name".into() } else { names.join(", ") };
            Err(root.wrong(format!("it holds no system {choice:?}; it holds {there}")))
        }
    }
}

/// Refuses what changes a system and is not read.
fn checked(table: &Table) -> Result<(), Wrong> {
    for name in DELAYS {
        let Some((key, node)) = find(table, &[name]) else { continue };
        let is_none = node.numbers().is_some_and(|all| all.iter().all(|delay| *delay == 0.0));
        let is_none = is_none || matches!(&node.value, Value::Nothing);
        let is_zero = matches!(&node.value, Value::Grid(grid) if grid.iter().all(|delay| *delay == 0.0));
        if !is_none && !is_zero {
            return Err(
                node.wrong(format!("{key} is {}; a system file with dead time is not read", node.in_words()))
            );
        }
    }
    if let Some((_, node)) = find(table, &["E"]) {
        let is_one = matches!(&node.value, Value::Nothing)
            || matrix(node, "E")?
                .is_some_and(|e| e.is_empty() || e == Matrix::identity(e.nrows(), e.ncols()));
        if !is_one {
            return Err(
                node.wrong("E is not the identity: solve E ẋ = A x + B u for ẋ first, A = E⁻¹ A, B = E⁻¹ B")
            );
        }
    }
    Ok(())
}

/// Its time: by its period, continuous without one.
fn time(table: &Table) -> Result<Time, Wrong> {
    const NAMES: [&str; 6] = ["period_s", "dt", "Ts", "sample_time", "sample_time_s", "sampling_period_s"];
    let mut found: Option<(&str, f64)> = None;
    for name in NAMES {
        let Some((key, node)) = find(table, &[name]) else { continue };
        let period_s = match &node.value {
            Value::Nothing => 0.0,
            Value::Text(text) if ["none", "null", ""].contains(&text.to_ascii_lowercase().as_str()) => 0.0,
            _ => match node.numbers().as_deref() {
                Some([]) => 0.0,
                Some([number]) => *number,
                _ => {
                    return Err(node.wrong(format!(
                        "{key} is {}; it has to be the seconds from sample to sample, 0 in continuous time",
                        node.in_words()
                    )));
                }
            },
        };
        if !(period_s >= 0.0 && period_s.is_finite()) {
            return Err(node.wrong(format!(
                "{key} is {period_s}: say how many seconds a sample lasts, 0 in continuous time"
            )));
        }
        if let Some((other, before)) = found.filter(|(other, before)| *other != key && *before != period_s) {
            return Err(node.wrong(format!("{key} is {period_s}, {other} is {before}: leave one out")));
        }
        found = Some((key, period_s));
    }
    Ok(match found {
        Some((_, period_s)) if period_s > 0.0 => Time::Sampled(period_s),
        _ => Time::Continuous,
    })
}

fn state_space(root: &Node, table: &Table) -> Result<Plant, Wrong> {
    checked(table)?;
    let get = |name: &str| {
        let (key, node) = find(table, &[name])
            .ok_or_else(|| root.wrong(format!("{name} is missing; where it is zero write {name} = 0")))?;
        let rows = matrix(node, key)?;
        let rows = rows.ok_or_else(|| {
            node.wrong(format!("{key} is {}; it has to be a list of rows", node.in_words()))
        })?;
        Ok((node, rows))
    };
    let [(node_a, a), (node_b, b), (node_c, c), (node_d, d)] = [get("A")?, get("B")?, get("C")?, get("D")?];
    let n = a.nrows();
    if n > MOST_STATES {
        return Err(node_a.wrong(format!("A has {n} rows; at most {MOST_STATES} states are taken")));
    }
    if a.nrows() != a.ncols() {
        return Err(node_a.wrong(format!("A is {} × {}; it has to be square", a.nrows(), a.ncols())));
    }
    let flat = |node: &Node| !matches!(&node.value, Value::List(_) | Value::Grid(_));
    // a flat list is the column of one input, or the row of one output
    let b = if flat(node_b) && b.nrows() == 1 && n != 1 && b.ncols() == n { b.transpose() } else { b };
    let (mut b, mut c) = (b, c);
    if n == 0 {
        (b, c) = (Matrix::zeros(0, d.ncols()), Matrix::zeros(d.nrows(), 0));
    }
    let (inputs, outputs) = (b.ncols(), c.nrows());
    if !(1..=MOST_PORTS).contains(&inputs) || !(1..=MOST_PORTS).contains(&outputs) {
        return Err(root.wrong(format!(
            "it has {inputs} inputs and {outputs} outputs; from 1 to {MOST_PORTS} of each are taken"
        )));
    }
    let is_zero = d.shape() == (1, 1) && d[(0, 0)] == 0.0;
    let d = match d.shape() {
        _ if is_zero => Matrix::zeros(outputs, inputs),
        (1, width) if flat(node_d) && inputs == 1 && width == outputs => d.transpose(),
        _ => d,
    };
    for (name, node, own, shape) in [
        ("B", node_b, &b, (n, inputs)),
        ("C", node_c, &c, (outputs, n)),
        ("D", node_d, &d, (outputs, inputs)),
    ] {
        if own.shape() != shape {
            return Err(node.wrong(format!(
                "{name} is {} × {}; with {n} states, {inputs} inputs and {outputs} outputs it has to be {} × {}",
                own.nrows(), own.ncols(), shape.0, shape.1
            )));
        }
    }
    let system = StateSpace::new(a, b, c, d, time(table)?).map_err(|e| linear(root, &e))?;
    let names = |keys: &[&str], count: usize| labels(table, keys, count);
    Ok(Plant {
        system: PlantFile::StateSpace(system),
        inputs: names(&["inputs", "input_labels", "InputName", "u"], inputs)?,
        outputs: names(&["outputs", "output_labels", "OutputName", "y"], outputs)?,
        understood: None,
    })
}

fn linear(root: &Node, error: &LinearError) -> Wrong {
    root.wrong(error.to_string())
}

/// Names of inputs or outputs: as many as there are, or none.
fn labels(table: &Table, keys: &[&str], count: usize) -> Result<Vec<String>, Wrong> {
    let Some((key, node)) = find(table, keys) else { return Ok(Vec::new()) };
    let names: Vec<String> = match &node.value {
        Value::Text(name) => vec![name.clone()],
        Value::List(list) => list
            .iter()
            .filter_map(|n| if let Value::Text(name) = &n.value { Some(name.clone()) } else { None })
            .collect(),
        _ => return Ok(Vec::new()),
    };
    if names.len() != count {
        return Err(node.wrong(format!("{key} has {} names; there are {count}", names.len())));
    }
    Ok(names)
}

/// A matrix of rows; of a flat list one row.
fn matrix(node: &Node, name: &str) -> Result<Option<Matrix>, Wrong> {
    Ok(match &node.value {
        Value::Number(number) => Some(Matrix::from_element(1, 1, *number)),
        Value::Numbers(numbers) if numbers.is_empty() => Some(Matrix::zeros(0, 0)),
        Value::Numbers(numbers) => Some(Matrix::from_row_slice(1, numbers.len(), numbers)),
        Value::Grid(grid) => Some(grid.clone()),
        Value::List(list) => {
            let mut all = Vec::new();
            let mut width = None;
            for (row, number) in list.iter().zip(1..) {
                let Value::Numbers(numbers) = &row.value else {
                    return Err(row.wrong(format!(
                        "row {number} of {name} is {}; it has to be a list of numbers",
                        row.in_words()
                    )));
                };
                if *width.get_or_insert(numbers.len()) != numbers.len() {
                    let first = width.unwrap_or_default();
                    return Err(row.wrong(format!(
                        "row {number} of {name} has {} numbers, the first has {first}",
                        numbers.len()
                    )));
                }
                all.extend_from_slice(numbers);
            }
            Some(Matrix::from_row_slice(list.len(), width.unwrap_or_default(), &all))
        }
        _ => None,
    })
}

fn coefficients(root: &Node, table: &Table, names: &[&str]) -> Result<Vec<f64>, Wrong> {
    let (key, node) = find(table, names).ok_or_else(|| root.wrong(format!("{} is missing", names[0])))?;
    let numbers = node.numbers().filter(|numbers| !numbers.is_empty()).ok_or_else(|| {
        node.wrong(format!(
            "{key} is {}; it has to be a list of coefficients, the highest power first, of one input and one output (of several, give A, B, C, D)",
            node.in_words()
        ))
    })?;
    if numbers.len() > MOST_STATES + 1 {
        return Err(node.wrong(format!(
            "{key} has {} coefficients; an order of at most {MOST_STATES} is taken",
            numbers.len()
        )));
    }
    Ok(numbers)
}

fn polynomials(root: &Node, table: &Table) -> Result<TransferFunction, Wrong> {
    let above = coefficients(root, table, &NUMERATOR)?;
    let below = coefficients(root, table, &DENOMINATOR)?;
    TransferFunction::new(Polynomial::new(above), Polynomial::new(below), time(table)?)
        .map_err(|e| linear(root, &e))
}

fn factors(root: &Node, table: &Table) -> Result<TransferFunction, Wrong> {
    let gain = match find(table, &GAIN).and_then(|(_, node)| node.numbers()).as_deref() {
        Some([gain]) => *gain,
        _ => return Err(root.wrong("gain has to be one number: the factor before the zeros and poles")),
    };
    let zeros = find(table, &ZEROS).map_or(Ok(Vec::new()), |(key, node)| roots(key, node))?;
    let poles = find(table, &POLES).map_or(Ok(Vec::new()), |(key, node)| roots(key, node))?;
    if zeros.len().max(poles.len()) > MOST_STATES {
        return Err(root.wrong(format!(
            "more than {MOST_STATES} zeros or poles; an order of at most {MOST_STATES} is taken"
        )));
    }
    Ok(Zpk::new(gain, zeros, poles, time(table)?).map_err(|e| linear(root, &e))?.transfer())
}

/// Real numbers, pairs of real and imaginary part, or texts such as "-1+2j".
fn roots(key: &str, node: &Node) -> Result<Vec<Complex>, Wrong> {
    let wrong = |node: &Node| {
        node.wrong(format!(
            "{key}: {} is no root; write −2, [−1, 2] for −1 + 2j, or \"-1+2j\"",
            node.in_words()
        ))
    };
    match &node.value {
        Value::Nothing => Ok(Vec::new()),
        Value::ComplexGrid(_, _, values) => Ok(values.clone()),
        Value::List(list) => list
            .iter()
            .map(|item| match &item.value {
                Value::Number(re) => Ok(Complex::new(*re, 0.0)),
                Value::Numbers(pair) if pair.len() == 2 => Ok(Complex::new(pair[0], pair[1])),
                Value::Text(text) => complex(text).ok_or_else(|| wrong(item)),
                _ => Err(wrong(item)),
            })
            .collect(),
        _ => Ok(node.numbers().ok_or_else(|| wrong(node))?.into_iter().map(Complex::from).collect()),
    }
}

/// -1+2j, 3, -2i; with brackets, as Python prints them.
fn complex(text: &str) -> Option<Complex> {
    let text: String = text.chars().filter(|c| !c.is_whitespace() && !"()*".contains(*c)).collect();
    let Some(imaginary) = text.strip_suffix(['j', 'i']) else {
        return text.parse().ok().map(|re| Complex::new(re, 0.0));
    };
    let split = imaginary.rmatch_indices(['+', '-']).map(|(at, _)| at);
    // a sign after e is of an exponent
    let at = split.into_iter().find(|at| !imaginary[..*at].ends_with(['e', 'E'])).unwrap_or(0);
    let part = |text: &str| match text {
        "" => Some(0.0),
        _ => text.parse::<f64>().ok().filter(|number| number.is_finite()),
    };
    let im = match &imaginary[at..] {
        "" | "+" => 1.0,
        "-" => -1.0,
        number => part(number)?,
    };
    Some(Complex::new(part(&imaginary[..at])?, im))
}

/// Lists of numbers by name, as columns of a table would be.
fn columns_of(table: &Table) -> Vec<Column> {
    let mut all = Vec::new();
    for (name, node) in table {
        match &node.value {
            Value::ComplexGrid(rows, columns, values) if *rows.min(columns) == 1 => {
                all.push(Column {
                    name: format!("{name} real"),
                    values: values.iter().map(|z| z.re).collect(),
                });
                all.push(Column {
                    name: format!("{name} imag"),
                    values: values.iter().map(|z| z.im).collect(),
                });
            }
            // points, each a table
            Value::List(list) if name == "points" => {
                let names = list
                    .first()
                    .and_then(Node::table)
                    .into_iter()
                    .flatten()
                    .take(64)
                    .map(|(name, _)| name.clone());
                let value = |node: &Node, name: &str| match node.table().and_then(|t| find(t, &[name])) {
                    Some((_, Node { value: Value::Number(number), .. })) => Some(*number),
                    _ => None,
                };
                let columns = names.filter_map(|name| {
                    let values: Option<Vec<f64>> = list.iter().map(|node| value(node, &name)).collect();
                    // this program's own, in units of the angle over volts
                    let name = if name == "magnitude" { "magnitude_abs".to_owned() } else { name };
                    Some(Column { values: values?, name })
                });
                all.extend(columns);
            }
            _ => {
                let numbers = node.numbers().filter(|numbers| numbers.len() > 1);
                all.extend(numbers.map(|values| Column { name: name.clone(), values }));
            }
        }
    }
    if columns::are_frequencies(&all) { all } else { Vec::new() }
}

fn frequencies(root: &Node, table: &Table, choice: Option<&str>) -> Result<Plant, Wrong> {
    checked(table)?;
    let all = columns_of(table);
    let names: Vec<&str> = all.iter().map(|column| column.name.as_str()).collect();
    let choice = choice.filter(|choice| names.iter().any(|name| name.contains(choice)));
    let picked = columns::pick(&names, choice).map_err(|what| root.wrong(what))?;
    let data =
        picked.data(|column, row| all[column].values.get(row).copied(), all[picked.frequency].values.len());
    let data = data.map_err(|what| root.wrong(what))?;
    Ok(Plant { understood: Some(picked.in_words(&names)), ..Plant::of(PlantFile::Frequencies(data)) })
}
