#!/usr/bin/env python3
"""Puts the licence of everything that an unpacked wheel carries into it: scripts/wheel_licences.py FOLDER

Shared libraries are found by name among the system's packages; headers and static parts are those that scripts/setup.sh
--minimal --wheel installs. A library without a licence file is an error.
"""

import re
import shutil
import subprocess
import sys
from importlib import metadata
from pathlib import Path


def output(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def packages_of(libraries):
    """The Debian packages of libtbb-3f1b2c.so.12.8, …: of the files of these names before auditwheel changed them."""
    names = {re.sub(r"-[0-9a-f]{8}(?=\.so)", "", library) for library in libraries}
    owners = {name: set() for name in names}
    for line in output("dpkg-query", "--search", *(f"*/{name}" for name in sorted(names))).splitlines():
        package, path = line.split(": ", 1)
        owners[Path(path).name].add(package.split(":")[0])
    for name, packages in owners.items():
        if len(packages) != 1:
            sys.exit(f"wheel_licences.py: {name}: expected one Debian package with it, found {sorted(packages)}")
    return set().union(*owners.values())


def main():
    folder = Path(sys.argv[1])
    licences = next(folder.glob("*.dist-info")) / "licenses"
    libraries = sorted(path.name for path in folder.glob("*.libs/*.so*"))
    # libroslib is ours: python/src/roslib_in_wheel.cpp.
    packages = packages_of(library for library in libraries if not library.startswith("libroslib-"))
    packages |= {name for name in output("scripts/setup.sh", "--minimal", "--wheel", "--print").split() if name.endswith("-dev")}
    packages |= {"libstdc++6", "libgcc-s1"}
    for package in sorted(packages):
        copyright_file = Path("/usr/share/doc") / package / "copyright"
        if not copyright_file.exists():
            sys.exit(f"wheel_licences.py: {package}: no {copyright_file}")
        shutil.copy(copyright_file, licences / f"{package}.txt")
    found = [path for path in metadata.files("pybind11") if path.name == "LICENSE"]
    if not found:
        sys.exit("wheel_licences.py: pybind11 has no LICENSE")
    shutil.copy(found[0].locate(), licences / "pybind11.txt")
    print(f"carries {len(libraries)} libraries: {' '.join(libraries)}")


main()
