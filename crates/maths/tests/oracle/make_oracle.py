"""Makes known.csv: elementary functions at seeded places, worked out to sixty digits by mpmath 1.3.0 and rounded once.
`cargo test -p tracelight-maths` compares the crate's own with them.

    python3 -m venv /tmp/oracle && /tmp/oracle/bin/pip install mpmath==1.3.0
    /tmp/oracle/bin/python crates/maths/tests/oracle/make_oracle.py

A row is a function, its arguments (the second empty where there is one) and its value, the numbers as Python prints
them: the fewest digits that are read back as the same bits.
"""

import os
import random

import mpmath as mp

HERE = os.path.dirname(os.path.abspath(__file__))
ROWS = 60  # a function
SEED = 2006
mp.mp.dps = 60


def spread(low, high):
    """Either sign, sizes even in their logarithm."""
    return lambda r: r.choice([-1, 1]) * 10 ** r.uniform(low, high)


def positive(low, high):
    return lambda r: 10 ** r.uniform(low, high)


def even(low, high):
    return lambda r: r.uniform(low, high)


ONE = {
    "sin": (mp.sin, spread(-8, 6)),
    "cos": (mp.cos, spread(-8, 6)),
    "tan": (mp.tan, spread(-8, 6)),
    "asin": (mp.asin, even(-1, 1)),
    "acos": (mp.acos, even(-1, 1)),
    "atan": (mp.atan, spread(-8, 8)),
    "exp": (mp.exp, spread(-8, 2.8)),
    "exp2": (lambda x: mp.power(2, x), spread(-8, 3)),
    "exp_m1": (mp.expm1, spread(-12, 1)),
    "ln": (mp.log, positive(-300, 300)),
    "ln_1p": (mp.log1p, positive(-12, 3)),
    "log10": (mp.log10, positive(-300, 300)),
    "log2": (lambda x: mp.log(x, 2), positive(-300, 300)),
    "cbrt": (lambda x: mp.sign(x) * mp.cbrt(abs(x)), spread(-30, 30)),
    "erfc": (mp.erfc, even(-5, 20)),
}
TWO = {
    "atan2": (mp.atan2, spread(-3, 3), spread(-3, 3)),
    "powf": (mp.power, positive(-3, 3), even(-20, 20)),
    "hypot": (mp.hypot, spread(-160, 160), spread(-160, 160)),
    "hypot_near": (mp.hypot, spread(-1, 1), spread(-1, 1)),
}


def main():
    r = random.Random(SEED)
    with open(os.path.join(HERE, "known.csv"), "w", encoding="ascii") as out:
        out.write("function,x,y,value\n")
        for name, (function, draw) in ONE.items():
            for _ in range(ROWS):
                x = draw(r)
                out.write(f"{name},{x!r},,{float(function(mp.mpf(x)))!r}\n")
        for name, (function, draw_x, draw_y) in TWO.items():
            for _ in range(ROWS):
                x, y = draw_x(r), draw_y(r)
                out.write(f"{name.removesuffix('_near')},{x!r},{y!r},{float(function(mp.mpf(x), mp.mpf(y)))!r}\n")


if __name__ == "__main__":
    main()
