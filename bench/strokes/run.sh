#!/usr/bin/env bash
# Our tracer beside others, on the same pictures, in the same run, on one core: `bash bench/strokes/run.sh`.
# Makes a Python environment in target/; potrace comes from the distribution. Takes some minutes; prints Markdown.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

readonly VENV=target/strokes-venv
export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1

loud() { printf '\n!!! %s\n\n' "$*" >&2; }

as_root() {
    if [ "$(id -u)" = 0 ]; then "$@"; else sudo -n "$@"; fi
}

install() { # PACKAGE: into the environment, or say loudly that it is missing
    "$VENV/bin/pip" install --quiet --disable-pip-version-check "$1" || loud "no $1: it is left out of the comparison"
}

[ -x "$VENV/bin/pip" ] || python3 -m venv "$VENV"
for package in opencv-contrib-python-headless scikit-image skan vtracer pyautotrace; do
    install "$package"
done
command -v potrace >/dev/null || {
    as_root apt-get update -qq && as_root apt-get install -y -qq --no-install-recommends potrace
} >/dev/null || loud 'no potrace: it is left out of the comparison'

cargo build --release --locked --quiet -p tracelight-bench-strokes
"$VENV/bin/python" bench/strokes/peers.py "$@"
