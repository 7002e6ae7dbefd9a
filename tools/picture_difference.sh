#!/usr/bin/env bash
# Compares 27 frames of the walk at 60 frames/s with complete frames at an error of half a pixel: 1 - SSIM,
# and the fraction of visibly different pixels. Takes some minutes; build release first.
#   tools/picture_difference.sh [PRESET [WORLD PATH]]     default: low paper walk27
# CLOCK=virtual in the environment: 60 frames/s by the virtual clock, identical on every machine.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
preset="${1:-low}" world="${2:-paper}" path="${3:-walk27}"
out="${OUT:-out/picture_difference}"
rm -rf "$out"
fly() { # FOLDER OPTIONS…
  local folder="$1"
  shift
  "${PSYGEN:-build/release/bin/psygen}" fly --headless --world "$world" --path "$path" --preset "$preset" \
    --size 1280x720 --seconds 27 --out "$out/$folder" "$@" >/dev/null
}
fly seen --clock "${CLOCK:-wall}" --target-fps 60 --fixed-step 60 --images 60
fly reference --paradigm lazy --error 0.5 --budget 2G --fixed-step 1 --images 1
build/release/bin/psygen_bench_pictures "$out/seen" "$out/reference"
