"""A tracer's strokes held against the ink of a real picture: figures, and where they come from."""

from dataclasses import dataclass, field

import numpy as np
from PIL import Image, ImageDraw
from scipy import ndimage

import real_ink

STEP = 0.5  # px between the points at which a stroke is looked at
OFF = 2.5  # px beside all ink: light that is false
FLYING = 8.0  # px from all ink: light that crosses white paper
SLACK = 2.0  # px beyond the pen within which ink counts as lit
BOUNDS = {"false": 0.005, "missed": 0.01, "light": (0.93, 1.10), "flying": 4.0}


@dataclass
class Stroke:
    """Points in the picture's pixels, n × 2 as x, y; whether it returns to its start; whether it is the edge of a shape."""

    points: np.ndarray
    closed: bool
    outline: bool = False

    def along(self):
        """Points every half pixel of its length."""
        points = np.vstack([self.points, self.points[:1]]) if self.closed else self.points
        way = np.r_[0, np.cumsum(np.hypot(*np.diff(points, axis=0).T))]
        at = np.arange(0, way[-1], STEP) if way[-1] > 0 else np.zeros(1)
        return np.c_[np.interp(at, way, points[:, 0]), np.interp(at, way, points[:, 1])]


@dataclass
class Score:
    """Figures of one tracer on one picture; `flying_parts` (points) and `missed_at` (mask) are for the overlay.

    `false` and `missed` are shares, `light` is length over what lines would take (NaN where all is shapes), `flying` px,
    `outlines` the share of the length that goes round edges.
    """

    strokes: int
    false: float
    missed: float
    light: float
    flying: float
    outlines: float
    seconds: float
    flying_parts: list = field(repr=False, default_factory=list)
    missed_at: np.ndarray = field(repr=False, default=None)

    def passes(self):
        """The rule: every figure within its bound."""
        low, high = BOUNDS["light"]
        light = np.isnan(self.light) or low <= self.light <= high
        return self.false <= BOUNDS["false"] and self.missed <= BOUNDS["missed"] and light and self.flying < BOUNDS["flying"]

    def faults(self):
        """Names of the figures that are out of bounds."""
        low, high = BOUNDS["light"]
        out = {key: getattr(self, key) > BOUNDS[key] for key in ("false", "missed")}
        out["light"] = not np.isnan(self.light) and not low <= self.light <= high
        return [key for key, bad in {**out, "flying": self.flying >= BOUNDS["flying"]}.items() if bad]


def scored(strokes, ink, seconds):
    """The score of strokes on a picture's ink."""
    h, w = ink.sure.shape
    off = ndimage.distance_transform_edt(~ink.maybe) if ink.maybe.any() else np.full((h, w), np.inf)
    bare, total, false, flying, outlined, in_shapes, parts = np.ones((h, w), bool), 0, 0, 0, 0, 0, []
    around = ndimage.binary_dilation(ink.shapes, iterations=3)
    for stroke in strokes:
        points = stroke.along()
        x, y = (np.clip(points.astype(int), 0, [w - 1, h - 1])).T
        bare[y, x] = False
        away = off[y, x]
        total, false, flying = total + len(x), false + (away > OFF).sum(), flying + (away > FLYING).sum()
        outlined += len(x) if stroke.outline else 0
        in_shapes += around[y, x].sum()
        parts += runs(points, away > FLYING)
    missed = unlit(strokes, ink, bare)
    lines = real_ink.length_of(ink.skeleton)
    # a picture of shapes alone, with a few hairs on it, has no lines to hold the light against
    light = (total - in_shapes) * STEP / lines if lines > 5 * ink.pen + 20 else float("nan")
    share = lambda part: float(part) / max(1, total)
    missed_share = missed.sum() / max(1, ink.sure.sum())
    return Score(len(strokes), share(false), missed_share, light, flying * STEP, share(outlined), seconds, parts, missed)


def runs(points, chosen):
    """Stretches of the points that are chosen."""
    edges = np.flatnonzero(np.diff(np.r_[0, chosen.astype(int), 0]))
    return [points[a:b] for a, b in zip(edges[::2], edges[1::2])]


def unlit(strokes, ink, bare):
    """Sure ink that no stroke lights: further from any than half the pen there and a little, and within no outline."""
    if bare.all():
        return ink.sure
    away, (rows, columns) = ndimage.distance_transform_edt(bare, return_indices=True)
    # a stroke may run a pixel beside the ridge: the pen there is the deepest around
    pen = ndimage.maximum_filter(ink.reach, 5)
    return ink.sure & (away > np.maximum(3, pen[rows, columns] + SLACK)) & ~within(strokes, ink.sure.shape)


def within(strokes, shape):
    """Pixels within outlines: an odd number of them runs round."""
    inside = np.zeros(shape, bool)
    for stroke in strokes:
        if stroke.outline and len(stroke.points) > 2:
            x0, y0 = np.maximum(np.floor(stroke.points.min(0)).astype(int), 0)
            x1, y1 = np.minimum(np.ceil(stroke.points.max(0)).astype(int) + 1, shape[::-1])
            if x1 > x0 and y1 > y0:
                patch = Image.new("1", (int(x1 - x0), int(y1 - y0)))
                ImageDraw.Draw(patch).polygon([(x - x0, y - y0) for x, y in stroke.points], fill=1)
                inside[y0:y1, x0:x1] ^= np.asarray(patch)
    return inside
