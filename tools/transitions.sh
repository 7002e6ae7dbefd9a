#!/usr/bin/env bash
# Measures flicker: pixels that change and change back from one frame to the next while models and LODs
# change. Flies a path at 5 and at 50 m/s with 60 frames/s of the virtual clock: at an error of 4 pixels
# with and without fades, with --target-fps 60, and at half a pixel with every mesh and no fades
# (reference). Prints the mean and the 95th percentile of the fraction of pixels in percent, and the
# difference of the mean from the reference. Takes ten minutes and 200 MB; build release first.
#   tools/transitions.sh [PRESET [WORLD PATH [SECONDS]]]   default: low paper walk27 3
# PATH is a name in game/paths, flown at 50 m/s; at 5 m/s it takes ten times as long. The first second does
# not count. In the environment: OUT, a folder; PSYGEN, the program; SPEEDS, "5 50"; KEEP=1 keeps the
# frames, and images with flickering pixels in red (1.5 GB).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
preset="${1:-low}" world="${2:-paper}" path="${3:-walk27}" seconds="${4:-3}"
out="${OUT:-out/transitions}" psygen="${PSYGEN:-build/release/bin/psygen}"
rm -rf "$out"
mkdir -p "$out"
cp "game/paths/$path.toml" "$out/50.toml"
awk '/^time_s /{$3 *= 10} /^smoothing_s /{$3 = 10} {print}' "$out/50.toml" >"$out/5.toml"

shares() { # NAME OPTIONS…: prints MEAN P95
  local folder="$out/$preset-$speed-$1"
  shift
  "$psygen" fly --headless --world "$world" --path "$out/$speed.toml" --preset "$preset" --size 1280x720 \
    --fixed-step 60 --images 1 --seconds "$seconds" --out "$folder" "$@" >/dev/null 2>"$folder.log"
  if [ "${KEEP:-0}" = 1 ]; then
    mkdir "$folder/flicker"
    build/release/bin/psygen_bench_flicker "$folder" 60 "$folder/flicker"
  else
    build/release/bin/psygen_bench_flicker "$folder" 60
    rm -rf "$folder"
  fi
}
row() { # WHAT NAME OPTIONS…
  local what="$1" name="$2" mean p95
  shift
  read -r mean p95 < <(shares "$@") || { echo "see the end of $out/$preset-$speed-$name.log" >&2; exit 1; }
  [ "$name" != reference ] || reference="$mean"
  awk -v row="| $preset | $speed | $what | $mean | $p95 |" -v a="$mean" -v b="$reference" \
    'BEGIN {printf "%s %+.3f |\n", row, a - b}'
}

echo "| preset | m/s | error | mean, % | p95, % | mean above the reference |"
echo "| --- | --- | --- | --- | --- | --- |"
for speed in ${SPEEDS:-5 50}; do
  [ -f "$out/$speed.toml" ] || { echo "SPEEDS: 5 or 50, not $speed" >&2; exit 2; }
  reference=0
  row "0.5 px, reference" reference --paradigm lazy --error 0.5 --budget 2G
  row "4 px, no fades" error4_at_once --clock virtual --error 4 --fade 0
  row "4 px" error4 --clock virtual --error 4
  row "--target-fps 60" fps60 --clock virtual --target-fps 60
done
