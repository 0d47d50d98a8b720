# Sourced by every script here: strict mode, the project's root as working folder, --help, and the number of parallel jobs.
# shellcheck shell=bash
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# A compile of one of our files takes up to 1 GB: RILO_JOBS=1 suits a small machine.
JOBS="${RILO_JOBS:-$(nproc)}"

# Prints the comment at the top of the script.
print_help() {
  sed -n '2,/^# shellcheck/s/^# \{0,1\}//p' "scripts/${0##*/}" | grep -v '^shellcheck'
}

# Prints to stderr and stops.
die() {
  echo "${0##*/}: $*" >&2
  exit 1
}

case "${1-}" in
  -h | --help) print_help && exit 0 ;;
esac

# print_sources0: our C++ files, NUL-separated.
print_sources0() {
  find src include apps tests examples benchmarks fuzz python ros1 ros2 -type f \( -name '*.cpp' -o -name '*.hpp' \) -print0 | sort -z
}

# build_preset PRESET [cmake --build arguments]: configures and builds, quietly when nothing is wrong.
build_preset() {
  local preset="$1"
  shift
  cmake --preset "$preset" --log-level=WARNING >/dev/null
  cmake --build --preset "$preset" --parallel "$JOBS" "$@"
}
