#!/usr/bin/env bash
# Reads every source of the libraries and the command by itself, without generating code: a unity build hides an include
# that is missing.
# shellcheck source-path=SCRIPTDIR
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

scripts/setup.sh
folder=build/separate
cmake --preset release -B "$folder" --log-level=WARNING -DCMAKE_UNITY_BUILD=OFF -DCMAKE_EXPORT_COMPILE_COMMANDS=ON \
  -DRILO_BUILD_TESTS=OFF -DRILO_BUILD_PYTHON=OFF -DRILO_BUILD_ROS1=OFF -DRILO_BUILD_BENCH=ON >/dev/null
sed -n 's/^ *"command": "\(.*\) -O[0-9s] \(.*\) -o [^ ]* -c \(.*\)",$/\1 \2 -fsyntax-only \3/p' \
  "$folder/compile_commands.json" | sed 's/\\"/"/g' >"$folder/commands"
count=$(wc -l <"$folder/commands")
[ "$count" -gt 100 ] || die "only $count commands in $folder/compile_commands.json"
(cd "$folder" && xargs -P "$JOBS" -d '\n' -I{} sh -c '{}' <commands) || die "failed: an include is missing above"
echo "separate: $count sources compile by themselves"
