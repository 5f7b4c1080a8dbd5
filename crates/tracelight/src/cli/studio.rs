//! The page in a browser: a server over the other commands.

use std::io::IsTerminal as _;
use std::path::{Path, PathBuf};

use clap::Args;
use serde_json::{Value, json};
use tracelight_camera::{Source, named_devices, shown};
use tracelight_files as files;
use tracelight_operator::{self as operator, Bar};
use tracelight_port::{At, Speaks, ask, examine};
use tracelight_sim::RigConfig;
use tracelight_studio::{Camera, Head, Invitation, Performed, Program, Seat, open};
use tracelight_task::{Failure, Progress, Stop, Task};

use crate::cli::answer::{Answer, LooksFor, PerformsWith, Voice};
use crate::cli::trace;
use crate::named;
use tracelight_flags::served;

/// Open the studio: a page in the browser where a picture is placed on the wall, planned and traced on the simulated rig
///
/// The page is served to this computer alone, until Ctrl-C, and with --lan to devices of the network that are invited, such as a phone at the wall. Whatever it does is a
/// command line, which it shows; its pictures and runs lie in a folder.
#[derive(Args, Debug)]
#[command(
    after_help = "Examples: tracelight studio\n          tracelight studio examples/sign.svg --folder out/studio --no-open\n          tracelight studio --lan\n          tracelight studio --rig /dev/ttyACM0:my-head.toml"
)]
pub(crate) struct StudioArgs {
    /// A picture or a drawing to begin with
    picture: Option<String>,
    /// Port of this computer at which the page is; 0 takes any that is free
    #[arg(long, value_name = "N", default_value_t = 4460)]
    port: u16,
    /// The head that Run draws with, as of trace: a rig file, emulated or emulated:RIG, or the head at a board's port, PORT:RIG, which has to be homed. Trace it
    /// simulates that head [default: the preset report, simulated]
    #[arg(long, value_name = "RIG.toml|PRESET|PORT")]
    rig: Option<String>,
    /// Camera that Cameras shows beside those that are plugged in, as of trace: http://… of one on the net, a film, a folder of images
    #[arg(long, value_name = "SOURCE")]
    camera: Option<String>,
    /// Let devices of the network in that are invited, such as a phone, by https at the next port; a code for the first one's camera is printed
    #[arg(long)]
    lan: bool,
    /// Folder of its pictures and runs, which is made [default: Tracelight in the home folder]
    #[arg(long, value_name = "DIR")]
    folder: Option<PathBuf>,
    /// Do not open a browser
    #[arg(long)]
    no_open: bool,
    /// How long, such as 30s [default: until Ctrl-C]
    #[arg(long = "for", value_name = "TIME", value_parser = served)]
    lasts_s: Option<f64>,
    #[command(flatten)]
    pub(crate) voice: Voice,
}

/// Somebody at a page who attends a job.
struct Attended<'a>(&'a dyn Seat);

impl operator::Seat for Attended<'_> {
    fn wish(&self) -> Option<operator::Wish> {
        self.0.wish().and_then(|word| operator::Wish::read(&word))
    }

    fn tell(&self, event: &Value) {
        self.0.tell(event);
    }
}

/// The commands that the page has done.
struct Commands {
    performs: PerformsWith,
    looks: LooksFor,
    head: Option<Head>,
    /// The camera that was named, by the value of `--camera`.
    camera: Option<String>,
}

impl Program for Commands {
    fn rigs(&self) -> Vec<String> {
        RigConfig::presets().into_iter().map(|preset| preset.name).collect()
    }

    fn head(&self) -> Option<&Head> {
        self.head.as_ref()
    }

    fn cameras(&self) -> Vec<Camera> {
        let named = self.camera.iter().map(|source| Camera {
            id: "named".to_owned(),
            name: shown(source),
            source: source.clone(),
        });
        let plugged = named_devices().into_iter().filter_map(|(path, name)| {
            let id = path.file_name()?.to_str()?.to_owned();
            Some(Camera { id, name, source: path.to_str()?.to_owned() })
        });
        let plugged: Vec<Camera> = plugged.collect();
        // one that is plugged in, too, is one camera
        let named: Vec<Camera> =
            named.filter(|named| plugged.iter().all(|camera| camera.source != named.source)).collect();
        plugged.into_iter().chain(named).collect()
    }

    fn look(
        &self,
        arguments: &[String],
        stop: &Stop,
        each: &mut dyn FnMut(Vec<u8>, Value) -> bool,
    ) -> Result<(), Failure> {
        (self.looks)(arguments, stop, each)
    }

    fn knows(&self, wish: &str) -> bool {
        operator::Wish::read(wish).is_some()
    }

    fn perform(
        &self,
        arguments: &[String],
        seat: Option<&dyn Seat>,
        (progress, stop): (&dyn Progress, &Stop),
    ) -> Result<Performed, Failure> {
        let attended = seat.map(Attended);
        let seat = attended.as_ref().map(|attended| attended as &dyn operator::Seat);
        let Answer { json, text, failure } = (self.performs)(arguments, seat, Task { progress, stop })?;
        Ok(Performed { json, text, failure })
    }
}

pub(crate) fn run(
    args: &StudioArgs,
    (performs, looks): (PerformsWith, LooksFor),
    stop: &Stop,
) -> Result<Answer, Failure> {
    let bar = Bar::new(args.voice.quiet);
    let folder = folder(args.folder.as_deref())?;
    let head = args.rig.as_deref().map(|name| head(name, &bar, stop)).transpose()?;
    let camera = args.camera.as_deref().map(camera).transpose()?;
    let commands = Commands { performs, looks, head, camera };
    let studio = open(args.port, args.lan, &folder, Box::new(commands))?;
    let mut address = studio.address();
    if let Some(path) = &args.picture {
        let id = studio.add(path, &files::read(path)?)?;
        address.push_str(&format!("#picture={id}"));
    }
    bar.say(&format!("the studio is at {address}: Ctrl-C ends it"));
    if let Some(invitation) = studio.invite()? {
        invited(&bar, &invitation);
    }
    if !args.no_open {
        trace::open(Path::new(&address));
    }
    studio.serve(args.lasts_s, stop)?;
    let json = json!({ "address": address, "folder": folder });
    Ok(Answer::new(
        format!("the studio is closed; its pictures and runs are in {}", folder.display()),
        json.to_string(),
    ))
}

/// The head that the studio is opened for. Of a board that cannot be asked now it is taken that its light is real.
///
/// # Errors
/// What is wrong with its name or its file.
fn head(name: &str, bar: &Bar, stop: &Stop) -> Result<Head, Failure> {
    let draws_as = named::from_root(name);
    let (_, at) = named::rig_or_port(&draws_as)?;
    let planned_as = named::head_at_port(&draws_as).unwrap_or(&draws_as).to_owned();
    let is_real = at.as_ref().is_some_and(|at| match wants_a_person(at, stop) {
        Ok(wants) => wants,
        Err(failure) => {
            bar.say(&format!("note: {}; a head that is real is taken to be there", failure.message));
            true
        }
    });
    Ok(Head { draws_as, planned_as, is_at_port: at.is_some(), is_real })
}

/// Whether a person must arm the head at a port.
fn wants_a_person(at: &At, stop: &Stop) -> Result<bool, Failure> {
    match at.speaks {
        Speaks::Wire => examine(at.port.as_ref(), stop).map(|examined| examined.board.wants_a_person()),
        Speaks::Grbl => ask(&at.port, stop).map(|board| !board.is_simulated()),
    }
}

/// The camera that is named, from the root: it is asked for from other folders.
///
/// # Errors
/// `usage` of what is none; of a simulated one, which is there anyway.
fn camera(name: &str) -> Result<String, Failure> {
    match Source::of(name)? {
        Source::Simulated(_) => {
            let message =
                format!("--camera {name}: the simulated room is in the studio anyway; name a real camera");
            Err(Failure::usage("usage", message))
        }
        Source::Film(path) | Source::Files(path) => {
            let path = std::path::absolute(path).unwrap_or_else(|_| path.into());
            Ok(path.to_string_lossy().into_owned())
        }
        // whatever link names it
        Source::Device(path) => {
            let real = std::fs::canonicalize(path).unwrap_or_else(|_| path.into());
            Ok(real.to_string_lossy().into_owned())
        }
        Source::Net(_) => Ok(name.to_owned()),
    }
}

/// Says how a phone joins.
fn invited(bar: &Bar, Invitation { link, code, fingerprint }: &Invitation) {
    if std::io::stderr().is_terminal() {
        bar.say(code);
    }
    bar.say(&format!(
        "a phone joins by {link} within ten minutes, once, and may operate the head; the page has more invitations under Devices"
    ));
    bar.say(&format!("it asks whether to trust this computer, whose certificate is {fingerprint}"));
}

/// The folder that was given, or one in the home folder.
fn folder(given: Option<&Path>) -> Result<PathBuf, Failure> {
    let home = || std::env::home_dir().map(|home| home.join("Tracelight"));
    let unknown = || {
        Failure::usage(
            "usage",
            "there is no home folder for the studio's pictures and runs: say where they go with --folder DIR",
        )
    };
    given.map(Path::to_owned).or_else(home).ok_or_else(unknown)
}
