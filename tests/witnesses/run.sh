#!/usr/bin/env bash
# Runs the tests of this folder with the packages that scripts/setup.sh --witnesses installs. Without them it says so and
# counts as skipped (77). Arguments go to pytest.
set -euo pipefail
here="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
python="${RILO_WITNESSES:-$here/../../build/witnesses}/bin/python"
if [ ! -x "$python" ] || ! "$python" -c 'import evo, mcap, mcap_ros2, plyfile, pytest, rosbags' 2>/dev/null; then
  echo "skipped: no evo, mcap, plyfile, rosbags; scripts/setup.sh --witnesses installs them"
  exit 77
fi
exec "$python" -m pytest -q -p no:cacheprovider "$@"
