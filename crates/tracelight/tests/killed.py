"""Kills the program at many moments while it draws with an emulated board at a port, and has it resume.

    pip install mcap mcap-protobuf-support
    python killed.py target/release/tracelight 20 out/killed

Each time: from the kill to a gate that the board says is shut; what is missing of the drawing after `resume`, against an undisturbed run, and what was drawn twice. A program
that shares the port tells the gate, as `watch` shows it. Exit status 1 if anything is beyond its bound.
"""

import csv
import json
import math
import os
import random
import struct
import subprocess
import sys
import threading
import time

from mcap.exceptions import EndOfFile
from mcap.reader import NonSeekingReader
from mcap_protobuf.decoder import DecoderFactory

PICTURE = os.path.join(os.path.dirname(__file__), "../../../examples/star.png")
DARK_MS = 75  # 51 ms of the board's, and what a share, a watch and a pipe take
REACH_M = 5e-4  # ink within that of light is drawn
TWICE_M = 2e-4  # light within that of earlier light is drawn again
MISSING_MM = 0.5
DOUBLED_MM = 0.8  # 0.5, and what light moves in a tick: it is known once a tick


def table(folder):
    """Where there was light of a run that ended, m."""
    with open(os.path.join(folder, "trace.csv"), encoding="utf-8") as file:
        return [(float(row["x_m"]), float(row["y_m"])) for row in csv.DictReader(file) if row["laser"] == "1"]


def log(folder):
    """The same of one that was killed: its log ends wherever that was."""
    lit = []
    with open(os.path.join(folder, "run.mcap"), "rb") as file:
        reader = NonSeekingReader(file, decoder_factories=[DecoderFactory()])
        try:
            for _, channel, _, spot in reader.iter_decoded_messages(log_time_order=False):
                if channel.topic == "/spot" and spot.light:
                    lit.append((spot.x_m, spot.y_m))
        except (EndOfFile, struct.error):
            pass
    return lit


class Near:
    """Whether a place is near some of many."""

    def __init__(self, places, reach, key=lambda place: place):
        self.reach, self.key, self.cells = reach, key, {}
        for place in places:
            self.cells.setdefault(self.cell(key(place)), []).append(place)

    def cell(self, place):
        return int(place[0] // self.reach), int(place[1] // self.reach)

    def around(self, place):
        column, row = self.cell(place)
        cells = ((column + i, row + j) for i in (-1, 0, 1) for j in (-1, 0, 1))
        return (one for cell in cells for one in self.cells.get(cell, ()) if math.dist(place, self.key(one)) <= self.reach)

    def has(self, place):
        return next(self.around(place), None) is not None


def length_mm(places, counts):
    """Of the line along places, of those steps that count; a jump is none."""
    steps = ((math.dist(a, b), b) for a, b in zip(places, places[1:]))
    return 1e3 * sum(length for length, place in steps if length < 2e-3 and counts(place))


def tips(places):
    """Places where the line lies beside itself: light there is near other light without being drawn again."""
    along, passed = [0.0], 0.0
    for a, b in zip(places, places[1:]):
        step = math.dist(a, b)
        passed += step if step < 2e-3 else 1.0
        along.append(passed)
    near = Near(list(zip(places, along)), TWICE_M, key=lambda both: both[0])
    return [place for place, at in zip(places, along) if any(abs(at - other) > 1e-3 for _, other in near.around(place))]


class Gate:
    """The gate as the board tells it, by a program that watches."""

    def __init__(self, program, port):
        self.is_open, self.since = False, 0.0
        self.process = subprocess.Popen([program, "watch", port, "--json"], stdout=subprocess.PIPE, text=True)
        threading.Thread(target=self.follow, daemon=True).start()

    def follow(self):
        for line in self.process.stdout:
            seen = json.loads(line)
            if "gate" in seen and seen["gate"] != self.is_open:
                self.is_open, self.since = seen["gate"], time.monotonic()


def main(program, count, folder):
    os.makedirs(folder, exist_ok=True)
    port, dice, wrong = os.path.join(folder, "head"), random.Random(folder), []
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    helpers = [subprocess.Popen([program, "rig", "serve", "--pty", port], **quiet)]
    while not os.path.exists(port):
        time.sleep(0.05)
    helpers.append(subprocess.Popen([program, "rig", "share", port], **quiet))
    gate = Gate(program, port)
    helpers.append(gate.process)
    draw = [program, "trace", PICTURE, "--width", "20cm", "--rig", port, "--out"]
    time.sleep(0.5)
    whole = os.path.join(folder, "whole")
    subprocess.run([*draw, whole], check=True, **quiet)
    asked = table(whole)
    beside = Near(tips(asked), 2 * TWICE_M)
    for number in range(count):
        run = os.path.join(folder, f"run{number}")
        killed = subprocess.Popen([*draw, run], **quiet)
        while not gate.is_open and killed.poll() is None:
            time.sleep(0.001)
        time.sleep(dice.random() * 3.0)
        was_open, at = gate.is_open, time.monotonic()
        killed.kill()
        killed.wait()
        time.sleep(0.3)
        dark_ms = 1e3 * (gate.since - at) if was_open else 0.0
        resumed = subprocess.run([program, "resume", run], capture_output=True, text=True, check=False)
        # one that was killed after its last stroke has nothing left
        rest = table(f"{run}-2") if os.path.exists(f"{run}-2") else []
        first = log(run)
        drawn, before = Near(first + rest, REACH_M), Near(first, TWICE_M)
        missing = length_mm(asked, lambda place: not drawn.has(place))
        doubled = length_mm(rest, lambda place: before.has(place) and not beside.has(place))
        print(f"{number}: dark {dark_ms:.0f} ms after the kill, {missing:.2f} mm missing, {doubled:.2f} mm twice", flush=True)
        is_good = not gate.is_open and dark_ms <= DARK_MS and missing <= MISSING_MM and doubled <= DOUBLED_MM
        if not is_good or (resumed.returncode != 0 and rest):
            wrong.append(f"{number}: {resumed.stderr.strip()}")
    for helper in helpers:
        helper.terminate()
    print(f"killed {count} times, {len(wrong)} beyond the bounds")
    if wrong:
        sys.exit("\n".join(wrong))


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]), sys.argv[3])
