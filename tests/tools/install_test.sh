#!/usr/bin/env bash
# Installs the build into an empty folder and builds and runs another project against it.
#   install_test.sh BUILD_DIR SOURCE_DIR
set -euo pipefail
build="$1" source="$2"
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT

cmake --install "$build" --prefix "$folder/psygen" >/dev/null
cmake -S "$source/tests/tools/consumer" -B "$folder/build" -G Ninja \
  -DCMAKE_PREFIX_PATH="$folder/psygen" -DCMAKE_BUILD_TYPE=Debug >/dev/null
cmake --build "$folder/build" >/dev/null
height="$("$folder/build/consumer" "$source/game/worlds/paper.toml" "$folder/picture.png")"
echo "ground height $height"
[[ "$height" =~ ^[0-9]+\.[0-9]{6}$ ]]
# What both load later lies in the installed folder.
for program in "$folder/build/consumer" "$folder/psygen/bin/psygen"; do
  readelf -d "$program" | grep -E 'RPATH.*(ORIGIN/\.\.|psygen)/lib[^]]*/psygen' >/dev/null
done
"$folder/psygen/bin/psygen" models >/dev/null
