#!/usr/bin/env bash
# Builds with AddressSanitizer and UBSan and runs all tests. Arguments go to ctest. With PRESET=tsan: ThreadSanitizer.
# TARGETS="core_test io_test": builds these programs alone.
# shellcheck source-path=SCRIPTDIR
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

preset=${PRESET:-asan}
if [[ $preset == tsan ]]; then scripts/setup.sh; else scripts/setup.sh --clang; fi
read -ra targets <<<"${TARGETS:-}"
build_preset "$preset" ${targets[@]:+--target "${targets[@]}"}
ctest --preset "$preset" --parallel "$JOBS" "$@"
