#!/usr/bin/env bash
# Linear systems by us and by python-control, on the same loops, in the same run: `bash bench/peers/lab/run.sh`.
# Makes a Python environment in target/. Takes a minute; prints Markdown.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../../.."

readonly VENV=target/lab-venv
export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1

[ -x "$VENV/bin/pip" ] || python3 -m venv "$VENV"
"$VENV/bin/pip" install --quiet --disable-pip-version-check numpy scipy control matplotlib

cargo build --release --locked --quiet -p tracelight
cargo run --release --locked --quiet -p tracelight-linear --example times > target/lab-times.json

# the whole command, from start to written file, ms: the median of 21
bode() {
    local took
    took=$(for _ in $(seq 21); do
        begun=$(date +%s%N)
        target/release/tracelight lab bode 'K11 G11' 'K22 G22' -o "target/lab-bode.$1" >/dev/null
        echo $((($(date +%s%N) - begun) / 1000))
    done | sort -n | sed -n 11p)
    printf '%d.%03d' $((took / 1000)) $((took % 1000))
}
"$VENV/bin/python" bench/peers/lab/times.py target/lab-times.json "$(bode svg)" "$(bode png)"
