#!/usr/bin/env bash
# Installs the Debian packages that the project needs. Says nothing and touches no network when all are there.
#
#   scripts/setup.sh            to build all but the ROS 1 node, and to test
#   scripts/setup.sh --minimal  to build the library and the command without the viewer, and no more
#   scripts/setup.sh --all      also the ROS 1 node, and Slurm with munge (daemons, which Debian starts) for their tests
#   scripts/setup.sh --lint     also clang-format, clang-tidy (from PyPI into build/lint-tools), gcovr, shellcheck
#   scripts/setup.sh --docs     also Doxygen
#   scripts/setup.sh --bench    also Valgrind, which counts instructions
#   scripts/setup.sh --browser  also Chromium, which the viewer's page is tested in
#   scripts/setup.sh --clang    also Clang with libFuzzer and its sanitizers
#   scripts/setup.sh --package  also what building Debian packages needs
#   scripts/setup.sh --wheel    also what building Python wheels needs
#   scripts/setup.sh --witnesses  also, from PyPI into build/witnesses, the programs that tests/witnesses asks
#   scripts/setup.sh --arm      also what cross-compiles for 64-bit ARM and runs its programs
#   scripts/setup.sh --print    print the package names instead of installing them
# shellcheck source-path=SCRIPTDIR
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

build=(build-essential cmake make libeigen3-dev libtbb-dev
       libcli11-dev libyaml-cpp-dev libfmt-dev nlohmann-json3-dev libnanoflann-dev
       libpng-dev libsqlite3-dev zlib1g-dev libzstd-dev liblz4-dev libpcap-dev libssl-dev)
# ROS 1 bags: 39 MB of the 174 MB that a bare Debian 12 downloads for --minimal. Everything else is built without them, too.
bags=(librosbag-storage-dev libnav-msgs-dev libtf2-msgs-dev)
# Node.js builds the page of the viewer: left out where npm came from elsewhere, which Debian's would conflict with.
viewer=(libboost-dev)
command -v npm >/dev/null || viewer+=(nodejs npm)
tests=(git libgtest-dev libgmock-dev libbenchmark-dev pkg-config python3-dev python3-numpy python3-pytest pybind11-dev)
slurm=(slurmctld slurmd slurm-client munge)
# The ROS 1 node and its tests; 45 MB.
ros1=(libroscpp-dev libtopic-tools-dev libtf2-ros-dev libdiagnostic-updater-dev libnav-msgs-dev
      libsensor-msgs-dev libgeometry-msgs-dev libstd-srvs-dev python3-gencpp python3-genpy ros-geometry-msgs
      ros-std-msgs python3-roslaunch python3-rosbag python3-nav-msgs python3-sensor-msgs python3-diagnostic-msgs
      python3-tf2-msgs python3-std-srvs)
lint=(clang-format clang-tidy gcovr shellcheck python3-venv)
docs=(doxygen)
bench=(valgrind)
browser=(chromium)
clang=(clang libclang-rt-14-dev)
package=(dpkg-dev file)
wheel=("${viewer[@]}" python3-dev python3-venv)
witnesses=(python3-venv)
arm=(g++-aarch64-linux-gnu qemu-user-static libtbb-dev:arm64 libgtest-dev:arm64 libgmock-dev:arm64)

minimal=false
with_all=false
with_lint=false
with_docs=false
with_bench=false
with_clang=false
with_browser=false
with_package=false
with_wheel=false
with_witnesses=false
with_arm=false
print_only=false
for argument in "$@"; do
  case "$argument" in
    --minimal) minimal=true ;;
    --all) with_all=true ;;
    --lint) with_lint=true ;;
    --docs) with_docs=true ;;
    --bench) with_bench=true ;;
    --clang) with_clang=true ;;
    --browser) with_browser=true ;;
    --package) with_package=true ;;
    --wheel) with_wheel=true ;;
    --witnesses) with_witnesses=true ;;
    --arm) with_arm=true ;;
    --print) print_only=true ;;
    *) die "unknown option '$argument'; known: --minimal --all --lint --docs --bench --browser --clang --package --wheel --witnesses --arm --print" ;;
  esac
done

wanted=("${build[@]}" "${bags[@]}")
$minimal || wanted+=("${viewer[@]}" "${tests[@]}")
! $with_all || wanted+=("${ros1[@]}" "${slurm[@]}")
! $with_lint || wanted+=("${lint[@]}")
! $with_docs || wanted+=("${docs[@]}")
! $with_bench || wanted+=("${bench[@]}")
! $with_browser || wanted+=("${browser[@]}")
! $with_clang || wanted+=("${clang[@]}")
! $with_package || wanted+=("${package[@]}")
! $with_wheel || wanted+=("${wheel[@]}")
! $with_witnesses || wanted+=("${witnesses[@]}")
! $with_arm || wanted+=("${arm[@]}")
if $print_only; then
  printf '%s\n' "${wanted[@]}"
  exit 0
fi

if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
  die "this needs Debian or Ubuntu (apt-get). Elsewhere install by hand what these provide: ${wanted[*]}"
fi

missing=()
for package in "${wanted[@]}"; do
  status="$(dpkg-query --show --showformat='${db:Status-Status}\n' "$package" 2>/dev/null || true)"
  grep -qx installed <<<"$status" || missing+=("$package")
done

# install_from_pypi FOLDER REQUIREMENTS ELSE: an environment with these versions. A copy of the requirements says that they
# are there. Without them the work goes on; ELSE says how.
install_from_pypi() {
  local folder="$1" requirements="$2"
  ! cmp -s "$requirements" "$folder/installed.txt" || return 0
  echo "Installing into $folder: $(grep -cE '^[^#]+==' "$requirements") packages from PyPI"
  python3 -m venv --clear "$folder"
  if ! "$folder/bin/pip" install --quiet --disable-pip-version-check --requirement "$requirements"; then
    echo "setup.sh: pip could not install $requirements into $folder; $3" >&2
    return 0
  fi
  cp "$requirements" "$folder/installed.txt"
}

install_pypi_parts() {
  ! $with_witnesses ||
    install_from_pypi build/witnesses tests/witnesses/requirements.txt "tests/witnesses will be skipped"
  ! $with_lint || install_from_pypi build/lint-tools scripts/lint_requirements.txt "Debian's clang-tidy will do, in twice the time"
}

if [ ${#missing[@]} -eq 0 ]; then
  install_pypi_parts
  exit 0
fi

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null ||
    die "neither root nor sudo here. Run as root: apt-get install --no-install-recommends ${missing[*]}"
  as_root=(sudo)
fi

# Waits for another apt rather than failing; its chatter goes nowhere, its errors to stderr.
apt() {
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -qq -o DPkg::Lock::Timeout=300 -o Dpkg::Use-Pty=0 "$@" \
    >/dev/null
}

echo "Installing: ${missing[*]}"
! $with_arm || "${as_root[@]}" dpkg --add-architecture arm64
apt update || echo "setup.sh: apt-get update failed; trying with the package lists at hand" >&2
apt install --yes --no-install-recommends "${missing[@]}" || die "apt-get could not install: ${missing[*]}"
install_pypi_parts
