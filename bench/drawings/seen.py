"""Are SVGs drawn as they are seen? Compares strokes with Chromium's picture of the file.

    python seen.py PROGRAM --cache DIR [--suites suites.txt] [--overlays DIR] [--chromium PATH]
    python seen.py PROGRAM --files a.svg b.svg ...

Fetches the repositories of the list into the cache (git, newest commit), takes as many SVGs of each as the list says, in the
order of a hash of their paths, and prints a line a file and a table. Needs git, Chromium, numpy, scipy and pillow.
"""

import argparse, hashlib, json, pathlib, subprocess, sys, tempfile

import numpy as np
from PIL import Image, ImageDraw
from scipy.ndimage import distance_transform_edt

SIDE = 400  # px, the picture's longer side
MARGIN = 20  # px round each picture, so that nothing of a neighbour shows
CONTRAST = 20  # of 255: an edge that has to be drawn
FAINT = 10  # of 255: an edge that may be drawn
FINER = 3  # times as fine as it is judged is the picture drawn: seams of anti-aliasing shrink, edges stay
NEAR = 2.0  # px between a stroke and an edge of the picture, its pen aside
RIM = 3  # px at the page's border where no edge is asked for
UNSEEN, UNDRAWN = 0.03, 0.03  # shares of length, and of edge, that may be wrong in a file
CHROMIUM = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--hide-scrollbars",
            f"--force-device-scale-factor={FINER}",
            "--disable-background-networking", "--disable-component-update", "--disable-sync", "--allow-file-access-from-files"]


def files_of(line, cache):
    """Paths of the sampled SVGs of one line of the list."""
    repository, count = line.split()[:2]
    copy = cache / repository.replace("/", "+")
    if not copy.exists():
        subprocess.run(["git", "clone", "-q", "--depth", "1", f"https://github.com/{repository}", str(copy)], check=True)
    found = [p for p in copy.rglob("*.svg") if p.stat().st_size < 600_000 and b"http://www.w3.org/2000/svg" in p.read_bytes()]
    found.sort(key=lambda p: hashlib.sha1(str(p.relative_to(copy)).encode()).hexdigest())
    return found[: int(count)]


def strokes_of(program, file):
    """The drawing as JSON, and what the program said of it."""
    run = subprocess.run([program, "strokes", str(file), "--json"], capture_output=True, text=True, timeout=60)
    return (json.loads(run.stdout) if run.returncode == 0 else None), run.stderr.strip()


def corners(stroke, within):
    """Points of a stroke's exact path (its "points" are coarser), px of the file."""
    at = np.array(stroke["path"]["start"], float)
    points = [at]
    for element in stroke["path"]["elements"]:
        if "line" in element:
            new = [np.array(element["line"], float)]
        elif "cubic" in element:
            c1, c2, to = (np.array(p, float) for p in element["cubic"])
            long = sum(np.linalg.norm(b - a) for a, b in ((at, c1), (c1, c2), (c2, to)))
            t = np.linspace(0, 1, max(2, min(200, int(long / within))) + 1)[1:, None]
            new = list((1 - t) ** 3 * at + 3 * (1 - t) ** 2 * t * c1 + 3 * (1 - t) * t**2 * c2 + t**3 * to)
        else:
            centre, sweep = np.array(element["arc"]["centre"], float), element["arc"]["sweep_rad"]
            arm = at - centre
            count = max(2, min(400, int(np.linalg.norm(arm) * abs(sweep) / within)))
            turns = sweep * np.arange(1, count + 1) / count
            new = [centre + [np.cos(a) * arm[0] - np.sin(a) * arm[1], np.sin(a) * arm[0] + np.cos(a) * arm[1]] for a in turns]
        points += new
        at = new[-1]
    return np.array(points)


def along(points):
    """Places every half pixel along the chords between points, and how long the chord is, chord by chord."""
    for a, b in zip(points, points[1:]):
        long = np.linalg.norm(b - a)
        count = max(1, int(np.ceil(2 * long)))
        yield a + (b - a) * ((np.arange(count) + 0.5)[:, None] / count), long


def pictures(chromium, sheets):
    """Chromium's pictures of (file, width, height), on white, each as grey levels of every channel."""
    done = []
    for first in range(0, len(sheets), 20):
        some = sheets[first : first + 20]
        cell = SIDE + 2 * MARGIN
        images = "".join(
            f'<img src="{file.resolve().as_uri()}" style="position:absolute;left:{MARGIN + i % 5 * cell}px;'
            f'top:{MARGIN + i // 5 * cell}px;width:{w}px;height:{h}px">'
            for i, (file, w, h) in enumerate(some))
        with tempfile.TemporaryDirectory() as folder:
            page, shot = pathlib.Path(folder, "page.html"), pathlib.Path(folder, "shot.png")
            page.write_text(f'<body style="margin:0;background:#fff">{images}')
            subprocess.run([chromium, *CHROMIUM, f"--user-data-dir={folder}/profile", f"--screenshot={shot}",
                            f"--window-size={5 * cell},{(len(some) + 4) // 5 * cell}", page.as_uri()],
                           capture_output=True, timeout=120)
            all_of_them = np.asarray(Image.open(shot).convert("RGB").reduce(FINER)).astype(int)
        for i in range(len(some)):
            x, y = i % 5 * cell, i // 5 * cell
            done.append(all_of_them[y : y + cell, x : x + cell])
    return done


def edges_of(picture, contrast=CONTRAST):
    """Pixels beside which the colour changes, at once or, anti-aliased, over two pixels."""
    edge = np.zeros(picture.shape[:2], bool)
    for axis in (0, 1):
        part = lambda first, last: tuple(slice(first, last) if a == axis else slice(None) for a in (0, 1))
        step = np.abs(np.diff(picture, axis=axis)).max(axis=2) >= contrast
        edge[part(0, -1)] |= step
        edge[part(1, None)] |= step
        edge[part(1, -1)] |= np.abs(picture[part(2, None)] - picture[part(0, -2)]).max(axis=2) >= contrast
    return edge


def judge(drawing, picture, scale):
    """Shares of the length where no edge and not even a faint one is seen, share of the edges that nothing is drawn of."""
    edge, faint = edges_of(picture), edges_of(picture, FAINT)
    if not edge.any():
        return None
    to_edge, to_faint = distance_transform_edt(~edge), distance_transform_edt(~faint)
    wrong, length = np.zeros(2), 0.0
    explained = np.zeros(edge.shape, bool)
    by_pen = {}
    for stroke in drawing["strokes"]:
        points = corners(stroke, 2 / scale) * scale + MARGIN
        pen = 0.5 * (stroke.get("pen_px") or 0.0) * scale
        for places, long in along(points):
            count = len(places)
            x, y = places.T
            column, row = x.astype(int), y.astype(int)
            inside = (row >= 0) & (row < edge.shape[0]) & (column >= 0) & (column < edge.shape[1])
            for i, distance in enumerate((to_edge, to_faint)):
                far = np.full(count, True)
                far[inside] = distance[row[inside], column[inside]] > pen + NEAR
                wrong[i] += long * far.mean()
            length += long
            by_pen.setdefault(round(2 * pen) / 2, []).append((row[inside], column[inside]))
    for pen, places in by_pen.items():
        drawn = np.zeros(edge.shape, bool)
        for row, column in places:
            drawn[row, column] = True
        # the corner of a square end lies 1.41 half pens from the line's end
        explained |= distance_transform_edt(~drawn) <= 1.42 * pen + NEAR
    # where the page cuts something, no line has to be
    height, width = (int(round(scale * drawing[key])) for key in ("height_px", "width_px"))
    inner = np.zeros(edge.shape, bool)
    inner[MARGIN + RIM : MARGIN + height - RIM, MARGIN + RIM : MARGIN + width - RIM] = True
    asked = edge & inner
    return *wrong / max(length, 1e-9), (asked & ~explained).sum() / max(asked.sum(), 1)


def overlay(folder, name, drawing, picture, scale):
    """The picture, faint, with the strokes in red."""
    image = Image.fromarray((255 - (255 - picture) // 3).astype(np.uint8)).resize([2 * n for n in picture.shape[1::-1]])
    draw = ImageDraw.Draw(image)
    for stroke in drawing["strokes"]:
        draw.line([tuple(2 * (np.array(p) * scale + MARGIN)) for p in corners(stroke, 2 / scale)], fill=(220, 0, 0))
    image.save(folder / f"{name}.png")


def main():
    options = argparse.ArgumentParser()
    options.add_argument("program")
    options.add_argument("--cache", type=pathlib.Path)
    options.add_argument("--suites", type=pathlib.Path, default=pathlib.Path(__file__).with_name("suites.txt"))
    options.add_argument("--files", nargs="*", type=pathlib.Path)
    options.add_argument("--overlays", type=pathlib.Path)
    options.add_argument("--chromium", default="chromium")
    given = options.parse_args()
    files = given.files
    if files is None:
        if given.cache is None:
            sys.exit("--cache DIR or --files")
        lines = [l for l in given.suites.read_text().splitlines() if l.strip() and not l.startswith("#")]
        files = [file for line in lines for file in files_of(line, given.cache)]
    read = [(file, *strokes_of(given.program, file)) for file in files]
    drawn = [(file, drawing, said) for file, drawing, said in read if drawing]
    scales = [SIDE / max(d["width_px"], d["height_px"]) for _, d, _ in drawn]
    sheets = [(f, d["width_px"] * s, d["height_px"] * s) for (f, d, _), s in zip(drawn, scales)]
    count = dict.fromkeys(["as seen", "faint edges too", "wrong, and told", "wrong, not told", "blank", "not drawn"], 0)
    count["not drawn"] = len(read) - len(drawn)
    for file, drawing, said in read:
        if not drawing:
            print(f"not drawn\t-\t-\t{file}\t{said[-150:]}")
    for (file, drawing, said), scale, picture in zip(drawn, scales, pictures(given.chromium, sheets)):
        shares = judge(drawing, picture, scale)
        if shares is None:
            kind = "blank"
        elif shares[0] <= UNSEEN and shares[2] <= UNDRAWN:
            kind = "as seen"
        elif shares[1] <= UNSEEN and shares[2] <= UNDRAWN:
            kind = "faint edges too"
        else:
            told = "not applied" in said or "not drawn: text" in said or "pictures" in said or "patterns" in said or "is drawn in" in said or "inside gradients" in said
            kind = "wrong, and told" if told else "wrong, not told"
        count[kind] += 1
        print(kind, *(f"{s:.3f}" for s in shares or ()), file, said.replace("\n", " | ")[:200], sep="\t")
        if given.overlays and kind.startswith("wrong"):
            given.overlays.mkdir(parents=True, exist_ok=True)
            name = hashlib.sha1(str(file).encode()).hexdigest()[:6] + "-" + file.stem[-40:]
            overlay(given.overlays, name, drawing, picture, scale)
    judged = sum(count[k] for k in count if k not in ("blank", "not drawn"))
    print()
    for kind, number in count.items():
        share = f" {100 * number / max(judged, 1):.0f} %" if kind not in ("blank", "not drawn") else ""
        print(f"{kind:16} {number:5}{share}")


if __name__ == "__main__":
    main()
