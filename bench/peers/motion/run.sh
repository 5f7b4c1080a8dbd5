#!/usr/bin/env bash
# Our order and timing beside others', on the same cases, in the same run: `bash bench/peers/motion/run.sh [quick]`.
# Makes a Python environment in target/. `quick` leaves out 20 000 strokes, which take vpype a minute.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../../.."

readonly VENV=target/motion-venv CASES=target/motion-cases
export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 PYTHONDONTWRITEBYTECODE=1

loud() { printf '\n!!! %s\n\n' "$*" >&2; }

[ -x "$VENV/bin/pip" ] || python3 -m venv "$VENV"
"$VENV/bin/pip" install --quiet --disable-pip-version-check numpy scipy
"$VENV/bin/pip" install --quiet --disable-pip-version-check vpype || loud 'no vpype: it is left out of the comparison'
for package in toppra copp-py ruckig; do
    "$VENV/bin/pip" install --quiet --disable-pip-version-check "$package" || loud "no $package: it is left out of the comparison"
done
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

printf '\nThe fastest motion at full torque, Coulomb friction; ours, then with viscous friction\n'
target/release/tracelight-bench-motion retime --cells 1000,16000 "$CASES"/path_*.csv
target/release/tracelight-bench-motion retime --cells 1000,16000 --viscous 0.0015 "$CASES"/path_*.csv
"$VENV/bin/python" bench/peers/motion/retime_peers.py 1000 8000
printf '\nThe same within 24 rad/s, 100 rad/s2 and 2000 rad/s3, jerk bounded; the line takes 0.4079996 s\n'
target/release/tracelight-bench-motion retime --smooth 24,100,2000 --cells 100,500,1000 --times 5 "$CASES"/path_*.csv

printf '\nWhole plans of 500 uniform strokes at 1 ft/s with the 2006 rig: stopping, passing, at one speed\n'
cargo build --release --locked --quiet -p tracelight
for lit_speed in stops fastest exact; do
    printf '%s: ' "$lit_speed"
    target/release/tracelight plan "$CASES/drawing_uniform_500.csv" --lit-speed "$lit_speed" | tail -n 1
done

printf '\nFrom any state to any other: 20 000 moves of two joints\n'
target/release/tracelight-bench-motion steer "$CASES/moves.csv"
"$VENV/bin/python" bench/peers/motion/steer_peers.py "$CASES/moves.csv" || loud 'no ruckig: it is left out of the comparison'
