#!/usr/bin/env bash
# Renders all shipped worlds in all presets, side by side on a page, to show the effect of a change of
# rendering. Takes some minutes; build release first.
#   tools/contact_sheet.sh [FOLDER [SIZE]]     default: out/contact_sheet, 480x270
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
out="${1:-out/contact_sheet}" size="${2:-480x270}"
psygen="${PSYGEN:-build/release/bin/psygen}"
presets=(low medium high ultra)
# World, position, height, yaw and pitch of the camera.
views=("silver_combe -2790,1884 26 258 -8"
       "lakes -1700,-1800 26 250 -7"
       "ember_pass -700,0 35 300 -7"
       "thorn_country 31,31 12 40 -4"
       "frost_isle -700,0 35 310 -7"
       "five_species 16128,16128 9 120 -8"
       "paper 16128,16128 9 0 -3"
       "endless 0,0 12 60 -4")

mkdir -p "$out"
page="$out/index.html"
{
  echo '<!DOCTYPE html><meta charset="utf-8"><title>psygen: worlds and presets</title>'
  echo '<style>body { font: 14px sans-serif; background: #222; color: #eee; } img { width: 100%; display: block; }'
  echo 'table { width: 100%; border-spacing: 4px; } th { font-weight: normal; }</style><table>'
  echo "<tr><th>$(printf '<th>%s' "${presets[@]}")"
} >"$page"
for view in "${views[@]}"; do
  read -r world at height yaw pitch <<<"$view"
  echo "<tr><th>$world" >>"$page"
  for preset in "${presets[@]}"; do
    "$psygen" picture --world "$world" --at="$at" --height "$height" --yaw "$yaw" --pitch="$pitch" \
      --preset "$preset" --size "$size" --error 2 --out "$out/${world}_$preset.png" 2>/dev/null ||
      { echo "no image of $world in preset $preset" >&2; exit 1; }
    echo "<td><img src=\"${world}_$preset.png\" alt=\"$world, $preset\">" >>"$page"
  done
done
echo '</table>' >>"$page"
echo "$page"
