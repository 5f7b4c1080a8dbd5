"""Random formulas, most of them slightly broken, through Tracelight's reader and through an evaluator that shares nothing with it.

    python3 formulas.py PROGRAM [COUNT] [SEED]      PROGRAM is target/release/examples/formula_values

Every formula that is accepted must have the value that Python computes for it; what Python's reading would guess at, Tracelight may
refuse. Prints how many were accepted, refused and wrong; exit status 1 if any was wrong.
"""

import random
import re
import subprocess
import sys

S = complex(0.7, 1.3)


class Value:
    """A value and the size of the terms that it was summed from: rounding is a share of that."""

    def __init__(self, value, size=None):
        self.value, self.size = complex(value), abs(value) if size is None else size

    def __add__(self, other):
        return Value(self.value + other.value, self.size + other.size)

    def __sub__(self, other):
        return Value(self.value - other.value, self.size + other.size)

    def __neg__(self):
        return Value(-self.value, self.size)

    def __pos__(self):
        return self

    def __mul__(self, other):
        return Value(self.value * other.value, self.size * other.size)

    def __truediv__(self, other):
        return Value(self.value / other.value, self.size * other.size / abs(other.value) ** 2)

    def __pow__(self, power):
        base = self if power >= 0 else Value(1) / self
        result = Value(1)
        for _ in range(abs(power)):
            result = result * base
        return result


S_VALUE = Value(S)
G1 = Value(2) / (S_VALUE + Value(3))
K2 = (S_VALUE + Value(1)) / (S_VALUE * S_VALUE + Value(4))

TOKEN = re.compile(r"\s*(?:(\d+\.?\d*(?:[eE][+-]?\d+)?|\.\d+(?:[eE][+-]?\d+)?)|(G1\(\s*s\s*\)|K2\(\s*s\s*\))|([A-Za-z][A-Za-z0-9]*)|(\*\*|[-+*/^()]))")


def expected(text):
    """What Python computes, with * where factors stand side by side; None if it is no formula."""
    parts, at, operand = [], 0, False
    while text[at:].strip():
        match = TOKEN.match(text, at)
        if not match:
            return None
        number, call, name, sign = match.groups()
        at = match.end()
        before = parts[-1] if parts else ""
        if sign in ("^", "**"):
            exponent = re.compile(r"\s*(\(?)\s*([-+]?)\s*(\d+)(?:\.0*)?\s*(\)?)").match(text, at)
            if not exponent or (exponent[1] == "(") != (exponent[4] == ")"):
                closing = re.compile(r"\s*([-+]?)\s*(\d+)(?:\.0*)?").match(text, at)
                if not closing:
                    return None
                exponent = closing
                parts.append(f"**({closing[1]}{int(closing[2])})")
            else:
                parts.append(f"**({exponent[2]}{int(exponent[3])})")
            at = exponent.end()
            operand = True
            continue
        if sign and sign != "(":
            operand = sign == ")"
            parts.append(sign)
            continue
        if operand and before:
            parts.append("*")
        if sign == "(":
            parts.append("(")
            operand = False
        elif number:
            parts.append(f"Value({float(number)!r})")
            operand = True
        elif call:
            parts.append(call[:2])
            operand = True
        elif name in ("s", "G1", "K2"):
            parts.append("S_VALUE" if name == "s" else name)
            operand = True
        elif set(name) == {"s"}:
            return None
        else:
            return None
    try:
        return eval("".join(parts), {"Value": Value, "S_VALUE": S_VALUE, "G1": G1, "K2": K2})  # noqa: S307
    except (SyntaxError, ZeroDivisionError, OverflowError, TypeError):
        return None


def formula(rng, depth):
    """A formula as people write them."""
    kind = rng.random()
    space = rng.choice(["", "", " "])
    if depth == 0 or kind < 0.25:
        return rng.choice(["s", "s", "G1", "K2(s)", "K2", "2", "0.5", "3.", ".25", "1e-1", "12"])
    inner = lambda: formula(rng, depth - 1)  # noqa: E731
    if kind < 0.45:
        return f"({inner()}{space}{rng.choice('+-')}{space}{inner()})"
    if kind < 0.6:
        return f"{inner()}{space}*{space}{inner()}"
    if kind < 0.7:
        return f"{inner()}{space}/{space}({inner()})"
    if kind < 0.8:
        return f"({inner()}){rng.choice(['^', '**', '^ '])}{rng.choice(['2', '3', '-1', '(2)', '2.0', '0'])}"
    if kind < 0.9:
        return f"{inner()}{rng.choice(['', ' '])}({inner()})"
    if kind < 0.95:
        return f"-{inner()}"
    return f"{inner()}{rng.choice(['', ' '])}{inner()}"


def broken(rng, text):
    """The same with a slip."""
    at = rng.randrange(len(text) + 1)
    kind = rng.random()
    if kind < 0.4:
        return text[:at] + text[at + 1 :]
    return text[:at] + rng.choice("s2.^*/+-() G1K2e5") + text[at:]


def main():
    program, count, seed = sys.argv[1], int((sys.argv[2:3] or [100000])[0]), int((sys.argv[3:4] or [1])[0])
    rng = random.Random(seed)
    texts = []
    for _ in range(count):
        text = formula(rng, rng.randint(1, 4))
        for _ in range(rng.choice([0, 1, 1, 2])):
            text = broken(rng, text)
        texts.append(text[:200])
    run = subprocess.run([program], input="\n".join(texts) + "\n", capture_output=True, text=True, check=True)
    accepted = refused = wrong = 0
    for text, line in zip(texts, run.stdout.splitlines()):
        if line.startswith("refused"):
            refused += 1
            continue
        accepted += 1
        value = complex(*map(float, line.split()))
        own = expected(text)
        if own is None or abs(value - own.value) > 1e-7 * own.size:
            wrong += 1
            if wrong <= 20:
                print(f"wrong: {text!r}: {value}, not {own and own.value}")
    print(f"{count} formulas: {accepted} accepted, {refused} refused, {wrong} wrong")
    return int(wrong > 0)


if __name__ == "__main__":
    sys.exit(main())
