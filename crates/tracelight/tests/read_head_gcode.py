"""Plays a plan's G-code in joint angles by a reader that is not ours, and holds it against the plan's table.

    read_head_gcode.py PLAN.csv HEAD.gcode DISTANCE_M

Both written by `plan` with `--axes X=pan,Y=-tilt`, in degrees, for a head that stands square. Reader: gcodeparser. Each move takes the time
that its inverse feed says. At each lit row of the table the joints are where the moves have them then; where the beam meets the wall, by the
contract's equations, may be off by 0.1 mm, and light may be off by one row at either end of a stroke.
"""

import csv
import math
import sys

from gcodeparser import parse_gcode_lines

MOST_MM = 0.1


def moves(text):
    """Time, pan and tilt (rad), light: one row a move, from the first place on."""
    at, power, s, rows = {"X": 0.0, "Y": 0.0}, 0.0, 0.0, []
    for line in parse_gcode_lines(text):
        power = line.params.get("S", power)
        at = {axis: line.params.get(axis, old) for axis, old in at.items()}
        if line.command == ("G", 1):
            s += 60.0 / line.params["F"]
        elif line.command == ("G", 4):
            s += line.params["P"]
        elif line.command != ("G", 0):
            continue
        rows.append((s, math.radians(at["X"]), math.radians(-at["Y"]), power > 0))
    return rows


def spot(pan, tilt, distance):
    return -distance * math.tan(pan), -distance * math.tan(tilt) / math.cos(pan)


def main():
    plan, gcode, distance = sys.argv[1], sys.argv[2], float(sys.argv[3])
    rows = moves(open(gcode).read())
    table = list(csv.DictReader(open(plan)))
    worst, wrong_light, row = 0.0, 0, 1
    for tick in table:
        t = float(tick["t_s"])
        # feeds are rounded, by far less than this
        while row + 1 < len(rows) and rows[row][0] < t - 1e-5:
            row += 1
        (s0, *a, _), (s1, *b, lit) = rows[row - 1], rows[row]
        share = min(max((t - s0) / (s1 - s0), 0.0), 1.0)
        x, y = spot(*(p + share * (q - p) for p, q in zip(a, b)), distance)
        if tick["lit"] == "1":
            worst = max(worst, 1e3 * math.hypot(x - float(tick["x_m"]), y - float(tick["y_m"])))
        wrong_light += lit != (tick["lit"] == "1")
    changes = sum(a["lit"] != b["lit"] for a, b in zip(table, table[1:]))
    if worst > MOST_MM or wrong_light > changes:
        sys.exit(f"read_head_gcode: {gcode}: {worst:.4f} mm off its plan; light wrong in {wrong_light} rows, {changes} changes")
    print(f"{gcode}: {len(rows)} moves, up to {worst:.4f} mm off the plan, {rows[-1][0]:.3f} s of {table[-1]['t_s']} s")


main()
