#!/usr/bin/env bash
# Draws everything under the newest Vulkan validation layer, with synchronisation validation and best practices, and fails
# on any message. Takes a minute on two cores; build release first.
#   tools/validation.sh
# PSYGEN_LAYER: the layer's library, 1.4 or newer (default: that of chromium, which follows every release).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

library="${PSYGEN_LAYER:-/usr/lib/chromium/libVkLayer_khronos_validation.so}"
[ -e "$library" ] || { echo "$library is missing; install chromium" >&2; exit 1; }

work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
cat >"$work/layer.json" <<JSON
{"file_format_version": "1.1.0", "layer": {"name": "VK_LAYER_KHRONOS_validation", "type": "GLOBAL",
 "library_path": "$library", "api_version": "1.4.0", "implementation_version": "1", "description": "validation",
 "instance_extensions": [{"name": "VK_EXT_debug_utils", "spec_version": "1"},
                         {"name": "VK_EXT_validation_features", "spec_version": "2"}]}}
JSON
cat >"$work/vk_layer_settings.txt" <<SETTINGS
khronos_validation.validate_sync = true
khronos_validation.validate_best_practices = true
khronos_validation.report_flags = error,warn,perf
khronos_validation.debug_action = VK_DBG_LAYER_ACTION_LOG_MSG
khronos_validation.log_filename = $work/messages
SETTINGS
export VK_LAYER_PATH="$work" VK_LAYER_SETTINGS_PATH="$work/vk_layer_settings.txt"

failed=0
check() { # NAME COMMAND...
  local name="$1" code=0
  shift
  : >"$work/messages"
  "$@" >"$work/output" 2>&1 || code=$?
  [ $code = 0 ] || { echo "$name: exit code $code" && tail -n 5 "$work/output"; }
  # Each kind of message once: its first line names it, and the second describes it.
  awk -v name="$name" '/^Validation/ {new = !seen[$0]++} NF && new {print name ": " $0}' "$work/messages"
  [ $code = 0 ] && [ ! -s "$work/messages" ] || failed=1
}

bin=build/release/bin
echo "validation by $library"
check devices $bin/psygen devices
# One test of each feature, on both paths, with draws pushed and in a buffer, and with light per vertex and per pixel.
tests='GpuCullingTest.ShowsThePictures*:StagedGeometryTest.CopiesMore*'
for way in 0 1 5; do
  tests+=":*/Objects.SurviveEveryView*/$way:*/Particles.OfManyEmitters*/$way:*/PointLights.SurviveAChange*/$way"
  tests+=":*/Resolutions.FollowTheSize*/$way"
done
check tests $bin/psygen_test_render --gtest_filter="$tests"
for preset in low high; do
  for path in cpu gpu; do
    for way in "--path walk27" "--world watershed"; do
      # shellcheck disable=SC2086
      check "flight, $way, preset $preset, path $path" $bin/psygen fly --headless $way --frames 20 --fixed-step 10 \
        --size 320x180 --preset $preset --render-path $path --validation --out "$work/out"
    done
  done
done
Xvfb -displayfd 1 -screen 0 640x480x24 >"$work/display" 2>/dev/null &
xvfb=$!
until [ -s "$work/display" ] || ! kill -0 $xvfb 2>/dev/null; do sleep 0.1; done
check "game in a window" env DISPLAY=":$(cat "$work/display")" $bin/psygen-game --folder "$work/game" --seed 1 --autoplay 4 \
  --width 320 --height 180 --validation --no-sound
kill $xvfb 2>/dev/null || true
[ $failed = 0 ] && echo "no messages"
exit $failed
