#!/usr/bin/env bash
# Usage: scripts/contact_sheets.sh [-o FOLDER] [--occlusion KIND] [TEMPLATE.glb...]
#
# Dresses templates in every recipe of outfits/ and draws one contact sheet for each template: every outfit
# from the front and from behind, in the order of the recipes' names, eight a row. Without templates: the woman
# and the man of config/people/two.yaml, and those in ../shared/people where that folder is there. Writes
# contact_NAME.png, NAME being the template's folder; with fewer colours where ffmpeg is installed, so that it is small.
#
#   -o FOLDER         where to (default: docs/figures)
#   --occlusion KIND  as of `ensemble tag` (default: authored, complete bodies, so that what pokes through shows)
set -euo pipefail
# shellcheck source-path=SCRIPTDIR source=lib.sh
. "$(dirname -- "${BASH_SOURCE[0]}")/lib.sh"

folder=$project/docs/figures
occlusion=authored
templates=()
while [ $# -gt 0 ]; do
  case $1 in
    -h | --help) help; exit 0 ;;
    -o) optionValue "$1" $#; folder=$2; shift ;;
    --occlusion) optionValue "$1" $#; occlusion=$2; shift ;;
    -*) usageError "unknown option $1" ;;
    *) templates+=("$1") ;;
  esac
  shift
done
program=$project/build/ensemble
[ -x "$program" ] || fail "there is no $program; build it with scripts/build.sh"
recipes=("$project"/outfits/*.yaml)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$folder"

if [ ${#templates[@]} -eq 0 ]; then
  say "Making people"
  sed 's/outfits: .*/outfits: [cap]/' "$project/config/people/two.yaml" >"$work/two.yaml"  # dressed below
  "$program" people "$work/two.yaml" -o "$work/people"
  for template in "$work"/people/*/template.glb "$project"/../shared/people/*/template.glb; do
    [ ! -f "$template" ] || templates+=("$template")
  done
fi

# writeScene WARDROBE: people in rows above each other, each outfit twice.
writeScene() {
  cat <<EOF
version: 1
wardrobe: $1
output: {width: 1200, height: 900, samples: 4, background: [0.93, 0.94, 0.95]}
ground: false
crowd: {count: 0}
people:
EOF
  local number=0 recipe
  for recipe in "${recipes[@]}"; do
    awk -v i="$number" -v name="$(basename "$recipe" .yaml)" 'BEGIN {
      row = int(i / 8)
      for (k = 0; k < 2; ++k) {
        printf "  - {outfit: %s, clip: idle, speed: 0, tint: %d, heading: %d, position: [%.2f, %.2f, 0]}\n",
               name, 10 + i, k == 0 ? 22 : 202, (i % 8 * 2 + k - 7.5) * 0.72, (1.5 - row) * 2.05
      }
    }'
    number=$((number + 1))
  done
  cat <<EOF
camera: {position: [0, 0.9, 60], target: [0, 0.9, 0], fov_y: 8.1}
light: {direction: [-0.35, -0.6, -0.7], shadows: false}
EOF
}

# fewerColours FROM TO: 96 of them.
fewerColours() {
  if command -v ffmpeg >/dev/null; then
    ffmpeg -v error -y -i "$1" -vf \
      'split[a][b];[a]palettegen=max_colors=96:reserve_transparent=0[p];[b][p]paletteuse=dither=none' "$2"
  else
    cp "$1" "$2"
  fi
}

for template in "${templates[@]}"; do
  name=$(basename "$(dirname "$template")")
  say "Dressing $name"
  "$program" author "${recipes[@]}" --template "$template" -o "$work/$name" > /dev/null
  "$program" tag "$template" "$work/$name"/*.glb -o "$work/wardrobe_$name" --occlusion "$occlusion" -q
  writeScene "$work/wardrobe_$name" > "$work/$name.yaml"
  "$program" render "$work/$name.yaml" -o "$work/contact_$name.png"
  fewerColours "$work/contact_$name.png" "$folder/contact_$name.png"
done
