#!/usr/bin/env python3
"""Real pictures, whose strokes nobody knows: ours and a peer held against the pictures' own ink, and laid over them.

    python bench/strokes/real.py PICTURES/ [MORE.png …] [--grades grades.csv]

Needs NumPy, SciPy, scikit-image and Pillow, and pyautotrace for the peer. Writes into target/real: figures.csv, look-01.png …
(twelve of our overlays a page), beside-01.png … (picture, ours, peer), sheet.html (all of it in one file). What the figures
mean and how to grade stands in README.md. Pictures are looked at, never copied into the repository.
"""

import argparse
import csv
import os
import sys
import traceback
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path

import real_grades
import real_ink
import real_score
import real_sheet
import real_tracers

ROOT = Path(__file__).resolve().parents[2]
KINDS = {".png", ".jpg", ".jpeg", ".bmp", ".gif", ".tif", ".tiff", ".webp", ".pgm", ".ppm"}
SIZES = (real_sheet.PANEL, real_sheet.WITHIN)
FIGURES = ("strokes", "false", "missed", "light", "flying", "outlines", "seconds")


@dataclass
class Looked:
    """What came of one picture: tracer to score or to why there is none, and images for the sheets."""

    name: str
    unsure: float = 0.0
    pen: float = 0.0
    said: str = ""
    scores: dict = field(default_factory=dict)
    panels: dict = field(default_factory=dict)


def pictures_of(places):
    """(name, file) of pictures and of those in folders, in order; names begin with the folder's."""
    for place in map(Path, places):
        files = sorted(f for f in place.rglob("*") if f.suffix.lower() in KINDS) if place.is_dir() else [place]
        top = place.resolve().parent if place.is_dir() else place.resolve().parents[1]
        yield from ((str(f.resolve().relative_to(top)), f) for f in files)


def look(name, file, options):
    """Everything about one picture; a picture that breaks the scorer is told, not fatal."""
    looked = Looked(name)
    try:
        image = real_ink.opened(file)
        ink = real_ink.found(image)
    except Exception:
        looked.said = "not read: " + traceback.format_exc(limit=0).strip().splitlines()[-1]
        return looked
    looked.unsure, looked.pen = ink.unsure, ink.pen
    looked.panels["picture"] = [real_sheet.panel(image, size)[0] for size in SIZES]
    strokes, seconds, looked.said = real_tracers.ours(options.program, file, options.flags.split())
    judge(looked, "ours", image, ink, strokes, seconds, looked.said)
    for peer in options.peers:
        scratch = options.out / f"mask-{os.getpid()}.png"
        judge(looked, peer, image, ink, *real_tracers.peer(peer, ink.flat, scratch))
        scratch.unlink(missing_ok=True)
    return looked


def judge(looked, tracer, image, ink, strokes, seconds, said):
    """Puts a tracer's score and overlays in place."""
    score = None if strokes is None else real_score.scored(strokes, ink, seconds)
    looked.scores[tracer] = said if score is None else score
    looked.panels[tracer] = [real_sheet.overlay(image, strokes or [], score, size) for size in SIZES]
    if score:
        score.missed_at, score.flying_parts = None, []  # large, and drawn already


# --- words -------------------------------------------------------------------------------------------------------------


def told(score):
    """A score in one line."""
    if isinstance(score, str):
        return "refused: " + score.replace("\n", " ")[:160]
    light = "   – " if score.light != score.light else f"×{score.light:4.2f}"
    return (
        f"strokes {score.strokes:4} false {score.false:6.2%} missed {score.missed:6.2%} light {light} "
        f"flying {score.flying:5.0f} px outlines {score.outlines:4.0%} {score.seconds:6.2f} s"
    )


def verdict(score):
    """Whether it passes, and by what not."""
    if isinstance(score, str):
        return "MISS: refused"
    return "ok" if score.passes() else "MISS: " + " ".join(score.faults())


def passes(score):
    return not isinstance(score, str) and score.passes()


def table(all_looked, tracers):
    """The lines of the table."""
    width = max(len(looked.name) for looked in all_looked)
    for looked in all_looked:
        for tracer in tracers if looked.scores else []:
            score = looked.scores[tracer]
            name = looked.name if tracer == tracers[0] else ""
            yield f"{name:{width}} {tracer:9} {verdict(score):28} {told(score)}"
        if not looked.scores:
            yield f"{looked.name:{width}} {looked.said}"
    for tracer in tracers:
        yield f"{tracer}: {sum(passes(looked.scores.get(tracer, '')) for looked in all_looked)} of {len(all_looked)} pass"


def write_csv(file, all_looked):
    with open(file, "w", newline="", encoding="utf-8") as lines:
        writer = csv.writer(lines, lineterminator="\n")
        writer.writerow(["picture", "tracer", "passes", "faults", *FIGURES, "pen", "unsure", "said"])
        for looked in all_looked:
            for tracer, score in looked.scores.items():
                refused = isinstance(score, str)
                values = [""] * len(FIGURES) if refused else [f"{getattr(score, key):.5g}" for key in FIGURES]
                faults = "refused" if refused else " ".join(score.faults())
                said = looked.said if tracer == "ours" else (score if refused else "")
                row = [looked.name, tracer, int(passes(score)), faults, *values]
                writer.writerow([*row, f"{looked.pen:.3g}", f"{looked.unsure:.3g}", said])


# --- sheets ------------------------------------------------------------------------------------------------------------


def graded(grade, program):
    """A grade in words."""
    if not grade:
        return "not graded"
    return grade.grade + (f": {grade.remark}" if grade.remark else "") + ("" if grade.program == program else f" ({grade.program})")


def write_sheets(all_looked, tracers, grades, heads, options):
    """PNG pages and the HTML."""
    latest = real_grades.latest(grades)
    for old in [*options.out.glob("look-*.png"), *options.out.glob("beside-*.png")]:
        old.unlink()
    shown = [looked for looked in all_looked if looked.scores]
    mark = lambda looked: graded(latest.get(looked.name), options.version)
    line = lambda looked, tracer: f"{verdict(looked.scores[tracer])}\n{short(looked.scores[tracer])}"
    ours = [[(looked.panels["ours"][1], f"{line(looked, 'ours')}\n{looked.name} - {mark(looked)}")] for looked in shown]
    real_sheet.pages(ours, options.out, "look", 3, 4)
    columns = ["picture", *tracers]
    text = lambda looked, c: f"{looked.name}\n{mark(looked)}" if c == "picture" else f"{line(looked, c)}\n{c}"
    rows = [[(looked.panels[c][1], text(looked, c)) for c in columns] for looked in shown]
    real_sheet.pages(rows, options.out, "beside", len(columns), 4)
    sections = [section(looked, columns, mark(looked)) for looked in shown]
    (options.out / "sheet.html").write_text(real_sheet.page("Strokes of real pictures", heads, sections), encoding="utf-8")


def short(score):
    """A score in few words."""
    if isinstance(score, str):
        return score[:60]
    light = "none" if score.light != score.light else f"{score.light:.2f}"
    return f"{score.strokes} strokes, false {score.false:.1%}, missed {score.missed:.1%}, light {light}, outlines {score.outlines:.0%}"


def section(looked, columns, mark):
    scores = looked.scores
    figures = [(looked.panels["picture"][0], "picture", f"pen {looked.pen:.1f} px, unsure {looked.unsure:.0%}")]
    figures += [(looked.panels[c][0], c, f"{verdict(scores[c])} · {short(scores[c])}") for c in columns[1:]]
    return real_sheet.section(f"{looked.name} · {mark}", verdict(scores["ours"]), passes(scores["ours"]), looked.said, figures)


def arguments():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("places", nargs="+", metavar="DIR|PICTURE", help="pictures, and folders of pictures")
    options.add_argument("--program", default=str(ROOT / "target/release/tracelight"), help="the program that is judged")
    options.add_argument("--flags", default="", help="flags of its strokes, such as '--mode centreline'")
    options.add_argument("--out", type=Path, default=ROOT / "target/real", help="folder for what is written")
    options.add_argument("--peers", choices=["auto", "none"], default="auto", help="other tracers beside it")
    options.add_argument("--jobs", type=int, default=1, help="pictures at the same time")
    options.add_argument("--grades", type=Path, help="CSV of grades: shown, and where --grade is written")
    options.add_argument("--grade", action="append", default=[], metavar="PICTURE=GRADE[:REMARK]",
                         help=f"a grade to write: {', '.join(real_grades.GRADES)}")  # fmt: skip
    options.add_argument("--only-grade", action="store_true", help="write the grades, trace nothing")
    return options.parse_args()


def main():
    options = arguments()
    pictures = list(pictures_of(options.places))
    names = [name for name, _ in pictures]
    if not pictures:
        sys.exit(f"no picture in {', '.join(options.places)}")
    if options.grade and not options.grades:
        sys.exit("--grade needs --grades FILE, where it is written")
    if not Path(options.program).exists():
        sys.exit(f"no program {options.program}: build it (cargo build --release -p tracelight), or name it with --program")
    options.out.mkdir(parents=True, exist_ok=True)
    options.version = real_grades.program_of(options.program, ROOT)
    grades = real_grades.given(real_grades.read(options.grades), options.grade, names, options.version)
    if options.grade:
        real_grades.write(options.grades, grades)
    if not options.only_grade:
        run(pictures, grades, options)
    print(real_grades.summary(grades, names, options.version))


def run(pictures, grades, options):
    """Traces, scores, writes."""
    options.peers = real_tracers.peers(options.peers)
    with ProcessPoolExecutor(options.jobs) as pool:
        waiting = [pool.submit(look, name, file, options) for name, file in pictures]
        all_looked = [told_progress(work.result(), len(waiting)) for work in waiting]
    tracers = ["ours", *options.peers]
    lines = list(table(all_looked, tracers))
    print("\n".join(lines))
    write_csv(options.out / "figures.csv", all_looked)
    summary = real_grades.summary(grades, [name for name, _ in pictures], options.version)
    write_sheets(all_looked, tracers, grades, [options.version, *lines[-len(tracers) :], summary], options)
    print(f"sheets: {options.out}/sheet.html, look-01.png …, beside-01.png …")


def told_progress(looked, count):
    print(f"{looked.name} (of {count})", file=sys.stderr)
    return looked


if __name__ == "__main__":
    main()
