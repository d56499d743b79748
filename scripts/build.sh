#!/usr/bin/env bash
# Usage: scripts/build.sh [--werror] [--tests] [--sanitize LIST] [--jobs N]
#
# Installs the packages and builds the program: build/ensemble, a release build.
#   --werror         warnings are errors
#   --tests          build the tests too
#   --sanitize LIST  with sanitizers, e.g. address,undefined, in a folder of its own: build-LIST/
#                    (build-address-undefined/ensemble)
#   --jobs N         compilers at once; default: one a core, as far as the memory goes
set -euo pipefail
# shellcheck source-path=SCRIPTDIR source=lib.sh
. "$(dirname -- "${BASH_SOURCE[0]}")/lib.sh"

werror=OFF tests=OFF sanitize="" job_count=$(jobs)
while [ $# -gt 0 ]; do
  case "$1" in
    --werror) werror=ON ;;
    --tests) tests=ON ;;
    --sanitize) optionValue "$1" $# && sanitize=$2 && shift ;;
    --jobs) optionValue "$1" $# && job_count=$2 && shift ;;
    -h | --help) help && exit 0 ;;
    *) usageError "unknown option '$1'" ;;
  esac
  shift
done
[[ $job_count =~ ^[1-9][0-9]*$ ]] || usageError "--jobs takes a number from 1, not '$job_count'"
[[ $sanitize =~ ^[a-z,-]*$ ]] || usageError "--sanitize takes names with commas between, not '$sanitize'"

"$project/scripts/install_packages.sh" build

build=$project/build
type=Release
if [ -n "$sanitize" ]; then
  build=$project/build-${sanitize//,/-}
  type=RelWithDebInfo
fi
options=(
  -G Ninja "-DCMAKE_BUILD_TYPE=$type" "-DENSEMBLE_WERROR=$werror" "-DENSEMBLE_TESTS=$tests"
  "-DENSEMBLE_SANITIZE=$sanitize"
)
# A cache from another place or generator (a clone that was moved or copied) is of no use.
cache=$build/CMakeCache.txt
if [ -f "$cache" ] && ! { grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$project" "$cache" &&
  grep -qxF "CMAKE_GENERATOR:INTERNAL=Ninja" "$cache"; }; then
  options+=(--fresh)
fi

say "Building $build/ensemble ($type, $job_count at once)"
cmake --log-level=WARNING -S "$project" -B "$build" "${options[@]}" >&2 || fail "configuring failed; CMake's message is above"
ninja -C "$build" -j "$job_count" >&2 || fail "the build failed; the compiler's message is above"
note "Done: $build/ensemble"
