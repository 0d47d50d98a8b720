#!/usr/bin/env bash
# Installs what is missing, builds the command, simulates a drive of 220 sweeps in a small town, runs the odometry on it,
# compares with the true path and writes a report into out/demo. Each run replaces the last.
#
#   scripts/demo.sh    about 5 minutes on two idle cores the first time, most of it compiling
#
# Needs Debian's or Ubuntu's package registry and root or sudo.
#
# The command is then build/release/rilo, without the live viewer, rilo bench and rilo report; the messages of these say
# how to get them.
# shellcheck source-path=SCRIPTDIR
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

case "${1-}" in
  '') ;;
  *) die "unknown argument '$1'; it takes none but --help" ;;
esac

rilo=build/release/rilo
if [ ! -x "$rilo" ]; then
  echo "== Building the command first: about 5 minutes in all on two idle cores"
fi
scripts/setup.sh --minimal
# The same folder as the tests', so that nothing is compiled twice; a developer's tests stay configured.
preset=demo
! grep -qs '^RILO_BUILD_TESTS:.*=ON' build/release/CMakeCache.txt || preset=release
build_preset "$preset" --target rilo_cli

echo "== Simulating 220 sweeps of a 64-beam sensor"
rm -rf out/demo
"$rilo" simulate --out out/demo/drive --sensor hdl64 --sweeps 220 --seed 1

echo "== Running the odometry"
"$rilo" run out/demo/drive --out out/demo/results --map out/demo/results/map.ply

echo "== Against the true path"
"$rilo" eval out/demo/drive out/demo/results/poses_lidar.txt
echo
echo "Report: $PWD/out/demo/results/report.html"
echo "Map:    $PWD/out/demo/results/map.ply"
