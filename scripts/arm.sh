#!/usr/bin/env bash
# Cross-compiles the core and its tests for 64-bit ARM and runs them in qemu's user mode: ctest's arguments. A
# quarter of an hour. Debian's packages for arm64 stand beside those of the machine.
# shellcheck source-path=SCRIPTDIR
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

scripts/setup.sh --arm
cmake -S . -B build/arm --log-level=WARNING -DCMAKE_BUILD_TYPE=Release -DCMAKE_UNITY_BUILD=ON \
  -DCMAKE_TOOLCHAIN_FILE="$PWD/cmake/aarch64-linux-gnu.cmake" -DRILO_BUILD_APPS=OFF >/dev/null
cmake --build build/arm --parallel "$JOBS" --target library_tests
ctest --test-dir build/arm --parallel "$JOBS" --label-regex '^library$' "$@"
