#!/usr/bin/env bash
# Reads every source of the libraries, the command and the tests by itself, without generating code: a unity build hides
# an include that is missing.
# shellcheck source-path=SCRIPTDIR
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

scripts/setup.sh
folder=build/separate
cmake --preset release -B "$folder" --log-level=WARNING -DCMAKE_UNITY_BUILD=OFF -DCMAKE_EXPORT_COMPILE_COMMANDS=ON \
  -DRILO_BUILD_PYTHON=OFF -DRILO_BUILD_ROS1=OFF -DRILO_BUILD_BENCH=ON >/dev/null
python3 - "$folder/compile_commands.json" >"$folder/commands" <<'PYTHON'
import json
import re
import sys

with open(sys.argv[1], encoding="utf-8") as file:
    for entry in json.load(file):
        print(re.sub(r" -O[0-9s] | -o \S+ -c ", lambda found: " -fsyntax-only " if "-c" in found[0] else " ", entry["command"]))
PYTHON
count=$(wc -l <"$folder/commands")
[ "$count" -gt 400 ] || die "only $count commands in $folder/compile_commands.json"
tr '\n' '\0' <"$folder/commands" | (cd "$folder" && xargs -0 -P "$JOBS" -n 1 sh -c) ||
  die "failed: an include is missing above"
echo "separate: $count sources compile by themselves"
