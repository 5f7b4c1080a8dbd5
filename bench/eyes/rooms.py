"""Traces a picture in place in simulated rooms and says how exact that was: python3 bench/eyes/rooms.py [SEEDS [PICTURE]]

Run `cargo build --release` before. Each seed is a room of its own: where head, camera and pages are, the lens, the noise.
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
PICTURE = sys.argv[2] if len(sys.argv) > 2 else os.path.join(ROOT, "examples", "house.png")


def run(*args):
    """The answer of a command; what it said where it failed."""
    done = subprocess.run([PROGRAM, *args, "--json", "--quiet"], capture_output=True, text=True)
    return json.loads(done.stdout)


def room(camera, seed):
    """The figures of one room: `camera` of a summary, or an error."""
    with tempfile.TemporaryDirectory() as folder:
        common = ["--sim-camera", camera, "--seed", str(seed)]
        known = []
        if camera == "report":
            file = os.path.join(folder, "camera.toml")
            run("calibrate", "markers", "--camera", "sim", "-o", file, *common)
            known = ["--calibration", file]
        summary = run("trace", "--camera", "sim:" + PICTURE, "--out", folder, *common, *known)
    return summary.get("camera") or summary


def figure(found, name):
    """How far the light is from the figure; None where the room does not tell."""
    told = found["figure_mm"]
    if told is None:
        return None
    return 100 * (1 - told["covered_share"]) if name == "missed" else told[name]


def line(name, values):
    values = [v for v in values if v is not None]
    if not values:
        return print(f"{name}: none")
    print(f"{name}: median {statistics.median(values):.3f}, worst {max(values):.3f} ({len(values)} rooms)")


for camera in ("webcam", "report"):
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        rooms = list(pool.map(lambda seed: room(camera, seed), range(1, SEEDS + 1)))
    bad = [(seed, found["error"]) for seed, found in enumerate(rooms, 1) if "error" in found]
    good = [found for found in rooms if "error" not in found]
    print(f"{camera}: {len(good)} of {SEEDS} rooms traced", *bad, sep="\n  ")
    line("  light beside the figure, rms, mm", [figure(found, "rms") for found in good])
    line("  99 % of it within, mm", [figure(found, "p99") for found in good])
    line("  of the figure not lit, %", [figure(found, "missed") for found in good])
    line("  spot beside where the head is believed to put it, rms, mm", [found["head"]["truth_rms_mm"] for found in good])
    line("  the same, largest, mm", [found["head"]["truth_max_mm"] for found in good])
