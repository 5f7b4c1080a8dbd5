"""Random systems and what is true of them, to sixty digits: `python goldens.py COUNT > ../../../crates/linear/tests/goldens/systems.jsonl`.

Needs mpmath, numpy, scipy, control, slycot. Of each system: coefficients (exactly these numbers), poles, zeros, margins, samples by
Tustin's rule, by a zero-order hold and with matched poles and zeros, the answer to a step. What control and scipy say of the same is compared with it; how often
and by how much they are off goes to standard error.
"""

import json
import sys
import warnings

import control
import numpy as np
import scipy.linalg
import scipy.signal
from mpmath import mp, mpc, mpf

warnings.filterwarnings("ignore")
mp.dps = 60
rng = np.random.default_rng(20061)
DIGITS = 14


def short(x):
    return float(mp.nstr(mpf(x), DIGITS))


def pair(z):
    return [short(mp.re(z)), short(mp.im(z))]


# --- polynomials, highest power first ------------------------------------------------------------------------------


def mul(a, b):
    out = [mpf(0)] * (len(a) + len(b) - 1)
    for i, x in enumerate(a):
        for j, y in enumerate(b):
            out[i + j] += x * y
    return out


def add(a, b):
    n = max(len(a), len(b))
    a, b = [mpf(0)] * (n - len(a)) + list(a), [mpf(0)] * (n - len(b)) + list(b)
    return [x + y for x, y in zip(a, b)]


def value(p, z):
    return mp.polyval(list(p), z)


def derivative(p):
    n = len(p) - 1
    return [c * (n - i) for i, c in enumerate(p[:-1])] or [mpf(0)]


def roots(p):
    p = list(p)
    while p and p[0] == 0:
        p.pop(0)
    zeros = 0
    while len(p) > 1 and p[-1] == 0:
        p.pop()
        zeros += 1
    found = mp.polyroots(p, maxsteps=2000, extraprec=600) if len(p) > 1 else []
    return [mpc(0)] * zeros + list(found)


# --- random systems ------------------------------------------------------------------------------------------------


def random_roots(count, stable):
    out = []
    while len(out) < count:
        size = 10.0 ** rng.uniform(-1, 2)
        if count - len(out) >= 2 and rng.random() < 0.5:
            damping = rng.uniform(0.05, 0.99)
            if not stable and rng.random() < 0.2:
                damping = -damping
            z = size * complex(-damping, np.sqrt(1 - damping**2))
            out += [z, z.conjugate()]
        else:
            out.append(complex(size if not stable and rng.random() < 0.2 else -size))
    return out


def random_system():
    order = int(rng.integers(1, 13))
    poles = random_roots(order, rng.random() < 0.85)
    if rng.random() < 0.2:
        real = [i for i, p in enumerate(poles) if p.imag == 0]
        if real:
            poles[real[0]] = 0j
    zeros = random_roots(int(rng.integers(0, order + 1)), rng.random() < 0.7)
    num, den = (np.atleast_1d(np.real(np.poly(r))) for r in (zeros, poles))
    middle = np.exp(np.mean(np.log([abs(p) for p in poles if p != 0] or [1.0])))
    size = abs(np.polyval(num, 1j * middle) / np.polyval(den, 1j * middle))
    num = num * float(10.0 ** rng.uniform(-0.5, 1.5) / size)
    fastest = max([abs(p) for p in poles] + [0.1])
    period = float(f"{rng.uniform(0.05, 0.6) / fastest:.6g}")
    return [float(c) for c in num], [float(c) for c in den], period


# --- what is true of them ------------------------------------------------------------------------------------------


def tustin(num, den, period):
    rate, n = 2 / mpf(period), max(len(num), len(den)) - 1

    def there(p):
        out = [mpf(0)]
        for i, c in enumerate(p):
            power = len(p) - 1 - i
            term = [mpf(c)]
            for _ in range(power):
                term = mul(term, [rate, -rate])
            for _ in range(n - power):
                term = mul(term, [mpf(1), mpf(1)])
            out = add(out, term)
        return out

    a, b = there(num), there(den)
    return [x / b[0] for x in a], [x / b[0] for x in b]


def companion(num, den):
    n = len(den) - 1
    den = [d / den[0] for d in den]
    num = [mpf(0)] * (n + 1 - len(num)) + list(num)
    a, b, c = mp.zeros(n), mp.zeros(n, 1), mp.zeros(1, n)
    for i in range(n - 1):
        a[i, i + 1] = 1
    for i in range(n):
        a[n - 1, i] = -den[n - i]
        c[0, i] = num[n - i] - num[0] * den[n - i]
    b[n - 1, 0] = 1
    return a, b, c, num[0]


def held(num, den, poles, period):
    n = len(den) - 1
    a, b, c, d = companion(num, den)
    whole = mp.zeros(n + 1)
    for i in range(n):
        for j in range(n):
            whole[i, j] = a[i, j] * mpf(period)
        whole[i, n] = b[i, 0] * mpf(period)
    e = mp.expm(whole, method="taylor")
    ad, x = e[:n, :n], e[:n, n]
    h = [d]
    for _ in range(n):
        h.append((c * x)[0, 0])
        x = ad * x
    below = [mpc(1)]
    for p in poles:
        below = mul(below, [mpc(1), -mp.exp(p * mpf(period))])
    below = [mp.re(x) for x in below]
    above = [sum(below[j] * h[k - j] for j in range(k + 1)) for k in range(n + 1)]
    return above, below


def matched_samples(num, zeros, poles, period):
    """Franklin, Powell & Workman: roots by e^(sT), zeros at infinity but one to -1, the same where nothing changes."""
    t = mpf(period)
    there = [mp.exp(z * t) for z in zeros] + [mpc(-1)] * (max(len(poles) - 1, len(zeros)) - len(zeros))
    gain = mpf(num[0])
    for z in zeros:
        gain *= 1 / t if z == 0 else z / mp.expm1(z * t)
    for p in poles:
        gain /= 1 / t if p == 0 else p / mp.expm1(p * t)
    gain /= mpf(2) ** (len(there) - len(zeros))
    above, below = [gain], [mpc(1)]
    for z in there:
        above = mul(above, [mpc(1), -z])
    for p in poles:
        below = mul(below, [mpc(1), -mp.exp(p * t)])
    return [mp.re(c) for c in above], [mp.re(c) for c in below]


def step(num, den, poles, times):
    """By partial fractions of G/s; the poles are simple, at 0 at most double with that of the step."""
    n = list(num)
    rest = [p for p in poles if p != 0]
    double = len(rest) < len(poles)
    lead, out = mpf(den[0]), []
    product = lambda z, skip=None: mp.fprod(z - q for q in rest if q is not skip)
    for t in times:
        t = mpf(t)
        total = mpc(0)
        for p in rest:
            total += value(n, p) / (lead * product(p, p) * p ** (2 if double else 1)) * mp.exp(p * t)
        if double:
            f = lambda z: value(n, z) / (lead * product(z))
            slope = f(0) * (value(derivative(n), 0) / value(n, 0) + sum(1 / q for q in rest)) if value(n, 0) != 0 else value(derivative(n), 0) / (lead * product(0))
            total += f(0) * t + slope
        else:
            total += value(n, 0) / (lead * product(0))
        out.append(mp.re(total))
    return out


def halves(p):
    low = list(reversed([mpf(c) for c in p]))
    even = [c * (-1) ** (i // 2) for i, c in enumerate(low) if i % 2 == 0]
    odd = [c * (-1) ** (i // 2) for i, c in enumerate(low) if i % 2 == 1]
    return list(reversed(even)) or [mpf(0)], list(reversed(odd)) or [mpf(0)]


def square(p):
    e, o = halves(p)
    return add(mul(e, e), mul(o, o) + [mpf(0)])


def positive_frequencies(p):
    tiny = mpf(10) ** -25
    return sorted(mp.sqrt(mp.re(x)) for x in roots(p) if mp.re(x) > tiny and abs(mp.im(x)) < tiny * abs(x))


def margins(num, den):
    num, den = [mpf(c) for c in num], [mpf(c) for c in den]
    loop = lambda w: value(num, mpc(0, w)) / value(den, mpc(0, w))
    phase = [(w, mp.arg(-loop(w))) for w in positive_frequencies(add(square(num), [-c for c in square(den)]))]
    (ne, no), (de, do) = halves(num), halves(den)
    across = add(mul(no, de), [-c for c in mul(ne, do)])
    real = [(w, -1 / mp.re(loop(w))) for w in positive_frequencies(across) if mp.re(loop(w)) < 0]
    if value(den, 0) != 0 and value(num, 0) / value(den, 0) < 0:
        real.insert(0, (mpf(0), -value(den, 0) / value(num, 0)))
    above, below = square(add(num, den)), square(den)
    flat = add(mul(derivative(above), below), [-c for c in mul(above, derivative(below))])
    near = [abs(1 + loop(w)) for w in positive_frequencies(flat)] + [abs(1 + (num[0] / den[0] if len(num) == len(den) else 0))]
    if value(den, 0) != 0:
        near.append(abs(1 + value(num, 0) / value(den, 0)))
    return phase, real, min(near)


# --- what others say -----------------------------------------------------------------------------------------------

off = {}


def compare(what, theirs, truth, size=None):
    theirs, truth = np.asarray(theirs, complex), np.asarray(truth, complex)
    if theirs.shape != truth.shape:
        off.setdefault(what, []).append(np.inf)
        return
    size = size if size is not None else np.abs(truth)
    off.setdefault(what, []).append(float(np.max(np.abs(theirs - truth) / np.maximum(size, 1e-300), initial=0.0)))


def matched(theirs, truth):
    left, out = list(theirs), []
    for t in truth:
        best = min(range(len(left)), key=lambda i: abs(left[i] - t))
        out.append(left.pop(best))
    return out


def others(num, den, period, true):
    g = control.tf(num, den)
    for what, theirs in [("poles", np.roots(den)), ("zeros", np.roots(num))]:
        truth = [complex(*z) for z in true[what]]
        if len(truth) == len(theirs):
            compare(what, matched(theirs, truth), truth)
    for what, method in [("tustin", "bilinear"), ("hold", "zoh")]:
        n, d, _ = scipy.signal.cont2discrete((num, den), period, method)
        for part, theirs in [("num", np.ravel(n)), ("den", d)]:
            truth = np.array(true[what][part])
            theirs = np.concatenate([np.zeros(max(0, len(truth) - len(theirs))), theirs])
            compare(f"{what} {part}", theirs, truth, np.max(np.abs(truth)))
    if true["phase"]:
        pm = control.stability_margins(g, returnall=True)[1]
        truth = sorted(np.degrees(p[1]) for p in true["phase"])
        compare("phase margins", sorted(pm), truth)
    compare("modulus", control.stability_margins(g)[2], true["modulus"])
    t = np.array(true["step_times"])
    y = control.step_response(g, np.concatenate([[0.0], t])).outputs[1:] if len(num) <= len(den) else t
    compare("step", y, np.array(true["step"]), np.max(np.abs(true["step"])) + 1e-300)


def main():
    made = 0
    while made < int(sys.argv[1]):
        num, den, period = random_system()
        poles, zeros = roots(den), roots(num)
        apart = lambda rs: min([abs(a - b) / max(abs(a), abs(b)) for i, a in enumerate(rs) for b in rs[:i]] + [mpf(1)])
        if apart(poles) < 1e-6:
            continue
        phase, gain, modulus = margins(num, den)
        slowest = min([abs(mp.re(p)) for p in poles if p != 0] + [mpf(10)])
        times = [float(f"{float(k * 3 / slowest / 5):.6g}") for k in range(1, 6)]
        if any(mp.re(p) * times[-1] > 30 for p in poles):
            times = [t * 0.01 for t in times]
        first = times[0]
        times = [first * k for k in range(1, 6)]
        tustin_num, tustin_den = tustin([mpf(c) for c in num], [mpf(c) for c in den], period)
        hold_num, hold_den = held([mpf(c) for c in num], [mpf(c) for c in den], poles, period)
        matched_num, matched_den = matched_samples(num, zeros, poles, period)
        true = {
            "num": num,
            "den": den,
            "period": period,
            "poles": [pair(z) for z in poles],
            "zeros": [pair(z) for z in zeros],
            "tustin": {"num": [short(c) for c in tustin_num], "den": [short(c) for c in tustin_den]},
            "hold": {"num": [short(c) for c in hold_num], "den": [short(c) for c in hold_den]},
            "matched": {"num": [short(c) for c in matched_num], "den": [short(c) for c in matched_den]},
            "phase": [[short(w), short(p)] for w, p in phase],
            "gain": [[short(w), short(k)] for w, k in gain],
            "modulus": short(modulus),
            "step_times": times,
            "step": [short(y) for y in step(num, den, poles, times)],
        }
        print(json.dumps(true, separators=(",", ":")))
        try:
            others(num, den, period, true)
        except Exception as e:  # theirs is said, ours goes on
            off.setdefault("failed: " + type(e).__name__, []).append(np.inf)
        made += 1
    print(f"{made} systems; control {control.__version__}, scipy {scipy.__version__} off what is true, relatively:", file=sys.stderr)
    for what, errors in sorted(off.items()):
        errors = np.array(errors)
        print(f"  {what:16} more than 1e-8: {np.sum(errors > 1e-8):5}  median {np.median(errors):.1e}  worst {np.max(errors):.1e}", file=sys.stderr)


if __name__ == "__main__":
    main()
