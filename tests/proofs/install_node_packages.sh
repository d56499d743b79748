#!/usr/bin/env bash
# Usage: tests/proofs/install_node_packages.sh FOLDER
#
# Puts the npm packages of package-lock.json, checked against its hashes, into FOLDER/node_modules.
# Without network it says so and ends well: the proofs that need them skip and say why.
set -euo pipefail
# shellcheck source-path=SCRIPTDIR/../../scripts source=lib.sh
. "$(dirname -- "${BASH_SOURCE[0]}")/../../scripts/lib.sh"

case "${1:-}" in -h | --help) help && exit 0 ;; esac
[ $# -eq 1 ] || usageError "name the folder"
folder=$1
mkdir -p "$folder"
if cmp -s "$project/tests/proofs/package-lock.json" "$folder/node_modules/.installed-lock"; then
  note "The npm packages of the proofs are installed."
  exit 0
fi
say "Installing the npm packages of the proofs into $folder"
cp "$project"/tests/proofs/package.json "$project"/tests/proofs/package-lock.json "$folder/"
if (cd "$folder" && npm ci --ignore-scripts --no-audit --no-fund >&2); then
  cp "$folder/package-lock.json" "$folder/node_modules/.installed-lock"
else
  note "npm could not install them (its message is above): the proofs that need them will be skipped."
fi
