#!/usr/bin/env bash
# Line coverage of the core by its own tests; fails under RILO_COVERAGE_MIN percent (90).
# shellcheck source-path=SCRIPTDIR
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

scripts/setup.sh --lint
build_preset coverage
find build/coverage -name '*.gcda' -delete  # figures of this run alone
ctest --preset coverage --parallel "$JOBS" "$@"
gcovr --root . --object-directory build/coverage --exclude-unreachable-branches \
  --filter '(src|include/rilo)/(geometry|cloud|map|registration|calibration|odometry)/' \
  --html-details build/coverage/coverage.html --print-summary --txt --fail-under-line "${RILO_COVERAGE_MIN:-90}" \
  --exclude-directories ".*/CMakeFiles/[0-9.]*/CompilerIdCXX" build/coverage
