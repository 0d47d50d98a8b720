#!/usr/bin/env bash
# Rewrites our C++ files in the project's format.
# shellcheck source-path=SCRIPTDIR
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

scripts/setup.sh --lint
print_sources0 | xargs -0 clang-format -i --style=file
