#!/usr/bin/env bash
# Usage: scripts/install_packages.sh [build|test|peers]...
#
# Installs the Debian 12 packages that the project needs. This is the one list of them.
#   build  what compiles and runs `ensemble` (default)
#   test   what the tests and proofs use beyond that
#   peers  what bench/peers measures us against
#
# Asks apt for what is missing and does nothing, without network, where all is there. Runs as root
# or through sudo, and never asks a question but sudo's own for a password.
set -euo pipefail
# shellcheck source-path=SCRIPTDIR source=lib.sh
. "$(dirname -- "${BASH_SOURCE[0]}")/lib.sh"

# Compiler and tools, then Vulkan (with lavapipe, the software driver), then libraries.
build_packages=(
  build-essential cmake ninja-build pkg-config ccache
  libvulkan-dev mesa-vulkan-drivers glslang-tools
  libavcodec-dev libavformat-dev libavutil-dev libcgal-dev libcli11-dev libdraco-dev libembree-dev libfmt-dev libglm-dev
  libjpeg62-turbo-dev libmeshoptimizer-dev libopenexr-dev libpng-dev libspdlog-dev libssl-dev
  libswscale-dev libtinygltf-dev libvalijson-dev libyaml-cpp-dev nlohmann-json3-dev
  python3
)
# GoogleTest, the validation layers, and what the proofs ask for a second opinion: Blender, and the
# Khronos glTF validator and Draco's own encoder, which come through npm.
test_packages=(
  libgtest-dev libgmock-dev vulkan-validationlayers clang-format blender python3-numpy
  nodejs npm
)
# OGRE, an X server without a screen, and a browser with three.js, which comes through npm.
peers_packages=(
  libogre-1.12-dev libopengl-dev libgl-dev xvfb xauth chromium nodejs npm python3-numpy python3-pil libmeshoptimizer-dev
)

case "${1:-}" in -h | --help) help && exit 0 ;; esac
wanted=()
[ $# -gt 0 ] || set -- build
for set_name in "$@"; do
  case "$set_name" in
    build) wanted+=("${build_packages[@]}") ;;
    test) wanted+=("${test_packages[@]}") ;;
    peers) wanted+=("${peers_packages[@]}") ;;
    *) usageError "there is no set of packages '$set_name', only build, test and peers" ;;
  esac
done

# isThere PACKAGE: installed, or for Node.js and npm a program of that name from elsewhere (other
# vendors' Node.js brings its own npm, and Debian's would clash with it).
installed=$(dpkg-query -W -f='${Package} ${db:Status-Status}\n' "${wanted[@]}" 2>/dev/null || true)
isThere() {
  case "$1" in nodejs) command -v node >/dev/null && return ;; npm) command -v npm >/dev/null && return ;; esac
  grep -qxF "$1 installed" <<<"$installed"
}
missing=()
for package in "${wanted[@]}"; do
  isThere "$package" || missing+=("$package")
done
if [ ${#missing[@]} -eq 0 ]; then
  note "All ${#wanted[@]} packages ($*) are installed."
  exit 0
fi

# Packages are missing: this takes Debian, and rights.
# shellcheck source=/dev/null
system=$(. /etc/os-release 2>/dev/null && echo "${ID:-unknown} ${VERSION_ID:-}") || system=unknown
case "$system" in
  "debian 12") ;;
  debian*) note "Written for Debian 12, and this is $system: going on, but names may differ." ;;
  *) fail "this is no Debian ($system); install what stands for these Debian 12 packages: ${missing[*]}" ;;
esac
command -v apt-get >/dev/null || fail "apt-get is missing; install these packages by hand: ${missing[*]}"
as_root=(env DEBIAN_FRONTEND=noninteractive)
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null ||
    fail "neither root nor sudo; as root, run: apt-get install ${missing[*]}"
  as_root=(sudo "${as_root[@]}")
  # Without a terminal sudo could not ask: let it fail at once.
  [ -t 0 ] || as_root=(sudo -n "${as_root[@]:1}")
  "${as_root[@]}" true || fail "sudo refused; as root, run: apt-get install ${missing[*]}"
fi

apt=("${as_root[@]}" apt-get -q -y -o DPkg::Lock::Timeout=600 -o Acquire::Retries=3 -o Dpkg::Use-Pty=0)
say "Installing ${#missing[@]} Debian packages: ${missing[*]}"
# Another source that can't be reached is no reason to stop: the install tells what is really missing.
"${apt[@]}" update >&2 || note "apt-get update failed; trying with the package lists that are there."
"${apt[@]}" install --no-install-recommends "${missing[@]}" >&2 ||
  fail "apt-get could not install all of: ${missing[*]}; its message is above"
