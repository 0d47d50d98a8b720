"""What a notebook, help() and an editor show."""

import ast
import inspect
import locale
import pydoc
import re
from pathlib import Path

import numpy as np
import pytest
from conftest import SWEEPS

import rilo


def test_what_a_notebook_shows(drive, run, tmp_path):
    odometry, results = run
    assert re.fullmatch(r"<rilo.SweepResult ok at 1\.1\d* s, position \(.*\) m, \d+ correspondences>", repr(results[-1]))
    assert f"after {SWEEPS} sweeps" in repr(odometry)
    (tmp_path / "a&b").mkdir()
    drive[0][0].tofile(tmp_path / "a&b" / "000000.bin")
    source = rilo.open(tmp_path / "a&b", bin_fields="x,y,z", rate=20)
    assert "folder, bin, 1 sweeps" in repr(source)
    assert "a&amp;b" in source._repr_html_() and "0.05 s, assumed" in source._repr_html_()
    assert "<table>" in results[-1]._repr_html_() and "ok" in results[-1]._repr_html_()
    assert "path" in odometry._repr_html_()
    assert f"of {len(drive[0][0])} points at 0.000 s" in repr(next(source))
    assert f"of {SWEEPS} sweeps" in repr(rilo.Simulator(sweeps=SWEEPS))


def test_numbers_have_a_point_whatever_the_locale(run):
    before = locale.setlocale(locale.LC_NUMERIC)
    try:
        locale.setlocale(locale.LC_NUMERIC, "de_DE.UTF-8")
    except locale.Error:
        pytest.skip("no locale with a decimal comma here")
    try:
        assert re.search(r"\(-?\d+\.\d{3}, ", repr(run[1][-1]))
    finally:
        locale.setlocale(locale.LC_NUMERIC, before)


def test_help_says_everything():
    for name in rilo.__all__:
        if name != "__version__":
            assert len(getattr(rilo, name).__doc__) > 20, name
    for cls in rilo.Odometry, rilo.RunResult, rilo.SweepResult, rilo.Sweep, rilo.ScanSource, rilo.Simulator:
        for name, member in vars(cls).items():
            if not name.startswith("_"):
                assert len(member.__doc__ or "") > 15, f"{cls.__name__}.{name}"
    assert "point_time_unit" in pydoc.render_doc(rilo.open) and "Raises IoError" in pydoc.render_doc(rilo.open)


def test_the_stub_names_what_there_is():
    stub = (Path(rilo.__file__).parent / "__init__.pyi").read_text()
    tree = ast.parse(stub)
    classes = {node.name: node for node in tree.body if isinstance(node, ast.ClassDef)}
    functions = {node.name for node in tree.body if isinstance(node, ast.FunctionDef)}
    public = {name for name in classes if name[0] != "_"}
    assert public | functions | {"__version__"} == set(rilo.__all__)
    for name, node in classes.items():
        if name not in public:
            continue
        there = {n for n in vars(getattr(rilo, name)) if not n.startswith("_")}
        assert {n.name for n in node.body if isinstance(n, ast.FunctionDef) and n.name[0] != "_"} == there, name
    figures = [n.target.id for n in classes["_Errors"].body]
    assert figures == list(rilo.evaluate([np.eye(4)] * 2, [np.eye(4)] * 2))
    assert (Path(rilo.__file__).parent / "py.typed").exists()


def test_the_stub_has_the_arguments_there_are():
    tree = ast.parse((Path(rilo.__file__).parent / "__init__.pyi").read_text())
    options = set(rilo._sources._DEFAULTS)
    for node in tree.body:
        if not isinstance(node, ast.FunctionDef) or node.decorator_list:
            continue
        wanted = [argument.arg for argument in node.args.args + node.args.kwonlyargs]
        function = getattr(rilo, node.name)
        if inspect.isbuiltin(function):
            assert re.findall(r"[(,] ?(\w+):", function.__doc__.splitlines()[0]) == wanted, node.name
        else:
            named = [p.name for p in inspect.signature(function).parameters.values() if p.kind != p.VAR_KEYWORD]
            assert set(named) | options == set(wanted), node.name
