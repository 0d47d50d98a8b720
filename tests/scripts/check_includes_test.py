"""What scripts/check_includes.py finds in small trees.

    check_includes_test.py SCRIPT
"""

import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

DRAWING = """
top → middle → bottom
middle/upper → middle/lower → middle
"""
CLEAN = {
    "src/top/a.cpp": '#include "rilo/middle/m.hpp"\n#include "middle/upper/u.hpp"\n#include <bottom>\n',
    "src/middle/upper/u.hpp": '#include "middle/lower/l.hpp"\n#include "bottom/b.hpp"\n',
    "src/middle/lower/l.hpp": '#include "middle/m.hpp"\n',
    "src/middle/m.hpp": '#include "rilo/bottom/b.hpp"\n',
    "src/bottom/b.hpp": "#include <vector>\n",
    "src/top/CMakeLists.txt": "target_link_libraries(rilo_top PUBLIC rilo::middle fmt::fmt)\n",
    "include/rilo/middle/m.hpp": '#include "rilo/bottom/b.hpp"\n',
}


def errors_of(changes, drawing=DRAWING):
    with tempfile.TemporaryDirectory() as folder:
        page = f"text\n\n## Who includes whom\n\n```{drawing}```\n"
        for name, text in {**CLEAN, "docs/development.md": page, **changes}.items():
            file = Path(folder, name)
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(text, encoding="utf-8")
        run = subprocess.run([sys.executable, "-B", SCRIPT, folder], capture_output=True, encoding="utf-8")
        assert (run.returncode == 0) == (run.stderr == ""), run.stderr
        return run.stderr


class CheckIncludes(unittest.TestCase):
    def test_a_tree_whose_includes_point_down(self):
        self.assertEqual(errors_of({}), "")

    def test_an_include_that_points_up(self):
        errors = errors_of({"src/bottom/b.cpp": '#include <vector>\n  #  include "top/t.hpp"\n'})
        self.assertIn('src/bottom/b.cpp:2: bottom includes "top/t.hpp" (top); below bottom lie only: none', errors)
        errors = errors_of({"src/middle/m.cpp": "#include <rilo/top/t.hpp>\n"})
        self.assertIn('src/middle/m.cpp:1: middle includes "rilo/top/t.hpp" (top); below middle lie only: bottom', errors)

    def test_a_folder_that_includes_one_inside_it(self):
        self.assertIn("src/middle/m.cpp:1", errors_of({"src/middle/m.cpp": '#include "middle/lower/l.hpp"\n'}))
        self.assertIn("src/middle/lower/l.cpp:1", errors_of({"src/middle/lower/l.cpp": '#include "middle/upper/u.hpp"\n'}))

    def test_a_public_header_or_a_front_that_includes_a_private_one(self):
        for name in ("include/rilo/top/t.hpp", "python/src/p.cpp"):
            errors = errors_of({name: '#include "bottom/b.hpp"\n'}, DRAWING + "python → top\n")
            self.assertIn(f'{name}:1: includes "bottom/b.hpp" of src/', errors)

    def test_a_link_that_points_up(self):
        errors = errors_of({"src/bottom/CMakeLists.txt": "target_link_libraries(rilo_bottom PRIVATE\n  rilo_top)\n"})
        self.assertIn("src/bottom/CMakeLists.txt: bottom links rilo_top (top)", errors)

    def test_a_drawing_with_a_cycle_an_unused_arrow_or_a_folder_missing(self):
        self.assertIn("the arrows lead from bottom back to bottom", errors_of({}, DRAWING + "bottom → top\n"))
        self.assertIn("nothing uses the arrow top → bottom", errors_of({}, DRAWING + "top → bottom\n"))
        self.assertIn("src/new/n.cpp: its folder is not in the drawing", errors_of({"src/new/n.cpp": ""}))


if __name__ == "__main__":
    SCRIPT = sys.argv.pop(1)
    unittest.main()
