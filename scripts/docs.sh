#!/usr/bin/env bash
# Writes the reference of the public headers to build/docs/html; wrong names in comments are errors.
# shellcheck source-path=SCRIPTDIR
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

scripts/setup.sh --docs
scripts/check_links.sh
mkdir -p build/docs
doxygen docs/Doxyfile
echo "Reference: $PWD/build/docs/html/index.html"
