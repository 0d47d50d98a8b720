#!/usr/bin/env bash
# Format, clang-tidy (warnings are errors), the direction of includes, links of the documents, and paths of a developer's
# machine.
# With files as arguments: clang-format and clang-tidy on these alone.
# shellcheck source-path=SCRIPTDIR
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

scripts/setup.sh --lint
failed=()

mkdir -p build
if [ $# -gt 0 ]; then
  printf '%s\0' "$@" >build/.lint-files
else
  print_sources0 >build/.lint-files
fi

echo "lint: clang-format"
xargs -0 clang-format --dry-run -Werror --style=file <build/.lint-files || failed+=("clang-format (scripts/format.sh)")

echo "lint: clang-tidy"
# Most of its time goes into the headers, so that sixteen sources are read together (a unity build), unless some are
# named.
if [ $# -gt 0 ]; then
  cmake --preset lint --log-level=WARNING -DCMAKE_UNITY_BUILD=OFF >/dev/null
  grep -z '\.cpp$' build/.lint-files | grep -zv '^tests/consumer/' >build/.tidy-files || true
else
  cmake --preset lint --log-level=WARNING >/dev/null
  # In the reverse of the order in which they are built: a source that only compiles after another one is found.
  find build/lint/src build/lint/apps -path '*/Unity/*.cxx' | while read -r unity; do
    tac "$unity" >build/.reversed
    mv build/.reversed "$unity"
  done
  sed -n 's/^ *"file": "\(.*\)".*/\1/p' build/lint/compile_commands.json | tr '\n' '\0' >build/.tidy-files
fi
clang_tidy=build/lint-tools/bin/clang-tidy
[ -x "$clang_tidy" ] || clang_tidy=clang-tidy
# Headers are seen through their users. The compile commands are GCC's: Clang knows not all of its warnings, and takes
# what the C++ library itself still uses for deprecated.
tidy() {
  xargs -0 -r -n 1 -P "$JOBS" "$clang_tidy" --quiet -p build/lint --header-filter="^$PWD/" \
    --checks=-bugprone-suspicious-include --extra-arg=-Wno-unknown-warning-option \
    --extra-arg=-Wno-deprecated-declarations <build/.tidy-files
}
tidy 2>build/.lint-errors || {
  grep -v 'warnings generated\|^Suppressed\|^Use -header-filter' build/.lint-errors >&2 || true
  failed+=("clang-tidy")
}

if [ $# -eq 0 ]; then
  echo "lint: includes, scripts, documents and paths"
  scripts/check_includes.py || failed+=("includes")
  shellcheck --external-sources scripts/*.sh .ci/run || failed+=("shellcheck")
  scripts/check_links.sh || failed+=("links")
  # A path into somebody's home works on one machine only; the temporary folder comes from the system, never by name.
  paths='(^|[^A-Za-z0-9_.~/-])/(root|home|work|tmp|mnt|Users)/[A-Za-z0-9_.]'
  ! grep -rnIE "$paths" . --exclude-dir=.git --exclude-dir=build --exclude-dir=out --exclude-dir=results ||
    failed+=("machine paths")
fi

[ ${#failed[@]} -eq 0 ] || die "failed: $(printf '%s; ' "${failed[@]}")"
echo "lint: clean"
