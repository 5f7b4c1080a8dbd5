"""What is ink in a real picture whose strokes nobody knows: a scorer's own answer, in three values.

One mask is always wrong somewhere: Otsu loses pale pencil, a narrow flattening hollows thick pens, a low threshold draws
the paper's grain. So a pixel is *ink* where every view agrees that it is, *paper* where none thinks it is ink, and *unsure*
in between: light there is not false, and it need not be lit. Nothing here is shared with the tracer that it judges.
"""

from dataclasses import dataclass

import numpy as np
from PIL import Image, ImageOps
from scipy import ndimage
from skimage.filters import apply_hysteresis_threshold, threshold_otsu
from skimage.morphology import skeletonize

PAPER_SIDE = 400  # px: the paper under the ink is smooth enough to be found in a picture this small
WIDEST_INK = 1 / 3  # of the shorter side: darker regions wider than this are light, not ink
TABLE = 1 / 12  # of the shorter side: half the width from which dark ground at the border is a table, not a stroke
LEAST_SIGMA = 5  # of the noise: darkness from which a pixel may be ink. Gaussian noise reaches it once in 3 million pixels
LEAST_DARKNESS = 0.06  # of the paper: below it lie the paper's own grain and the squares of a JPEG
PALE = 0.5  # of the dark ink's threshold: as pale as ink joined with it may be, and still be sure
RIM = 0.5  # of the strongest ink around: where a line's edge is
SHAPE = 3.0  # pens: ink wider than this is a shape, which is drawn round its edge
SHAPE_SIDE = 1 / 12  # of the shorter side: so is ink wider than this, whatever the pen
LONG = 4  # of its own widths: ink so long is a line, however thick
RULES, RULE = 6, 0.5  # so many lines, each over so much of the page, are ruled paper
DIAGONAL = np.array([0.948, 1.340])  # px for a straight and a diagonal step, without bias (Kulpa 1977)


@dataclass
class Ink:
    """Masks of one picture, rows × columns.

    `sure`: ink. `flat`: that with printed rules, as a plain threshold would have it. `maybe`: ink or unsure. `reach`: half the ink's width, px, as the distance to paper. `shapes`: where it is
    too wide for a line. `skeleton`: its middle, without shapes. `pen`: its usual width, px. `unsure`: share of all skeleton
    that is not sure.
    """

    sure: np.ndarray
    flat: np.ndarray
    maybe: np.ndarray
    reach: np.ndarray
    shapes: np.ndarray
    skeleton: np.ndarray
    pen: float
    unsure: float


def opened(path):
    """The picture as people see it: upright, on white where it is transparent."""
    image = ImageOps.exif_transpose(Image.open(path))
    if image.mode in ("RGBA", "LA", "P", "PA"):
        image = image.convert("RGBA")
        image = Image.alpha_composite(Image.new("RGBA", image.size, "white"), image)
    if image.mode.startswith("I;16") or image.mode == "I":
        image = Image.fromarray((np.asarray(image, dtype=np.float32) / 257).astype(np.uint8))
    return image.convert("RGB")


def found(image):
    """Ink of an RGB image."""
    grey = np.asarray(image.convert("L"), dtype=np.float32)
    grey = 255 - grey if light_ink(grey) else grey
    darkness = darkness_of(grey)
    table = table_of(darkness)
    darkness[table] = 0
    sure, maybe = views(darkness)
    return described(sure, maybe, rules_of(maybe))


def reduced(grey, side=PAPER_SIDE):
    """The picture with a longer side of at most `side`, each pixel the mean of those it stands for."""
    image = Image.fromarray(grey)
    image.thumbnail((side, side), Image.BOX)
    return np.asarray(image)


def light_ink(grey):
    """Whether ink is lighter than its ground: what stands out from its surroundings is then mostly lighter than they are."""
    small = reduced(grey, PAPER_SIDE // 2)
    window = max(3, max(small.shape) // 8)
    off = np.clip(small, 1, None) - np.clip(ndimage.median_filter(small, window), 1, None)
    return np.sum(off**3) > 0 and np.median(small) < 160


def darkness_of(grey):
    """How much darker than the paper under it each pixel is, 0 to 1: the paper found widely, so that no pen is hollowed."""
    small = reduced(grey)
    window = max(5, round(min(small.shape) * WIDEST_INK))
    paper = ndimage.grey_closing(ndimage.median_filter(small, 3), window)
    paper = ndimage.gaussian_filter(paper, window / 8)
    paper = np.asarray(Image.fromarray(paper).resize(grey.shape[::-1], Image.BILINEAR))
    return np.clip(1 - grey / np.maximum(paper, 8), 0, 1)


def table_of(darkness):
    """Wide dark ground that reaches the border: what the sheet lies on. Its edge is no ink either."""
    small = reduced(darkness)
    half = min(small.shape) * TABLE
    dark = np.pad(small > 0.25, 1, mode="edge")
    deep = ndimage.distance_transform_edt(np.pad(dark, int(half) + 1, mode="edge"))
    deep = deep[int(half) + 1 : -int(half) - 1, int(half) + 1 : -int(half) - 1] > half
    labels, count = ndimage.label(dark)
    deep_ones = set(np.unique(labels[deep])) - {0}
    border = np.r_[labels[0], labels[-1], labels[:, 0], labels[:, -1]]
    kept = [n for n in deep_ones if np.mean(border == n) > 0.15]
    wide = np.isin(labels, kept) & (ndimage.distance_transform_edt(~deep) < 1.5 * half)
    table = Image.fromarray(wide[1:-1, 1:-1]).resize(darkness.shape[::-1], Image.NEAREST)
    return ndimage.binary_dilation(np.asarray(table), iterations=2) if kept else np.zeros(darkness.shape, bool)


def views(darkness):
    """Sure and possible ink."""
    noise = noise_of(darkness)
    smooth = ndimage.gaussian_filter(darkness, 0.7) if min(darkness.shape) > 200 else darkness
    least = max(LEAST_DARKNESS, LEAST_SIGMA * noise)
    dark = smooth[smooth > least]
    if len(dark) < 10:
        return smooth > least, smooth > least
    split = max(least, threshold_otsu(np.r_[dark, np.zeros(len(dark))]))
    window = max(5, round(min(darkness.shape) / 40)) | 1
    rim = RIM * ndimage.gaussian_filter(ndimage.maximum_filter(smooth, window), window / 4)
    maybe = without_specks(smooth > np.clip(rim, least, 0.6), 4)
    core = (smooth > np.clip(rim, PALE * split, 0.6)) & maybe
    sure = apply_hysteresis_threshold(np.where(core, smooth, 0), PALE * split, split)
    pen = 2 * usual(sure)
    return without_grain(without_specks(sure, max(4, 0.5 * pen * pen)), smooth, 2 * pen * pen), maybe | sure


def rules_of(maybe):
    """Printed rules, level or upright: at least `RULES` long straight ones on one page. Unsure: no one need draw them."""
    found = np.zeros(maybe.shape, bool)
    for turned in (False, True):
        mask = maybe.T if turned else maybe
        w = mask.shape[1]
        # a rule on a slant, one pixel down in some tens, is long still when it is thickened
        level = ndimage.binary_dilation(mask, np.ones((3, 1)))
        level = eroded(eroded(level, w // 30), w // 30, grow=True)
        labels, _ = ndimage.label(ndimage.binary_dilation(level, np.ones((3, w // 60 * 2 + 1))))
        long = [n for n, (_, x) in enumerate(ndimage.find_objects(labels), 1) if x.stop - x.start > RULE * w]
        if len(long) >= RULES:
            rules = np.isin(labels, long) & ndimage.binary_dilation(level, np.ones((3, 3)))
            found |= rules.T if turned else rules
    return found


def eroded(mask, length, grow=False):
    """A mask eroded (or grown) along its rows."""
    extreme = ndimage.maximum_filter1d if grow else ndimage.minimum_filter1d
    return extreme(mask.view(np.uint8), max(3, length), axis=1).astype(bool)


def noise_of(darkness):
    """Standard deviation of the paper's grain, from differences of neighbours where it is brightest."""
    step = np.diff(darkness, axis=1)[darkness[:, 1:] < np.median(darkness) + 0.1]
    return 1.4826 * np.median(np.abs(step)) / np.sqrt(2) if step.size else 0.0


def without_specks(mask, least):
    """The mask without patches of fewer pixels than `least`."""
    labels, _ = ndimage.label(mask, np.ones((3, 3)))
    large = np.bincount(labels.ravel()) >= least
    large[0] = False
    return large[labels]


def without_grain(mask, darkness, small):
    """The mask without patches of fewer pixels than `small` that are nowhere as dark as ink usually is: grain, not dots."""
    if not mask.any():
        return mask
    labels, count = ndimage.label(mask, np.ones((3, 3)))
    darkest = ndimage.maximum(darkness, labels, np.arange(count + 1))
    kept = (np.bincount(labels.ravel(), minlength=count + 1) >= small) | (darkest >= np.median(darkness[mask]))
    kept[0] = False
    return kept[labels]


def usual(mask):
    """Half the usual width of a mask's lines, px."""
    if not mask.any():
        return 1.0
    deep = ndimage.distance_transform_edt(np.pad(mask, 1))[1:-1, 1:-1]
    return float(np.median(deep[skeletonize(mask)]))


def described(flat, maybe, rules):
    """All that the score needs to know of the masks."""
    sure = flat & ~rules
    pen = 2 * usual(sure)
    deep = ndimage.distance_transform_edt(np.pad(sure, 1))[1:-1, 1:-1]
    wide = deep > max(4, min(SHAPE / 2 * pen, SHAPE_SIDE / 2 * min(sure.shape)))
    thin = skeletonize(~without_specks(~sure, max(2, pen * pen / 4)))
    shapes = whole(stout(grown(wide, deep) & sure, thin, deep), sure)
    both = skeletonize(maybe)
    near = ndimage.distance_transform_edt(~sure)
    unsure = np.mean(near[both] > 2.5) if both.any() else 0.0
    reach = ndimage.distance_transform_edt(np.pad(maybe, 1))[1:-1, 1:-1]
    return Ink(sure, flat, maybe, reach, shapes, thin & ~shapes, pen, float(unsure))


def whole(shapes, sure):
    """Shapes with all of the patch in which they lie, where they are most of it: a horse's legs belong to its body."""
    labels, count = ndimage.label(sure, np.ones((3, 3)))
    share = np.bincount(labels[shapes], minlength=count + 1) / np.maximum(1, np.bincount(labels.ravel()))
    return shapes | (sure & (share > 0.5)[labels])


def grown(seeds, deep):
    """All that lies in the inscribed discs of the seeds."""
    if not seeds.any():
        return seeds
    away, (rows, columns) = ndimage.distance_transform_edt(~seeds, return_indices=True)
    return away <= deep[rows, columns] + 1


def stout(shapes, skeleton, deep):
    """Shapes less those that are thick lines: longer than `LONG` of their own widths."""
    labels, count = ndimage.label(shapes, np.ones((3, 3)))
    each = np.arange(1, count + 1)
    length, half = ndimage.sum(skeleton, labels, each), ndimage.maximum(deep, labels, each)
    return np.isin(labels, each[np.asarray(length) <= LONG * 2 * np.asarray(half)]) if count else shapes


def length_of(skeleton):
    """Length of a skeleton, px: straight and diagonal steps between its pixels; a corner is not counted twice."""
    s = skeleton
    down, right = s[:-1] & s[1:], s[:, :-1] & s[:, 1:]
    fall = s[:-1, :-1] & s[1:, 1:] & ~s[1:, :-1] & ~s[:-1, 1:]
    rise = s[1:, :-1] & s[:-1, 1:] & ~s[:-1, :-1] & ~s[1:, 1:]
    return float(DIAGONAL @ [down.sum() + right.sum(), fall.sum() + rise.sum()])
