#!/usr/bin/env python3
"""Two programs held against each other: the same command lines, the same bytes.

    python bench/same/same.py OLD/tracelight target/release/tracelight [--only WORD] [--keep FOLDER] [--set NAME=VALUE]

Both run every command line below, each in a folder of its own that begins with copies of `examples/`; what a command writes, later
ones read. What is printed, how it ends, and every file left behind are compared byte by byte, apart from what tells the time: see
TIMES. Exit status 1, and the first lines that differ, where they do. Needs Python 3.10 alone. For a change that should move code and
change nothing.
"""

import argparse
import difflib
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]

# Written before anything runs.
FILES = {
    "path.csv": "t_s,pan_rad,tilt_rad\n" + "".join(f"{k / 100},{0.1 * k / 100},{-0.05 * k / 100}\n" for k in range(101)),
    "binary.toml": b"\xff\xfe\x00rig",
    "broken.csv": "axis,count,way,spot_m\npan,12,3,0.1\n",
    "own.toml": "base = \"report\"\nname = \"own\"  # a head of one's own\n",
    "torques.csv": "axis,torque_nm,velocity_rad_s\n" + "".join(f"tilt,{0.02 * way * k + 0.03 * way},{way * k}\n" for way in (1, -1) for k in (1, 2, 3, 5)),
    "amperes.csv": "axis,volt,ampere\n" + "".join(f"pan,{k / 4},{0.11 * k / 4 + 0.001 * (k % 2)}\n" for k in range(-8, 9)),
    "broken.toml": "name = \"x\"\n[model.pan.motor]\nlimit = 9\n",
    "broken.svg": "<svg xmlns=\"http://www.w3.org/2000/svg\"><path d=\"M 0 0 L\"",
    "mine.toml": "base = \"report\"\nname = \"mine\" # my own\n\n[control]\nlaw = \"pid\" # for now\n",
    "plan.svg": '<svg xmlns="http://www.w3.org/2000/svg" width="100mm" height="80mm" viewBox="0 0 100 80">'
    '<g id="a"><path d="M10 10 C 30 0 50 40 90 70" stroke="#ff0000" fill="none"/></g><circle cx="40" cy="40" r="20"/></svg>',
}

# A line each; `|` parts words that hold blanks.
COMMANDS = """
--version
--help
trace --help
lab --help
rigs
rigs --json
rigs show report
rigs show worn
rigs show stepper
explain following-error
explain nothing-of-this-name
completions bash
trace examples/house.png --width 24in --out house
trace examples/star.png --width 24in --out star --json
trace examples/shapes.png --rig worn --out worn --quiet
trace examples/star.png --rig stepper --out stepper
trace examples/star.png --rig servo --out servo --json
trace examples/chalk.png --dry-run --out dry
trace examples/house.png --law pid-ff --laps 2 --seed 3 --out laps --json
trace examples/star.png --lit-speed exact --rotate 15deg --offset 10cm,-5cm --out exact
trace examples/star.png --profile quintic --amax 20rad/s2 --out quintic --json
trace examples/star.png --amax 2m/s2
trace plan.svg --colour red --distance 2m --out svg
trace broken.svg --out broken
trace nowhere.png
trace examples/house.png --rig broken.toml
trace examples/house.png --rig binary.toml
trace examples/star.png --sim-unhomed --out unhomed
trace --camera sim:examples/house.png --out camera
trace --camera sim:examples/house.png --open-loop --out open
trace --camera sim:nowhere.png
trace --camera examples/ --out still --dry-run
trace --camera sim:examples/star.png --sim-trouble pan-slip=20@5 --seed 2 --out slip --json
trace examples/silhouette.png --width 30cm --out outline
strokes examples/handwriting.png --json
strokes examples/house.png -o house.svg
strokes examples/house.png -o house.dxf
strokes examples/house.png -o house.gcode
strokes examples/house.png -o house.hpgl
strokes examples/house.png -o house.ild
strokes examples/house.png -o house.json
strokes examples/house.png -o house.csv
strokes house.svg -o again.json
strokes house.dxf -o again.csv
strokes house.csv --json
strokes examples/shapes.png --stages stages.svg --mode outline -o shapes.svg
strokes examples/star.png --mode sweep
strokes examples/ -o batch --jobs 1
strokes examples/ -o batch --json
plan examples/house.png -o plan.csv
plan examples/house.png --preview preview.svg --colour-by limit --json
plan examples/handwriting.png --order-by distance --order-effort quick --preview order.svg --colour-by order
calibrate sheet -o pages.pdf
calibrate head --camera sim -o head.toml
calibrate markers --camera sim -o camera.toml
calibrate head --camera sim --calibration camera.toml -o measured.toml --json
calibrate lens examples/house.png --json
calibrate head --camera sim --home --head head.toml --json
calibrate ruler examples/ruler-upright.png examples/ruler-level.png --marks 4in --wish 3ft,3ft
lab move arc --angle 90deg -o arc.svg
lab move line --start=-10in,0in --to 10in,0in --profile optimal,sine --rig worn -o line.csv --json
lab move arc --as-asked -o asked.png
lab move line --angle 30deg --length 6in --dmax 2m/s2 --ramps 0.1,0.1,0.3,0.3 --distance 2m --as-asked -o slanted.svg --json
lab move line --profile optimal --as-asked
lab move line --vmax 1mm/s
lab move line --length 2000in
lab move arc --start 0in,0in
lab profile --distance 180deg -o profiles.svg
lab profile --distance 30deg --vmax 2rad/s --amax 9rad/s2 -o profiles.csv --json
lab profile --ramps 0.1,0.1,0.3,0.3 --dmax 40rad/s2 --profile s-curve,sigmoid,sine,cycloid,quintic -o many.png
lab profile --distance 100000rad --vmax 1rad/s -o long.csv
lab profile --profile optimal
lab profile --profile zigzag
lab profile --help
lab step --axis tilt --to 15deg --law state,report-zpk -o step.svg
lab step --gains kp=40,kd=5 --json
lab step --reference move --law state,pid --observer edge-times --seed 4 -o moved.csv --json
lab step --gains kp=40 --law state
lab bode|K11 G11|K11t G11|-o|bode.svg
lab bode|K11 G11|--sample|10ms|--method|tustin|--closed|--dark|-o|bode.png|-o|bode.csv|--json
lab bode|1/(s+
lab bode|(z+0.5)/(z-0.9)|--period|10ms|--from|1rad/s
lab nyquist|K11 G11|--json
lab nyquist|K11 G11|G22|--dark|-o|nyquist.svg|-o|nyquist.csv
lab nichols|K11 G11|-o|nichols.svg
lab nichols|K11 G11|-o|nichols.csv
lab locus|K11 G11|-o|locus.svg
lab locus|K11 G11|--damping|0.7|--reach|60|-o|damped.svg|-o|locus.csv|--json
lab locus|1/(s+1)|--damping|0.5
lab pzmap|G11|--json
lab pzmap|K11 G11|--closed|-o|poles.svg|-o|poles.csv
lab pzmap|G11|--sample|20ms|--set|B|-o|sampled.svg
lab response|G11/(1+K11 G11)|-o|response.svg
lab response|K11 G11|--closed|--input|ramp|--duration|2s|-o|ramp.svg|-o|ramp.csv|--json
lab response|1/(s+1)|--sample|50ms|--input|impulse
lab linearize --json
lab linearize --rig worn --at 10deg,-5deg --rates 0.5rad/s,1rad/s --keep-cancellations
lab design pid G11 --crossover 40rad/s --try pan
lab design lqg G11 --json
lab design lead-lag G11 --crossover 40rad/s --phase-margin 50deg --lag 5 -o lead.svg -o lead.csv --json
lab design place G11 --poles -40+20j --try tilt --rig worn --dark -o placed.svg
lab design place G11 --poles -30
lab design lqg
lab simulate path.csv --law state,report-pd -o scopes.svg
lab simulate path.csv --rig worn --law hand-tuned --gains kp=20,kd=1 -o scopes.csv --json
lab simulate --random --seed 3 --json
lab simulate path.csv --between lines --law pid --observer washout --set B --quantizer off --cap 0.5Nm --rest 1s -o lines.csv
lab simulate|--random|2s|--controller|K11|K22|--hold|off|--rig|worn|-o|random.svg
lab simulate|path.csv|--controller|K11t|1/(s+
lab simulate path.csv --hold off
lab simulate broken.csv
lab simulate nowhere.csv
lab velocity -o velocity.svg
lab velocity --shape line --speeds 0.3ft/s --intervals 5ms,20ms -o velocity.csv --json
lab velocity --shape examples/star.png --speeds 0.1ft/s,0.2ft/s --intervals 2ms --edge-stamps on --rig worn -o star.svg
lab velocity --shape nowhere.png
lab velocity --speeds 1ft/s --law report-zpk
lab identify --json
lab identify --rig worn --out identified
lab identify out/identify/record.csv identified/record.csv --rig own.toml --save --out again --json
lab identify --law pid --observer tracking-loop --seed 2 --rig own.toml --out moved --json
lab identify --save
lab identify path.csv
lab friction --fixture --out friction
lab friction friction/log.csv --axis pan --json --out told
lab friction --most 1.6V --step 0.2V --hold 6s --pulse 0.8V --pulse-time 0.5s --seed 2 --rig worn --out held
lab friction torques.csv --out torques
lab friction torques.csv friction/log.csv --out both
lab friction torques.csv --rig own.toml --save --out torques --json
lab friction --save
lab friction broken.csv
lab friction --step 2V
lab friction --hold 1s
lab friction --most 40V
lab friction --most 0.05V --axis tilt --fixture --hold 3s --out stuck
lab inertia --out inertia
lab inertia inertia/log.csv --json
lab inertia --fixture --axis pan --most 3V --step 0.5V --hold 5s --rig own.toml --save --out spun
lab inertia torques.csv --out torques
lab gravity --out gravity
lab gravity gravity/log.csv --rig own.toml --save --json --out weighed
lab gravity --fixture
lab gravity --axis pan
lab amplifier --out amplifier
lab amplifier --rig worn --axis tilt --json --out worn-amplifier
lab amplifier amplifier/readings.csv --torque-per-ampere 0.5Nm/A --rig own.toml --save --out read --json
lab amplifier amperes.csv --out read
lab amplifier amperes.csv --axis tilt
lab amplifier amperes.csv amplifier/readings.csv
lab amplifier --most 1V --ammeter 10mA --seed 3 --out coarse
lab backlash --out backlash
lab backlash backlash/readings.csv --axis tilt --rig worn --out slack --json
lab backlash broken.csv
lab encoder --out encoder
lab encoder encoder/edges.csv --json --out edges
lab encoder --rig worn --axis pan --speed 1rad/s --turns 3 --seed 2 --out slow
lab encoder --turns 1 --rig worn --out turned --json
lab encoder path.csv
lab encoder encoder/edges.csv --axis tilt --rig worn --out edges
lab frequency --axis tilt -o tilt.svg
lab frequency --axis pan -o pan.csv --json
lab frequency --from 2rad/s --to 200rad/s --sines 12 --amplitude 1V --speed=-8rad/s --period 5s --periods 3 --seed 2 --volts volts.csv --record record.csv -o pan.png
lab frequency record.csv --period 5s --speed=-8rad/s -o record.svg
lab frequency record.csv --period 5s --axis tilt
lab frequency record.csv --period 40s
lab frequency --from 600rad/s --to 1rad/s
lab frequency --period 1s
lab frequency --amplitude 100V
lab relay --axis pan --json
lab relay --axis tilt -o relay.svg
lab relay --axis tilt --fixture --crossover 30rad/s --phase-margin 40deg --integral 5 --observer washout --hysteresis 1deg --to=-10deg --seed 2 -o relay.csv
lab relay --rig mine.toml --save
lab relay --rig worn --save
lab relay --level 100V
lab lesson 1
lab lesson
lab lesson 2 --json
lab lesson 1 --answer kp=10,sticks=4 -o mine.svg -o mine.csv
lab lesson 1 --answer kp=10
lab tune --rig worn --json
lab tune --rig mine.toml --laws state,pid-ff --gain-margin 1.3 --slowest 60rad/s --fastest 240rad/s --plants 2 --save --out tuned
lab tune --shape line --laws pid --gain-margin 5 --lag 50ms
lab tune --slowest 50rad/s --fastest 40rad/s
lab montecarlo --plants 12 --shape examples/star.png -o montecarlo.csv
lab montecarlo --plants 3 --laps 2 --shape line --seed 7 --rig worn -o heads.svg --json
lab montecarlo --plants 2 --law report-zpk -o failed.svg
lab montecarlo --plants 2 --law report-zpk --json
lab reproduce -o book
"""

# What tells how long something took, or when; `N` stands there instead.
TIMES = [
    rb'"(?:vision|plan|run|report|timing_ms)":\s*([0-9.e+-]+)',
    rb'"modified_ns":([0-9]+)',
    rb'begun = "([0-9: -]+)"',
    rb'"pictures_per_s":\s*([0-9.e+-]+)',
    rb"px of line on a sheet of [^,]*, ([0-9.]+ \w+)",
    rb"%(\s+[0-9.]+ m?s)  (?:good|usable|kept)",
    rb"strokes; ([0-9.]+ m?s(?:, [0-9.]+ pictures a second)?)",
    rb">(?:picture to strokes|strokes to plan|run|report)</th><td>([^<]*)<",
]


def arguments(line):
    """The words of a command line: those before the first `|` by blanks, those after it whole."""
    first, *rest = line.split("|")
    return first.split() + rest


def without_times(data):
    for pattern in TIMES:
        data = re.sub(pattern, lambda found: found[0].replace(found[1], b"N"), data)
    return data


def run_all(program, folder, lines, environment):
    """What each line printed and how it ended, in this folder."""
    shutil.copytree(ROOT / "examples", folder / "examples")
    for name, content in FILES.items():
        (folder / name).write_bytes(content if isinstance(content, bytes) else content.encode())
    results = []
    for line in lines:
        command = [program, *arguments(line)]
        done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, timeout=600)
        results.append({"status": str(done.returncode).encode(), "stdout": done.stdout, "stderr": done.stderr})
    return results


def traced_anew(program, folder):
    """What a program traces again of a folder that another has left complete."""
    if not (folder / "batch").is_dir():
        return []
    line = "strokes examples/ -o batch --json".split()
    done = subprocess.run([program, *line], cwd=folder, capture_output=True, timeout=600)
    again = [entry for entry in json.loads(done.stdout)["pictures"] if not entry["kept"]]
    return [(entry["picture"], ["the new program traces it again"]) for entry in again]


def files_of(folder):
    return {str(f.relative_to(folder)): f.read_bytes() for f in sorted(folder.rglob("*")) if f.is_file()}


def difference(old, new, most=8):
    """The first lines that differ, or where bytes do."""
    try:
        a, b = old.decode().splitlines(), new.decode().splitlines()
    except UnicodeDecodeError:
        at = next((k for k, (x, y) in enumerate(zip(old, new)) if x != y), min(len(old), len(new)))
        return [f"{len(old)} and {len(new)} bytes, the first that differs is number {at}"]
    lines = [line[:160] for line in difflib.unified_diff(a, b, "old", "new", n=0, lineterm="")]
    return lines[2 : 2 + most]


def compared(old, new):
    """Names of what differs, with how."""
    found = []
    for name in sorted(set(old) | set(new)):
        if name not in old or name not in new:
            found.append((name, [f"only the {'new' if name in new else 'old'} program makes it"]))
            continue
        a, b = without_times(old[name]), without_times(new[name])
        if a != b:
            found.append((name, difference(a, b)))
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("old", type=Path)
    parser.add_argument("new", type=Path)
    parser.add_argument("--only", help="command lines that hold this word; they may need files of others")
    parser.add_argument("--keep", type=Path, help="leave both folders here")
    parser.add_argument("--set", default="", metavar="NAME=VALUE", help="a variable that only the new program is given")
    options = parser.parse_args()
    lines = [line for line in COMMANDS.strip().splitlines() if not options.only or options.only in line]
    with tempfile.TemporaryDirectory() as scratch:
        base = (options.keep or Path(scratch)).resolve()  # programs run in another folder
        # one folder's name and one program's for both: what is written may hold them
        here, program = base / "here", base / "tracelight"
        sides = []
        for side, given in (("old", options.old), ("new", options.new)):
            shutil.rmtree(here, ignore_errors=True)
            here.mkdir(parents=True)
            shutil.copy(given, program)
            name, _, value = options.set.partition("=")
            environment = os.environ | ({name: value} if name and side == "new" else {})
            printed = run_all(program, here, lines, environment)
            shown = {f"{line} ({what})": data for line, result in zip(lines, printed) for what, data in result.items()}
            sides.append((shown, files_of(here)))
            if side == "old":
                shutil.copy(options.new, program)
                anew = traced_anew(program, here)
            if options.keep:
                shutil.rmtree(base / side, ignore_errors=True)
                here.rename(base / side)
        (old_shown, old_files), (new_shown, new_files) = sides
        found = compared(old_shown, new_shown) + compared(old_files, new_files) + anew
    for name, how in found:
        print(f"differs: {name}", *how, sep="\n    ")
    failed = [line for line in lines if old_shown[f"{line} (status)"] != b"0"]
    print(f"{len(lines)} command lines ({len(failed)} end with an error), {len(old_files)} files: {len(found)} differ")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
