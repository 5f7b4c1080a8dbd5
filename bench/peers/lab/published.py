"""What is true of the rows of `crates/linear/tests/goldens/published/figures.tsv` whose published figure is rounded, read from a grid or
of another convention: by mpmath, in thirty digits, as far as the row's note does not say it in a formula."""

import mpmath as mp

mp.mp.dps = 30


def bandwidth(value, near):
    """Where the square of the gain is half of what it is at rest."""
    return mp.findroot(lambda w: abs(value(w)) ** 2 - mp.mpf(1) / 2, near)


tenth = mp.mpf("0.1")
print("bandwidth of 0.1z/(z-0.9)", bandwidth(lambda w: tenth / (mp.expj(w) - mp.mpf("0.9")), tenth))
lag = lambda w: tenth / (1j * w + tenth) / (1 - w * w + mp.mpf("0.002") * 1j * w)
print("bandwidth of 0.1/(s+0.1)/(s^2+0.002s+1)", bandwidth(lag, tenth))

# 1/(s^2+s+1), and (1-s)/(s^2+s+1): its step less its impulse
a, d = mp.mpf(1) / 2, mp.sqrt(3) / 2
step = lambda t: 1 - mp.exp(-a * t) * (mp.cos(d * t) + a / d * mp.sin(d * t))
turned = lambda t: step(t) - mp.exp(-a * t) * mp.sin(d * t) / d
when = lambda answer, level, near: mp.findroot(lambda t: answer(t) - level, near)
low, high = mp.mpf(1) / 10, mp.mpf(9) / 10
print("rise of 1/(s^2+s+1)", when(step, high, 2.2) - when(step, low, 0.5))
print("rise of (1-s)/(s^2+s+1)", when(turned, high, 3.2) - when(turned, low, 2.0))
print("settle of (1-s)/(s^2+s+1)", when(turned, mp.mpf("0.98"), 9))
print("peak time of (1-s)/(s^2+s+1)", mp.findroot(lambda t: mp.diff(turned, t), 4.2))

loop = lambda w: 25 / ((1j * w) ** 3 + 10 * (1j * w) ** 2 + 10j * w + 10)
turn = lambda w: abs((1 - loop(w)) / (1 + loop(w)))
print("disk margin of 25/(s^3+10s^2+10s+10), where", mp.findroot(lambda w: mp.diff(turn, w), 1.95))


def satellite(w, at_output):
    """Two over the largest singular value of S - T."""
    plant = mp.matrix([[1, 10], [-10, 1]]) * mp.inverse(1j * w * mp.eye(2) - mp.matrix([[0, 10], [-10, 0]]))
    gain = mp.matrix([[1, -2], [0, 1]])
    loop = plant * gain if at_output else gain * plant
    m = (mp.eye(2) - loop) * mp.inverse(mp.eye(2) + loop)
    square = m.H * m
    trace = mp.re(square[0, 0] + square[1, 1])
    determinant = mp.re(square[0, 0] * square[1, 1] - square[0, 1] * square[1, 0])
    return 2 / mp.sqrt((trace + mp.sqrt(trace * trace - 4 * determinant)) / 2)


for at_output in (True, False):
    # the pole at 10 rad/s is left out; it is least at 0
    alpha = min(satellite(mp.mpf(k) / 20, at_output) for k in range(400) if k != 200)
    decibels = 20 * mp.log10((1 + alpha / 2) / (1 - alpha / 2))
    print("satellite", alpha, decibels, "dB", mp.degrees(2 * mp.atan(alpha / 2)), "deg")
