#!/usr/bin/env bash
# Writes the site of documents and reference of the public headers to build/docs/html; wrong names and links are errors.
# shellcheck source-path=SCRIPTDIR
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

scripts/setup.sh --docs
scripts/check_links.sh
mkdir -p build/docs
doxygen docs/Doxyfile
echo "Site: $PWD/build/docs/html/index.html"
