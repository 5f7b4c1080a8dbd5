"""Homes heads that were just powered up in simulated rooms and says how exact that was: python3 bench/eyes/homing.py [SEEDS]

Run `cargo build --release` before. Each seed is a room of its own, its head left anywhere within a radian. Once nothing is known of the head, once it was found before.
"""
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


def run(*args):
    """The answer of a command; what it said where it failed."""
    done = subprocess.run([PROGRAM, *args, "--json", "--quiet"], capture_output=True, text=True)
    return json.loads(done.stdout)


def room(camera, seed):
    """What homing came to, of an unknown head and of a known one."""
    with tempfile.TemporaryDirectory() as folder:
        common = ["--camera", "sim", "--sim-camera", camera, "--seed", str(seed)]
        head = os.path.join(folder, "head.toml")
        home = ["calibrate", "head", "--home", *common]
        unknown = run(*home, "-o", os.path.join(folder, "homed.toml"))
        run("calibrate", "head", *common, "-o", head)
        return unknown, run(*home, "--head", head)


for camera in ("webcam", "report"):
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        rooms = list(pool.map(lambda seed: room(camera, seed), range(1, SEEDS + 1)))
    for name, homed in (("unknown", [r[0] for r in rooms]), ("known", [r[1] for r in rooms])):
        bad = [(seed, found["error"]) for seed, found in enumerate(homed, 1) if "error" in found]
        good = [found for found in homed if "error" not in found]
        print(f"{camera}, {name} head: {len(good)} of {SEEDS} homed", *bad, sep="\n  ")
        if not good:
            continue
        for joint in (0, 1):
            off = [abs(found["homed"]["truth_mm"][joint]) for found in good]
            print(f"  {('pan', 'tilt')[joint]} zero: median {statistics.median(off):.2f}, worst {max(off):.2f} mm")
        sought = [found["homed"]["sought"] for found in good]
        print(f"  dots until one was seen: median {statistics.median(sought):.0f}, most {max(sought)}")
