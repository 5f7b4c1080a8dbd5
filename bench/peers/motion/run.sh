#!/usr/bin/env bash
# Our order beside others', on the same strokes, in the same run: `bash bench/peers/motion/run.sh [quick]`.
# Makes a Python environment in target/. `quick` leaves out 20 000 strokes, which take vpype a minute.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../../.."

readonly VENV=target/motion-venv CASES=target/motion-cases
export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 PYTHONDONTWRITEBYTECODE=1

loud() { printf '\n!!! %s\n\n' "$*" >&2; }

[ -x "$VENV/bin/pip" ] || python3 -m venv "$VENV"
"$VENV/bin/pip" install --quiet --disable-pip-version-check numpy
"$VENV/bin/pip" install --quiet --disable-pip-version-check vpype || loud 'no vpype: it is left out of the comparison'
"$VENV/bin/python" bench/peers/motion/cases.py "$CASES"
cargo build --release --locked --quiet -p tracelight-bench-motion

ours() { target/release/tracelight-bench-motion order "$@"; }
theirs() { "$VENV/bin/python" -c 'import vpype' 2>/dev/null && "$VENV/bin/python" bench/peers/motion/order_peers.py "$@"; }

cases=("$CASES"/{uniform,sketch,hatch}_500.csv "$CASES"/{uniform,sketch,hatch}_5000.csv)
[ "${1:-}" = quick ] || cases+=("$CASES/uniform_20000.csv")

printf '\nBy distance\n'
ours "${cases[@]}"
theirs "${cases[@]}" || true
printf '\nBy time, rest to rest\n'
ours --by time --times 1 "$CASES"/{uniform,sketch,hatch}_500.csv
printf '\nA net of 328 lines that meet at junctions; ours counts a lift as 10 mm\n'
ours --lift-m 0.01 "$CASES/junctions.csv"
theirs "$CASES/junctions.csv" || true
