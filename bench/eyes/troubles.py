"""Lets one thing after the other go wrong in simulated rooms and says what became of the light: python3 bench/eyes/troubles.py [SEEDS [PICTURE]]

Run `cargo build --release` before. Each seed is a room of its own. What happens to the head happens mid-stroke, 8 s after drawing began.
"""
import csv
import json
import os
import statistics
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor

ROOT = os.path.join(os.path.dirname(__file__), "..", "..")
PROGRAM = os.path.join(ROOT, "target", "release", "tracelight")
SEEDS = int(sys.argv[1]) if len(sys.argv) > 1 else 50
PICTURE = sys.argv[2] if len(sys.argv) > 2 else os.path.join(ROOT, "examples", "house.png")
# further from where it was asked to be, light is wrong
WRONG_MM = 3

CASES = [
    ("report", "nothing", []),
    ("report", "pan-slip=20@8", []),
    ("report", "tilt-slip=-20@8", []),
    ("report", "camera-bump=5@8", []),
    ("report", "head-bump=1@8", []),
    ("report", "camera-unplugged@8", []),
    ("report", "camera-frozen@8", []),
    ("report", "camera-black@8", []),
    ("report", "camera-slow=5@0", []),
    ("report", "camera-stamps=0.1@8", []),
    ("worn", "nothing", []),
    ("worn", "drift=0.5@0", []),
    ("worn", "drift=0.5@0", ["--open-loop"]),
    ("worn", "head-bump=1@8", []),
]


def room(rig, trouble, flags, seed):
    """The summary of one room, or an error; with how long light was wrong, ms, as `wrong_ms`."""
    with tempfile.TemporaryDirectory() as folder:
        args = ["trace", "--camera", "sim:" + PICTURE, "--rig", rig, "--seed", str(seed), "--out", folder, *flags]
        if trouble != "nothing":
            args += ["--sim-trouble", trouble]
        done = subprocess.run([PROGRAM, *args, "--json", "--quiet"], capture_output=True, text=True)
        summary = json.loads(done.stdout)
        if "camera" in summary:
            with open(os.path.join(folder, "trace.csv")) as table:
                lit = [row for row in csv.DictReader(table) if row["laser"] == "1" and row["error_mm"]]
            summary["wrong_ms"] = sum(float(row["error_mm"]) > WRONG_MM for row in lit)
        return summary


def told(name, values):
    values = [v for v in values if v is not None]
    return f"{name} {statistics.median(values):.3f}, {max(values):.3f}" if values else f"{name} none"


print("median, worst of each; mm unless it says ms")
for rig, trouble, flags in CASES:
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        all_rooms = list(pool.map(lambda seed: room(rig, trouble, flags, seed), range(1, SEEDS + 1)))
    is_done = lambda found: "camera" in found and found["run"]["finished"]
    bad = [(seed, found.get("error")) for seed, found in enumerate(all_rooms, 1) if not is_done(found)]
    good = [found for found in all_rooms if is_done(found)]
    follow = [found["camera"]["follow"] for found in good]
    print(f"{rig}, {trouble} {' '.join(flags)}: {len(good)} of {SEEDS} done, {sum(len(f['recoveries']) > 0 for f in follow)} found again,"
          f" {sum(f['checks'] for f in follow)} dots to be sure", *bad, sep="\n  ")
    if good:
        print("  " + "; ".join([
            told("light beside the figure, rms", [f["camera"]["figure_mm"] and f["camera"]["figure_mm"]["rms"] for f in good]),
            told("light off its stroke at most", [f["tracking"]["off_stroke_max_mm"] for f in good]),
            told("wrong for, ms", [f["wrong_ms"] for f in good]),
            told("seen beside asked, rms", [f["off_mm"] and f["off_mm"]["rms"] for f in follow]),
        ]), flush=True)
