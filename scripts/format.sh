#!/usr/bin/env bash
# Usage: scripts/format.sh [--check]
#
# Formats the project's C++ with clang-format as .clang-format says.
#   --check  change nothing; name the files that are not formatted, and fail
set -euo pipefail
# shellcheck source-path=SCRIPTDIR source=lib.sh
. "$(dirname -- "${BASH_SOURCE[0]}")/lib.sh"

mode=(-i)
while [ $# -gt 0 ]; do
  case "$1" in
    --check) mode=(--dry-run --Werror) ;;
    -h | --help) help && exit 0 ;;
    *) usageError "unknown option '$1'" ;;
  esac
  shift
done
command -v clang-format >/dev/null || fail "clang-format is missing; run scripts/install_packages.sh test"

cd "$project"
mapfile -d '' files < <(find assetpipe bench cli core renderer server shaders/shared tests \
  \( -name '*.cpp' -o -name '*.h' \) -print0 2>/dev/null | sort -z)
[ ${#files[@]} -gt 0 ] || fail "found no C++ in $project"
clang-format "${mode[@]}" "${files[@]}"
note "${#files[@]} files: formatted."
