"""Regulators of the systems in systems.jsonl, to all digits: `python lqr_goldens.py < systems.jsonl > lqr.jsonl`, both in
crates/linear/tests/goldens.

The output and the input cost alike, so that the closed poles are those roots of D(s) D(-s) + N(s) N(-s) that are stable, of samples
by a zero-order hold those of D(z) D(1/z) + N(z) N(1/z): no equation of Riccati is solved. What is kept are the coefficients of the
polynomial that has them, of samples in z - 1. What SLICOT and scipy say of the same, by
their states' gains, is compared with it; how far off they are goes to standard error. Needs mpmath, numpy, scipy, control, slycot.
"""

import json
import sys
import warnings

import control
import numpy as np
import scipy.linalg
import slycot
from mpmath import mp, mpc, mpf

from goldens import add, held, mul

warnings.filterwarnings("ignore")
mp.dps = 160  # of twenty roots within a thousandth of 1 sixty digits leave none


def product(roots):
    out = [mpc(1)]
    for r in roots:
        out = mul(out, [mpc(1), -r])
    return [mp.re(c) for c in out]


def mirrored(p):
    return [c * (-1) ** (len(p) - 1 - i) for i, c in enumerate(p)]


def roots(p):
    """In s**2, so that they come in exact pairs."""
    return mp.polyroots(p, maxsteps=3000, extraprec=1200)


def continuous(num, den):
    whole = add(mul(den, mirrored(den)), mul(num, mirrored(num)))
    squares = roots(whole[::2])
    left = []
    for q in squares:
        r = mp.sqrt(q)
        left.append(-r if mp.re(r) > 0 else r)
    return product(left)


def sampled(num, den):
    """z**n times it is a palindrome: roots inside the circle."""
    n = len(den) - 1
    num = [mpf(0)] * (n + 1 - len(num)) + list(num)
    whole = add(mul(den, den[::-1]), mul(num, num[::-1]))
    # what nothing moves: zeros at 0 come with others at infinity
    while abs(whole[0]) < mpf(10) ** -140 * max(abs(c) for c in whole):
        whole = whole[1:-1]
    inside = sorted(roots(whole), key=abs)[: (len(whole) - 1) // 2]
    return product([z - 1 for z in inside] + [mpc(-1)] * (n - len(inside)))


def companion(num, den):
    """Float; controllable, states in the unit that the poles' mean is: what the gain of each then is."""
    n = len(den) - 1
    unit = 2.0 ** np.round(np.log2(abs(den[-1]) ** (1 / n))) if den[-1] != 0 else 1.0
    num = np.concatenate([np.zeros(n + 1 - len(num)), num])
    a, b, c = np.zeros((n, n)), np.zeros((n, 1)), np.zeros((1, n))
    for i in range(n - 1):
        a[i, i + 1] = unit
    scale = unit ** (n - 1 - np.arange(n, dtype=float))
    for i in range(n):
        a[n - 1, i] = -den[n - i] / scale[i]
        c[0, i] = (num[n - i] - num[0] * den[n - i]) / scale[i]
    b[n - 1, 0] = 1
    return a, b, c, num[0], scale


off = {}


def compare(what, coefficients, truth):
    size = np.max(np.abs(truth))
    off.setdefault(what, []).append(float(np.max(np.abs(coefficients - truth)) / size) if np.all(np.isfinite(coefficients)) else np.inf)


def others(num, den, alpha):
    a, b, c, d, scale = companion(np.array(num), np.array(den))
    n = len(den) - 1
    # output y = c x + d u costs y'y: with a cross term
    q, s, r = c.T @ c, c.T * d, np.array([[1 + d * d]])
    for what, solve in [
        ("scipy", lambda: scipy.linalg.solve_continuous_are(a, b, q, r, s=s)),
        ("SLICOT", lambda: slycot.sb02od(n, 1, a, b, q, r, "C", L=s)[1] if d != 0 else control.care(a, b, q, r, method="slycot")[0]),
    ]:
        try:
            k = np.linalg.solve(r, b.T @ solve() + s.T)
            # last row of A - B k, lowest power first
            closed = -(a[n - 1] - k[0]) * scale
            compare(what, np.concatenate([[1.0], closed[::-1]]) / size_of(alpha), np.array(alpha) / size_of(alpha))
        except Exception as e:
            off.setdefault(f"{what} failed: {type(e).__name__}", []).append(np.inf)


def size_of(alpha):
    """Powers of the poles' mean, so that coefficients are alike."""
    n = len(alpha) - 1
    mean = abs(alpha[-1]) ** (1 / n)
    return mean ** np.arange(n + 1, dtype=float)


def main():
    for line in sys.stdin:
        system = json.loads(line)
        num, den = [mpf(c) for c in system["num"]], [mpf(c) for c in system["den"]]
        alpha = [float(mp.nstr(c, 14)) for c in continuous(num, den)]
        poles = mp.polyroots(den, maxsteps=2000, extraprec=600)
        there = [float(mp.nstr(c, 14)) for c in sampled(*held(num, den, poles, system["period"]))]
        print(json.dumps({"continuous": alpha, "sampled": there}, separators=(",", ":")))
        others(system["num"], system["den"], alpha)
    for what, errors in sorted(off.items()):
        errors = np.array(errors)
        print(f"  {what:24} of {len(errors)} more than 1e-8: {np.sum(errors > 1e-8):5}  median {np.median(errors):.1e}  worst {np.max(errors):.1e}", file=sys.stderr)


if __name__ == "__main__":
    main()
