#!/usr/bin/env bash
# Installs what is missing, builds everything and runs the tests. Tests whose packages are not there are skipped.
#
#   scripts/test.sh              all tests that need no daemon and no ROS: about 25 minutes on two cores, most of it building
#   scripts/test.sh --all        first installs Slurm, munge and ROS 1 for their tests, too
#   scripts/test.sh -R Odometry  other arguments go to ctest
# shellcheck source-path=SCRIPTDIR
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

setup=()
arguments=()
for argument in "$@"; do
  case "$argument" in
    --all) setup=(--all) ;;
    *) arguments+=("$argument") ;;
  esac
done

scripts/setup.sh "${setup[@]}"
build_preset release
ctest --preset release --parallel "$JOBS" "${arguments[@]}"
