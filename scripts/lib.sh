# shellcheck shell=bash
# What the scripts of this folder share; sourced, never run. Sets `project` to the project's folder.

# shellcheck disable=SC2034
project=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." && pwd -P)

# say TEXT...: a headline of what happens now. On standard error, as every message of the scripts.
say() { printf '\n== %s\n' "$*" >&2; }

# note TEXT...: a detail.
note() { printf '   %s\n' "$*" >&2; }

# fail TEXT...: one clear line that tells how to mend, and the end.
fail() {
  printf '%s: %s\n' "$(basename -- "$0")" "$*" >&2
  exit 1
}

# usageError TEXT...: the same for a wrong command line.
usageError() {
  printf '%s: %s; see --help\n' "$(basename -- "$0")" "$*" >&2
  exit 2
}

# help: prints the comment block at the top of the script, which is its manual.
help() { sed -n '2,/^[^#]/{s/^# \{0,1\}//p}' "$0"; }

# optionValue OPTION COUNT: refuses an option at the end of the line that lacks its value.
optionValue() { [ "$2" -ge 2 ] || usageError "$1 needs a value"; }

# jobs: how many compilers at once: one a core, and no more than the free memory carries (1.5 GiB each).
jobs() {
  local cores free_kib by_memory
  cores=$(nproc)
  free_kib=$(awk '/^MemAvailable:/ {print $2}' /proc/meminfo 2>/dev/null || true)
  by_memory=$((${free_kib:-0} / 1572864))
  [ -n "$free_kib" ] || by_memory=$cores
  [ "$by_memory" -ge 1 ] || by_memory=1
  echo $((cores < by_memory ? cores : by_memory))
}

# duration SECONDS: "1 min 05 s".
duration() {
  if [ "$1" -ge 60 ]; then
    printf '%d min %02d s' $(($1 / 60)) $(($1 % 60))
  else
    printf '%d s' "$1"
  fi
}
