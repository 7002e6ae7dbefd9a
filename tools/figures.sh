#!/bin/sh
# Measures docs/performance.md, "Targets": the flights, also shortened, far from the origin and in a huge
# world, and the benchmarks of PLP and of the tick without drawing. Needs an otherwise idle machine and
# about twelve minutes.
#
# usage: tools/figures.sh [OUT]        (a folder, default out/figures; build preset release first)
set -eu
cd "$(dirname "$0")/.."
out=${1:-out/figures}
psygen=build/release/bin/psygen
[ -x "$psygen" ] || { echo "build it first: cmake --preset release && cmake --build --preset release" >&2; exit 1; }
mkdir -p "$out"
worlds=game/worlds
paths=game/paths
walk="--world $worlds/paper.toml --path $paths/walk27.toml"

failed=0
fly() { # name, then options; prints the command, and the log after an error
  name=$1
  shift
  rm -rf "${out:?}/$name"
  echo "== $name: $psygen fly --headless $*"
  $psygen fly --headless --out "$out/$name" "$@" >"$out/$name.log" 2>&1 || { cat "$out/$name.log"; failed=1; }
}
laps() { # name: the same path twice, the second time from the cache
  # shellcheck disable=SC2086
  fly "$1" $walk --error 12 --loop --seconds 54
  python3 tools/lap_table.py 27 "$out/$1/frames.csv" || failed=1
}

# shellcheck disable=SC2086
{
  fly fixed $walk
  fly walk $walk --target-fps 60
  fly walk_again $walk --target-fps 60
  for seconds in 5 9 13 18 22; do # frame time over its floor, at several places
    fly "until_$seconds" $walk --target-fps 60 --seconds $seconds
  done
}
for path in dash whirl leaps jumps; do
  fly "$path" --world $worlds/paper.toml --path "$paths/$path.toml" --target-fps 60
done
python3 tools/lap_table.py 4 "$out/jumps/frames.csv" || failed=1 # each jump without its first second
laps laps
if command -v taskset >/dev/null; then
  first=$(taskset -pc $$ | sed 's/.*: *//; s/[-,].*//')
  psygen="taskset -c $first $psygen"
  laps one_core
  psygen=build/release/bin/psygen
fi
sed 's/^blocks *=.*/blocks = [1048576, 1048576]/' $worlds/paper.toml >"$out/huge.toml"
# shellcheck disable=SC2086
fly same $walk --error 12
fly huge --world "$out/huge.toml" --path $paths/walk27.toml --error 12
for place in origin:0,0 far_away:1073741824,-1073741824; do
  name=${place%%:*}
  sed "s/^origin_block *=.*/origin_block = [${place#*:}]/" $paths/walk27.toml >"$out/$name.toml"
  fly "$name" --world $worlds/endless.toml --path "$out/$name.toml" --error 12
done

python3 tools/flight_table.py "$out"/*/summary.json
echo "== PLP over 100,489 blocks, and the tick without drawing"
build/release/bin/psygen_bench_visibility --benchmark_filter='plp' --benchmark_min_time=0.2
build/release/bin/psygen_bench_scene
exit $failed
