#!/usr/bin/env bash
# Builds the examples of docs/guide against an installed psygen, runs each, and looks at what it
# leaves. Nothing of the engine is compiled again.
#   examples_test.sh BUILD_DIR SOURCE_DIR
set -euo pipefail
build="$1" source="$2"
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT

cmake --install "$build" --prefix "$folder/psygen" >/dev/null
cmake -S "$source/examples" -B "$folder/build" -G Ninja -DCMAKE_BUILD_TYPE=Debug \
  -DCMAKE_PREFIX_PATH="$folder/psygen" >"$folder/log.txt" 2>&1 || { cat "$folder/log.txt"; exit 1; }
cmake --build "$folder/build" >"$folder/log.txt" 2>&1 || { cat "$folder/log.txt"; exit 1; }

# Of a step of the guide: at most so many lines.
for program in "$source"/examples/*/*.cpp; do
  lines="$(wc -l <"$program")"
  [ "$lines" -le 150 ] || { echo "$program has $lines lines; at most 150 are a step"; exit 1; }
done

cd / # programs find their files from any folder
picture() { # FOLDER NAME: the example draws a picture that is not empty
  "$folder/build/$1/example_$2" "$folder/$2.png" 2>"$folder/log.txt" || { cat "$folder/log.txt"; exit 1; }
  [ "$(stat -c %s "$folder/$2.png")" -gt 50000 ] || { echo "$2: the picture is empty"; exit 1; }
}
picture 01_window window
picture 02_world world
picture 03_model_type model_type
"$folder/build/04_systems/example_systems" 2 2>/dev/null | tee "$folder/systems.txt"
grep -qE '^1[12][0-9] steps, block [0-9-]+, [1-9][0-9]+ models seen$' "$folder/systems.txt"
"$folder/build/05_walking/example_walking" 20 2>/dev/null | tee "$folder/walking.txt"
grep -qE '^walked [1-9][0-9]+ m, -?0\.0[0-9] m above the ground$' "$folder/walking.txt"
for run in 1 2; do # the second run starts from what the first one saved
  "$folder/build/06_felling/example_felling" "$folder/game.save" "$folder/felling$run.png" 2>/dev/null |
    tee -a "$folder/felling.txt"
done
grep -q '; 1 oaks in all$' "$folder/felling.txt" && grep -q '; 2 oaks in all$' "$folder/felling.txt"
! cmp -s "$folder/felling1.png" "$folder/felling2.png" || { echo "no tree is gone"; exit 1; }
[ "$(cut -d';' -f1 "$folder/felling.txt" | sort -u | wc -l)" -eq 2 ] # two different ones
picture 07_hud hud
picture 08_objects objects
picture 09_gltf gltf

# The game to start from, and its frame tests: one within its budgets, and one that none holds.
"$folder/build/template/my_game" "$folder/game.png" 2>"$folder/log.txt" || { cat "$folder/log.txt"; exit 1; }
[ "$(stat -c %s "$folder/game.png")" -gt 50000 ] || { echo "the game's picture is empty"; exit 1; }
# The folder for players. Without psygen's package the game runs and saves an image.
cmake --install "$folder/build/template" --prefix "$folder/for players" >/dev/null
mv "$folder/psygen" "$folder/away"
(cd / && "$folder/for players/my_game" "$folder/shipped.png") 2>"$folder/log.txt" || { cat "$folder/log.txt"; exit 1; }
mv "$folder/away" "$folder/psygen"
[ "$(stat -c %s "$folder/shipped.png")" -gt 50000 ] || { echo "the shipped game's picture is empty"; exit 1; }
ctest --test-dir "$folder/build/template" --tests-regex '^exact$' --output-on-failure --no-tests=error
sed -E 's/^frame_ms.p99 = .*/frame_ms.p99 = 0/; s|"(world\|walk).toml"|"'"$source"'/examples/template/\1.toml"|' \
  "$source/examples/template/exact.toml" >"$folder/missed.toml"
code=0
"$folder/build/template/my_game_frame_test" "$folder/missed.toml" >"$folder/frames.txt" 2>/dev/null || code=$?
[ "$code" -eq 3 ] || { echo "a missed budget ended with $code instead of 3"; exit 1; }
grep -qE '^missed: frame_ms.p99 .* <= 0  MISSED$' "$folder/frames.txt"
# The template's workflow, on a copy in a repository of its own: its steps build the game against the installed
# package, and tell a result that holds, and one that does not. On the wall clock any run holds, however few its frames.
cp -r "$source/examples/template" "$folder/game"
cd "$folder/game"
sed -i -E 's/^frame_ms.p9[59] = .*/frame_ms.max = 1000000/; s/^(missing.pixels_max_percent) = .*/\1 = 100/
           s/^figures.physics_ms.p95 = .*/figures.physics_ms.max = 1000000/' frames.toml
git init -q
git -c user.name=test -c user.email=test@localhost commit -q --allow-empty -m first
workflow() { # CODE STEP...: the steps end with this exit code
  local expected="$1" code=0
  PSYGEN_PREFIX="$folder/psygen" GITHUB_STEP_SUMMARY="$folder/step.md" CMAKE_BUILD_PARALLEL_LEVEL=2 \
    "$source/tests/tools/workflow_steps.py" .github/workflows/frame-tests.yml "${@:2}" >"$folder/log.txt" 2>&1 || code=$?
  [ "$code" -eq "$expected" ] || { cat "$folder/log.txt"; echo "the workflow ended with $code"; exit 1; }
}
workflow 0 "Build the game" "Run the frame tests" "Show the summary"
grep -qE '^\| exact \| held, 4 budgets \|' "$folder/step.md"
[ -s frame-tests/exact/report.html ] && [ -s frame-tests/frames/report.html ] && [ -s frame-tests/junit.xml ]
[ "$(grep -c '"test":"frames","pair_s":[0-9]' usual.jsonl)" -eq 1 ]
sed -i -E 's/^frame_ms.p99 = .*/frame_ms.p99 = 0.001/' exact.toml
line="$(grep -n '^frame_ms.p99' exact.toml | cut -d: -f1)"
workflow 3 "Run the frame tests"
grep -q "^::error file=exact.toml,line=$line,title=exact misses frame_ms.p99::frame_ms.p99 is " "$folder/log.txt"
workflow 0 "Show the summary"
grep -qE '^\| exact \| missed 1 of 4 budgets \|' "$folder/step.md" && [ -s frame-tests/exact/failed.html ]
[ -z "${KEEP_PICTURES:-}" ] || cp "$folder"/*.png "$KEEP_PICTURES"
