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
height="$("$folder/build/consumer" "$source/game/worlds/paper.toml")"
echo "ground height $height"
[[ "$height" =~ ^[0-9]+\.[0-9]{6}$ ]]
"$folder/psygen/bin/psygen" models >/dev/null
