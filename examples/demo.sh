#!/bin/sh
# The demonstration: calibrate the camera with a ruler, trace a picture to the size it allows, show the report.
#
#   examples/demo.sh [PICTURE]
set -eu
cd "$(dirname "$0")/.."
picture=${1:-examples/house.png}
tracelight() { cargo run --release --quiet -- "$@"; }

echo "== calibrate: a ruler with two tapes 4 in apart, upright and level, seen from 3 ft"
tracelight calibrate ruler examples/ruler-upright.png examples/ruler-level.png --marks 4in --distance 3ft --wish 3ft,3ft

echo
echo "== trace: $picture, 24 in wide, at 1 ft/s"
tracelight trace "$picture" --width 24in --distance 3ft --speed 1ft/s --out out/demo --open

echo
echo "== the same on a worn rig: sticking friction, backlash, uneven encoder, drifted amplifiers"
tracelight trace "$picture" --width 24in --distance 3ft --speed 1ft/s --rig worn --out out/demo-worn
