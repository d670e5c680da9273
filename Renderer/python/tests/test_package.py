"""The package: its stub, its types, an installation, the notebook."""

import ast
import importlib.util
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import fenestra
from conftest import write_slices
from fenestra import _fenestra

TOP = Path(__file__).resolve().parents[3]
STUB = TOP / "Renderer/python/fenestra/_fenestra.pyi"


def names_of(thing, inherited=object):
    return {
        name for name in set(dir(thing)) - set(dir(inherited)) if name == "_repr_png_" or not name.startswith("_")
    }


def test_the_stub_has_the_names_of_the_module():
    found = {}
    for node in ast.parse(STUB.read_text()).body:
        if isinstance(node, ast.ClassDef):
            found[node.name] = {
                getattr(member, "name", None) or member.target.id
                for member in node.body
                if getattr(member, "name", "") != "__init__"
            }
        elif isinstance(node, ast.FunctionDef):
            found[node.name] = None
        elif isinstance(node, ast.AnnAssign):
            found[node.target.id] = None
    assert set(found) == names_of(_fenestra)
    for name, members in found.items():
        if members is not None:
            own = getattr(_fenestra, name)
            assert members == names_of(own, own.__mro__[1]), name


def test_public_names_have_docstrings():
    for name in fenestra.__all__:
        thing = getattr(fenestra, name)
        assert thing.__doc__, name
        for member in names_of(thing, thing.__mro__[1]) if isinstance(thing, type) and name != "Error" else ():
            assert getattr(thing, member).__doc__, (name, member)


def test_types(tmp_path):
    pytest.importorskip("mypy")
    words = [sys.executable, "-m", "mypy", "--strict", "--cache-dir", str(tmp_path), str(STUB.parent)]
    result = subprocess.run(words, capture_output=True, text=True, cwd=STUB.parent.parent)
    assert result.returncode == 0, result.stdout


def test_an_installed_package_needs_no_build_folder(subject, tmp_path):
    if "FENESTRA_BUILD" not in os.environ or not importlib.util.find_spec("wheel"):
        pytest.skip("FENESTRA_BUILD is not set, or the package wheel is missing")
    source = tmp_path / "source"
    shutil.copytree(STUB.parent, source / "Renderer/python/fenestra", ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copy(STUB.parent.parent / "README.md", source / "Renderer/python")
    for name in ("CMakeLists.txt", "pyproject.toml", "setup.py"):
        shutil.copy(TOP / name, source)
    flags = ["--no-build-isolation", "--no-index", "--no-deps", "--no-warn-script-location", "--target"]
    subprocess.run(
        [sys.executable, "-m", "pip", "-q", "install", *flags, str(tmp_path / "site"), str(source)], check=True
    )
    package = tmp_path / "site/fenestra"
    libraries = subprocess.run(["ldd", *package.glob("_fenestra.*.so")], capture_output=True, text=True, check=True).stdout
    assert re.search(r"libfenestra\.so\S* => (\S+)", libraries).group(1).startswith(str(package))
    write_slices(tmp_path / "slices", subject.labels * 100)  # which the program fenestra-reader reads
    code = "import fenestra; print(fenestra.__file__, fenestra.Scene('slices', spacing=(1, 1, 1)).camera()['up'])"
    environment = {**os.environ, "PYTHONPATH": str(tmp_path / "site")}
    for words, expected in ((["-c", code], f"{package}/__init__.py (0.0, 0.0, 1.0)"), (["-m", "fenestra", "--version"], "fenestra")):
        result = subprocess.run([sys.executable, *words], capture_output=True, text=True, env=environment, cwd=tmp_path)
        assert result.stdout.startswith(expected), result.stderr


def test_the_notebook_runs(tmp_path):
    for package in ("nbconvert", "ipykernel", "nibabel"):
        pytest.importorskip(package)
    words = [sys.executable, "-m", "nbconvert", "--execute", "--to", "notebook", "--output-dir", str(tmp_path)]
    notebook = TOP / "Resources/notebook/fenestra.ipynb"
    result = subprocess.run([*words, str(notebook)], capture_output=True, text=True, cwd=tmp_path)
    assert result.returncode == 0, result.stderr
    assert (tmp_path / "fenestra.ipynb").read_text().count('"image/png"') >= 3
