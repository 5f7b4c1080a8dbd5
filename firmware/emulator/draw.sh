#!/usr/bin/env bash
# Has the program draw a picture by the emulated board at a pseudo-terminal, as by a real one at a port, and holds what came of it against the simulated rig:
#     draw.sh PROGRAM IMAGE MODULE PICTURE FOLDER
set -euo pipefail
readonly program=$1 image=$2 module=$3 picture=$4 folder=$5
readonly here=$(dirname "${BASH_SOURCE[0]}")
mkdir -p "$folder"
rm -rf "$folder"/{board,drawn,simulated,report.json,report.csv}
socat "PTY,link=$folder/board,raw,echo=0" "EXEC:node $here/serve.mjs $image $module 1 $folder/report,pipes" &
readonly line=$!
trap 'kill $line 2>/dev/null || true' EXIT
for _ in $(seq 50); do
    [ -e "$folder/board" ] && break
    sleep 0.1
done
"$program" doctor --rig "$folder/board"
"$program" home --rig "$folder/board:bridge" --quiet
"$program" trace "$picture" --width 25cm --rig "$folder/board:bridge" --out "$folder/drawn" --quiet
# its emulator ends when its line is closed, and writes what it saw
kill $line
wait $line || true
for _ in $(seq 50); do
    [ -s "$folder/report.csv" ] && break
    sleep 0.1
done
"$program" trace "$picture" --width 25cm --rig bridge --out "$folder/simulated" --quiet
node "$here/drawn.mjs" "$folder/drawn" "$folder/report" "$folder/simulated"
