#!/usr/bin/env bash
# Usage: scripts/tidy.sh [FILE.cpp...]
#
# Reads the sources, all or those named, with clang-tidy as .clang-tidy says. Needs a build folder
# (scripts/build.sh) for the compile commands. Fails on any finding.
set -euo pipefail
# shellcheck source-path=SCRIPTDIR source=lib.sh
. "$(dirname -- "${BASH_SOURCE[0]}")/lib.sh"

case "${1:-}" in -h | --help) help && exit 0 ;; esac
command -v clang-tidy >/dev/null || fail "clang-tidy is missing; run apt-get install clang-tidy"
[ -f "$project/build/compile_commands.json" ] || fail "there is no build/; run scripts/build.sh --tests first"
cd "$project"
if [ $# -eq 0 ]; then
  mapfile -t sources < <(find assetpipe cli core renderer server -name '*.cpp' 2>/dev/null | sort)
  set -- "${sources[@]}"
fi
printf '%s\0' "$@" | xargs -0 -n 1 -P "$(jobs)" clang-tidy -p build --quiet --warnings-as-errors='*'
