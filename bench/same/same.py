#!/usr/bin/env python3
"""Two programs held against each other: the same command lines, the same bytes.

    python bench/same/same.py OLD/tracelight target/release/tracelight [--only WORD] [--keep FOLDER]

Both run every command line below, each in a folder of its own that begins with copies of `examples/`; what a command writes, later
ones read. What is printed, how it ends, and every file left behind are compared byte by byte, apart from what tells the time: see
TIMES. Exit status 1, and the first lines that differ, where they do. Needs Python 3.10 alone. For a change that should move code and
change nothing.
"""

import argparse
import difflib
import json
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
    "broken.toml": "name = \"x\"\n[model.pan.motor]\nlimit = 9\n",
    "broken.svg": "<svg xmlns=\"http://www.w3.org/2000/svg\"><path d=\"M 0 0 L\"",
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
explain following-error
explain nothing-of-this-name
completions bash
trace examples/house.png --width 24in --out house
trace examples/star.png --width 24in --out star --json
trace examples/shapes.png --rig worn --out worn --quiet
trace examples/chalk.png --dry-run --out dry
trace examples/house.png --law pid-ff --laps 2 --seed 3 --out laps --json
trace examples/star.png --lit-speed exact --rotate 15deg --offset 10cm,-5cm --out exact
trace examples/star.png --profile quintic --amax 20rad/s2 --out quintic --json
trace examples/star.png --amax 2m/s2
trace plan.svg --colour red --distance 2m --out svg
trace broken.svg --out broken
trace nowhere.png
trace examples/house.png --rig broken.toml
trace examples/star.png --sim-unhomed --out unhomed
trace --camera sim:examples/house.png --out camera
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
calibrate head --camera sim --home --head head.toml --json
calibrate ruler examples/ruler-upright.png examples/ruler-level.png --marks 4in --wish 3ft,3ft
lab move arc --angle 90deg -o arc.svg
lab profile --distance 180deg -o profiles.svg
lab step --axis tilt --to 15deg --law state,report-zpk -o step.svg
lab step --gains kp=40,kd=5 --json
lab bode|K11 G11|K11t G11|-o|bode.svg
lab nyquist|K11 G11|--json
lab nichols|K11 G11|-o|nichols.svg
lab locus|K11 G11|-o|locus.svg
lab pzmap|G11|--json
lab response|G11/(1+K11 G11)|-o|response.svg
lab linearize --json
lab design pid G11 --crossover 40rad/s --try pan
lab design lqg G11 --json
lab design lqg
lab simulate path.csv --law state,report-pd -o scopes.svg
lab velocity -o velocity.svg
lab identify --json
lab identify --rig worn --out identified
lab friction --fixture --out friction
lab inertia --out inertia
lab inertia inertia/log.csv --json
lab gravity --out gravity
lab amplifier --out amplifier
lab backlash --out backlash
lab encoder --out encoder
lab frequency --axis tilt -o tilt.svg
lab relay --axis pan --json
lab lesson 1
lab montecarlo --plants 12 --shape examples/star.png -o montecarlo.csv
lab reproduce -o book
"""

# What tells how long something took, or when; `N` stands there instead.
TIMES = [
    rb'"(?:vision|plan|run|report|\w*_ms)":\s*([0-9.e+-]+)',
    rb'"modified_ns":([0-9]+)',
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


def run_all(program, folder, lines):
    """What each line printed and how it ended, in this folder."""
    shutil.copytree(ROOT / "examples", folder / "examples")
    for name, text in FILES.items():
        (folder / name).write_text(text)
    results = []
    for line in lines:
        done = subprocess.run([program, *arguments(line)], cwd=folder, capture_output=True, timeout=600)
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
            printed = run_all(program, here, lines)
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
