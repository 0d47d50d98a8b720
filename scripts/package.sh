#!/usr/bin/env bash
# Builds the Debian packages librilo0.1, librilo-dev and rilo into build/package. Install them with
#   apt install ./build/package/*.deb
#
#   scripts/package.sh        builds them
#   scripts/package.sh --try  and simulates and runs a short drive with what is in them, unpacked beside them
# shellcheck source-path=SCRIPTDIR
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

try=false
case "${1-}" in
  '') ;;
  --try) try=true ;;
  *) die "unknown option '$1'; known: --try" ;;
esac

scripts/setup.sh --package
cmake -S . -B build/package -DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_PREFIX=/usr -DBUILD_SHARED_LIBS=ON \
  -DRILO_BUILD_TESTS=OFF -DCMAKE_UNITY_BUILD=ON --log-level=WARNING
cmake --build build/package --parallel "$JOBS"
rm -f build/package/*.deb
(cd build/package && cpack -G DEB)
ls -l build/package/*.deb
$try || exit 0

root=build/package/root
rm -rf "$root"
for package in build/package/*.deb; do
  dpkg -x "$package" "$root"
done
rilo="$root/usr/bin/rilo"
LD_LIBRARY_PATH="$(echo "$root"/usr/lib/*-linux-gnu)"
export LD_LIBRARY_PATH
# Another version of the libraries can stand beside this one: it has no file of the same name.
libraries="$(echo build/package/librilo[0-9]*.deb)"
soversion="$(dpkg-deb -f "$libraries" Package)"
soversion="${soversion#librilo}"
! dpkg -c "$libraries" | grep -v '/$' | grep -vF "$soversion" || die "$libraries holds files without its version"
# Of the packages, not of a build that lies beside them.
! ldd "$rilo" | grep librilo | grep -v "$root/" || die "$rilo finds libraries that are not those of the packages"
"$rilo" simulate --out "$root/drive" --sensor vlp16 --start 10 --sweeps 30 --quiet
"$rilo" run "$root/drive" --out "$root/results" --map "$root/results/map.ply" --quiet
"$rilo" eval "$root/drive" "$root/results/poses_lidar.txt" | tail -n 2
[ -s "$root/usr/share/man/man1/rilo.1" ] || die "the manual page is missing"
echo "packages: the command in them runs"
