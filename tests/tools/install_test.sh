#!/usr/bin/env bash
# Installs the build into an empty folder, builds and runs another project against it, and runs what
# was installed: from other folders, after the installation has been moved.
#   install_test.sh BUILD_DIR SOURCE_DIR
set -euo pipefail
build="$1" source="$2"
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT

cmake --install "$build" --prefix "$folder/psygen" >/dev/null
cmake -S "$source/tests/tools/consumer" -B "$folder/build" -G Ninja \
  -DCMAKE_PREFIX_PATH="$folder/psygen" -DCMAKE_BUILD_TYPE=Debug >/dev/null
cmake --build "$folder/build" >/dev/null
height="$("$folder/build/consumer" "$folder/psygen/share/psygen/worlds/paper.toml" "$folder/picture.png")"
echo "ground height $height"
[[ "$height" =~ ^[0-9]+\.[0-9]{6}$ ]]
# What both load later lies in the installed folder.
for program in "$folder/build/consumer" "$folder/psygen/bin/psygen"; do
  readelf -d "$program" | grep -E 'RPATH.*(ORIGIN/\.\.|psygen)/lib[^]]*/psygen' >/dev/null
done

mkdir "$folder/elsewhere" "$folder/bin"
mv "$folder/psygen" "$folder/elsewhere/moved here"
ln -s "$folder/elsewhere/moved here/bin/psygen" "$folder/bin/psygen"
for psygen in "$folder/elsewhere/moved here/bin/psygen" "$folder/bin/psygen"; do
  for work in "$folder" / "$folder/elsewhere/moved here/share"; do
    cd "$work"
    "$psygen" models >/dev/null
    "$psygen" models --world five_species | grep '^birch:' >/dev/null
    "$psygen" amplify --region 1,1,2,2 | grep '^hash  *[0-9a-f]\{16\}$' >/dev/null
  done
done
cd "$folder"
psygen="$folder/bin/psygen"
# As psygen fly does, to the point where it would open a device: its world and its path are found.
VK_ICD_FILENAMES=/nonexistent.json "$psygen" fly --headless --path combe 2>"$folder/fly.txt" || code=$?
[ "${code:-0}" -eq 4 ] || { cat "$folder/fly.txt"; exit 1; }
"$psygen" export --world silver_combe --block 3,-4 --level 2 --out block.glb 2>/dev/null
[ -s block.glb ]
if "$psygen" amplify --world silver_comb 2>"$folder/amplify.txt"; then exit 1; fi
grep -q "moved here/share/psygen/worlds.*silver_combe; did you mean silver_combe?" "$folder/amplify.txt"
