#!/usr/bin/env bash
# Tries a wheel as its user has it: scripts/try_wheel.sh WHEEL [PYTHON]
# Installs it into an empty environment, runs the package's tests there, simulates a drive with its command, and compares
# poses: those of its command with those of the library through Python and with those of build/release/rilo, bit for bit.
# Then time and error beside KISS-ICP, where PyPI has that for this Python.
# shellcheck source-path=SCRIPTDIR
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

case "${1-}" in
  '' | -*) print_help; exit 0 ;;
esac
wheel="$1"
python="${2:-/usr/bin/python3}"
folder="$PWD/build/wheel/try"
rm -rf "$folder"
"$python" -m venv "$folder/env"
pip=("$folder/env/bin/pip" --quiet --disable-pip-version-check)
"${pip[@]}" install "$wheel"
PATH="$folder/env/bin:$PATH"
unset PYTHONPATH

cd "$folder"
[ "$(command -v rilo)" = "$folder/env/bin/rilo" ] || die "no command rilo on the PATH of the environment"
rilo simulate --out drive --sensor vlp16 --start 10 --sweeps 40 --quiet
rilo run drive --out results --one-pass --map results/map.ply --quiet
for file in map.ply report.html trajectory.bag; do
  [ -s "results/$file" ] || die "the command wrote no $file"
done
python -m rilo eval drive results/poses_lidar.txt | tail -n 2
# Every library comes from the wheel or is glibc's and the compiler's.
python - <<'END'
import pathlib, re, subprocess, rilo
package = pathlib.Path(rilo.__file__).parent
for file in [package / "bin" / "rilo", *package.glob("_rilo*.so")]:
    loaded = subprocess.run(["ldd", file], capture_output=True, text=True, check=True).stdout
    unresolved = subprocess.run(["ldd", "-r", file], capture_output=True, text=True, check=True).stdout
    wanted = [line for line in unresolved.splitlines() if "undefined symbol" in line and not re.search("Py|_Py", line)]
    assert not wanted, wanted
    for line in loaded.splitlines():
        name = line.split()[0]
        own = "/rilo.libs/" in line
        system = re.match(r"(linux-vdso|/lib64/ld-|lib(c|m|dl|rt|pthread|stdc\+\+|gcc_s|resolv|util|z)\.so)", name)
        assert own or system, f"{file}: {line.strip()} is not of the wheel"
    print(file.name, "loads", len(loaded.splitlines()), "libraries")
END
# The bag that a run writes is read by Python through the same plugin: it has no point clouds, and says so.
message="$(python -c 'import rilo; rilo.open("results/trajectory.bag")' 2>&1 | tail -n 1 || true)"
[[ $message == *"nav_msgs/Odometry"* ]] || die "a ROS 1 bag is not read: $message"
python "$OLDPWD/python/examples/write_poses.py" drive python.txt
cmp python.txt results/poses_lidar.txt || die "Python and the command give other poses"
"$OLDPWD/build/release/rilo" run drive --out built --one-pass --quiet
cmp built/poses_lidar.txt results/poses_lidar.txt || die "the wheel's command and build/release/rilo give other poses"

"${pip[@]}" install pytest
if "${pip[@]}" install --only-binary :all: kiss-icp==1.3.0; then
  python "$OLDPWD/python/examples/beside_kiss_icp.py"
else
  echo "try_wheel.sh: no KISS-ICP for this Python: not compared"
fi
python -m pytest -q -p no:cacheprovider "$OLDPWD/python/tests"
echo "wheel: $(basename "$wheel"): the poses of the command, of Python and of the build are the same"
