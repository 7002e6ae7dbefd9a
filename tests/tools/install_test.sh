#!/usr/bin/env bash
# Installs the build into an empty folder, builds and runs other projects against it (tests/tools/consumer), and
# runs the installed programs from other folders after moving the installation. Compiles nothing of the
# engine.
#   install_test.sh BUILD_DIR SOURCE_DIR
set -euo pipefail
build="$1" source="$2"
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT

cmake --install "$build" --prefix "$folder/psygen" >/dev/null
consumers="$source/tests/tools/consumer"
configure() { # PROJECT arguments...
  cmake -S "$consumers/$1" -B "$folder/build/$1" -G Ninja -DCMAKE_BUILD_TYPE=Debug \
    -DCMAKE_PREFIX_PATH="$folder/psygen" "${@:2}" >"$folder/log.txt" 2>&1 ||
    { cat "$folder/log.txt"; exit 1; }
}

# No library is named by a bare -l, and nothing of this build is left in the package.
cmake_files="$(dirname "$(find "$folder/psygen" -name psygen-config.cmake)")"
if grep -hE 'INTERFACE_LINK_LIBRARIES ' "$cmake_files"/*.cmake | grep -oE '"[^"]*"' | tr -d '"' | tr ';' '\n' |
  sed -E 's/^\\?\$<LINK_ONLY:(.*)>$/\1/' | grep -vE '^$|^glfw$|::'; then
  echo "the package links the libraries above by their bare names"; exit 1
fi
# Paths below the place of installation may end in the name of this folder, as include/psygen.
if sed -E 's#\$\{[A-Za-z_]+\}/[^"; )]*##g' "$cmake_files"/*.cmake |
  grep -E 'GLM_FORCE|ffp-contract|disable-new-dtags|'"$source"; then
  echo "the package has the settings above for its users"; exit 1
fi
# Headers that are not public stay private; documents, worlds and paths are installed.
for private in engine/render/device/vulkan.hpp engine/core/headroom.hpp engine/cli/text_values.hpp engine/scene/state.hpp; do
  [ ! -e "$folder/psygen/include/psygen/$private" ] || { echo "$private is installed"; exit 1; }
done
installed_docs="$folder/psygen/share/doc/psygen"
[ -s "$folder/psygen/share/psygen/gdb/psygen.py" ]
[ -s "$installed_docs/docs/guide/../../examples/template/game.cpp" ] && [ -s "$installed_docs/docs/architecture.md" ] && [ -s "$folder/psygen/share/psygen/paths/walk27.toml" ]

python3 "$source/tests/tools/docs_test.py" --installed "$installed_docs"

# Each program has a manual page with its options, and completions that know them.
share="$folder/psygen/share"
grep -qF '\fB\-\-target\-fps\fR' "$share/man/man1/psygen.1"
offered() { # PROGRAM WORD...: prints what bash offers for the last word
  (source "$share/bash-completion/completions/$1"
   PATH="$folder/psygen/bin:$PATH" COMP_WORDS=("$@") COMP_CWORD=$(($# - 1))
   "_${1//-/_}" && echo "${COMPREPLY[*]}")
}
expect() { # OFFERED PROGRAM WORD...
  [ "$(cd "$folder/psygen" && offered "${@:2}")" = "$1" ] || { echo "${*:2}: bash offers $(offered "${@:2}")"; exit 1; }
}
expect fly psygen fl
expect "--view --view-distance" psygen fly --view
expect "ultra" psygen picture --preset = u
expect check psygen history ch
expect silver_combe psygen amplify --world silver
[ ! -e "$folder/psygen/bin/psygen-game" ] || expect --autoplay psygen-game --auto
if command -v zsh >/dev/null; then # in a terminal of its own, where each tab completes a word
  PATH="$folder/psygen/bin:$PATH" zsh -f -c 'zmodload zsh/zpty; zpty shell zsh -f -i
    zpty -w shell "fpath=(${(q)1} \$fpath); autoload -U compinit; compinit -u -d ${(q)2}; PS1=rea\"\"dy"
    zpty -r shell shown "*ready*"
    zpty -w -n shell $'"'"'psygen fl\t--target\t30 --preset u\t'"'"'
    zpty -r shell shown "*--target-fps*ultra*"' zsh "$share/zsh/site-functions" "$folder/zcompdump"
fi
# Desktop files, icons and AppStream data of the programs with a window.
for program in psygen-game psygen-editor; do
  [ -e "$folder/psygen/bin/$program" ] || continue # not built
  (cd / && "$folder/psygen/bin/$program" --help >/dev/null)
  [ -s "$share/man/man1/$program.1" ] && [ -s "$share/zsh/site-functions/_$program" ]
  grep -qx "Icon=$program" "$share/applications/$program.desktop"
  grep -q "<launchable type=\"desktop-id\">$program.desktop<" "$share/metainfo/$program.metainfo.xml"
  [ -s "$share/icons/hicolor/scalable/apps/$program.svg" ]
done
# DESTDIR comes before the prefix.
DESTDIR="$folder/root" cmake --install "$build" --prefix /usr --component psygen_tools >/dev/null
[ -x "$folder/root/usr/bin/psygen" ]

# One version: the package's and the program's.
grep -q "set(PACKAGE_VERSION \"$("$folder/psygen/bin/psygen" --version | cut -d' ' -f2)\")" \
  "$cmake_files/psygen-config-version.cmake" || { echo "psygen --version is not the package's version"; exit 1; }

configure only_ecs
cmake --build "$folder/build/only_ecs" >/dev/null
"$folder/build/only_ecs/only_ecs"
# One definition of GLM's types in a program that is optimised when it is linked, and one layout in any program.
configure parent -DPSYGEN_SOURCE="$source" -DCMAKE_INTERPROCEDURAL_OPTIMIZATION=ON -DCMAKE_UNITY_BUILD=ON
cmake --build "$folder/build/parent" --target layout >"$folder/log.txt" 2>&1 || { cat "$folder/log.txt"; exit 1; }
if grep -e -Wodr "$folder/log.txt"; then echo "types have two definitions"; exit 1; fi
"$(find "$folder/build/parent" -name layout -type f)"
for refused in "packed vectors:-DGLM_FORCE_INTRINSICS -DGLM_FORCE_DEFAULT_ALIGNED_GENTYPES" \
               "quaternions in the order x, y, z, w:-DGLM_FORCE_QUAT_DATA_WXYZ"; do
  read -ra options <<<"${refused##*:}"
  if c++ -std=c++20 -fsyntax-only -I "$folder/psygen/include/psygen" "${options[@]}" "$consumers/layout.cpp" \
    2>"$folder/log.txt"; then echo "${options[*]} is accepted"; exit 1; fi
  grep -q "psygen needs .*${refused%%:*}: compile without ${options[-1]#-D}" "$folder/log.txt" ||
    { cat "$folder/log.txt"; exit 1; }
done

# A program tells the revision of its own repository, and whether a file had changed.
cp -r "$consumers/revision" "$folder/revision"
game() { git -C "$folder/revision" -c user.name=test -c user.email=test@localhost "$@"; }
game init -q
game add .
game commit -q -m first
consumers="$folder" configure revision
for state in clean changed; do
  cmake --build "$folder/build/revision" >/dev/null
  told="$("$folder/build/revision/revision")"
  [ "$told" = "$(game rev-parse --short=12 HEAD) $state" ] || { echo "the program tells: $told"; exit 1; }
  echo "// changed" >>"$folder/revision/main.cpp"
done

configure .
cmake --build "$folder/build" >/dev/null
height="$(cd / && "$folder/build/consumer" "$folder/picture.png")"
[ -s "$folder/picture.png" ]
echo "ground height $height"
[[ "$height" =~ ^[0-9]+\.[0-9]{6}$ ]]
# Both find the modules that they load later in the installed folder.
for program in "$folder/build/consumer" "$folder/psygen/bin/psygen"; do
  readelf -d "$program" | grep -E '(RPATH|RUNPATH).*(ORIGIN/\.\.|psygen)/lib[^]]*/psygen' >/dev/null
done

mkdir "$folder/elsewhere" "$folder/bin"
mv "$folder/psygen" "$folder/elsewhere/moved here"
# A program that pkg-config builds against the moved package finds data and modules there, too. Shared libraries
# outside of the system's folders must be named to it.
packages="$(dirname "$(find "$folder/elsewhere" -name psygen-app.pc)")"
flags="$(PKG_CONFIG_PATH="$packages" pkg-config --cflags --libs psygen-app vulkan)"
eval "${CXX:-c++} -std=c++20 -g0 '$source/tests/tools/consumer/main.cpp' $flags -o '$folder/by_pkg_config'"
told="$(cd / && LD_LIBRARY_PATH="$(dirname "$packages")" "$folder/by_pkg_config" "$folder/by_pkg_config.png")"
[ "$told" = "$height" ]
cmp "$folder/picture.png" "$folder/by_pkg_config.png"
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
grep -q "moved here/share/psygen/worlds.*silver_combe, thorn_country, watershed; did you mean silver_combe?" "$folder/amplify.txt"
