//! The run log: everything measured, tick by tick, in a form that outlives the program.
//!
//! While the run goes on, each tick's messages go to the file bare and at once, so a killed program loses nothing it
//! had been handed: readers take such a file to its last whole record. When the run ends, the file is copied into
//! chunks with an index, which viewers can seek in, and takes the first one's place in one rename.

mod protobuf;
mod schema;

use std::collections::BTreeMap;
use std::io::{BufReader, Read, Seek, Write};

use mcap::records::{MessageHeader, Metadata};
use mcap::sans_io::LinearReaderOptions;
use mcap::{McapResult, WriteOptions, Writer};
use tracelight_sim::Tick;
use tracelight_trajectory::PlanPoint;

use self::protobuf::{Encoder, descriptor_set};
use self::schema::time_ns;
use crate::events::{Change, Watch};
use crate::finished::Setting;
use crate::sample::Sample;

/// What is known before the first tick; it becomes the log's metadata record `tracelight`.
pub struct LogMeta<'a> {
    /// The picture's file as the user named it.
    pub picture_path: &'a str,
    /// What the job was asked to do.
    pub settings: &'a [Setting],
    /// Seed of the run.
    pub seed: u64,
}

/// Writes `run.mcap` while the run goes on.
///
/// Dropping it without [`finish`](Self::finish) leaves a log that is complete but for its index.
pub struct LogWriter<W: Write + Seek> {
    writer: Writer<W>,
    channels: Channels,
    message: Encoder,
    watch: Watch,
    clock: Clock,
}

/// The log's time: ticks that start again with every lap, laid end to end.
#[derive(Clone, Copy, Default)]
struct Clock {
    /// Laps before this one.
    laps: u32,
    /// Where this one began.
    lap_began: u64,
    /// The tick after the last; `None` before the first.
    next: Option<u64>,
}

/// Numbers of the log's channels.
struct Channels {
    telemetry: u16,
    spot: u16,
    plan: u16,
    faults: u16,
}

/// Longest record of a log that is read, bytes: what is longer is none of ours.
const LONGEST_RECORD: usize = 1 << 24;
/// Size of a finished log's chunks: a few seconds of ticks each.
const CHUNK_BYTES: u64 = 1 << 20;

impl<W: Write + Seek> LogWriter<W> {
    /// Begins a log.
    ///
    /// # Errors
    /// What `out` says.
    pub fn begin(out: W, meta: &LogMeta<'_>) -> McapResult<Self> {
        let mut writer = options().use_chunks(false).create(out)?;
        writer.write_metadata(&metadata(meta))?;
        let channels = Channels::declare(&mut writer)?;
        writer.flush()?;
        Ok(Self {
            writer,
            channels,
            message: Encoder::default(),
            watch: Watch::default(),
            clock: Clock::default(),
        })
    }

    /// Appends a tick and the point of the plan it follows; both are in the file when this returns. Laps follow each
    /// other in one log: where the ticks start again, the log's time goes on.
    ///
    /// # Errors
    /// What the file says.
    pub fn append(&mut self, tick: &Tick, planned: &PlanPoint) -> McapResult<()> {
        let sample = &Sample::new(tick, planned);
        let tick = self.clock.at(sample.tick.telemetry.tick);
        let lap = self.clock.laps + 1;
        self.send(self.channels.telemetry, tick, |out| schema::telemetry(out, sample, lap))?;
        self.send(self.channels.spot, tick, |out| schema::spot(out, sample))?;
        self.send(self.channels.plan, tick, |out| schema::plan(out, sample.planned))?;
        match self.watch.push(&sample.tick.telemetry) {
            Change::Began(event) | Change::Became(_, event) => {
                self.send(self.channels.faults, tick, |out| schema::fault(out, &event, tick))?;
            }
            Change::None | Change::Ended(_) => {}
        }
        self.writer.flush()
    }

    fn send(&mut self, channel_id: u16, tick: u64, fill: impl FnOnce(&mut Encoder)) -> McapResult<()> {
        let time = time_ns(tick);
        let header = MessageHeader { channel_id, sequence: tick as u32, log_time: time, publish_time: time };
        self.message.clear();
        fill(&mut self.message);
        self.writer.write_to_known_channel(&header, self.message.bytes())
    }

    /// Closes the log: whole, and not indexed yet.
    ///
    /// # Errors
    /// What the file says.
    pub fn finish(mut self) -> McapResult<()> {
        self.writer.finish().map(drop)
    }
}

impl Clock {
    /// The log's tick for a lap's; a number that goes back begins the next lap.
    fn at(&mut self, tick: u32) -> u64 {
        let mut now = self.lap_began + u64::from(tick);
        if let Some(next) = self.next.filter(|&next| now < next) {
            self.laps += 1;
            self.lap_began = next;
            now = next + u64::from(tick);
        }
        self.next = Some(now + 1);
        now
    }
}

impl Channels {
    fn declare<W: Write + Seek>(writer: &mut Writer<W>) -> McapResult<Self> {
        let own = descriptor_set(&[&schema::TRACELIGHT]);
        let log = descriptor_set(&[&schema::TIMESTAMP, &schema::FOXGLOVE_LOG]);
        let mut channel = |topic: &str, schema: &str, descriptor: &[u8]| {
            let schema = writer.add_schema(schema, "protobuf", descriptor)?;
            writer.add_channel(schema, topic, "protobuf", &BTreeMap::new())
        };
        Ok(Self {
            telemetry: channel("/telemetry", "tracelight.Telemetry", &own)?,
            spot: channel("/spot", "tracelight.Spot", &own)?,
            plan: channel("/plan", "tracelight.Plan", &own)?,
            faults: channel("/faults", "foxglove.Log", &log)?,
        })
    }
}

fn options() -> WriteOptions {
    WriteOptions::new()
        .library(concat!("tracelight ", env!("CARGO_PKG_VERSION")))
        .chunk_size(Some(CHUNK_BYTES))
}

/// Copies a closed log into an indexed one, record by record.
///
/// # Errors
/// What either of them says.
pub fn index(bare: impl Read + Seek, indexed: impl Write + Seek) -> McapResult<()> {
    let options = LinearReaderOptions::default().with_record_length_limit(LONGEST_RECORD);
    match copy(bare, indexed, options)? {
        (_, Some(error)) => Err(error),
        (_, None) => Ok(()),
    }
}

/// What was found of a log that was never closed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Recovered {
    /// Whole messages.
    pub messages: u64,
    /// Something follows the last of them that is no whole record: the program was killed while it wrote.
    pub torn: bool,
}

/// Copies all whole records of a log that was never closed into an indexed one.
///
/// # Errors
/// What either of them says; of the first one only before its first message.
pub fn recover(bare: impl Read + Seek, indexed: impl Write + Seek) -> McapResult<Recovered> {
    let options =
        LinearReaderOptions::default().with_skip_end_magic(true).with_record_length_limit(LONGEST_RECORD);
    match copy(bare, indexed, options)? {
        (0, Some(error)) => Err(error),
        (messages, torn) => Ok(Recovered { messages, torn: torn.is_some() }),
    }
}

/// Copies records until one cannot be read: how many messages, and why that one could not.
fn copy(
    mut bare: impl Read + Seek,
    indexed: impl Write + Seek,
    options: LinearReaderOptions,
) -> McapResult<(u64, Option<mcap::McapError>)> {
    let mut writer = self::options().create(indexed)?;
    for metadata in metadata_of(&mut bare)? {
        writer.write_metadata(&metadata)?;
    }
    bare.rewind()?;
    let (mut messages, mut unread) = (0, None);
    for message in mcap::io::MessageReader::new_with_options(BufReader::new(bare), options) {
        match message {
            Ok(message) => writer.write(&message)?,
            Err(error) => {
                unread = Some(error);
                break;
            }
        }
        messages += 1;
    }
    writer.finish()?;
    Ok((messages, unread))
}

/// The metadata records of a log.
fn metadata_of(log: &mut impl Read) -> McapResult<Vec<Metadata>> {
    let mut reader = mcap::sans_io::LinearReader::new();
    let mut log = BufReader::new(log);
    let mut found = Vec::new();
    while let Some(event) = reader.next_event() {
        match event? {
            mcap::sans_io::LinearReadEvent::ReadRequest(wanted) => {
                let got = log.read(reader.insert(wanted))?;
                reader.notify_read(got);
            }
            mcap::sans_io::LinearReadEvent::Record { data, opcode } => {
                match mcap::parse_record(opcode, data)? {
                    mcap::records::Record::Metadata(record) => found.push(record),
                    mcap::records::Record::Message { .. } => break, // all of it stands before the first tick
                    _ => {}
                }
            }
        }
    }
    Ok(found)
}

fn metadata(meta: &LogMeta<'_>) -> Metadata {
    let own = [
        ("picture", meta.picture_path.to_owned()),
        ("seed", meta.seed.to_string()),
        ("version", env!("CARGO_PKG_VERSION").to_owned()),
    ];
    let settings = meta.settings.iter().map(|s| (s.name.clone(), s.value.clone()));
    // a setting of the same name does not hide what the log itself says
    let metadata = settings.chain(own.map(|(name, value)| (name.to_owned(), value))).collect();
    Metadata { name: "tracelight".to_owned(), metadata }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;
    use std::fs::File;
    use std::io::BufWriter;
    use std::path::{Path, PathBuf};
    use std::sync::atomic::{AtomicU32, Ordering};
    use tracelight_rig::Fault;

    fn file(name: &str) -> PathBuf {
        static NUMBER: AtomicU32 = AtomicU32::new(0);
        let number = NUMBER.fetch_add(1, Ordering::Relaxed);
        std::env::temp_dir().join(format!("tracelight-{}-{number}-{name}.mcap", std::process::id()))
    }

    fn begun(path: &Path, ticks: usize) -> (LogWriter<BufWriter<File>>, fixture::Fixture) {
        let fixture = fixture::star();
        let meta = LogMeta { picture_path: "star.png", settings: &fixture.settings, seed: 7 };
        let mut log = LogWriter::begin(BufWriter::new(File::create(path).unwrap()), &meta).unwrap();
        for (tick, planned) in fixture.run.ticks.iter().zip(&fixture.plan.points).take(ticks) {
            log.append(tick, planned).unwrap();
        }
        (log, fixture)
    }

    /// A log that was closed and indexed.
    fn finished(log: LogWriter<BufWriter<File>>, path: &Path) -> Vec<u8> {
        log.finish().unwrap();
        let mut indexed = std::io::Cursor::new(Vec::new());
        index(File::open(path).unwrap(), &mut indexed).unwrap();
        indexed.into_inner()
    }

    /// Messages on a topic, until the file ends, however it ends.
    fn count(bytes: &[u8], topic: &str) -> usize {
        let messages =
            mcap::MessageStream::new_with_options(bytes, mcap::read::Options::IgnoreEndMagic.into()).unwrap();
        messages.map_while(Result::ok).filter(|m| m.channel.topic == topic).count()
    }

    /// Doubles of a message's fields by number, one level deep.
    fn double_field(data: &[u8], number: u8) -> f64 {
        let key = number << 3 | 1;
        let at = data.iter().position(|&b| b == key).unwrap(); // the asked-for field stands first
        f64::from_le_bytes(data[at + 1..at + 9].try_into().unwrap())
    }

    #[test]
    fn a_finished_log_is_whole_indexed_and_true() {
        let path = file("finished");
        let (log, fixture) = begun(&path, 3000);
        let bytes = finished(log, &path);
        let summary = mcap::Summary::read(&bytes).unwrap().unwrap();
        assert!(!summary.chunk_indexes.is_empty());
        assert_eq!(summary.stats.unwrap().message_count, 9000);
        let metadata = mcap::read::metadata(&bytes, &summary.metadata_indexes[0]).unwrap();
        assert_eq!(
            (metadata.metadata["seed"].as_str(), metadata.metadata["profile"].as_str()),
            ("7", "s-curve")
        );
        let spots = mcap::MessageStream::new(&bytes).unwrap().map(Result::unwrap);
        let spots: Vec<_> = spots.filter(|m| m.channel.topic == "/spot").collect();
        assert_eq!(spots.len(), 3000);
        assert_eq!(spots[1234].log_time, 1_234_000_000);
        assert_eq!(double_field(&spots[1234].data, 1), fixture.run.ticks[1234].spot.unwrap().x);
        std::fs::remove_file(&path).unwrap();
    }

    #[test]
    fn a_log_that_was_never_closed_is_made_whole_wherever_it_ends() {
        let path = file("recovered");
        let (log, _) = begun(&path, 300);
        let bytes = std::fs::read(&path).unwrap();
        drop(log);
        let recovered = |bytes: &[u8]| {
            let mut indexed = std::io::Cursor::new(Vec::new());
            let found = recover(std::io::Cursor::new(bytes), &mut indexed)?;
            // whole to the strictest reader
            let all = mcap::MessageStream::new(indexed.get_ref()).unwrap().map(Result::unwrap).count();
            assert_eq!(all as u64, found.messages);
            assert!(mcap::Summary::read(indexed.get_ref()).unwrap().is_some());
            McapResult::Ok(found)
        };
        let whole = recovered(&bytes).unwrap();
        assert!(!whole.torn && whole.messages >= 900, "{whole:?}");
        for cut in 1..200 {
            let found = recovered(&bytes[..bytes.len() - cut]).unwrap();
            assert!(found.messages < whole.messages && found.messages + 4 > whole.messages, "{found:?}");
        }
        assert!(recovered(b"no log at all").is_err() && recovered(b"").is_err());
        // a record that says it is longer than any
        let mut wild = bytes[..bytes.len() / 2].to_vec();
        wild.extend([5, 255, 255, 255, 255, 255, 255, 255, 127]);
        assert!(recovered(&wild).unwrap().torn);
        std::fs::remove_file(&path).unwrap();
    }

    #[test]
    fn a_killed_program_leaves_every_tick() {
        let path = file("killed");
        let (log, _) = begun(&path, 777);
        let bytes = std::fs::read(&path).unwrap(); // as a kill would leave it
        for topic in ["/telemetry", "/spot", "/plan"] {
            assert_eq!(count(&bytes, topic), 777, "{topic}");
        }
        drop(log);
        std::fs::remove_file(&path).unwrap();
    }

    #[test]
    fn a_log_cut_anywhere_is_read_up_to_the_cut() {
        let path = file("cut");
        let (log, _) = begun(&path, 200);
        let bytes = std::fs::read(&path).unwrap();
        let mut before = 0;
        for length in (bytes.len() / 2..bytes.len()).step_by(97) {
            let ticks = count(&bytes[..length], "/telemetry");
            assert!(ticks >= before && ticks <= 200);
            before = ticks;
        }
        assert!(before >= 199, "{before}");
        drop(log);
        std::fs::remove_file(&path).unwrap();
    }

    #[test]
    fn a_fault_is_a_line_in_the_log() {
        let path = file("fault");
        let (mut log, fixture) = begun(&path, 10);
        let mut tick = fixture.run.ticks[10];
        tick.telemetry.latched = fixture::latched(Fault::EncoderJumped);
        log.append(&tick, &fixture.plan.points[10]).unwrap();
        log.append(&tick, &fixture.plan.points[11]).unwrap();
        let bytes = finished(log, &path);
        assert_eq!(count(&bytes, "/faults"), 1);
        assert!(bytes.windows(14).any(|w| w == b"encoder-jumped"));
        std::fs::remove_file(&path).unwrap();
    }

    #[test]
    fn laps_follow_each_other_in_time() {
        let path = file("laps");
        let (mut log, fixture) = begun(&path, 40);
        for tick in &fixture.run.ticks[..40] {
            log.append(tick, &fixture.plan.points[0]).unwrap();
        }
        let bytes = finished(log, &path);
        let spots = mcap::MessageStream::new(&bytes).unwrap().map(Result::unwrap);
        let times: Vec<_> = spots.filter(|m| m.channel.topic == "/spot").map(|m| m.log_time).collect();
        assert!(times.iter().copied().eq((0..80).map(|i| i * 1_000_000)), "{times:?}");
        std::fs::remove_file(&path).unwrap();
    }

    #[test]
    fn equal_runs_give_equal_logs() {
        let logs = [file("one"), file("two")].map(|path| {
            let bytes = finished(begun(&path, 500).0, &path);
            std::fs::remove_file(&path).unwrap();
            bytes
        });
        assert!(logs[0] == logs[1]);
    }
}
