#!/usr/bin/env bash
# Usage: scripts/demo.sh [DIR]
#
# From nothing to a picture of a thousand differently dressed people, and a report of what the
# tagging saved. Installs the packages, builds, and then makes two people (config/people), or takes
# those in DIR: each subfolder (or DIR itself) with a template.glb and outfits/*.glb is a wardrobe.
# Leaves all it makes in out/: wardrobes/, scene.yaml, crowd.png, reports/.
set -euo pipefail
# shellcheck source-path=SCRIPTDIR source=lib.sh
. "$(dirname -- "${BASH_SOURCE[0]}")/lib.sh"

# findPeople DIR: fills `people` with the folders that hold a template.glb and outfits/*.glb.
findPeople() {
  local folder outfits
  people=()
  for folder in "$1" "$1"/*/; do
    folder=${folder%/}
    outfits=("$folder"/outfits/*.glb)
    if [ -f "$folder/template.glb" ] && [ -f "${outfits[0]}" ]; then people+=("$folder"); fi
  done
  [ ${#people[@]} -gt 0 ] ||
    fail "found no template.glb with outfits/*.glb beside it in $1 or its subfolders; see docs/wardrobe.md"
}

# step TEXT COMMAND...: says what is done, does it, and tells how long it took.
step() {
  local text=$1 start=$SECONDS
  shift
  say "$text"
  "$@"
  note "$text: $(duration $((SECONDS - start)))"
}

# keyOf FOLDER: a name for the wardrobe that a scene file takes as a key, not given before.
keyOf() {
  local base key number=2
  base=$(basename -- "$1" | LC_ALL=C tr -c 'A-Za-z0-9_\n' '_')
  key=$base
  while [ -e "$out/wardrobes/$key" ]; do key=${base}_$((number++)); done
  printf '%s\n' "$key"
}

# writeScene KEY...: config/scenes/demo.yaml, with these wardrobes in place of its own.
writeScene() {
  local key block="wardrobe:"
  for key in "$@"; do block+=$'\n'"  '$key': wardrobes/$key"; done
  BLOCK=$block awk '
    /^wardrobe:/ { print ENVIRON["BLOCK"]; inside = 1; next }
    inside && /^[^ \t#]/ { inside = 0 }
    !inside' "$project/config/scenes/demo.yaml" >"$out/scene.yaml"
}

# report KEY: the table, on standard output and beside its JSON and its page in out/reports/.
report() {
  "$ensemble" report "$out/wardrobes/$1" --json "$out/reports/$1.json" --html "$out/reports/$1.html" \
    --extrapolate 20 | tee "$out/reports/$1.txt"
}

case "${1:-}" in
  -h | --help) help && exit 0 ;;
  -*) usageError "unknown option '$1'" ;;
esac
[ $# -le 1 ] || usageError "takes one folder at most"
source_folder=""
if [ $# -eq 1 ]; then
  source_folder=$(cd -- "$1" 2>/dev/null && pwd -P) || fail "there is no folder '$1'"
  findPeople "$source_folder"
fi

ensemble=$project/build/ensemble
out=$project/out
start=$SECONDS
step "Building the program" "$project/scripts/build.sh"

rm -rf "$out/wardrobes" "$out/reports" "$out/scene.yaml" "$out/crowd.png"
mkdir -p "$out/wardrobes" "$out/reports"
if [ -z "$source_folder" ]; then
  rm -rf "$out/people"
  step "Making people" "$ensemble" people "$project/config/people/two.yaml" -o "$out/people"
  findPeople "$out/people"
fi
keys=()
for folder in "${people[@]}"; do
  key=$(keyOf "$folder")
  step "Tagging the outfits of $folder" \
    "$ensemble" tag "$folder/template.glb" "$folder"/outfits/*.glb -o "$out/wardrobes/$key"
  keys+=("$key")
done
writeScene "${keys[@]}"
step "Rendering a crowd of them" "$ensemble" render "$out/scene.yaml" -o "$out/crowd.png"
for key in "${keys[@]}"; do
  say "What the tagging saves: $key"
  report "$key"
done

say "Done in $(duration $((SECONDS - start)))."
echo "Picture: $out/crowd.png"
for key in "${keys[@]}"; do
  echo "Report:  $out/reports/$key.txt (page: $key.html, figures: $key.json)"
done
