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
DIAGONAL = np.array([0.948, 1.340])  # px for a straight and a diagonal step, without bias (Kulpa 1977)


@dataclass
class Ink:
    """Masks of one picture, rows × columns.

    `sure`: ink. `maybe`: ink or unsure. `reach`: half the ink's width, px, as the distance to paper. `shapes`: where it is
    too wide for a line. `skeleton`: its middle, without shapes. `pen`: its usual width, px. `unsure`: share of all skeleton
    that is not sure.
    """

    sure: np.ndarray
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
    return described(sure, maybe)


def reduced(grey, side=PAPER_SIDE):
    """The picture with a longer side of at most `side`, each pixel the mean of those it stands for."""
    image = Image.fromarray(grey)
    image.thumbnail((side, side), Image.BOX)
    return np.asarray(image)


def light_ink(grey):
    """Whether ink is lighter than its ground: what stands out from its surroundings is then mostly lighter than they are."""
    small = reduced(grey)
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
    return without_specks(sure, max(4, 0.5 * pen * pen)), maybe | sure


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


def usual(mask):
    """Half the usual width of a mask's lines, px."""
    if not mask.any():
        return 1.0
    deep = ndimage.distance_transform_edt(np.pad(mask, 1))[1:-1, 1:-1]
    return float(np.median(deep[skeletonize(mask)]))


def described(sure, maybe):
    """All that the score needs to know of the masks."""
    pen = 2 * usual(sure)
    deep = ndimage.distance_transform_edt(np.pad(sure, 1))[1:-1, 1:-1]
    shapes = grown(deep > max(SHAPE / 2 * pen, 4), deep) & sure
    thin = skeletonize(~without_specks(~sure, max(2, pen * pen / 4)))
    both = skeletonize(maybe)
    near = ndimage.distance_transform_edt(~sure)
    unsure = np.mean(near[both] > 2.5) if both.any() else 0.0
    reach = ndimage.distance_transform_edt(np.pad(maybe, 1))[1:-1, 1:-1]
    return Ink(sure, maybe, reach, shapes, thin & ~shapes, pen, float(unsure))


def grown(seeds, deep):
    """All that lies in the inscribed discs of the seeds."""
    if not seeds.any():
        return seeds
    away, (rows, columns) = ndimage.distance_transform_edt(~seeds, return_indices=True)
    return away <= deep[rows, columns] + 1


def length_of(skeleton):
    """Length of a skeleton, px: straight and diagonal steps between its pixels; a corner is not counted twice."""
    s = skeleton
    down, right = s[:-1] & s[1:], s[:, :-1] & s[:, 1:]
    fall = s[:-1, :-1] & s[1:, 1:] & ~s[1:, :-1] & ~s[:-1, 1:]
    rise = s[1:, :-1] & s[:-1, 1:] & ~s[:-1, :-1] & ~s[1:, 1:]
    return float(DIAGONAL @ [down.sum() + right.sum(), fall.sum() + rise.sum()])
