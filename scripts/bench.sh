#!/usr/bin/env bash
# Builds the benchmark programs and runs them all. Arguments go to each: scripts/bench.sh --benchmark_filter=Icp
# shellcheck source-path=SCRIPTDIR
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

scripts/setup.sh
build_preset bench
for program in build/bench/benchmarks/*; do
  if [ -f "$program" ] && [ -x "$program" ]; then
    echo "== ${program##*/}"
    "$program" "$@"
  fi
done
