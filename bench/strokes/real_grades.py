"""What a person said of the strokes, with the program that drew them: a small CSV, a line for each picture and program."""

import csv
import hashlib
import subprocess
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

GRADES = ("as-is", "touch", "wrong")
FIELDS = ("picture", "grade", "remark", "program")


@dataclass
class Grade:
    """One line. `program` is its version and commit."""

    picture: str
    grade: str
    remark: str
    program: str


def read(file):
    """Grades of a file, none if there is no such file. A word that is no grade ends the program."""
    if not file or not Path(file).exists():
        return []
    with open(file, newline="", encoding="utf-8") as lines:
        grades = [Grade(*(line.get(key) or "" for key in FIELDS)) for line in csv.DictReader(lines)]
    for grade in grades:
        known(grade.grade)
    return grades


def known(word):
    """The word, if it is a grade or empty (not looked at yet)."""
    if word and word not in GRADES:
        raise SystemExit(f"grade {word!r} is none of {', '.join(GRADES)}")
    return word


def write(file, grades):
    """Writes grades, sorted by picture, the order of programs kept."""
    with open(file, "w", newline="", encoding="utf-8") as lines:
        writer = csv.writer(lines, lineterminator="\n")
        writer.writerow(FIELDS)
        writer.writerows([getattr(g, key) for key in FIELDS] for g in sorted(grades, key=lambda g: g.picture))


def given(grades, words, pictures, program):
    """Grades with those of `PICTURE=GRADE[:REMARK]` words put in; a picture may be named by its last part."""
    for word in words:
        name, _, said = word.partition("=")
        grade, _, remark = said.partition(":")
        fits = [p for p in pictures if p == name or Path(p).name == name or Path(p).stem == name]
        if len(fits) != 1:
            raise SystemExit(f"--grade {word}: {name} names {len(fits)} of the pictures: {', '.join(fits) or 'none'}")
        grades = [g for g in grades if (g.picture, g.program) != (fits[0], program)]
        grades.append(Grade(fits[0], known(grade), remark.strip(), program))
    return grades


def latest(grades):
    """Picture to its last grade."""
    return {g.picture: g for g in grades if g.grade}


def summary(grades, pictures, program):
    """One line: how many of the pictures have which grade, and how many grades are of this very program."""
    now = [g for p, g in latest(grades).items() if p in pictures]
    if not now:
        return f"graded: none of {len(pictures)}"
    count = Counter(g.grade for g in now)
    told = ", ".join(f"{word} {count[word]} ({count[word] / len(now):.0%})" for word in GRADES)
    older = sum(g.program != program for g in now)
    return f"graded: {len(now)} of {len(pictures)}: {told}" + (f"; {older} of them looked at with another program" if older else "")


def program_of(path, root):
    """Version and commit of a program; where it was not built in this checkout, its version and what its bytes hash to."""
    version = subprocess.run([path, "--version"], capture_output=True, text=True).stdout.strip()
    if Path(path).resolve().is_relative_to(root):
        commit = ["git", "-C", str(root), "describe", "--always", "--dirty", "--abbrev=9"]
        return f"{version} {subprocess.run(commit, capture_output=True, text=True).stdout.strip()}"
    return f"{version} sha256:{hashlib.sha256(Path(path).read_bytes()).hexdigest()[:9]}"
