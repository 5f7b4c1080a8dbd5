"""Step figures of random systems against partial fractions in sixty digits and more.

    python3 step_figures.py PROGRAM [COUNT] [SEED] [SECONDS]      PROGRAM is target/release/examples/step_figures; needs numpy, python-flint

Systems have up to 12 poles over up to six decades, single, repeated or nearly so, damped down to 0.01, and zeros on either side. The
program gets their coefficients. The reference finds the poles of exactly these coefficients, expands in partial fractions, looks at the
response on a grid of each pole's own scale, and refines every figure with Newton's iteration.

A figure is wrong if it is further off than 1e-8 of itself; overshoot and undershoot than 1e-8 of the final value. Counted apart: rise
times of responses that swing over 10 000 times their final value (f64 has no more digits for them), and excursions below 0.01 % that the
reference's grid steps over.
"""

import random
import subprocess
import sys
import time
from fractions import Fraction

import numpy as np
from flint import acb, arb, ctx, fmpq, fmpz_poly

BAND = Fraction(1, 50)
WRONG = 1e-8


class Skip(Exception):
    """The reference cannot or need not do this one."""


def random_roots(rng, count, decades, stable):
    """Roots in conjugate pairs; some are repeated, exactly or nearly."""
    roots = []
    while len(roots) < count:
        size = 10 ** rng.uniform(*decades)
        copies = 1 if rng.random() < 0.8 else rng.randint(2, 4)
        near = rng.choice([0, 0, 1e-7, 1e-4, 1e-2])
        swings = rng.random() < 0.5
        side = -1 if stable or rng.random() < 0.7 else 1
        damping = rng.choice([rng.uniform(0.02, 1), 10 ** rng.uniform(-2, 0)])
        for _ in range(copies):
            own = size * (1 + near * rng.uniform(-1, 1))
            if swings and len(roots) + 2 <= count:
                place = complex(side * damping * own, own * (1 - damping**2) ** 0.5)
                roots += [place, place.conjugate()]
            elif len(roots) < count:
                roots.append(complex(side * own, 0))
    return roots


def coefficients(roots):
    """Of the polynomial with these roots, each rounded once."""
    product, i = [Fraction(1)], 0
    while i < len(roots):
        root = roots[i]
        if root.imag == 0:
            factor, i = [Fraction(1), -Fraction(root.real)], i + 1
        else:
            size = Fraction(root.real) ** 2 + Fraction(root.imag) ** 2
            factor, i = [Fraction(1), -2 * Fraction(root.real), size], i + 2
        longer = [Fraction(0)] * (len(product) + len(factor) - 1)
        for a, x in enumerate(product):
            for b, y in enumerate(factor):
                longer[a + b] += x * y
        product = longer
    return [float(c) for c in product]


def random_system(rng):
    decades = rng.choice([(-3, 3), (-1, 1), (-0.5, 0.5), (0, 0.3), (-3, 3)])
    order = rng.randint(1, 12)
    below = coefficients(random_roots(rng, order, decades, True))
    above = coefficients(random_roots(rng, rng.randint(0, order), decades, False))
    gain = abs(below[-1] / above[-1]) * rng.choice([1, 1, -3.7, 0.01])
    return [c * gain for c in above], below


def exact(fraction):
    return arb(fmpq(fraction.numerator, fraction.denominator))


class Response:
    """A step response as partial fractions."""

    def __init__(self, above, below, digits=60):
        ctx.dps = digits
        above, below = [Fraction(c) for c in above], [Fraction(c) for c in below]
        whole = max(c.denominator for c in below)
        roots = fmpz_poly([int(c * whole) for c in reversed(below)]).complex_roots()
        if any(count > 1 for _, count in roots):
            raise Skip("poles that are exactly multiple")
        self.poles = [root for root, _ in roots]
        self.final = exact(above[-1] / below[-1])
        slope = [c * (len(below) - 1 - i) for i, c in enumerate(below[:-1])]
        self.residues = [horner(above, p) / (horner(slope, p) * p) for p in self.poles]
        worst = max(float(abs(r).rad()) / (float(abs(r).mid()) + 1e-300) for r in self.residues)
        if worst > 1e-25:
            if digits > 900:
                raise Skip("more than 900 digits")
            self.__init__(above, below, 2 * digits)
            return
        self.p, self.r = (
            np.array([complex(z.real.mid(), z.imag.mid()) for z in all]) for all in (self.poles, self.residues)
        )
        self.cancels = np.abs(self.r).max() / abs(float(self.final.mid()))

    def at(self, t, derivative=0):
        """Value or derivative, with all digits."""
        t, total = arb(t), acb(0)
        for p, r in zip(self.poles, self.residues):
            term = (p * t).exp() * r
            for _ in range(derivative):
                term *= p
            total += term
        return total.real + (self.final if derivative == 0 else 0)

    def grid(self):
        """Moments on each pole's own scale until it has died out."""
        times = [np.array([0.0])]
        for p in self.p:
            step, end = 2 * np.pi / abs(p) / 40, (14 + np.log1p(self.cancels)) / abs(p.real)
            if end / step > 60000:
                raise Skip("swings for very long")
            times.append(np.arange(1, int(end / step) + 2) * step)
        times = np.unique(np.concatenate(times))
        kept, gap = [0.0], times[1]
        for t in times[1:]:
            if t - kept[-1] >= 0.2 * gap:
                gap = min(t - kept[-1], 1.5 * gap) if len(kept) > 1 else t
                kept.append(t)
        first = kept[1]
        return np.concatenate([[0.0], np.geomspace(1e-5 * first, 0.9 * first, 60), kept[1:]])

    def values(self, times):
        if self.cancels < 1e5:
            return (np.exp(np.outer(times, self.p)) @ self.r).real + float(self.final.mid())
        if len(times) > 6000:
            raise Skip("many moments in many digits")
        return np.array([float(self.at(t).mid()) for t in times])


def horner(polynomial, at):
    value = acb(0)
    for c in polynomial:
        value = value * at + exact(c)
    return value


def zero(low, high, value, slope):
    """Where a function that changes its sign is zero."""
    low, high = arb(low), arb(high)
    begins = value(low) > 0
    t = (low + high) / 2
    for _ in range(200):
        here = value(t)
        if (here > 0) == begins:
            low = t
        else:
            high = t
        steep = slope(t)
        onward = (t - here / steep).mid() if steep != 0 else (low + high) / 2
        if not (onward > low and onward < high):
            onward = ((low + high) / 2).mid()
        if float(abs(onward - t)) <= 1e-22 * abs(float(t)):
            return onward
        t = onward.mid()
    return t


def turns(response, times, values):
    """Turning points that may be the furthest, refined: (value, time)."""
    inner = np.where((values[1:-1] >= values[:-2]) & (values[1:-1] > values[2:]))[0] + 1
    wide = [0.5 * max(values[j] - min(values[max(j - 3, 0)], values[min(j + 3, len(values) - 1)]), 0) for j in inner]
    return [(values[j], values[j] + w, j) for j, w in zip(inner, wide)]


def furthest(response, times, values, final, sign):
    best, places = (sign * final, None), turns(response, times, sign * values)
    if sign * values[0] > best[0]:
        best = (sign * values[0], 0.0)
    least = max([value for value, _, _ in places], default=-np.inf)
    for _, most, j in places:
        if most >= max(least, best[0]):
            t = zero(times[j - 1], times[j + 1], lambda x: response.at(x, 1), lambda x: response.at(x, 2))
            value = sign * float(response.at(t).mid())
            if value > best[0]:
                best = (value, float(t.mid()))
    return sign * best[0], best[1]


def first_at(response, times, share, level):
    if share[0] >= float(level):
        return 0.0
    i = int(np.argmax(share >= float(level)))
    for j in range(1, i):
        if share[j] > share[j - 1] and share[j] >= share[j + 1] and share[j] > float(level) - 0.02:
            top = zero(times[j - 1], times[j + 1], lambda x: response.at(x, 1), lambda x: response.at(x, 2))
            if float((response.at(top) / response.final).mid()) >= float(level):
                times, i = np.concatenate([times[:j], [float(top.mid())]]), j
                break
    value = lambda x: response.at(x) / response.final - exact(level)  # noqa: E731
    return float(zero(times[i - 1], times[i], value, lambda x: response.at(x, 1) / response.final).mid())


def settled(response, times, share):
    """When it is within the band for good, and whether it only just touches it somewhere."""
    off = np.abs(share - 1)
    inner = np.where((off[1:-1] >= off[:-2]) & (off[1:-1] > off[2:]))[0] + 1
    outside = np.where(off > float(BAND))[0]
    last = int(outside[-1]) if len(outside) else -1
    touches = False
    for j in reversed([j for j in inner if j > last and off[j] > 0.98 * float(BAND)]):
        top = zero(times[j - 1], times[j + 1], lambda x: response.at(x, 1), lambda x: response.at(x, 2))
        size = abs(float((response.at(top) / response.final - 1).mid()))
        touches = touches or abs(size - float(BAND)) < 1e-10
        if size > float(BAND):
            return crossing(response, float(top.mid()), times[j + 1 if off[j + 1] < float(BAND) else j + 2], share[j]), touches
    if last < 0:
        return 0.0, touches
    return crossing(response, times[last], times[last + 1], share[last]), touches


def crossing(response, low, high, share):
    sign = 1 if share > 1 else -1
    value = lambda x: sign * (response.at(x) / response.final - 1) - exact(BAND)  # noqa: E731
    return float(zero(low, high, value, lambda x: sign * response.at(x, 1) / response.final).mid())


def reference(response):
    times = response.grid()
    values, final = response.values(times), float(response.final.mid())
    share = values / final
    settle, touches = settled(response, times, share)
    sides = [furthest(response, times, values, final, side) for side in ((1, -1) if final > 0 else (-1, 1))]
    return {
        "final": final,
        "rise": first_at(response, times, share, Fraction(9, 10)) - first_at(response, times, share, Fraction(1, 10)),
        "settle": None if touches else settle,
        "overshoot": 100 * max(0, sides[0][0] / final - 1),
        "undershoot": 100 * max(0, -sides[1][0] / final),
        "peak": max(sides, key=lambda side: abs(side[0])),
    }


def compare(response, found, true):
    """How far off each figure is; None of a tiny excursion that the grid steps over."""
    final, rise, settle, over, under, peak, peak_s = found
    if peak_s:
        value = float(response.at(peak_s).mid())
        # a true value that the grid did not see
        if abs(value) > abs(true["peak"][0]) and abs(value - peak) < 1e-9 * abs(value):
            true["peak"] = (value, peak_s)
            side = "overshoot" if value / final > 0 else "undershoot"
            true[side] = 100 * (abs(value / final) - (side == "overshoot"))
    off = lambda a, b, least=1e-300: 0 if a == b else abs(a - b) / max(abs(b), least)  # noqa: E731
    errors = {
        "final": off(final, true["final"]),
        "rise": off(rise, true["rise"]),
        "settle": 0 if true["settle"] is None else off(settle, true["settle"]),
    }
    unseen = (true["overshoot"] == 0 and 0 < over < 1e-2) or (true["undershoot"] == 0 and 0 < under < 1e-2)
    if not unseen:
        errors["overshoot"] = off(over, true["overshoot"], 100.0)
        errors["undershoot"] = off(under, true["undershoot"], 100.0)
        errors["peak"] = off(peak, true["peak"][0])
    return errors, unseen


def main():
    program, count, seed, seconds = sys.argv[1], *(
        kind(given) for kind, given in zip((int, int, float), (sys.argv[2:5] + ["500", "1", "500"][len(sys.argv) - 2 :]))
    )
    rng = random.Random(seed)
    systems = [random_system(rng) for _ in range(count)]
    lines = [" ".join(map(repr, above)) + ";" + " ".join(map(repr, below)) for above, below in systems]
    run = subprocess.run([program], input="\n".join(lines) + "\n", capture_output=True, text=True, check=True)
    answers = run.stdout.splitlines()
    micros = [float(line.split()[-1]) for line in answers if not line.startswith("error")]
    print(f"time a system: mean {np.mean(micros):.0f} µs, median {np.median(micros):.0f}, 99 % {np.percentile(micros, 99):.0f}")
    done = wrong = wild = unseen = 0
    skipped, began = {}, time.time()
    for i, ((above, below), line) in enumerate(zip(systems, answers)):
        if time.time() - began > seconds:
            break
        try:
            response = Response(above, below)
            true = reference(response)
        except Skip as why:
            skipped[str(why)] = skipped.get(str(why), 0) + 1
            continue
        done += 1
        found = [None if word == "-" else float(word) for word in line.split()[:7]]
        if line.startswith("error") or found[0] is None:
            wrong += 1
            print(f"system {i}: {line}")
            continue
        errors, is_unseen = compare(response, found, true)
        unseen += is_unseen
        if errors["rise"] > WRONG and max(true["overshoot"], true["undershoot"]) > 1e6:
            wild += 1
            del errors["rise"]
        if max(errors.values()) > WRONG:
            wrong += 1
            print(f"system {i}: {errors}")
    print(f"{done} systems: {wrong} wrong; {wild} rise times of wild swings; {unseen} excursions below 0.01 %; skipped {skipped}")
    return int(wrong > 0)


if __name__ == "__main__":
    sys.exit(main())
