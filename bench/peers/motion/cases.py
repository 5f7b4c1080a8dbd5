#!/usr/bin/env python3
"""Seeded strokes, junctions, moves and paths for the motion benchmarks, written as CSV: `cases.py DIRECTORY`.

The same seeds give the same files with any numpy ≥ 1.22 and scipy. Metres on a canvas of 0.6 × 0.45 m around the axis.
"""

import sys
from pathlib import Path

import numpy as np
from scipy.interpolate import make_interp_spline

WIDTH, HEIGHT = 0.6, 0.45
SEED = 2006


def uniform(n):
    """Lines of 8 mm (log-normal) anywhere, in any direction."""
    rng = np.random.default_rng([SEED, n, 1])
    middle = rng.uniform([-WIDTH / 2, -HEIGHT / 2], [WIDTH / 2, HEIGHT / 2], (n, 2))
    length = np.exp(rng.normal(np.log(0.008), 0.5, n))
    angle = rng.uniform(0, 2 * np.pi, n)
    half = 0.5 * length[:, None] * np.c_[np.cos(angle), np.sin(angle)]
    return [np.array([m - h, m + h]) for m, h in zip(middle, half)]


def sketch(n):
    """Stretches of 40 long smooth curves with gaps, in no order: neighbours in space are none in the file."""
    rng = np.random.default_rng([SEED, n, 2])
    curves = 40
    each = -(-n // curves)
    waves = np.arange(1, 6)
    strokes = []
    for _ in range(curves):
        ax, ay = rng.normal(0, 1, (2, 5)) / waves
        px, py = rng.uniform(0, 2 * np.pi, (2, 5))
        scale = rng.uniform(0.25, 1.0)
        ox, oy = rng.uniform(-0.15, 0.15, 2)
        cuts = np.sort(rng.uniform(0, 2 * np.pi, 2 * each))
        for first, last in zip(cuts[::2], cuts[1::2]):
            u = np.linspace(first, last, int(rng.integers(2, 13)))
            x = ox + scale * 0.12 * sum(a * np.sin(w * u + p) for a, w, p in zip(ax, waves, px))
            y = oy + scale * 0.10 * sum(a * np.sin(w * u + p) for a, w, p in zip(ay, waves, py))
            points = np.c_[x, y]
            strokes.append(points[::-1].copy() if rng.random() < 0.5 else points)
    strokes = strokes[:n]
    rng.shuffle(strokes)
    return strokes


def hatch(n):
    """Parallel lines in 60 discs, shuffled."""
    rng = np.random.default_rng([SEED, n, 3])
    discs = 60
    each = -(-n // discs)
    strokes = []
    for _ in range(discs):
        cx, cy = rng.uniform([-WIDTH / 2, -HEIGHT / 2], [WIDTH / 2, HEIGHT / 2])
        radius = rng.uniform(0.015, 0.05)
        angle = rng.uniform(0, np.pi)
        c, s = np.cos(angle), np.sin(angle)
        for offset in np.linspace(-radius, radius, each + 2)[1:-1]:
            half = np.sqrt(max(radius * radius - offset * offset, 0))
            points = np.array([[cx - half * c - offset * s, cy - half * s + offset * c],
                               [cx + half * c - offset * s, cy + half * s + offset * c]])
            strokes.append(points[::-1].copy() if rng.random() < 0.5 else points)
    strokes = strokes[:n]
    rng.shuffle(strokes)
    return strokes


def junctions(nx=20, ny=15, kept=0.6):
    """Streets of a town: a bent grid of which 60 % of the edges are kept, every edge a stroke."""
    rng = np.random.default_rng([SEED, nx, ny])
    gx, gy = np.meshgrid(np.linspace(-0.3, 0.3, nx), np.linspace(-0.225, 0.225, ny), indexing="ij")
    place = np.c_[gx.ravel(), gy.ravel()] + rng.normal(0, 0.004, (nx * ny, 2))
    number = np.arange(nx * ny).reshape(nx, ny)
    edges = np.r_[np.c_[number[:-1].ravel(), number[1:].ravel()],
                  np.c_[number[:, :-1].ravel(), number[:, 1:].ravel()]]
    edges = edges[rng.random(len(edges)) < kept]
    return [place[edge] for edge in edges]


WALL = 0.9
PATHS = ("lissajous", "rose", "circle50", "scribble", "loops")


def joint_path(name, points=4001):
    """A C4 quintic spline of pan and tilt over 0…1 through a curve on the wall, 0.9 m away."""
    u = np.linspace(0, 2 * np.pi, points)
    if name == "lissajous":
        x, y = 0.30 * np.sin(3 * u + 0.3), 0.20 * np.sin(2 * u)
    elif name == "rose":
        r = 0.2 * (1 + 0.35 * np.cos(5 * u))
        x, y = r * np.cos(u), r * np.sin(u)
    elif name == "circle50":
        x, y = 0.05 * np.cos(u), 0.05 * np.sin(u)
    elif name == "scribble":
        rng = np.random.default_rng([SEED, 77])
        knots = rng.uniform([-0.3, -0.2], [0.3, 0.2], (24, 2))
        chord = np.r_[0, np.cumsum(np.sqrt(np.hypot(*np.diff(knots, axis=0).T)))]
        u = np.linspace(0, chord[-1], points)
        x, y = make_interp_spline(chord, knots, k=5)(u).T
    else:  # loops as in handwriting, 12 mm high
        u = np.linspace(0, 40 * np.pi, points)
        x, y = -0.25 + 0.004 * u + 0.006 * np.cos(u), 0.01 * np.sin(u)
    pan, tilt = np.arctan2(x, WALL), np.arctan2(y, np.hypot(x, WALL))
    return make_interp_spline((u - u[0]) / (u[-1] - u[0]), np.c_[pan, tilt], k=5)


def write_path(path, spline, cells=16000):
    s = np.linspace(0, 1, cells + 1)
    columns = [s[:, None]] + [spline(s, k) for k in range(3)]
    np.savetxt(path, np.hstack(columns), delimiter=",", fmt="%.15g",
               header="s,pan,tilt,d_pan,d_tilt,dd_pan,dd_tilt", comments="")


def moves(n=20000):
    """Starts and ends of moves of two joints: every other from rest to rest, the rest anything within 24, 100, 2000."""
    rng = np.random.default_rng([SEED, n, 2])
    v, a, j = 24.0, 100.0, 2000.0
    places = [rng.uniform(-np.pi, np.pi, (n, 2)) for _ in range(2)]
    speeds = [rng.uniform(-0.6 * v, 0.6 * v, (n, 2)) for _ in range(2)]
    rises = [rng.uniform(-0.6 * a, 0.6 * a, (n, 2)) for _ in range(2)]
    for speed, rise in zip(speeds, rises):
        room = np.sqrt(2 * j * (v - np.abs(speed)))
        np.clip(rise, -0.9 * room, 0.9 * room, out=rise)
        speed[::2] = rise[::2] = 0
    return np.hstack([places[0], speeds[0], rises[0], places[1], speeds[1], rises[1]])


def write_moves(path, table):
    names = [f"{what}{end}_{joint}" for end in "01" for what in "pva" for joint in ("pan", "tilt")]
    np.savetxt(path, table, delimiter=",", fmt="%.12g", header=",".join(names), comments="")


def write_ends(path, strokes):
    ends = np.array([[*s[0], *s[-1]] for s in strokes])
    np.savetxt(path, ends, delimiter=",", fmt="%.9f", header="x0,y0,x1,y1", comments="")


def write_drawing(path, strokes):
    rows = [f"{number},{x:.9f},{y:.9f}" for number, stroke in enumerate(strokes, 1) for x, y in stroke]
    path.write_text("\n".join(["stroke,x_m,y_m", *rows]) + "\n")


def main():
    out = Path(sys.argv[1])
    out.mkdir(parents=True, exist_ok=True)
    for kind in (uniform, sketch, hatch):
        for n in (500, 5000, 20000):
            write_ends(out / f"{kind.__name__}_{n}.csv", kind(n))
    write_drawing(out / "drawing_uniform_500.csv", uniform(500))
    write_ends(out / "junctions.csv", junctions())
    write_moves(out / "moves.csv", moves())
    write_path(out / "path_line.csv", make_interp_spline([0, 1], [[0, 0], [np.pi, 0]], k=1))
    for name in PATHS:
        write_path(out / f"path_{name}.csv", joint_path(name))


if __name__ == "__main__":
    main()
