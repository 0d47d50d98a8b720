#!/usr/bin/env python3
"""Includes and CMake's links of our libraries point down, as drawn in "Who includes whom" of docs/development.md.

usage: check_includes.py [ROOT]

A folder may include what the arrows reach from it. Public headers and the fronts include public headers only. The
drawing has no cycle, names every folder with C++ in it, and has no arrow that nothing uses.
"""
import re
import sys
from pathlib import Path

PAGE = "docs/development.md"
HEADING = "## Who includes whom"
FRONTS = ("python", "ros1", "ros2")
INCLUDE = re.compile(r'\s*#\s*include\s*[<"]([^>"]+/[^>"]+)[>"]')  # without a slash: the same folder, or the system
LINKS = re.compile(r"target_link_libraries\(rilo_(\w+)([^)]*)\)")


def drawn(page):
    """Folder → folders that an arrow leads to. `a b → c d → e`: from a and b to c and d, from these to e."""
    block = page.read_text(encoding="utf-8").partition(HEADING)[2].split("```")[1]
    arrows = {}
    for chain in re.split(r"\n|   +", block):
        groups = [group.split() for group in chain.split("→")]
        for left, right in zip(groups, groups[1:]):
            for name in left:
                arrows.setdefault(name, set()).update(right)
            for name in right:
                arrows.setdefault(name, set())
    return arrows


def reached(arrows, start):
    """What the arrows reach from `start`, in one step or more."""
    found, open_ends = set(), [start]
    while open_ends:
        new = arrows[open_ends.pop()] - found
        found |= new
        open_ends += new
    return found


def folder_of(name, arrows):
    """Of a path below src/ or include/rilo/: the folder in the drawing, or None. Headers of include/rilo: themselves."""
    below = name.removeprefix("rilo/").split("/")
    return next((f for f in ("/".join(below[:2]), below[0]) if f in arrows), None)


class Tree:
    def __init__(self, root):
        self.root = root
        self.arrows = drawn(root / PAGE)
        self.below = {folder: reached(self.arrows, folder) for folder in self.arrows}
        self.used = set()
        self.errors = []

    def check_includes(self, file):
        path = file.relative_to(self.root).as_posix()
        top = path.split("/")[0]
        user = folder_of(path if top in (*FRONTS, "apps") else path.partition("/")[2], self.arrows)
        if user is None:
            self.errors.append(f"{path}: its folder is not in the drawing of {PAGE}")
            return
        for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), 1):
            header = INCLUDE.match(line)
            target = header and folder_of(header[1], self.arrows)
            if target and top in (*FRONTS, "include") and not header[1].startswith("rilo/"):
                self.errors.append(f'{path}:{number}: includes "{header[1]}" of src/; public headers and fronts include '
                                   "public headers (rilo/…) only")
            elif target:
                self.check(f"{path}:{number}", user, f'includes "{header[1]}"', target)

    def check_links(self, file):
        for user, links in LINKS.findall(file.read_text(encoding="utf-8")):
            for library in re.findall(r"\brilo(?:_|::)(\w+)", links):
                if user in self.arrows and library in self.arrows:
                    self.check(file.relative_to(self.root).as_posix(), user, f"links rilo_{library}", library)

    def check(self, where, user, uses, target):
        self.used.add((user, target))
        whole = target.split("/")[0]  # what lies above io may include io/times, too
        allowed = {user} | self.below[user]
        if target not in allowed and (whole == user.split("/")[0] or whole not in allowed):
            self.errors.append(f"{where}: {user} {uses} ({target}); below {user} lie only: "
                               f"{' '.join(sorted(self.below[user])) or 'none'} ({PAGE})")

    def check_all(self):
        self.errors += [f"{PAGE}: the arrows lead from {f} back to {f}" for f in self.arrows if f in self.below[f]]
        for top in ("src", "include/rilo", "apps", *FRONTS):
            for file in sorted((self.root / top).rglob("*.[ch]pp")):
                self.check_includes(file)
        for file in sorted((self.root / "src").rglob("CMakeLists.txt")):
            self.check_links(file)
        for user, targets in self.arrows.items():
            self.errors += [f"{PAGE}: nothing uses the arrow {user} → {f}" for f in sorted(targets)
                            if (user, f) not in self.used]


def main():
    tree = Tree(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent.parent)
    tree.check_all()
    print("".join(f"{error}\n" for error in tree.errors), end="", file=sys.stderr)
    return bool(tree.errors)


if __name__ == "__main__":
    sys.exit(main())
