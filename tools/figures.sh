#!/bin/sh
# Measures the flights whose figures docs/performance.md lists. Wants a machine with nothing else
# running, and some nine minutes.
#
# usage: tools/figures.sh [OUT]        (a folder, default out/figures; needs preset release built)
set -eu
cd "$(dirname "$0")/.."
out=${1:-out/figures}
psygen=build/release/game/psygen
[ -x "$psygen" ] || { echo "build it first: cmake --preset release && cmake --build --preset release" >&2; exit 1; }
mkdir -p "$out"
worlds=game/worlds
paths=game/paths

fly() { # name, then options
  name=$1
  shift
  echo "== $name: psygen fly --headless $*"
  "$psygen" fly --headless --out "$out/$name" "$@" 2>"$out/$name.log" |
    grep -E 'median|p95|hitches|thousand tri|holes|worst|visible|peak|visibility|cache  ' || cat "$out/$name.log"
}
python=python3

fly fixed --world $worlds/paper.toml --path $paths/walk27.toml
fly walk --world $worlds/paper.toml --path $paths/walk27.toml --target-fps 60
fly laps --world $worlds/paper.toml --path $paths/walk27.toml --error 12 --loop --seconds 54
$python tools/lap_table.py 27 "$out/laps/frames.csv"
if command -v taskset >/dev/null; then
  first=$(taskset -pc $$ | sed 's/.*: *//; s/[-,].*//')
  psygen="taskset -c $first $psygen"
  fly_one_core() { $psygen fly --headless --out "$out/$1" --world $worlds/paper.toml \
    --path $paths/walk27.toml --error 12 --loop --seconds 54 >"$out/$1.log" 2>&1; }
  echo "== one core: $psygen fly ... --error 12 --loop --seconds 54"
  fly_one_core one_core
  $python tools/lap_table.py 27 "$out/one_core/frames.csv"
  psygen=build/release/game/psygen
fi
for path in dash whirl leaps; do
  fly "$path" --world $worlds/paper.toml --path "$paths/$path.toml" --target-fps 60
done
sed 's/^blocks *=.*/blocks = [1048576, 1048576]/' $worlds/paper.toml >"$out/huge.toml"
fly huge --world "$out/huge.toml" --path $paths/walk27.toml --error 12 --seconds 27
fly same --world $worlds/paper.toml --path $paths/walk27.toml --error 12 --seconds 27
fly endless --world $worlds/endless.toml --path $paths/walk27.toml --error 12
$python tools/flight_table.py "$out"/*/summary.json
