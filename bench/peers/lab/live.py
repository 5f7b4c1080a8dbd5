"""Random systems up to order 12 asked of us and of control, scipy and SLICOT at once: `python live.py ANSWERS COUNT [SEED]`.

ANSWERS is crates/linear/examples/answers, built. Where two disagree by more than 1e-8, some are worked out in sixty digits or more, so
that it is known who is off. Prints Markdown. Needs mpmath, numpy, scipy, control, slycot.
"""

import json
import subprocess
import sys
import threading
import warnings

import control
import numpy as np
import scipy.linalg
import scipy.signal
from mpmath import mp, mpf

import goldens
import lqr_goldens

warnings.filterwarnings("ignore")
CLOSE = 1e-8
MOST_TRUTHS = 100


def complexes(pairs):
    return np.array([complex(*z) for z in pairs])


def matched(theirs, ours):
    left, out = list(theirs), []
    for z in ours:
        out.append(left.pop(min(range(len(left)), key=lambda i: abs(left[i] - z))))
    return np.array(out)


def root_distance(a, b):
    if len(a) != len(b):
        return np.inf
    return float(np.max(np.abs(matched(a, b) - b) / np.maximum(np.abs(b), 1e-300), initial=0.0))


def padded(p, size):
    return np.concatenate([np.zeros(size - len(p)), p])


def coefficient_distance(a, b):
    a, b = np.ravel(a), np.ravel(b)
    size = max(len(a), len(b))
    a, b = padded(a, size), padded(b, size)
    return float(np.max(np.abs(a - b)) / max(np.max(np.abs(b)), 1e-300))


def list_distance(a, b):
    a, b = sorted(a), sorted(b)
    return np.inf if len(a) != len(b) else max((abs(x - y) / max(abs(y), 1.0) for x, y in zip(a, b)), default=0.0)


def regulated(num, den, solve):
    """Closed poles of a regulator whose output and input cost alike."""
    a, b, c, d, _ = lqr_goldens.companion(np.array(num), np.array(den))
    q, s, r = c.T @ c, c.T * d, np.array([[1 + d * d]])
    k = np.linalg.solve(r, b.T @ solve(a, b, q, r, s) + s.T)
    return np.linalg.eigvals(a - b @ k)


def poly_of(poles):
    """As coefficients in the unit of their mean, since poles that are close scatter."""
    p = np.real(np.poly(poles))
    mean = abs(p[-1]) ** (1 / (len(p) - 1))
    return p / mean ** np.arange(len(p))


def slicot(a, b, q, r, s):
    # without a cross term: u = v - r^-1 s' x
    before = np.linalg.solve(r, s.T)
    return control.care(a - b @ before, b, q - s @ before, r, method="slycot")[0]


KINDS = {
    # what, theirs, how far apart, the truth
    "poles": ("numpy", lambda g: np.roots(g["den"]), lambda o: complexes(o["poles"]), root_distance, lambda g: exact_roots(g["den"])),
    "zeros": ("numpy", lambda g: np.roots(g["num"]), lambda o: complexes(o["zeros"]), root_distance, lambda g: exact_roots(g["num"])),
    "Tustin, numerator": ("scipy", lambda g: scipy.signal.cont2discrete((g["num"], g["den"]), g["period"], "bilinear")[0], lambda o: np.array(o["tustin"]["num"]), coefficient_distance, lambda g: floats(tustin(g)[0])),
    "Tustin, denominator": ("scipy", lambda g: scipy.signal.cont2discrete((g["num"], g["den"]), g["period"], "bilinear")[1], lambda o: np.array(o["tustin"]["den"]), coefficient_distance, lambda g: floats(tustin(g)[1])),
    "hold, numerator": ("scipy", lambda g: scipy.signal.cont2discrete((g["num"], g["den"]), g["period"], "zoh")[0], lambda o: np.array(o["hold"]["num"]), coefficient_distance, lambda g: floats(hold(g)[0])),
    "hold, denominator": ("scipy", lambda g: scipy.signal.cont2discrete((g["num"], g["den"]), g["period"], "zoh")[1], lambda o: np.array(o["hold"]["den"]), coefficient_distance, lambda g: floats(hold(g)[1])),
    "phase margins": ("control", lambda g: np.radians(theirs_margins(g)[1]), lambda o: o["phase"], list_distance, lambda g: floats(p for _, p in goldens.margins(g["num"], g["den"])[0])),
    "gain margins": ("control", lambda g: theirs_margins(g)[0], lambda o: [k for k in o["gain"]], list_distance, lambda g: floats(k for _, k in goldens.margins(g["num"], g["den"])[1])),
    "regulator": ("scipy", lambda g: poly_of(regulated(g["num"], g["den"], lambda a, b, q, r, s: scipy.linalg.solve_continuous_are(a, b, q, r, s=s))), lambda o: poly_of(complexes(o["regulator"])), coefficient_distance, lambda g: exact_regulator(g)),
    "regulator ": ("SLICOT", lambda g: poly_of(regulated(g["num"], g["den"], slicot)), lambda o: poly_of(complexes(o["regulator"])), coefficient_distance, lambda g: exact_regulator(g)),
}


def floats(values):
    return np.array([float(mp.re(v)) for v in values])


def exact_roots(p):
    return np.array([complex(z) for z in goldens.roots(p)])


def tustin(g):
    return goldens.tustin([mpf(c) for c in g["num"]], [mpf(c) for c in g["den"]], g["period"])


def hold(g):
    num, den = [mpf(c) for c in g["num"]], [mpf(c) for c in g["den"]]
    return goldens.held(num, den, goldens.roots(den), g["period"])


def theirs_margins(g):
    if "margins" not in g:
        gm, pm, *_ = control.stability_margins(control.tf(g["num"], g["den"]), returnall=True)
        g["margins"] = gm, pm
    return g["margins"]


def exact_regulator(g):
    alpha = floats(lqr_goldens.continuous([mpf(c) for c in g["num"]], [mpf(c) for c in g["den"]]))
    mean = abs(alpha[-1]) ** (1 / (len(alpha) - 1))
    return alpha / mean ** np.arange(len(alpha))


def main():
    count = int(sys.argv[2])
    goldens.rng = np.random.default_rng(int(sys.argv[3]) if len(sys.argv) > 3 else 1)
    systems = []
    while len(systems) < count:
        num, den, period = goldens.random_system()
        systems.append({"num": num, "den": den, "period": period})
    process = subprocess.Popen([sys.argv[1]], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    threading.Thread(target=lambda: (process.stdin.writelines(json.dumps(g) + "\n" for g in systems), process.stdin.close()), daemon=True).start()
    apart, truths = {kind: [] for kind in KINDS}, {kind: [] for kind in KINDS}
    for g, line in zip(systems, process.stdout, strict=True):
        ours = json.loads(line)
        for kind, (_, theirs, mine, distance, truth) in KINDS.items():
            try:
                d = distance(theirs(g), mine(ours))
            except Exception:
                d = np.inf
            d = np.inf if np.isnan(d) else d
            apart[kind].append(d)
            if d > CLOSE and len(truths[kind]) < MOST_TRUTHS:
                try:
                    true = truth(g)
                    # coefficients are compared with the first padded to the second
                    truths[kind].append((distance(mine(ours), true), d))
                except Exception:
                    pass
    print(f"{count} systems, control {control.__version__}, scipy {scipy.__version__}\n")
    print("| | beside | median apart | beyond 1e-8 | of these worked out | ours then off by more than 1e-8 | ours at worst |\n|---|---|---|---|---|---|---|")
    for kind, (name, *_) in KINDS.items():
        d, t = np.array(apart[kind]), truths[kind]
        ours = [o for o, _ in t]
        print(f"| {kind.strip()} | {name} | {np.median(d):.0e} | {np.sum(d > CLOSE)} | {len(t)} | {sum(o > CLOSE for o in ours)} | {max(ours, default=0):.0e} |")


main()
