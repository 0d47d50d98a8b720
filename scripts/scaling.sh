#!/usr/bin/env bash
# Measures how time and memory grow with points, map radius, threads, speed and number of sweeps: CSV and SVG plots.
#
#   scripts/scaling.sh OUT [STUDY…]   studies: points map threads speed memory; all when none is named
# shellcheck source-path=SCRIPTDIR
caller="$PWD"
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

case "${1-}" in
  '' | -*) print_help; exit 2 ;;
esac
out="$1"
shift
[[ "$out" = /* ]] || out="$caller/$out"
studies=("$@")
[ $# -gt 0 ] || studies=(points map threads speed memory)

scripts/setup.sh
build_preset bench --target scaling
mkdir -p "$out"
for study in "${studies[@]}"; do
  echo "== $study"
  # Under another name until it is whole.
  build/bench/benchmarks/studies/scaling --study "$study" >"$out/.$study.csv"
  mv "$out/.$study.csv" "$out/$study.csv"
  cat "$out/$study.csv"
  python3 scripts/plot_scaling.py "$out/$study.csv"
done
