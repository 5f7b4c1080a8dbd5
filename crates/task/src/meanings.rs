//! What the codes of messages, faults and reasons for darkness mean, and what to do.

use tracelight_rig::{Darkness, Fault};

/// Codes of messages, with what they mean and what to do.
const MESSAGES: &[(&str, &str)] = &[
    (
        "not-a-log",
        "A file that should be a run log has no record of one. Give the run.mcap of a folder with results.",
    ),
    ("unreadable", "A file could not be opened or read. Check its name and permissions."),
    ("empty-file", "A file has no bytes. Save it again."),
    (
        "malformed",
        "A file is of a known kind but broken. The message says where; save it again from its source.",
    ),
    ("not-a-picture", "A file's first bytes are those of no picture or drawing that is known here."),
    ("unsupported", "A picture uses a part of its format that is not decoded here. Save it as PNG."),
    (
        "standing-light",
        "The light of a job would stand in one place for longer than it may, or come back to it too often; nothing was lit. Draw faster (--speed) or larger (--width). \
         How long it may stand is safety.standing in the rig file; left out, it follows from laser.power: 1 mJ, but a second at most.",
    ),
    ("too-large", "A picture has more pixels or bytes than are traced (100 megapixels). Scale it down."),
    (
        "no-strokes-found",
        "A picture was read, but has nothing to draw: no ink, no contrast, or only noise; or it looks like a photograph or a screenshot, not like a drawing (--force traces it all the same); or what was set by --threshold, --despeckle or --min-length leaves nothing. The message names the figure that failed and its bound.",
    ),
    (
        "usable",
        "The verdict on a picture that was traced although a figure of it is weak: strokes may be missing or wrong there. The verdict names the figure, its value, its bound and what to do; `good` is a picture without any.",
    ),
    (
        "size-not-meant",
        "By its file a drawing is larger than 100 m or smaller than 1 mm, which nobody means: its numbers are in another unit. Say which (--unit for a DXF, --dpi for an SVG in pixels) or how large it is to be (--width, --height).",
    ),
    ("no-strokes", "A drawing has no strokes to plan."),
    (
        "port",
        "A port to a board cannot be opened, or no pseudo-terminal made. The message says whether it is not there, may not be opened, or is another program's, and what to do.",
    ),
    (
        "board",
        "No board of Tracelight's answers at a port, or its line broke. See whether it has power, whether the cable holds, and whether Tracelight's program is loaded.",
    ),
    (
        "rig-gone",
        "A head does not answer any more: its cable is out, or its board lost power. The board darkens by itself. Put the cable in again, home the head if its board lost power, and go on with tracelight resume.",
    ),
    (
        "disarmed",
        "A head was disarmed while it drew, and not by this program: by `tracelight stop` in another terminal, or the connection to its board was interrupted. Go on with tracelight resume.",
    ),
    (
        "not-armed",
        "A real head is lit only after a person has armed it by the key A, and another key was pressed. Nothing was lit.",
    ),
    (
        "no-light",
        "A dot was asked for, and the head let no light out. The message names the reasons for darkness; each has its own explanation (tracelight explain host-silent).",
    ),
    (
        "stops",
        "The end stops of a head are not where they should be: it does not stop at the same place twice, not as far apart as its rig file's [homing] says, or within its range. See whether something is in its way; tracelight home --find-stops measures them on a head that is homed.",
    ),
    (
        "not-dark",
        "A head that another program drives was told to be dark, and its board did not say within a second that it is disarmed. Take its laser's power. The program may hang; its board is dark by itself within 50 ms then, but nobody has seen it.",
    ),
    (
        "no-stop",
        "A joint was turned as far as it may go without a zero, and came up against nothing. It has no end stop that way, or its range in the rig file is narrower than what it turns.",
    ),
    (
        "align",
        "The marks of --align do not say where the drawing goes: they lie too near each other or on one line, mirror it, or are in a unit that the drawing does not have. Choose marks near the corners of the drawing; a DXF and a CSV have coordinates of their own, pictures are measured in px from the top left.",
    ),
    (
        "corners",
        "The angles of `calibrate corners` are not those of a rectangle of that size: two corners are exchanged, one was pointed at wrongly, or width and height are. The message says which.",
    ),
    (
        "unreachable",
        "Part of the drawing cannot be lit from where the head stands. Make it smaller, shift it, or step back.",
    ),
    (
        "motor-too-weak",
        "Gravity and friction take more torque than a plan may use. See motion.torque_share in the rig file.",
    ),
    (
        "open-loop-rig",
        "The rig has no encoders (drive = \"stepper\" or \"servo\"), and what was asked needs some, or joints that are placed more finely than hobby servos do. Take a rig with drive = \"motor\".",
    ),
    ("too-long", "The job takes longer than a run may. Draw larger steps, faster, or in parts."),
    (
        "no-way-at-speed",
        "With --lit-speed exact every stroke is run up to and out of in the dark, at its speed, and there is no room for that: the way would leave a joint's range or the target. Lower --speed, move the picture away from the edge of what the head can reach, or let the spot rest at stroke ends (--lit-speed fastest).",
    ),
    (
        "too-bent",
        "With --lit-speed exact all that is lit is drawn at one speed, and a stroke bends so sharply that no speed is slow enough. Smooth the drawing, or let the spot slow down in bends (--lit-speed fastest).",
    ),
    (
        "speed-unreachable",
        "The speed asked for with --speed is reached nowhere on the drawing. The message names the best possible.",
    ),
    (
        "record",
        "A record to identify a head from is no table of consecutive control ticks. It has the columns t_s, pan_count, tilt_count, pan_v, tilt_v, a row a millisecond, as trace.csv does; the message names the line.",
    ),
    (
        "identify",
        "A joint moved too little to tell what it is made of. Give a longer record, of motion to and fro, or none: then the rig moves by itself.",
    ),
    (
        "amplifier-log",
        "A log of currents is no table of axis,volt,ampere and perhaps velocity_rad_s, axis being pan or tilt; the message names the line.",
    ),
    ("amplifier", "Readings of a current tell no amplifier. Give three at least, at different voltages."),
    (
        "backlash-log",
        "A log of where the spot rests is no table of axis,count,way,spot_m, axis being pan or tilt, way 1 or -1; the message names the line.",
    ),
    (
        "backlash",
        "Readings of where the spot rests tell no play. Give four at least, of places that were come to from both sides, in turns.",
    ),
    (
        "encoder-log",
        "A log of edges is no table of axis,time_s,count, axis being pan or tilt; the message names the line.",
    ),
    ("encoder", "A joint passed too few edges one way to tell where they lie. Turn it further."),
    (
        "frequency-log",
        "A log to tell a frequency response from is no table of axis,time_s,volt,count, a row a millisecond, of two periods at least; the message names the line.",
    ),
    (
        "relay",
        "A relay did not swing a joint evenly, so nothing is tuned from it. The message says why, and which of --level and --hysteresis helps.",
    ),
    (
        "not-yet",
        "An answer to a lesson's question was simulated, and some of its figures are not what they must be. The table names each with what helps; `tracelight lab lesson NUMBER` has the text, and -o mine.svg draws what your answer does.",
    ),
    (
        "motion-array",
        "A motion to simulate is no table of t,pan,tilt: seconds that rise, and angles within the joints' range; the message names the line.",
    ),
    (
        "friction-log",
        "A log to tell friction from is no table of axis,volt,time_s,count or of axis,torque_nm,velocity_rad_s, axis being pan or tilt; the message names the line.",
    ),
    (
        "friction",
        "A joint turned too little to tell its friction. Give more volts or more time, another --axis, or a --fixture in which gravity does not hold it.",
    ),
    (
        "rig-file",
        "A rig file is wrong. The message shows file, line and value, what is allowed and what to do. \
         A rig file has every key of [model], [truth.gyroscope], [truth.wear], [control], [motion], [laser] and [safety], as `tracelight rigs show report` prints them, or it begins with the line base = \"report\" (or another preset) and leaves out what is as there. drive = \"stepper\" or \"servo\" is a head without encoders; it has [stepper] or [servo] too. \
         Without that line a key that is missing is an error: the file was cut off. With it, nobody can tell. \
         These may be left out of any: keys of [model] under [truth], which are then as in [model]; [identified]; safety.standing, which follows from laser.power; safety.park_pan and safety.park_tilt, for a head that stays where it is; name, description. \
         A file older than some keys is read with a note that says which; `tracelight rigs show FILE` prints it with all of them.",
    ),
    (
        "camera-image",
        "Images of one camera have different sizes, or another than the lens file's. A lens holds for one size: take all images with the same setting.",
    ),
    (
        "no-camera",
        "A camera cannot be used. The message says why: none is plugged in there, you may not use it, another program does, or it sends nothing that is understood. `tracelight doctor` lists what is there.",
    ),
    (
        "not-a-camera",
        "A video device sends no images: webcams often have a second one for what else they know, and processors have some for coding. `tracelight doctor` lists those that are cameras.",
    ),
    (
        "no-image",
        "A camera sends no image, or only broken ones. The message says which; look at its plug, cable and switch, and whether another program uses it.",
    ),
    (
        "camera-not-found",
        "The printed markers of an image tell no camera. The message says why: none in sight, pages that no image links, or pages that do not lie on one plane.",
    ),
    (
        "spot-off",
        "While it drew the spot was seen elsewhere than it should be, and why could not be told or mended: the laser is dark. Keep camera and head still, hang pages of markers where the camera sees them, and draw again.",
    ),
    (
        "head-not-found",
        "The dots that a head drew, or lit here and there, do not tell where it stands. The message says what was seen of them. See that the laser is on, that the camera's view of the wall is free and holds markers, and that the head faces the wall.",
    ),
    (
        "camera-file",
        "A camera file is not one, or holds numbers that no camera has. Write it again with `tracelight calibrate`.",
    ),
    (
        "marks-not-found",
        "A ruler picture does not show two marks. Use two dark tapes across a light ruler, or the reverse.",
    ),
    (
        "pictures-failed",
        "Some pictures of a batch failed, the others are done. The table says why each of them did; the same command again goes on with those that are left.",
    ),
    ("internal", "The program made a mistake on a picture. Please report it, with the picture."),
    (
        "bad-formula",
        "A transfer function could not be read; the message points at the place. `tracelight lab bode --help` says how it is written.",
    ),
    (
        "no-such-system",
        "A system cannot be had that way: one that has more zeros than poles, or that is already sampled, or a loop that closes on nothing.",
    ),
    (
        "no-such-design",
        "No controller of that kind does what was asked of that system. Ask for less margin or another crossover, or use another method.",
    ),
    (
        "no-such-gain",
        "No gain does what was asked, or all large ones do. Ask for another damping, give a --gain, or change the loop.",
    ),
    (
        "no-linear-model",
        "A head could not be linearized: its masses or its friction are no numbers that move. Check the rig file.",
    ),
    ("cannot-write", "A result could not be written. Check the folder, its permissions and the free space."),
    (
        "usage",
        "The command line is wrong: a command, a flag or a value that there is not, or one too many, or too few. The message says which, and what to type instead. `tracelight COMMAND --help` lists a command's flags with their units, and ends with an example; `tracelight --help` lists the commands. Quantities have units (24in, 0.6m, 15deg, 1ft/s). With --json the same is said as {\"error\": {\"code\", \"message\", \"where\", \"help\", \"exit\"}}. The exit status is 2.",
    ),
    (
        "certificate",
        "The studio's certificate for its network, or the key to it, cannot be read. Delete both files that the message names: they are made anew, and devices ask once more whether to trust them.",
    ),
    (
        "too-slow",
        "What is sent to the studio has to come without long pauses. Look at the network, or bring the device nearer to its access point, and send it again.",
    ),
    (
        "not-invited",
        "A device of the network asks the studio without having joined. Open Devices on the studio's own computer, choose what the device may do, and read the code with its camera. A code is for one device, and holds ten minutes; after the studio was started anew, devices join anew.",
    ),
    (
        "not-allowed",
        "Who asks may not do that: a device that looks on may stop, and nothing else; pages of other servers may nothing. Open Devices on the studio's own computer for an invitation to operate.",
    ),
    (
        "not-a-run",
        "A folder holds no job.toml, or a damaged one, so it is no folder of a run. `tracelight runs` lists those that are. The exit status is 2.",
    ),
    (
        "changed",
        "A run is not gone on with, as something it was read from is not what it was: a file changed or is gone, or this version of the program draws other strokes. Put the old file back, use the old version, or begin anew.",
    ),
    (
        "cannot-resume",
        "A run that a camera followed, that went from stroke to stroke, that was to be drawn several times, that another run went on with, or whose picture came from standard input, is not gone on with. Begin anew, where it helps with --from-stroke. The exit status is 2.",
    ),
    (
        "unfinished",
        "The run was given up: it took far longer than its plan, holding again and again. The report shows where.",
    ),
    (
        "interrupted",
        "Ctrl-C: the laser was darkened, then the log closed. A batch keeps what is done; the same command goes on.",
    ),
];

/// What a code means, and what to do.
#[must_use]
pub fn meaning(code: &str) -> Option<String> {
    codes().into_iter().find(|(known, _)| *known == code).map(|(_, words)| words)
}

/// All codes, with what they mean and what to do.
#[must_use]
pub fn codes() -> Vec<(&'static str, String)> {
    let own = MESSAGES.iter().map(|&(code, words)| (code, words.to_owned()));
    let faults = Fault::ALL.map(|fault| (fault.code(), fault.words().to_owned()));
    let darkness = Darkness::TABLE.map(|row| (row.code, format!("{} {}", row.words, row.advice)));
    own.chain(faults).chain(darkness).collect()
}
