#!/usr/bin/env bash
# Builds the Debian packages librilo0, librilo-dev and rilo into build/package. Install them with
#   apt install ./build/package/*.deb
# shellcheck source-path=SCRIPTDIR
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

scripts/setup.sh --package
cmake -S . -B build/package -DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_PREFIX=/usr -DBUILD_SHARED_LIBS=ON \
  -DRILO_BUILD_TESTS=OFF -DRILO_BUILD_EXAMPLES=OFF ${RILO_UNITY:+"-DCMAKE_UNITY_BUILD=$RILO_UNITY"} --log-level=WARNING
cmake --build build/package --parallel "$JOBS"
rm -f build/package/*.deb
(cd build/package && cpack -G DEB)
ls -l build/package/*.deb
