#!/usr/bin/env bash
# Repeats the evaluation of "Parallel Lazy Amplification" (Figures 8 and 9, the size of the world, the
# three paradigms), and writes a page with plots, results and the machine. Needs an otherwise idle machine
# with two processors, and about eight minutes.
#   tools/reproduce_paper.sh [OUT]           a folder, default out/paper; build preset release first
#   tools/reproduce_paper.sh --quick [OUT]   three seconds on the virtual clock, to test the script
# PSYGEN names another executable.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

quick=0
[ "${1:-}" = "--quick" ] && { quick=1; shift; }
out="${1:-out/paper}"
psygen="${PSYGEN:-build/release/bin/psygen}"
[ -x "$psygen" ] || { echo "build it first: cmake --preset release && cmake --build --preset release" >&2; exit 1; }

flight=(--world paper --path walk27)
far=(--view-distance 16000)
near=(--view-distance 1000)
samples=64 region=224,224,288,288
if [ "$quick" = 1 ]; then
  flight+=(--clock virtual --fixed-step 20 --seconds 3 --size 160x90)
  far=(--view-distance 300)
  near=("${far[@]}")
  samples=8 region=256,256,258,258
fi

rm -rf "$out"
mkdir -p "$out"
cp /proc/loadavg "$out/load_before"

# Processors that this shell may use. With one there is nothing to compare, and the page states that.
cpus="$(taskset -pc $$ | sed 's/.*: *//')"
first="${cpus%%[-,]*}"
second="${cpus##*[-,]}"

# run FOLDER COMMAND...: records the command line and a failure, for the page.
run() {
  local folder="$out/$1"
  shift
  mkdir -p "$folder"
  printf '%s\n' "$*" >"$folder/command"
  echo "== $*" >&2
  "$@" >"$folder/output.json" 2>"$folder/log" || { echo "$?" >"$folder/failed"; tail -1 "$folder/log" >&2; }
}
fly() { # FOLDER PROCESSORS THREADS options...: THREADS are those of a software driver; "": its default
  local folder="$1" processors="$2" threads="$3"
  shift 3
  run "$folder" env ${threads:+LP_NUM_THREADS=$threads} taskset -c "$processors" \
    "$psygen" fly --headless "${flight[@]}" --out "$out/$folder" --json "$@"
}

for priority in lowest normal; do
  fly "one_core_$priority" "$first" "" "${far[@]}" --modeler-priority "$priority"
  fly "two_cores_$priority" "$first,$second" "" "${far[@]}" --modeler-priority "$priority"
  # The paper's "two cores, one of them off": the driver has threads for two, and one processor runs them.
  fly "one_of_two_$priority" "$first" 2 "${far[@]}" --modeler-priority "$priority"
done
for paradigm in amplify lazy pla; do
  fly "paradigm_$paradigm" "$first,$second" "" --paradigm "$paradigm" "${near[@]}"
done
run curves taskset -c "$first" "$psygen" calibrate --samples "$samples" --out "$out/curves" --json
run world taskset -c "$first" "$psygen" amplify --threads 1 --region "$region" --json
"$psygen" --version >"$out/version"

python3 tools/reproduction_page.py "$out" "$quick"
echo "wrote $out/paper.html" >&2
