#!/usr/bin/env bash
# Usage: scripts/test.sh [--full] [--werror] [--sanitize LIST] [--jobs N]
#
# Installs the packages of build and tests, builds with tests and runs them all: unit tests, and the
# proofs that hold the program's files against other people's programs (tests/proofs/). What can't
# run here is skipped and named. The last line is `N passed, N failed, N skipped`.
#   --full           with the long proofs, then the unit tests again under ASan and UBSan
#   --werror         warnings are errors
#   --sanitize LIST  the unit tests alone, with these sanitizers (see build.sh)
#   --jobs N         compilers at once (see build.sh)
set -euo pipefail
# shellcheck source-path=SCRIPTDIR source=lib.sh
. "$(dirname -- "${BASH_SOURCE[0]}")/lib.sh"

full=no sanitize="" build_options=(--tests)
while [ $# -gt 0 ]; do
  case "$1" in
    --full) full=yes ;;
    --werror) build_options+=(--werror) ;;
    --sanitize) optionValue "$1" $# && sanitize=$2 && shift ;;
    --jobs) optionValue "$1" $# && build_options+=(--jobs "$2") && shift ;;
    -h | --help) help && exit 0 ;;
    *) usageError "unknown option '$1'" ;;
  esac
  shift
done

passed=0 failed=0 skipped=0

# runTests FOLDER CTEST_OPTION...: runs the tests built in FOLDER and adds up what they say.
runTests() {
  local build=$1 results=$1/test-results.xml counts p f s
  shift
  rm -f "$results"
  # A failed test is counted below; a ctest that wrote no results at all is an error.
  ctest --test-dir "$build" -j 2 --output-on-failure --no-tests=error --output-junit "$results" "$@" || true
  [ -s "$results" ] || fail "ctest left no results in $results; its message is above"
  counts=$(python3 "$project/scripts/test_summary.py" "$results")
  read -r p f s <<<"$counts"
  passed=$((passed + p)) failed=$((failed + f)) skipped=$((skipped + s))
}

"$project/scripts/install_packages.sh" build test
if [ -n "$sanitize" ]; then
  "$project/scripts/build.sh" "${build_options[@]}" --sanitize "$sanitize"
  runTests "$project/build-${sanitize//,/-}" -LE 'proof|full|lint'
else
  "$project/scripts/build.sh" "${build_options[@]}"
  "$project/tests/proofs/install_node_packages.sh" "$project/build/proofs"
  if [ $full = yes ]; then
    ENSEMBLE_FULL_TESTS=1 runTests "$project/build"
    "$project/scripts/build.sh" "${build_options[@]}" --sanitize address,undefined
    runTests "$project/build-address-undefined" -LE 'proof|full|lint'
  else
    runTests "$project/build" -LE full
  fi
fi
echo "$passed passed, $failed failed, $skipped skipped"
[ "$failed" -eq 0 ] && [ "$passed" -gt 0 ]
