"""Orders the same strokes with vpype and prints the rows that `tracelight-bench-motion order` prints."""

import sys
import time
from pathlib import Path

import numpy as np
import vpype
import vpype_cli

PX_PER_M = 96 / 0.0254
WAYS = {
    "vpype": "linesort",
    "vpype 2": "linesort --two-opt",
    "vpype m2": "linemerge --tolerance 0.001mm linesort --two-opt",
}


def main():
    for name in sys.argv[1:]:
        path = Path(name)
        ends = np.loadtxt(path, delimiter=",", skiprows=1)
        lines = [np.array([complex(*e[:2]), complex(*e[2:])]) * PX_PER_M for e in ends]
        for way, command in WAYS.items():
            if (way != "vpype 2" and len(lines) > 5000) or ("m2" in way) != (path.stem == "junctions"):
                continue
            document = vpype.Document()
            document.add(vpype.LineCollection(lines), 1)
            start = time.perf_counter()
            done = vpype_cli.execute(command, document).layers[1]
            took = time.perf_counter() - start
            gaps = np.array([abs(done[i + 1][0] - done[i][-1]) for i in range(len(done) - 1)]) / PX_PER_M
            print(f"{path.stem:20} {way:8} {gaps.sum():9.4f} {(gaps > 1e-9).sum():6d} {'':26} {took:8.3f}", flush=True)


if __name__ == "__main__":
    main()
