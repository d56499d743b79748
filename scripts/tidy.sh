#!/usr/bin/env bash
# Usage: scripts/tidy.sh [FILE.cpp...]
#
# Reads the sources, all or those named, with clang-tidy as .clang-tidy says. Fails on any finding.
# Configures a folder of its own, build-tidy/, without precompiled headers, which are the compiler's.
set -euo pipefail
# shellcheck source-path=SCRIPTDIR source=lib.sh
. "$(dirname -- "${BASH_SOURCE[0]}")/lib.sh"

case "${1:-}" in -h | --help) help && exit 0 ;; esac
command -v clang-tidy >/dev/null || fail "clang-tidy is missing; run apt-get install clang-tidy"
cd "$project"
cmake --log-level=WARNING -G Ninja -S . -B build-tidy -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON >&2 ||
  fail "configuring failed; CMake's message is above"
# Shaders and embedded texts are headers that the sources include.
ninja -C build-tidy -t targets all | sed -n 's,^\(\(embedded\|spirv\)/.*\.h\): .*,\1,p' |
  xargs ninja -C build-tidy >&2 || fail "the shaders failed; the message is above"
if [ $# -eq 0 ]; then
  mapfile -t sources < <(find assetpipe cli core renderer server -name '*.cpp' 2>/dev/null | sort)
  set -- "${sources[@]}"
fi
printf '%s\0' "$@" | xargs -0 -n 1 -P "$(jobs)" clang-tidy -p build-tidy --quiet \
  --extra-arg=-Wno-unknown-warning-option --warnings-as-errors='*'
