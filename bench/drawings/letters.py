"""Are the letters of SVGs drawn? Compares strokes with where Chromium has each letter.

    python letters.py PROGRAM --cache DIR [--suites suites.txt] [--chromium PATH] [--most 100]

Of each repository of the list, takes the first files that hold text, in the order of a hash of their paths. Both sides get a copy whose
text is in DejaVu Sans, the font that the program carries. A letter is seen if Chromium has a box for it and its picture an edge in the box;
it is drawn if strokes of a third of the box's height lie in it. Prints a line a file and a table.
"""

import argparse, html, json, pathlib, re, subprocess, tempfile

import numpy as np

from seen import CHROMIUM, MARGIN, SIDE, along, corners, edges_of, files_of, pictures, strokes_of

STYLE = '<style type="text/css">text, text *, textPath, tspan { font-family: "DejaVu Sans" !important }</style>'
SIZE = 1000  # px, the frame in which a file is shown
SCRIPT = """
const frames = [...document.querySelectorAll('iframe')];
const matrix = (m, x, y) => [m.a * x + m.c * y + m.e, m.b * x + m.d * y + m.f];
addEventListener('load', () => {
  const found = frames.map(frame => {
    const root = frame.contentDocument && frame.contentDocument.documentElement;
    if (!root || root.localName !== 'svg') return null;
    const sheet = root.getBoundingClientRect(), letters = [];
    for (const text of root.querySelectorAll('text')) {
      const on = text.getScreenCTM && text.getScreenCTM();
      const count = on ? text.getNumberOfChars() : 0;
      // the letters that are addressed are those after white space is collapsed; where that leaves others, all count
      const written = [text.textContent, text.textContent.replace(/\\s+/g, ' ').trim()].find(t => t.length === count) || '';
      for (let i = 0; i < count; i++) {
        let box;
        try { box = text.getExtentOfChar(i); } catch { continue; }
        if (written && written[i].trim() === '') continue;
        if (!(box.width > 0 && box.height > 0)) continue;
        const [x0, y0, x1, y1] = [box.x, box.y, box.x + box.width, box.y + box.height];
        letters.push([[x0, y0], [x1, y0], [x1, y1], [x0, y1]].map(([x, y]) => matrix(on, x, y))
          .map(([x, y]) => [x - sheet.left, y - sheet.top]));
      }
    }
    return {width: sheet.width, letters};
  });
  document.body.textContent = JSON.stringify(found);
});
"""


def letters_of(chromium, files):
    """For each file the width it is shown with and the four corners of each letter's box, px of the frame; None where it shows nothing."""
    frames = "".join(f'<iframe src="{f.resolve().as_uri()}" style="border:0;width:{SIZE}px;height:{SIZE}px"></iframe>' for f in files)
    with tempfile.TemporaryDirectory() as folder:
        page = pathlib.Path(folder, "page.html")
        page.write_text(f"<!doctype html><meta charset=utf-8><body>{frames}<script>{SCRIPT}</script>")
        run = subprocess.run([chromium, *CHROMIUM, f"--user-data-dir={folder}/profile", "--virtual-time-budget=20000", "--dump-dom", page.as_uri()],
                             capture_output=True, text=True, timeout=180)
    body = re.search(r"<body>(.*)</body>", run.stdout, re.S)
    return json.loads(html.unescape(body.group(1))) if body else [None] * len(files)


def inside(box, points):
    """Which points lie in a convex box of four corners, either way round."""
    sides = [np.cross(b - a, points - a) for a, b in zip(box, np.roll(box, -1, axis=0))]
    return np.all([s >= 0 for s in sides], axis=0) | np.all([s <= 0 for s in sides], axis=0)


def judge(drawing, found, picture, scale):
    """Letters seen and drawn."""
    to_sheet = drawing["width_px"] / found["width"]
    edge = edges_of(picture)
    row, column = np.nonzero(edge)
    seen_at = np.stack([column, row], axis=1) - MARGIN
    middles, lengths = [np.zeros((0, 2))], [np.zeros(0)]
    for stroke in drawing["strokes"]:
        for places, long in along(corners(stroke, 2 / scale) * scale):
            middles.append(places)
            lengths.append(np.full(len(places), long / len(places)))
    middles, lengths = np.concatenate(middles), np.concatenate(lengths)
    seen = drawn = 0
    for box in found["letters"]:
        box = np.array(box) * to_sheet * scale
        centre = box.mean(axis=0)
        height = np.linalg.norm(box[3] - box[0])
        if inside(centre + (box - centre) * 0.8, seen_at).sum() < 3:
            continue
        seen += 1
        drawn += lengths[inside(centre + (box - centre) * 1.1, middles)].sum() >= 0.3 * height
    return seen, drawn


def main():
    options = argparse.ArgumentParser()
    options.add_argument("program")
    options.add_argument("--cache", type=pathlib.Path, required=True)
    options.add_argument("--suites", type=pathlib.Path, default=pathlib.Path(__file__).with_name("suites.txt"))
    options.add_argument("--chromium", default="chromium")
    options.add_argument("--most", type=int, default=100, help="files of a repository")
    given = options.parse_args()
    lines = [l for l in given.suites.read_text().splitlines() if l.strip() and not l.startswith("#")]
    table = {}
    with tempfile.TemporaryDirectory() as folder:
        for line in lines:
            repository = line.split()[0]
            with_text = lambda p: "<text" in (t := p.read_text(errors="replace")) and "</svg>" in t and "</text>" in t
            files = [p for p in files_of(f"{repository} 1000000", given.cache) if with_text(p)][: given.most]
            copies = []
            for i, file in enumerate(files):
                copy = pathlib.Path(folder, f"{repository.replace('/', '+')}-{i}.svg")
                text = file.read_text(errors="replace")
                at = text.rindex("</svg>")
                copy.write_text(text[:at] + STYLE + text[at:])
                copies.append(copy)
            for first in range(0, len(copies), 20):
                some = copies[first : first + 20]
                found = letters_of(given.chromium, some)
                read = [strokes_of(given.program, copy) for copy in some]
                scales = [SIDE / max(d["width_px"], d["height_px"]) if d else 1 for d, _ in read]
                sheets = [(c, d["width_px"] * s if d else 1, d["height_px"] * s if d else 1) for c, (d, _), s in zip(some, read, scales)]
                for file, where, (drawing, said), scale, picture in zip(files[first:], found, read, scales, pictures(given.chromium, sheets)):
                    if not where or not where["letters"] or not where["width"]:
                        continue
                    seen, drawn = judge(drawing, where, picture, scale) if drawing else (len(where["letters"]), 0)
                    row = table.setdefault(repository, [0, 0, 0, 0])
                    missing = "no font has" in said or "cannot be drawn" in said
                    for k, v in enumerate((1, seen, drawn, (seen - drawn) * missing)):
                        row[k] += v
                    print(f"{drawn}/{seen}", file.relative_to(given.cache), said.replace("\n", " | ")[-160:] if drawn < seen else "", sep="\t")
    print(f"\n{'repository':40}{'files':>7}{'letters':>9}{'drawn':>8}{'told':>6}")
    for repository, row in [*table.items(), ("all", np.sum(list(table.values()), axis=0))]:
        print(f"{repository:40}{row[0]:7}{row[1]:9}{row[2]:8}{row[3]:6}  {100 * row[2] / max(row[1], 1):.1f} %")


if __name__ == "__main__":
    main()
