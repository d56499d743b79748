#!/usr/bin/env bash
# Usage: scripts/demo.sh [--full] [--occlusion KIND] [DIR]
#
# From nothing to a picture of a thousand differently dressed people, and a report of what the
# tagging saved. Installs the packages, builds, and then makes a woman and a man with eleven items each
# (config/people/two.yaml), or takes the people in DIR: each subfolder (or DIR itself) with a template.glb and
# outfits/*.glb is a wardrobe. Leaves all it makes in out/: people/, wardrobes/, street.glb,
# scene.yaml, crowd.png, reports/.
#
#   --full            eight people of all ages and builds (config/people/*.yaml), each with every recipe
#                     of outfits/; an hour and more on two cores, most of it to find what layers hide
#   --occlusion KIND  as of `ensemble tag` (default: auto for people made here, whose bodies are complete;
#                     authored for those in DIR)
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

# writeScene KEY...: the scene, with these wardrobes in place of its own, and the street made here.
writeScene() {
  local key block="wardrobe:"
  for key in "$@"; do block+=$'\n'"  '$key': wardrobes/$key"; done
  BLOCK=$block awk '
    /^wardrobe:/ { print ENVIRON["BLOCK"]; inside = 1; next }
    inside && /^[^ \t#]/ { inside = 0 }
    /^environment:/ { print "environment: street.glb"; next }
    !inside' "$scene" >"$out/scene.yaml"
}

# makeStreet: more people, all in every recipe, and the scene of them.
makeStreet() {
  local template
  scene=$project/config/scenes/street.yaml
  step "Making more people" "$ensemble" people "$project/config/people/street.yaml" -o "$out/people"
  for template in "$out"/people/*/template.glb; do
    step "Dressing $template" "$ensemble" author "$project"/outfits/*.yaml --template "$template" \
      -o "$(dirname -- "$template")/outfits" -q
  done
}

# report KEY: the table, on standard output and beside its JSON and its page in out/reports/.
report() {
  "$ensemble" report "$out/wardrobes/$1" --json "$out/reports/$1.json" --html "$out/reports/$1.html" \
    --extrapolate 20 | tee "$out/reports/$1.txt"
}

full="" occlusion="" source_folder=""
while [ $# -gt 0 ]; do
  case $1 in
    -h | --help) help && exit 0 ;;
    --full) full=yes ;;
    --occlusion) optionValue "$1" $#; occlusion=$2; shift ;;
    -*) usageError "unknown option '$1'" ;;
    *)
      [ -z "$source_folder" ] || usageError "takes one folder at most"
      source_folder=$(cd -- "$1" 2>/dev/null && pwd -P) || fail "there is no folder '$1'"
      ;;
  esac
  shift
done
scene=$project/config/scenes/demo.yaml
if [ -n "$source_folder" ]; then
  [ -z "$full" ] || usageError "--full makes people of its own; give it no folder"
  findPeople "$source_folder"
fi

ensemble=$project/build/ensemble
out=$project/out
start=$SECONDS
step "Building the program" "$project/scripts/build.sh"

rm -rf "$out/wardrobes" "$out/reports" "$out/scene.yaml" "$out/crowd.png"
mkdir -p "$out/wardrobes" "$out/reports"
if [ -z "$source_folder" ]; then
  occlusion=${occlusion:-auto}
  rm -rf "$out/people"
  step "Making people" "$ensemble" people "$project/config/people/two.yaml" -o "$out/people"
  if [ -n "$full" ]; then makeStreet; fi
  findPeople "$out/people"
fi
keys=()
for folder in "${people[@]}"; do
  key=$(keyOf "$folder")
  step "Tagging the outfits of $folder" \
    "$ensemble" tag "$folder/template.glb" "$folder"/outfits/*.glb -o "$out/wardrobes/$key" \
    --occlusion "${occlusion:-authored}"
  keys+=("$key")
done
python3 "$project/scripts/make_street.py" "$out/street.glb"
writeScene "${keys[@]}"
step "Rendering a crowd of them" "$ensemble" render "$out/scene.yaml" -o "$out/crowd.png"
say "What the crowd wears"
"$ensemble" report "$out/scene.yaml" --json "$out/reports/crowd.json" | tee "$out/reports/crowd.txt"
for key in "${keys[@]}"; do
  say "What the tagging saves: $key"
  report "$key"
done

say "Done in $(duration $((SECONDS - start)))."
echo "Picture: $out/crowd.png"
echo "Crowd:   $out/reports/crowd.txt (figures: crowd.json)"
for key in "${keys[@]}"; do
  echo "Report:  $out/reports/$key.txt (page: $key.html, figures: $key.json)"
done
