#!/usr/bin/env bash
# Builds with AddressSanitizer and UBSan and runs all tests. Arguments go to ctest. With PRESET=tsan: ThreadSanitizer.
# TARGETS="core_test io_test": builds these programs alone.
# shellcheck source-path=SCRIPTDIR
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

scripts/setup.sh --clang
read -ra targets <<<"${TARGETS:-}"
build_preset "${PRESET:-asan}" ${targets[@]:+--target "${targets[@]}"}
ctest --preset "${PRESET:-asan}" --parallel "$JOBS" "$@"
