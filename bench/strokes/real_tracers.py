"""Tracers of real pictures: ours as its program, autotrace's centreline (else potrace, else a skeleton) on the scorer's mask.

Also a program of its own, `real_tracers.py NAME MASK.png`, so that a peer that crashes or never ends takes nobody with it.
"""

import importlib.util
import json
import re
import shutil
import subprocess
import sys
import time

import numpy as np
from PIL import Image

from real_score import Stroke

PATIENCE_S = 120  # a tracer that takes longer on one picture has lost it


def ours(program, picture, flags=()):
    """Strokes, seconds, what it said; strokes are None where it refused."""
    start = time.perf_counter()
    try:
        done = subprocess.run(
            [program, "strokes", str(picture), "--json", *flags], capture_output=True, text=True, timeout=PATIENCE_S
        )
    except subprocess.TimeoutExpired:
        return None, PATIENCE_S, "took too long"
    seconds, said = time.perf_counter() - start, done.stderr.strip()
    if done.returncode:
        return None, seconds, said or f"ended with {done.returncode}"
    strokes = json.loads(done.stdout)["strokes"]
    return [Stroke(np.array(s["points"]), s["closed"], s["kind"] != "centreline") for s in strokes if s["points"]], seconds, said


def peers(wanted):
    """Names of the peers that are there; the first is shown beside ours."""
    if wanted == "none":
        return []
    if importlib.util.find_spec("autotrace"):
        return ["autotrace"]
    print("!!! no pyautotrace: beside ours stand potrace (if it is there) and a skeleton", file=sys.stderr)
    return (["potrace"] if shutil.which("potrace") else []) + ["skeleton"]


def peer(name, mask, scratch):
    """As `ours`, of a peer on a mask; `scratch` is a file that may be written."""
    Image.fromarray(np.where(mask, 0, 255).astype(np.uint8)).save(scratch)
    command = [sys.executable, __file__, name, str(scratch)]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE_S)
    except subprocess.TimeoutExpired:
        return None, PATIENCE_S, "took too long"
    if done.returncode:
        return None, 0.0, f"ended with {done.returncode}"
    answer = json.loads(done.stdout)
    strokes = [Stroke(np.array(points), closed, name == "potrace") for points, closed in answer["strokes"]]
    return strokes, answer["seconds"], ""


# --- in a process of its own -------------------------------------------------------------------------------------------


def autotrace(mask):
    import autotrace

    rgb = np.repeat(np.asarray(mask)[..., None], 3, 2).copy()
    svg = autotrace.Bitmap(rgb).trace(centerline=True, background_color=(255, 255, 255)).encode("svg")
    # its frame, by lines drawn at known pixels: half a pixel to the left of ours, and half a pixel down
    return paths(svg.decode() if isinstance(svg, bytes) else svg, lambda p: p + [0.5, -0.5])


def potrace(mask):
    command = ["potrace", "-b", "svg", "--flat", "-u", "1", "-o", "-"]
    pbm = f"P4 {mask.shape[1]} {mask.shape[0]}\n".encode() + np.packbits(np.asarray(mask) == 0, axis=1).tobytes()
    svg = subprocess.run(command, input=pbm, capture_output=True, check=True).stdout.decode()
    return paths(svg, lambda p: p * [1, -1] + [0, mask.shape[0]])


def skeleton(mask):
    from skimage.measure import find_contours
    from skimage.morphology import skeletonize

    thin = skeletonize(np.asarray(mask) == 0)
    # round the skeleton and back: half of each contour is its way there
    contours = [c[: len(c) // 2 + 1, ::-1] + 0.5 for c in find_contours(np.pad(thin, 1).astype(float)[1:-1, 1:-1], 0.5)]
    return [(c, False) for c in contours if len(c) > 1]


TOKEN = re.compile(r"[MmLlCcZz]|-?\d*\.?\d+(?:e-?\d+)?")


def paths(svg, placed):
    """Polylines of an SVG's paths of M, L, C and Z; curves in eight steps."""
    lines = []
    for d in re.findall(r"<path[^>]*?\sd=\"([^\"]*)\"", svg, re.S):
        lines += [(placed(np.array(points)), closed) for points, closed in lines_of(TOKEN.findall(d)) if len(points) > 1]
    return lines


def lines_of(tokens):
    """[(points, closed)] of one path."""
    lines, line, at, command, i = [], [], np.zeros(2), "M", 0
    ahead = lambda count: np.array(tokens[i : i + 2 * count], float).reshape(count, 2)
    while i < len(tokens):
        if tokens[i].isalpha():
            command, i = tokens[i], i + 1
        base = at if command.islower() else np.zeros(2)
        kind = command.upper()
        if kind == "Z":
            lines, line, at = lines + [(line, True)], [], line[0] if line else at
            continue
        count = 3 if kind == "C" else 1
        points, i = base + ahead(count), i + 2 * count
        if kind == "M":
            lines, line = lines + ([(line, False)] if line else []), [points[0]]
            command = "l" if command == "m" else "L"
        else:
            line = (line or [at]) + (bent(at, points) if kind == "C" else [points[0]])
        at = points[-1]
    return lines + ([(line, False)] if line else [])


def bent(start, points):
    """A cubic in eight steps, without its start."""
    t = np.linspace(0, 1, 9)[1:, None]
    a, b, c = points
    return list((1 - t) ** 3 * start + 3 * (1 - t) ** 2 * t * a + 3 * (1 - t) * t**2 * b + t**3 * c)


def main():
    name, file = sys.argv[1:]
    mask = np.asarray(Image.open(file))
    start = time.perf_counter()
    strokes = {"autotrace": autotrace, "potrace": potrace, "skeleton": skeleton}[name](mask)
    seconds = time.perf_counter() - start
    print(json.dumps({"seconds": seconds, "strokes": [(np.round(p, 2).tolist(), c) for p, c in strokes]}))


if __name__ == "__main__":
    main()
