#!/usr/bin/env bash
# Counts the instructions that one sweep costs in a short fixed run (one thread, callgrind), and compares them with
# benchmarks/instructions.txt: more than 3 % above fails. A count does not depend on what else the machine does.
#
#   scripts/instructions.sh          count and compare
#   scripts/instructions.sh --renew  count and write the figure
# shellcheck source-path=SCRIPTDIR
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

figure=benchmarks/instructions.txt
sweeps=20 # as in benchmarks/fixed_run.cpp
renew=false
case "${1-}" in
  '') ;;
  --renew) renew=true ;;
  *) die "unknown option '$1'; known: --renew" ;;
esac

scripts/setup.sh --bench
build_preset bench --target fixed_run
profile=build/bench/callgrind.fixed_run
valgrind --tool=callgrind --toggle-collect=rilo_measured_sweep --callgrind-out-file="$profile" \
  build/bench/benchmarks/studies/fixed_run 2>build/bench/callgrind.log || {
  cat build/bench/callgrind.log >&2
  die "the run failed"
}
total="$(sed -n 's/^\(summary\|totals\): \([0-9]*\).*/\2/p' "$profile" | head -n 1)"
[ "${total:-0}" -gt 0 ] || die "callgrind collected nothing: $profile"
now=$((total / sweeps))
echo "instructions a sweep: $now (callgrind_annotate $profile says where)"

if $renew; then
  {
    echo "# Instructions a sweep of benchmarks/fixed_run, written by scripts/instructions.sh --renew with"
    echo "# $(c++ --version | head -n 1)"
    echo "$now"
  } >"$figure"
  echo "written to $figure"
  exit 0
fi
before="$(grep -E '^[0-9]+$' "$figure" || true)"
[ -n "$before" ] || die "$figure has no figure; scripts/instructions.sh --renew writes it"
awk -v now="$now" -v before="$before" 'BEGIN { printf "committed: %d, now %+.2f %%\n", before, 100 * (now / before - 1) }'
[ $((100 * now)) -le $((103 * before)) ] || die "more than 3 % above $figure"
