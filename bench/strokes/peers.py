"""Our tracer beside others: strokes against the truth, and time on one core.

Run by run.sh, which installs what it can. Whatever is missing is said and left out. Pictures and scores come from
tracelight-bench-strokes, so every tracer is judged by the same rules; tables are printed as Markdown.
"""

import argparse
import importlib
import json
import multiprocessing
import os
import re
import shutil
import statistics
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
BENCH = ROOT / "target/release/tracelight-bench-strokes"
WORK = ROOT / "target/strokes-peers"
PATIENCE_S = 30  # a tracer that takes longer on one picture has lost it
TOO_SLOW_S = 10  # a tool that will take longer is not timed at that size


def optional(name):
    try:
        return importlib.import_module(name)
    except Exception as why:  # a broken wheel is as good as none
        print(f"!!! no {name} ({why}): left out", file=sys.stderr)
        return None


cv2 = optional("cv2")
np = optional("numpy")
skimage = optional("skimage")
skan = optional("skan")
vtracer = optional("vtracer")
autotrace = optional("autotrace")
POTRACE = shutil.which("potrace")
if not POTRACE:
    print("!!! no potrace: left out", file=sys.stderr)
if not (cv2 and np):
    sys.exit("OpenCV and NumPy are needed to read pictures: nothing can be compared")
cv2.setNumThreads(1)


# --- ink ---------------------------------------------------------------------------------------------------------------


def otsu(grey):
    """Ink is 255. Whichever is rarer, dark or light, is ink."""
    _, mask = cv2.threshold(grey, 0, 255, cv2.THRESH_BINARY_INV | cv2.THRESH_OTSU)
    return 255 - mask if np.count_nonzero(mask) * 2 > mask.size else mask


def flat(grey):
    """Light evened by hand: median, closing, divide; then Otsu, and what is small dropped."""
    h = grey.shape[0]
    if np.median(grey) < 110:
        grey = 255 - grey
    quiet = cv2.medianBlur(grey, 3)
    window = max(15, (h // 8) | 1)
    paper = cv2.morphologyEx(quiet, cv2.MORPH_CLOSE, np.ones((window, window), np.uint8))
    paper = cv2.GaussianBlur(paper, (0, 0), window / 3)
    even = np.clip(quiet.astype(np.float32) * 255 / np.maximum(paper, 1), 0, 255).astype(np.uint8)
    _, mask = cv2.threshold(even, 0, 255, cv2.THRESH_BINARY_INV | cv2.THRESH_OTSU)
    _, labels, stats, _ = cv2.connectedComponentsWithStats(mask)
    large = stats[:, cv2.CC_STAT_AREA] >= 0.15 * (h / 12) ** 2
    large[0] = False
    return (large[labels] * 255).astype(np.uint8)


# --- tracers: mask or grey to [(points, closed)] -----------------------------------------------------------------------


def contours(mask):
    found, _ = cv2.findContours(mask, cv2.RETR_CCOMP, cv2.CHAIN_APPROX_NONE)
    return [(c[:, 0] + 0.5, True) for c in found if len(c) > 2]


def skeleton(mask):
    from skimage.morphology import skeletonize

    return skeletonize(mask > 0)


def skeleton_skan(mask):
    thin = skeleton(mask)
    if np.count_nonzero(thin) < 2:
        return []
    graph = skan.Skeleton(thin)
    return [(graph.path_coordinates(i)[:, ::-1] + 0.5, False) for i in range(graph.n_paths)]


def thinning_graph(mask):
    """OpenCV's skeleton, chains of pixels between junction pixels."""
    thin = cv2.ximgproc.thinning(mask) > 0
    left = {tuple(p) for p in np.argwhere(thin)}
    ring = [(a, b) for a in (-1, 0, 1) for b in (-1, 0, 1) if a or b]
    near = {p: [q for q in ((p[0] + a, p[1] + b) for a, b in ring) if q in left] for p in left}
    used, chains = set(), []

    def walk(start, then):
        chain = [start, then]
        used.update([(start, then), (then, start)])
        while len(near[chain[-1]]) == 2:
            onward = [q for q in near[chain[-1]] if q != chain[-2]]
            if not onward or (chain[-1], onward[0]) in used:
                break
            used.update([(chain[-1], onward[0]), (onward[0], chain[-1])])
            chain.append(onward[0])
        chains.append(chain)

    for ends_only in (True, False):
        for p in sorted(left):
            if (len(near[p]) != 2) == ends_only:
                for q in near[p]:
                    if (p, q) not in used:
                        walk(p, q)
    return [(np.array(c)[:, ::-1] + 0.5, False) for c in chains]


def potrace(mask):
    cv2.imwrite(str(WORK / "potrace.pbm"), 255 - mask)
    command = [POTRACE, "-s", "-o", "-", str(WORK / "potrace.pbm")]
    return svg_lines(subprocess.run(command, capture_output=True, text=True, check=True).stdout)


def vtrace_svg(grey):
    ok, png = cv2.imencode(".png", grey)
    return vtracer.convert_raw_image_to_svg(png.tobytes(), img_format="png", colormode="binary")


def vtrace(mask):
    return svg_lines(vtrace_svg(255 - mask))


def autotrace_svg(mask):
    rgb = np.repeat((255 - mask)[..., None], 3, 2)
    return autotrace.Bitmap(rgb).trace(centerline=True, background_color=(255, 255, 255)).encode("svg")


def autotrace_lines(mask):
    # its frame, by lines drawn at known pixels: half a pixel to the left of ours, and half a pixel down
    svg = autotrace_svg(mask)
    lines = svg_lines(svg.decode() if isinstance(svg, bytes) else svg)
    return [(points + [0.5, -0.5], closed) for points, closed in lines]


NUMBER = r"-?\d*\.?\d+(?:e-?\d+)?"


def svg_lines(text):
    """Polylines of the paths of a simple SVG: M L H V C Z, a path's or the group's translate and scale."""
    lines = []
    group = re.search(r"<g[^>]*transform=\"([^\"]*)\"", text)
    for tag in re.findall(r"<path[^>]*>", text, re.S):
        own = re.search(r"transform=\"([^\"]*)\"", tag)
        place = transform(own or group)
        for points, closed in path_lines(re.search(r"\sd=\"([^\"]*)\"", tag, re.S).group(1)):
            lines.append((place(np.array(points)), closed))
    return [(p, c) for p, c in lines if len(p) > 1]


def transform(found):
    text = found.group(1) if found else ""
    pair = lambda word, default: [float(v) for v in re.findall(NUMBER, (re.search(word + r"\(([^)]*)\)", text) or ["", default])[1])]
    shift, scale = pair("translate", "0,0"), pair("scale", "1,1")
    return lambda p: p * np.resize(scale, 2) + np.array((shift + [0.0])[:2])


def path_lines(d):
    tokens = re.findall(rf"[MmLlCcZzHhVv]|{NUMBER}", d)
    at, start, lines, line, command, i = np.zeros(2), np.zeros(2), [], [], "M", 0

    def numbers(count):
        nonlocal i
        i += count
        return [float(t) for t in tokens[i - count : i]]

    while i < len(tokens):
        if tokens[i].isalpha():
            command = tokens[i]
            i += 1
        base = at if command.islower() else np.zeros(2)
        if command in "Zz":
            if line:
                lines.append((line, True))
            line, at = [], start
        elif command in "Mm":
            if line:
                lines.append((line, False))
            at = start = base + numbers(2)
            line, command = [at], "l" if command == "m" else "L"
        elif command in "Ll":
            at = base + numbers(2)
            line = line or [start]
            line.append(at)
        elif command in "HhVv":
            value, axis = numbers(1)[0], 0 if command in "Hh" else 1
            at = at.copy()
            at[axis] = value + base[axis]
            line.append(at)
        else:
            p = base + np.array(numbers(6)).reshape(3, 2)
            t = np.linspace(0, 1, 17)[1:, None]
            line = line or [start]
            line += list((1 - t) ** 3 * at + 3 * (1 - t) ** 2 * t * p[0] + 3 * (1 - t) * t * t * p[1] + t**3 * p[2])
            at = p[2]
    if line:
        lines.append((line, False))
    return lines


def tracers():
    """Name to a function of the grey picture. Centreline tracers first; the rest draw outlines by design."""
    table = {}
    if skan:
        table["Otsu + skimage skeletonize + skan"] = lambda g: skeleton_skan(otsu(g))
        table["flatten + skimage skeletonize + skan"] = lambda g: skeleton_skan(flat(g))
    table["flatten + OpenCV thinning + pixel graph"] = lambda g: thinning_graph(flat(g))
    if autotrace:
        table["Otsu + autotrace centreline"] = lambda g: autotrace_lines(otsu(g))
        table["flatten + autotrace centreline"] = lambda g: autotrace_lines(flat(g))
    if POTRACE:
        table["flatten + potrace (outlines)"] = lambda g: potrace(flat(g))
    if vtracer:
        table["flatten + vtracer (outlines)"] = lambda g: vtrace(flat(g))
    table["Otsu + findContours (outlines)"] = lambda g: contours(otsu(g))
    return table


# --- strokes against the truth -----------------------------------------------------------------------------------------


def patient(work, *arguments):
    """Runs in a process of its own: a tracer may crash or never end. None if it did."""
    reader, writer = multiprocessing.Pipe(False)
    process = multiprocessing.Process(target=lambda: writer.send(work(*arguments)))
    process.start()
    writer.close()
    result = None
    try:
        if reader.poll(PATIENCE_S):
            result = reader.recv()
    except EOFError:
        pass
    if process.is_alive():
        process.terminate()
    process.join()
    return result


def save_strokes(file, grey, lines):
    strokes = []
    for points, closed in lines:
        points = [[round(float(x), 3), round(float(y), 3)] for x, y in points]
        if len({tuple(p) for p in points}) > 1:
            strokes.append({"closed": bool(closed), "points": points})
    h, w = grey.shape
    file.write_text(json.dumps({"width_px": w, "height_px": h, "mode": "peer", "strokes": strokes}))


def bench(*arguments):
    return subprocess.run([BENCH, *map(str, arguments)], check=True, capture_output=True, text=True).stdout


FIELDS = ["drawn", "truth", "matched", "rms", "max", "missed", "false", "doubled", "length"]


def scores(truth, drawn):
    """Scores of stroke files against a truth file; {} for one that cannot be read."""
    rows = {}
    for file in drawn:
        try:
            line = bench("score", truth, file).splitlines()[-1]
            rows[file] = dict(zip(FIELDS, map(float, line.split()[-len(FIELDS) :])))
        except (subprocess.CalledProcessError, ValueError):
            rows[file] = {}
    return rows


def judge(folder):
    """Every picture of a folder by every tracer: {(tracer, picture): score}."""
    ours = WORK / "ours"
    pictures = sorted(folder.glob("*.png"))
    bench("trace", *pictures, "--out", ours)
    judged = {}
    for picture in pictures:
        grey, truth = cv2.imread(str(picture), cv2.IMREAD_GRAYSCALE), picture.with_suffix(".json")
        files = {"Tracelight": ours / truth.name}
        for number, (name, tracer) in enumerate(tracers().items()):
            lines = patient(tracer, grey)
            file = WORK / f"peer{number}.json"
            save_strokes(file, grey, lines or [])
            files[name] = file
        found = scores(truth, files.values())
        judged.update({(name, picture.stem): found[file] for name, file in files.items()})
        print(f"judged {picture.stem}", file=sys.stderr)
    return judged


def told_nine(judged):
    pictures = [f"nine-{how}-{size}" for size in ("320x240", "1280x720") for how in ("clean", "webcam")]
    print("| tracer | " + " | ".join(p.removeprefix("nine-") for p in pictures) + " |")
    print("|---|" + "---|" * len(pictures))
    for name in ["Tracelight", *tracers()]:
        cells = []
        for s in (judged[name, p] for p in pictures):
            cells.append(
                f"{s['drawn']:.0f} ({s['matched']:.0f} right), rms {s['rms']:.2f}, missed {s['missed']:.1f} %, "
                f"false {s['false']:.1f} %, ×{s['length']:.2f}" if s else "–"
            )
        print(f"| {name} | " + " | ".join(cells) + " |")


def told_random(judged):
    print("| tracer | exact | ±2 | strokes matched | rms px, median | missed | false | length |")
    print("|---|---|---|---|---|---|---|---|")
    for name in ["Tracelight", *tracers()]:
        rows = [s for (n, _), s in judged.items() if n == name and s]
        share = lambda test: 100 * sum(map(test, rows)) / len(rows)
        off = lambda s: abs(s["drawn"] - s["truth"])
        mean = lambda key: statistics.mean(s[key] for s in rows)
        rms = statistics.median([s["rms"] for s in rows if s["rms"] == s["rms"]] or [float("nan")])
        matched = 100 * sum(s["matched"] for s in rows) / sum(s["truth"] for s in rows)
        length = statistics.median(s["length"] for s in rows)
        print(
            f"| {name} | {share(lambda s: off(s) == 0):.0f} % | {share(lambda s: off(s) <= 2):.0f} % | {matched:.0f} % "
            f"| {rms:.2f} | {mean('missed'):.1f} % | {mean('false'):.1f} % | {length:.2f} |"
        )


# --- time --------------------------------------------------------------------------------------------------------------

SIZES = [(320, 240), (1280, 720), (3840, 2160)]


def horse(w, h):
    from skimage import data

    image = data.horse().astype(np.uint8) * 255
    image = image[..., 0] if image.ndim == 3 else image
    scale = 0.95 * min(w / image.shape[1], h / image.shape[0])
    kind = cv2.INTER_CUBIC if scale > 1 else cv2.INTER_AREA
    small = cv2.resize(image, None, fx=scale, fy=scale, interpolation=kind)
    full = np.full((h, w), 255, np.uint8)
    y, x = (h - small.shape[0]) // 2, (w - small.shape[1]) // 2
    full[y : y + small.shape[0], x : x + small.shape[1]] = small
    return full


def page(w, h):
    from skimage import data

    return cv2.resize(data.page(), (w, h), interpolation=cv2.INTER_CUBIC if w > 384 else cv2.INTER_AREA)


def timed_pictures():
    """(name, size) to a file: the nine strokes, a silhouette, a photographed page."""
    files = {}
    for w, h in SIZES:
        files["lines", w, h] = WORK / "nine" / f"nine-clean-{w}x{h}.png"
        for name, make in (("horse", horse), ("page", page)):
            try:
                file = WORK / f"{name}-{w}x{h}.png"
                cv2.imwrite(str(file), make(w, h))
                files[name, w, h] = file
            except Exception as why:
                print(f"!!! no picture of {name} ({why}): left out", file=sys.stderr)
    return files


def timed_tools():
    """Name to a function of the grey picture, as long as the tool takes in use."""
    tools = {"Otsu + findContours (outlines)": lambda g: cv2.findContours(otsu(g), cv2.RETR_CCOMP, cv2.CHAIN_APPROX_NONE)}
    if skimage:
        tools["Otsu + skimage skeletonize (pixels only)"] = lambda g: skeleton(otsu(g))
    tools["Otsu + OpenCV thinning (pixels only)"] = lambda g: cv2.ximgproc.thinning(otsu(g))
    if POTRACE:
        tools["Otsu + potrace, process (outlines)"] = lambda g: potrace_process(otsu(g))
    if vtracer:
        tools["vtracer, PNG to SVG (outlines)"] = vtrace_svg
    if autotrace:
        tools["Otsu + autotrace centreline"] = lambda g: autotrace_svg(otsu(g))
    return tools


def potrace_process(mask):
    cv2.imwrite(str(WORK / "time.pbm"), 255 - mask)
    subprocess.run([POTRACE, "-s", "-o", os.devnull, str(WORK / "time.pbm")], check=True)


def clock(tool, grey):
    start = time.perf_counter()
    tool(grey)
    return 1e3 * (time.perf_counter() - start)


OURS = {"Tracelight": [], "Tracelight, outlines only": ["--outlines"]}


def ours_ms(file, *options):
    answer = bench("time", file, "--repeat", 9, *options)
    return float(re.search(r"([\d.]+) ms", answer.splitlines()[-1]).group(1))


def time_all(rounds):
    """Milliseconds of every tool on every picture, tool after tool in each round. One core: this process and its children."""
    os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
    tools, taken = timed_tools(), {}
    for (name, w, h), file in timed_pictures().items():
        grey = cv2.imread(str(file), cv2.IMREAD_GRAYSCALE)
        slow = set()
        for number in range(rounds if w < 3840 else min(rounds, 3)):
            for own, options in OURS.items():
                try:
                    taken.setdefault((own, name, w), []).append(ours_ms(file, *options))
                except subprocess.CalledProcessError:
                    taken[own, name, w] = []
            for tool, work in tools.items():
                before = [t for key, t in taken.items() if key[:2] == (tool, name) and key[2] < w]
                if before and w == 3840 and 27e-3 * max(map(statistics.median, before)) > TOO_SLOW_S:
                    slow.add(tool)
                if tool not in slow:
                    taken.setdefault((tool, name, w), []).append(clock(work, grey))
                    # one long call says enough
                    if taken[tool, name, w][-1] > 2000:
                        slow.add(tool)
        print(f"timed {name} {w}x{h}", file=sys.stderr)
    return taken


def told_times(taken):
    columns = [(name, w) for w, _ in SIZES for name in ("lines", "horse", "page")]
    median = lambda tool, name, w: statistics.median(taken.get((tool, name, w)) or [float("nan")])
    print("| tool | " + " | ".join(f"{name} {w}" for name, w in columns) + " |")
    print("|---|" + "---|" * len(columns))
    for tool in [*OURS, *timed_tools()]:
        cells = []
        for name, w in columns:
            # what follows edges is held against ours that does
            ours = "Tracelight, outlines only" if "outlines" in tool else "Tracelight"
            own, other = median(ours, name, w), median(tool, name, w)
            ratio = "" if tool in OURS else f" (ours ×{own / other:.2g})"
            cells.append("–" if other != other else f"{other:.3g}{ratio}")
        print(f"| {tool} | " + " | ".join(cells) + " |")


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--rounds", type=int, default=7, help="times each tool is timed on each picture")
    options.add_argument("--pictures", type=int, default=68, help="random pictures")
    options.add_argument("--only", choices=["nine", "random", "time"], help="one table only")
    chosen = options.parse_args()
    wanted = lambda part: chosen.only in (None, part)
    shutil.rmtree(WORK, ignore_errors=True)
    WORK.mkdir(parents=True)
    bench("make", WORK / "nine", "--nine")
    if skan:  # it compiles itself at its first call, which the processes to come need not do again
        skeleton_skan(flat(cv2.imread(str(WORK / "nine/nine-clean-320x240.png"), cv2.IMREAD_GRAYSCALE)))
    for file in (WORK / "nine").glob("*webcam-3840*"):
        file.unlink()
    if wanted("nine"):
        shutil.copytree(WORK / "nine", WORK / "nine-judged", ignore=shutil.ignore_patterns("*3840*"))
        print("\n### The nine-stroke drawing\n")
        told_nine(judge(WORK / "nine-judged"))
    if wanted("random"):
        bench("make", WORK / "random", "--seed", 3, "--count", chosen.pictures, "--size", "640x480")
        print(f"\n### {chosen.pictures} random drawings × degradations, 640×480\n")
        told_random(judge(WORK / "random"))
    if wanted("time"):
        print("\n### Time, ms, one core, medians; in brackets ours over theirs\n")
        told_times(time_all(chosen.rounds))


if __name__ == "__main__":
    main()
