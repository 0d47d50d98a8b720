#!/usr/bin/env bash
# Builds with AddressSanitizer and UBSan and runs all tests. Arguments go to ctest. With PRESET=tsan: ThreadSanitizer.
# shellcheck source-path=SCRIPTDIR
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

scripts/setup.sh
build_preset "${PRESET:-asan}"
ctest --preset "${PRESET:-asan}" --parallel "$JOBS" "$@"
