#!/usr/bin/env bash
# Our default configuration on a folder of drives, beside other programs: ratios of drift, drive by drive.
#
# usage: scripts/compare.sh [--plan FILE | --all] DRIVES PEERS [options of rilo bench]
#
# DRIVES   a folder of folders that `rilo run` opens
# PEERS    figures (CSV: drive,peer,t_rel_pct,...), or a folder with their poses, PEERS/DRIVE/NAME.txt; beside poses a
#          file PEERS/figures.csv, if there is one, gives the times
# --plan   the drives and their groups; default: experiments/panel.yaml
# --all    every folder in DRIVES in the plan's place
#
# RILO names the program; by default this tree's release is built. Results: --out FOLDER, see docs/bench.md.
# shellcheck source-path=SCRIPTDIR
caller="$PWD"
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
root="$PWD"

usage() {
  print_help >&2
  exit 2
}

plan="$root/experiments/panel.yaml"
all=false
while [[ "${1:-}" == --* ]]; do
  case "$1" in
    --plan) plan="$(cd "$caller" && realpath -- "${2:?}")" && shift ;;
    --all) all=true ;;
    *) usage ;;
  esac
  shift
done
[ $# -ge 2 ] || usage
cd "$caller"
drives="$1" peers="$2"
shift 2
[ -d "$drives" ] || die "$drives: no folder; expected one with a folder a drive"
[ -e "$peers" ] || die "$peers: no such file; expected a CSV with figures, or a folder with poses"

options=()
if $all; then
  data=()
  for drive in "$drives"/*/; do data+=("${drive%/}"); done
  options+=(--data "${data[@]}")
else
  options+=(--root "$drives")
fi

if [ -d "$peers" ]; then
  while IFS= read -r name; do
    options+=(--peer "$name=$peers/{sequence}/$name.txt")
  done < <(find "$peers" -mindepth 2 -maxdepth 2 -name '*.txt' -printf '%f\n' | sed 's/\.txt$//' | sort -u)
  [ ! -f "$peers/figures.csv" ] || options+=(--peer-figures "$peers/figures.csv")
else
  options+=(--peer-figures "$peers")
fi

if [ -z "${RILO:-}" ]; then
  (cd "$root" && build_preset release --target rilo_cli >&2)
  RILO="$root/build/release/rilo"
fi
exec "$RILO" bench "$plan" "${options[@]}" "$@"
