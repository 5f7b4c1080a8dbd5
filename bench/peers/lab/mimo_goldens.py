"""Random systems of several channels with what python-control, slycot and scipy say of them: crates/linear/tests/goldens/mimo.jsonl.

python-control 0.10.2, slycot 0.7.1, scipy 1.17.1, numpy 2.4.6; run: python bench/peers/lab/mimo_goldens.py > crates/linear/tests/goldens/mimo.jsonl
"""

import json

import control
import numpy as np
from scipy.signal import cont2discrete

random = np.random.default_rng(36)


def system(number):
    """Stable poles over two decades, mixed by a random change of states; every third is made of samples."""
    n, m, p = (int(k) for k in (random.integers(2, 9), random.integers(1, 4), random.integers(1, 4)))
    blocks = []
    while len(blocks) < n:
        size = 10 ** random.uniform(-1, 1)
        if n - len(blocks) >= 2 and random.random() < 0.5:
            damping = 10 ** random.uniform(-2, -0.1)
            blocks += [(size * damping, size * np.sqrt(1 - damping**2)), None]
        else:
            blocks += [(size, 0.0)]
    a = np.zeros((n, n))
    for k, block in enumerate(blocks):
        if block and block[1]:
            a[k : k + 2, k : k + 2] = [[-block[0], block[1]], [-block[1], -block[0]]]
        elif block:
            a[k, k] = -block[0]
    mix = random.normal(size=(n, n))
    a = np.linalg.solve(mix, a @ mix)
    b, c = random.normal(size=(n, m)), random.normal(size=(p, n))
    d = random.normal(size=(p, m)) if number % 2 else np.zeros((p, m))
    dt = 0.0
    if number % 3 == 0:
        dt = 0.1
        a, b, c, d, _ = cont2discrete((a, b, c, d), dt, "zoh")
    return control.ss(a, b, c, d, dt)


def rows(matrix):
    return [[float(x) for x in row] for row in np.atleast_2d(matrix)]


for number in range(90):
    g = system(number)
    w = [float(x) for x in np.logspace(-1.5, 1.2, 7)]
    golden = {"a": rows(g.A), "b": rows(g.B), "c": rows(g.C), "d": rows(g.D), "dt": float(g.dt), "rad_s": w}
    places = [np.exp(1j * x * g.dt) if g.dt else 1j * x for x in w]
    golden["singular"] = [[float(x) for x in np.linalg.svd(g(z, squeeze=False))[1]] for z in places]
    golden["h_infinity"] = float(control.system_norm(g, p="inf", tol=1e-10, method="slycot", print_warning=False))
    if g.dt or not np.any(g.D):
        golden["h2"] = float(control.system_norm(g, p=2, method="slycot", print_warning=False))
    golden["zeros"] = [[float(z.real), float(z.imag)] for z in g.zeros()]
    if not g.dt:
        for how in ("foh", "impulse"):
            if how == "impulse" and np.any(g.D):
                continue
            sampled = cont2discrete((g.A, g.B, g.C, g.D), 0.2, how)
            golden[how] = [rows(x) for x in sampled[:4]]
    if g.ninputs == g.noutputs:
        loop = control.ss(g.A, g.B, 0.1 * g.C, 0.1 * g.D, g.dt)
        closed = control.feedback(loop, control.ss([], [], [], np.eye(g.ninputs), g.dt))
        poles = closed.poles()
        if all(abs(poles) < 1) if g.dt else all(poles.real < 0):
            one = control.ss([], [], [], np.eye(g.ninputs), g.dt)
            shifted = control.feedback(one, loop) - 0.5 * np.eye(g.ninputs)
            golden["disk"] = 1 / float(control.system_norm(shifted, p="inf", tol=1e-10, method="slycot", print_warning=False))
    print(json.dumps(golden))
