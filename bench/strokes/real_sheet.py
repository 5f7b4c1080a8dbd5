"""Contact sheets: strokes laid over pictures, as one HTML file and as PNG pages that a person looks through in minutes."""

import base64
import colorsys
import html
import io

import numpy as np
from PIL import Image, ImageDraw, ImageFont

import real_score

PANEL = (960, 800)  # px: a picture in the HTML is at most so large
CELL = (460, 380)  # px: on a PNG page
WITHIN = (CELL[0] - 6, CELL[1] - 6)  # px: the picture in its cell
TEXT = 54  # px under a cell: three lines
TINT = (120, 170, 255)  # of what outlines enclose
RED, ORANGE = (230, 0, 0), (255, 140, 0)


def panel(image, size):
    """The picture within `size`, and the scale; little figures are enlarged up to six times."""
    scale = min(size[0] / image.width, size[1] / image.height, 6)
    small = (max(1, round(image.width * scale)), max(1, round(image.height * scale)))
    return image.resize(small, Image.LANCZOS if scale < 1 else Image.NEAREST), scale


def overlay(image, strokes, score, size):
    """Strokes in colours of their own over the faded picture: rings at open ends, outlines tinted inside and with a square
    at their start, missed ink orange, flying stretches red and thick. Drawn twice as large and reduced, which smooths it."""
    under, scale = panel(image, (size[0] * 2, size[1] * 2))
    shown = Image.blend(under, Image.new("RGB", under.size, "white"), 0.62)
    tinted(shown, real_score.within(strokes, (image.height, image.width)), TINT, 110)
    if score and score.missed_at is not None:
        tinted(shown, score.missed_at, ORANGE, 255)
    draw = ImageDraw.Draw(shown)
    for number, stroke in enumerate(strokes):
        one(draw, stroke, colour(number), scale, ring=7 if len(strokes) < 80 else 4)
    for part in score.flying_parts if score else []:
        draw.line([tuple(p) for p in part * scale], fill=RED, width=9, joint="curve")
    return shown.resize((max(1, shown.width // 2), max(1, shown.height // 2)), Image.BOX)


def tinted(image, mask, ink, most):
    """Colours the image where the mask is, with at most `most` of 255; a single pixel of a large picture shows still."""
    if mask.any():
        at = Image.fromarray((mask * 255).astype(np.uint8)).resize(image.size, Image.BOX)
        image.paste(ink, mask=at.point(lambda v: min(most, 3 * v)))


def colour(number):
    """Neighbours in the order differ: the hue goes on by the golden ratio; no orange, no pure red."""
    return tuple(int(255 * c) for c in colorsys.hsv_to_rgb(0.15 + 0.8 * (number * 0.381966 % 1), 1, 0.75))


def one(draw, stroke, ink, scale, ring):
    """One stroke, its ends and, of an outline, its start."""
    points = np.vstack([stroke.points, stroke.points[:1]]) if stroke.closed else stroke.points
    points = [tuple(p) for p in points * scale]
    if len(points) > 1:
        draw.line(points, fill=ink, width=4 if ring > 4 else 3, joint="curve")
    for x, y in [] if stroke.closed else [points[0], points[-1]]:
        draw.ellipse((x - ring, y - ring, x + ring, y + ring), outline=ink, width=2)
    if stroke.outline:
        x, y = points[0]
        draw.rectangle((x - ring, y - ring, x + ring, y + ring), fill=ink)


# --- PNG pages ---------------------------------------------------------------------------------------------------------


def pages(rows, folder, name, columns, lines):
    """Writes `name-01.png`…: `rows` are rows of (image, line of text) cells that are filled in order. Returns the files."""
    cells = [cell for row in rows for cell in row]
    each, files = columns * lines, []
    for number, first in enumerate(range(0, len(cells), each), 1):
        page = Image.new("RGB", (columns * CELL[0], lines * (CELL[1] + TEXT)), "white")
        for place, (image, text) in enumerate(cells[first : first + each]):
            x, y = place % columns * CELL[0], place // columns * (CELL[1] + TEXT)
            written(page, image, text, x, y)
        files.append(folder / f"{name}-{number:02}.png")
        page.save(files[-1])
    return files


def written(page, image, text, x, y):
    """A cell with three lines of text under it."""
    page.paste(image, (x + (CELL[0] - image.width) // 2, y + (CELL[1] - image.height) // 2))
    draw = ImageDraw.Draw(page)
    font = ImageFont.load_default(13)
    for line, words in enumerate(text.split("\n")[:3]):
        draw.text((x + 6, y + CELL[1] + 16 * line), words[:68], fill=RED if words.startswith("MISS") else "black", font=font)
    draw.rectangle((x, y, x + CELL[0] - 1, y + CELL[1] + TEXT - 1), outline=(190, 190, 190))


# --- HTML --------------------------------------------------------------------------------------------------------------

STYLE = """
:root { color-scheme: light dark; --back: #fff; --text: #1b1b1b; --quiet: #666; --line: #ddd; --bad: #b3261e; --good: #1b7f3b }
@media (prefers-color-scheme: dark) { :root { --back: #16181b; --text: #e8e8e8; --quiet: #9aa0a6; --line: #33373c;
  --bad: #ff8a80; --good: #7bd88f } }
* { box-sizing: border-box } body { margin: 0 auto; padding: 1rem; max-width: 1600px; background: var(--back);
  color: var(--text); font: 15px/1.45 system-ui, sans-serif }
h1 { font-size: 1.3rem } h2 { font-size: 1rem; margin: 0; overflow-wrap: anywhere }
p { margin: .2rem 0 } .quiet { color: var(--quiet) } .bad { color: var(--bad) } .good { color: var(--good) }
section { border-top: 1px solid var(--line); padding: .7rem 0 }
.row { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 300px), 1fr)); gap: .6rem; margin-top: .4rem }
figure { margin: 0; min-width: 0 } figcaption { font-size: .85rem; font-variant-numeric: tabular-nums }
label { cursor: zoom-in; display: block } label input { position: absolute; opacity: 0 }
img { width: 100%; max-height: 60vh; object-fit: contain; background: #fff; display: block; border: 1px solid var(--line) }
label:has(:checked) img { position: fixed; inset: 0; width: 100vw; height: 100vh; max-height: none; z-index: 1; cursor: zoom-out }
label:has(:focus-visible) img { outline: 3px solid var(--good) }
"""


def embedded(image):
    """An image as a data address."""
    data = io.BytesIO()
    image.save(data, "WEBP", quality=80)
    return "data:image/webp;base64," + base64.b64encode(data.getvalue()).decode()


def figure(image, name, text):
    """One image with what is said of it; a click shows it as large as the window."""
    alt = html.escape(f"{name}: {text}")
    return (
        f'<figure><label><input type="checkbox" aria-label="enlarge {alt}"><img loading="lazy" src="{embedded(image)}" '
        f'alt="{alt}"></label><figcaption><b>{html.escape(name)}</b> {html.escape(text)}</figcaption></figure>'
    )


def section(title, verdict, good, remark, figures):
    """One picture: its title, verdict and figures (image, name, text)."""
    shown = "".join(figure(*f) for f in figures)
    return (
        f'<section><h2>{html.escape(title)} <span class="{"good" if good else "bad"}">{html.escape(verdict)}</span></h2>'
        f'<p class="quiet">{html.escape(remark)}</p><div class="row">{shown}</div></section>'
    )


def page(title, lines, sections):
    """The whole file."""
    said = "".join(f"<p>{html.escape(line)}</p>" for line in lines)
    return (
        f'<!doctype html><html lang="en"><meta charset="utf-8"><meta name="viewport" content="width=device-width, '
        f'initial-scale=1"><title>{html.escape(title)}</title><style>{STYLE}</style><h1>{html.escape(title)}</h1>{said}'
        f"{''.join(sections)}</html>"
    )
