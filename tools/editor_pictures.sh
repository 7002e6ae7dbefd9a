#!/usr/bin/env bash
# Takes the screenshots of docs/editor.md on virtual displays: the window in the dark and the light theme at
# 1280 × 800 and 1920 × 1080, and each panel, dark in the small window and light in the large one.
# Takes some minutes; build release first.
#   tools/editor_pictures.sh [FOLDER]     default: docs/images/editor
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
out=${1:-docs/images/editor}
mkdir -p "$out"
take() { build/release/bin/psygen_manual_pictures "$out" "$@"; }
take dark 1280x800
take dark 1280x800 rivers
take light 1280x800 window
take dark 1920x1080 window
take light 1920x1080
du -ch "$out"/*.jpg | tail -n 1
