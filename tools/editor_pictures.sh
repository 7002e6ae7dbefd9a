#!/usr/bin/env bash
# Takes the pictures of docs/editor.md on displays of their own: the window in the dark and the light
# theme at 1280 × 800 and 1920 × 1080, and each panel dark in the small and light in the large window.
# Some minutes.
#   tools/editor_pictures.sh [FOLDER]     default: docs/images/editor
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
editor=${PSYGEN_EDITOR:-build/release/bin/psygen-editor}
out=${1:-docs/images/editor}
mkdir -p "$out"
home=$(mktemp -d)
mkdir "$home/cache"
pids=()
finish() {
  for pid in "${pids[@]}"; do kill "$pid" 2>/dev/null || true; done
  rm -rf "$home"
}
trap finish EXIT

take() { # THEME WIDTHxHEIGHT DISPLAY [OPTION]
  local theme=$1 size=$2 screen=$3 folder=$home/$1-$2
  shift 3
  mkdir -p "$folder"/{config/psygen,state,run,screen}
  chmod 700 "$folder/run"
  printf '[General]\ntheme=%s\n' "$theme" >"$folder/config/psygen/psygen-editor.conf"
  Xvfb "$screen" -screen 0 "${size}x24" -fbdir "$folder/screen" >"$folder/xvfb.log" 2>&1 &
  pids+=($!)
  sleep 1
  DISPLAY=$screen openbox --sm-disable >"$folder/openbox.log" 2>&1 &
  pids+=($!)
  sleep 2
  DISPLAY=$screen QT_QPA_PLATFORM=xcb XDG_RUNTIME_DIR=$folder/run XDG_CONFIG_HOME=$folder/config \
    XDG_STATE_HOME=$folder/state XDG_CACHE_HOME=$home/cache "$editor" --pictures "$out" "$@" \
    game/worlds/silver_combe.toml
}

display=77
for size in 1280x800 1920x1080; do
  for theme in dark light; do
    case $theme-$size in
      dark-1280x800 | light-1920x1080) what=() ;;
      *) what=(--only-window) ;;
    esac
    take "$theme" "$size" ":$display" "${what[@]}"
    display=$((display + 1))
  done
done
du -ch "$out"/*.jpg | tail -n 1
