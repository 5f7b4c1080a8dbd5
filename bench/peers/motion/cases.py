#!/usr/bin/env python3
"""Seeded strokes, junctions and paths for the motion benchmarks, written as CSV: `cases.py DIRECTORY`.

The same seeds give the same files with any numpy ≥ 1.22. Metres on a canvas of 0.6 × 0.45 m around the axis.
"""

import sys
from pathlib import Path

import numpy as np

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


def write_ends(path, strokes):
    ends = np.array([[*s[0], *s[-1]] for s in strokes])
    np.savetxt(path, ends, delimiter=",", fmt="%.9f", header="x0,y0,x1,y1", comments="")


def main():
    out = Path(sys.argv[1])
    out.mkdir(parents=True, exist_ok=True)
    for kind in (uniform, sketch, hatch):
        for n in (500, 5000, 20000):
            write_ends(out / f"{kind.__name__}_{n}.csv", kind(n))
    write_ends(out / "junctions.csv", junctions())


if __name__ == "__main__":
    main()
