//! `docs/wire-format.md`: its examples are printed by the code that makes packets, and read by the code that reads them.

use std::fmt::Write as _;

use tracelight_rig::wire::{
    Ask, Configured, FromBoard, Greeting, MOST_PACKET, Order, Packets, Reset, Row, RowBytes, Rows,
    RowsHeader, ToBoard, VERSION, WrongConfiguration, as_told, packed,
};
use tracelight_rig::{
    Actuation, Capabilities, Command, Darkness, DarknessSet, Exceeded, Fault, FaultRecord, Input, InputState,
    Inputs, Joint, Measurement, PanTilt, Phase, RateLimit, Segment, Sensed,
};

use crate::support;

/// The last byte of the connection's number.
const CONNECTION: u8 = 7;
const HEADER: RowsHeader = RowsHeader { first_tick: 65, wanted: 2, free: 380, disarm: 0, fault_number: 0 };

/// The inputs of the rig of the examples.
fn inputs() -> Inputs {
    Inputs::ABSENT.with(Input::EmergencyStop, InputState::Fine).with(Input::Lid, InputState::Fine)
}

fn to_board() -> Vec<(&'static str, ToBoard<'static>)> {
    let segment = Segment {
        start_tick: 40,
        ticks: 25,
        coefficients: PanTilt::new([0.1, 1e-3, 0.0, 0.0, 0.0, 0.0], [-0.05, 0.0, 0.0, 2e-7, 0.0, 0.0]),
        tolerance_rad: PanTilt::new(3e-3, 3e-3),
        gate: true,
        rate_limit: RateLimit { start: 2.0, end: 1.5 },
    };
    let order = |sequence, ask| ToBoard::Order(Order { sequence, ask });
    let command = |sequence, command| order(sequence, Ask::Command(command));
    vec![
        ("Hello", ToBoard::Hello { version: VERSION, session: 7, program: *b"0.1.0\0\0\0" }),
        ("Configure", ToBoard::Configure { offset: 200, bytes: &[0, 0, 128, 63] }),
        ("Commit", ToBoard::Commit { length: 204, crc: 0x1234_5678 }),
        ("Arm", order(0, Ask::Arm { nonce: 3, acknowledges: 1 })),
        ("Append", command(1, Command::Append(segment))),
        ("Finish", command(2, Command::Finish)),
        ("Home", command(3, Command::Home(PanTilt::new(-12, 250)))),
        ("Unhome", command(4, Command::Unhome)),
        ("Point", command(5, Command::Point(900))),
        ("Speed", command(6, Command::Speed(0.5))),
        ("Pause", command(7, Command::Pause)),
        ("Abandon", command(8, Command::Abandon)),
        ("Acknowledge", command(9, Command::Acknowledge { fault: 1 })),
        ("Keep-alive", ToBoard::KeepAlive { host_us: 1_000_000 }),
        ("Disarm", ToBoard::Disarm { before: 10, number: 1 }),
        ("Again", ToBoard::Again { from: 65, count: 7 }),
        ("Seen", ToBoard::Seen { number: 1 }),
    ]
}

fn from_board() -> Vec<(&'static str, FromBoard<'static>)> {
    let capabilities =
        Capabilities { stamps: true, gate_watched: true, inputs: inputs(), ..Capabilities::default() };
    let greeting = Greeting {
        version: VERSION,
        session: 7,
        firmware: [0, 1, 0],
        source: [0xAB; 8],
        board: 1,
        id: *b"example\0",
        tick_ns: 1_000_000,
        segments: 384,
        rows: 2048,
        capabilities,
        configuration: None,
        reset: Reset::PowerUp,
        tick: 60,
        nonce: 2,
    };
    let configured = Configured {
        crc: 0x1234_5678,
        tick: 61,
        law: 0x0BAD_CAFE,
        home: None,
        heat: None,
        shut_ticks: u32::MAX,
    };
    let record = FaultRecord {
        fault: Fault::EncoderJumped,
        number: 1,
        tick: 66,
        joint: Some(Joint::Pan),
        exceeded: Some(Exceeded { value: 12.5, bound: 1.5 }),
    };
    vec![
        ("Hello", FromBoard::Hello(greeting)),
        ("Configured", FromBoard::Configured(Ok(configured))),
        (
            "Configured, refused",
            FromBoard::Configured(Err(WrongConfiguration::Word { word: 50, bits: f32::NAN.to_bits() })),
        ),
        ("Fault", FromBoard::Fault(record)),
        ("Log", FromBoard::Log("the lid is open")),
        ("Pong", FromBoard::Pong { host_us: 1_000_000, tick: 65, tick_us: 420 }),
    ]
}

/// Two rows: one that is armed, one in which it is lit.
fn rows() -> [Row; 2] {
    let sensed = Sensed {
        encoders: PanTilt::new(
            Measurement { count: 65, edge_age_ticks: Some(0.25) },
            Measurement { count: -33, edge_age_ticks: None },
        ),
        laser_on: Some(false),
        inputs: inputs(),
        lasted_ticks: Some(1.0),
        ..Sensed::default()
    };
    let mut darkness = DarknessSet::default();
    darkness.insert_if(true, Darkness::Planned);
    let dark = Row {
        sensed: as_told(&sensed),
        plan_tick: 39,
        actuation: Actuation { command_v: PanTilt::new(0.75, -1.9), gate: false, enable: true },
        darkness,
        phase: Phase::Tracing,
        homed: true,
        taken: 2,
        heard: true,
        ..Row::default()
    };
    let lit = Row {
        plan_tick: 40,
        actuation: Actuation { gate: true, ..dark.actuation },
        darkness: DarknessSet::default(),
        taken: 0,
        heard: false,
        ..dark
    };
    [dark, lit]
}

fn hex(body: &[u8]) -> String {
    let mut out = [0; MOST_PACKET];
    let length = packed(body, &mut out);
    let mut text = String::new();
    out[..length].iter().for_each(|byte| write!(text, "{byte:02x}").unwrap());
    text
}

/// The bodies of the packets in hexadecimal digits.
fn bodies(digits: &str) -> Vec<Vec<u8>> {
    let mut packets = Packets::new();
    let bytes = (0..digits.len() / 2).map(|at| u8::from_str_radix(&digits[2 * at..][..2], 16).unwrap());
    bytes.filter_map(|byte| packets.push(byte).map(<[u8]>::to_vec)).collect()
}

fn examples() -> Vec<(String, String)> {
    let told = rows().map(|row| row.told());
    let (body, _) = Rows::body(CONNECTION, &HEADER, &told);
    let to = to_board()
        .into_iter()
        .map(|(name, said)| (format!("host: {name}"), hex(said.body(CONNECTION).bytes())));
    let from = from_board()
        .into_iter()
        .map(|(name, said)| (format!("board: {name}"), hex(said.body(CONNECTION).bytes())));
    to.chain(from).chain([("board: Rows".to_owned(), hex(body.bytes()))]).collect()
}

#[test]
fn the_page_on_the_wire_has_a_frame_of_each_kind_as_it_is_made() {
    let path = support::root().join("docs/wire-format.md");
    let page = std::fs::read_to_string(&path).unwrap();
    let mut table = "| packet | bytes |\n|---|---|\n".to_owned();
    examples().iter().for_each(|(name, digits)| writeln!(table, "| {name} | `{digits}` |").unwrap());
    let (before, rest) = page.split_once("<!-- packets -->\n").unwrap();
    let (_, after) = rest.split_once("<!-- end -->").unwrap();
    let new = format!("{before}<!-- packets -->\n{table}<!-- end -->{after}");
    if std::env::var_os("RENEW_DOCS").is_none() {
        assert_eq!(new, page, "RENEW_DOCS=1 prints it anew");
    } else if new != page {
        std::fs::write(path, new).unwrap();
    }
}

#[test]
fn every_frame_on_the_page_is_read_as_what_it_says() {
    let page = std::fs::read_to_string(support::root().join("docs/wire-format.md")).unwrap();
    let lines: Vec<(&str, &str)> = page
        .lines()
        .filter_map(|line| line.strip_prefix("| ")?.strip_suffix("` |")?.split_once(" | `"))
        .filter(|(name, _)| name.starts_with("host: ") || name.starts_with("board: "))
        .collect();
    assert_eq!(lines.len(), examples().len());
    let (to, from) = (to_board(), from_board());
    for (name, digits) in lines {
        let bodies = bodies(digits);
        assert_eq!(bodies.len(), 1, "{name}");
        if let Some(name) = name.strip_prefix("host: ") {
            let said = to.iter().find(|(of, _)| *of == name).unwrap().1;
            assert_eq!(ToBoard::read(&bodies[0]).map(|(said, _)| said), Some(said), "{name}");
        } else if name == "board: Rows" {
            let Some((FromBoard::Rows(read), CONNECTION)) = FromBoard::read(&bodies[0]) else {
                panic!("no rows")
            };
            let RowsHeader { first_tick, wanted, free, .. } = read.header;
            assert_eq!((first_tick, wanted, free), (65, 2, 380));
            assert!(read.rows(inputs()).eq((65..).zip(rows())));
            assert_eq!(rows().map(|row| row.told()).map(|told: RowBytes| told.bytes().len()), [32, 32]);
        } else {
            let said = from.iter().find(|(of, _)| Some(*of) == name.strip_prefix("board: ")).unwrap().1;
            assert_eq!(FromBoard::read(&bodies[0]).map(|(said, _)| said), Some(said), "{name}");
        }
    }
}
