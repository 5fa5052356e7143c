"""Stubs, and the checks of all Python of the project. They skip where the checkers could not be installed."""

import subprocess
import sys

import pytest
from conftest import ROOT

import posewire


def check(module, *arguments):
    pytest.importorskip(module.split(".")[0])
    cache = {"MYPY_CACHE_DIR": str(ROOT / "target/python/mypy"), "PATH": ""}
    command = [sys.executable, "-m", module, *arguments]
    ended = subprocess.run(command, capture_output=True, text=True, cwd=ROOT, env=cache, timeout=300)
    assert ended.returncode == 0, ended.stdout + ended.stderr


def test_the_stubs_are_what_the_module_is():
    check("mypy.stubtest", "posewire", "--mypy-config-file", "crates/py/pyproject.toml")


def test_a_typed_program_is_found_right():
    check("mypy", "--strict", "--config-file", "crates/py/pyproject.toml", "crates/py/tests/typed.py")


def test_the_package_is_typed_itself():
    check("mypy", "--strict", "--config-file", "crates/py/pyproject.toml", "crates/py/python/posewire")


def test_all_python_is_formatted_and_checked():
    check("ruff", "check", ".")
    check("ruff", "format", "--check", ".")


def test_a_star_brings_no_name_of_pythons_own():
    assert "OverflowError" not in posewire.__all__
    assert set(posewire.__all__) <= set(dir(posewire))


def test_classes_that_functions_make_cannot_be_called():
    for kind in (posewire.Take, posewire.Frame, posewire.Stream, posewire.Streamer, posewire.Saved, posewire.Table):
        with pytest.raises(TypeError):
            kind()
