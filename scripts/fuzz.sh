#!/usr/bin/env bash
# Fuzzes the parsers with libFuzzer, AddressSanitizer and UBSan, one after the other; any finding ends the script and
# leaves the input in out/fuzz/NAME-*. What is found on the way stays in out/fuzz/corpus/NAME.
#
#   scripts/fuzz.sh                 a minute for each parser
#   scripts/fuzz.sh 600             ten minutes for each
#   scripts/fuzz.sh 600 mcap pcap   these alone
# shellcheck source-path=SCRIPTDIR
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

case "${1:-60}" in
  *[!0-9]* | '') print_help; exit 2 ;;
esac
seconds="${1:-60}"
shift || true

scripts/setup.sh --clang
build_preset fuzz
programs=build/fuzz/fuzz
found="$PWD/out/fuzz"
mkdir -p "$found"
"$programs/fuzz_seeds" "$found/seeds"

names=("$@")
if [ ${#names[@]} -eq 0 ]; then
  for program in "$programs"/fuzz_*; do
    case "${program##*/}" in
      fuzz_seeds | *.*) ;;
      *) names+=("${program##*/fuzz_}") ;;
    esac
  done
fi

# A chunk may unpack to what a small input can hold packed: hence the room.
options=(-max_total_time="$seconds" -max_len=16384 -timeout=20 -rss_limit_mb=2560 -print_final_stats=1 -verbosity=0)
for name in "${names[@]}"; do
  [ -x "$programs/fuzz_$name" ] || die "no harness '$name' in fuzz/"
  mkdir -p "$found/corpus/$name"
  kept=()
  [ ! -d "fuzz/corpus/$name" ] || kept=("fuzz/corpus/$name")
  echo "fuzz: $name, $seconds s"
  "$programs/fuzz_$name" "${options[@]}" -artifact_prefix="$found/$name-" "$found/corpus/$name" "${kept[@]}" \
    "$found/seeds/$name" >"$found/$name.log" 2>&1 || {
    tail -n 40 "$found/$name.log" >&2
    die "$name failed; its log is $found/$name.log"
  }
  grep -E 'number_of_executed_units|average_exec_per_sec|peak_rss_mb' "$found/$name.log"
done
echo "fuzz: nothing found"
