"""What python-control takes for what `crates/linear/examples/times.rs` does, and the ratio, as Markdown: `times.py OURS.json SVG_MS PNG_MS`."""

import json
import statistics
import sys
import time
import warnings

import control
import matplotlib
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

warnings.filterwarnings("ignore")
s = control.tf("s")
pan = 281 * (s + 32.9) * (s + 97.8) / ((s + 250) * (s + 177)) * control.tf(
    [13.16, 1.754, 10.29], [1, 0.2649, 0.7997, 0.1029, 0]
)
tilt = 144 * (s + 31.5) * (s + 33.4) / ((s + 194) * (s + 83.5)) * control.tf([13.33], [1, 0.1333, 0.7822])
closed = control.feedback(pan, 1)
plant = control.tf2ss(tilt)
gains, frequencies, times = np.logspace(-3, 1, 1000), np.logspace(-2, 3, 1000), np.linspace(0, 3, 3001)


def bode():
    control.bode_plot([pan, tilt])
    plt.savefig("/dev/null", format="png")
    plt.close("all")


def poly(roots):
    return np.poly(roots)


theirs = {
    "root locus, 1000 gains": lambda: control.root_locus_map(pan, gains),
    "frequency response, 1000 points": lambda: control.frequency_response(pan, frequencies),
    "all margins, pan": lambda: control.stability_margins(pan, returnall=True),
    "all margins, tilt": lambda: control.stability_margins(tilt, returnall=True),
    "step, 3001 points": lambda: control.step_response(closed, times),
    "poles": lambda: pan.poles(),
    "feedback": lambda: control.feedback(pan, 1),
    "Tustin": lambda: control.sample_system(pan, 1e-3, "tustin"),
    "LQR, 4 states": lambda: control.lqr(plant, np.eye(4), np.eye(1)),
    "pole placement, 4 states": lambda: control.place(plant.A, plant.B, [-10, -20, -30, -40]),
    "zero-order hold": lambda: control.sample_system(pan, 1e-3, "zoh"),
    "roots of (x + 1)⁴⁰": lambda: np.roots(poly([-1.0] * 40)),
    "roots of Wilkinson's of order 20": lambda: np.roots(poly(range(1, 21))),
    "roots of 40 roots a decade apart": lambda: np.roots(poly(-(10.0 ** np.arange(-20, 20)))),
    "roots of x⁴⁰ − 1": lambda: np.roots([1] + [0] * 39 + [-1]),
    "roots of x⁴⁰ + … + 1": lambda: np.roots([1] * 41),
    "roots of alternating 1e±150, order 40": lambda: np.roots([1e150 if i % 2 == 0 else -1e-150 for i in range(41)]),
}


def median(work):
    work()
    taken, begun = [], time.perf_counter()
    while len(taken) < 5 or (len(taken) < 200 and time.perf_counter() - begun < 1):
        start = time.perf_counter()
        work()
        taken.append(time.perf_counter() - start)
    return statistics.median(taken)


def ms(seconds):
    return f"{1e3 * seconds:.3g} ms"


ours = json.load(open(sys.argv[1]))
print(f"| | ours | python-control {control.__version__} | ratio |\n|---|---|---|---|")
for name, work in theirs.items():
    mine, other = ours[name] * 1e-6, median(work)
    print(f"| {name} | {ms(mine)} | {ms(other)} | {other / mine:.0f} |")
other = median(bode)
for kind, took in [("SVG", sys.argv[2]), ("PNG", sys.argv[3])]:
    mine = float(took) * 1e-3
    print(f"| Bode plot of two loops: ours the whole command to {kind}, theirs to PNG | {ms(mine)} | {ms(other)} | {other / mine:.0f} |")
