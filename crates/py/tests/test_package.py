"""The package as a whole: its command, its types, its examples and its documents."""

import ast
import importlib.metadata
import importlib.util
import inspect
import os
import pathlib
import re
import subprocess
import sys

import numpy as np
import pytest
from conftest import ROOT

import posewire

EXAMPLES = sorted((ROOT / "examples").glob("*.py"))
DOCUMENTS = [ROOT / "docs/python.md", ROOT / "README.md", ROOT / "crates/py/README.md"]


def run(*arguments, **options):
    return subprocess.run([sys.executable, *arguments], capture_output=True, text=True, timeout=300, **options)


def test_the_module_runs_the_command_line():
    ended = run("-m", "posewire", "--version")
    assert (ended.returncode, ended.stdout) == (0, f"posewire {posewire.__version__}\n")
    assert run("-m", "posewire", "nonsense").returncode == 2


def test_the_command_is_installed():
    command = pathlib.Path(sys.executable).with_name("posewire")
    ended = subprocess.run([command, "--version"], capture_output=True, text=True)
    assert ended.stdout == f"posewire {posewire.__version__}\n"


def test_the_licences_come_with_the_package():
    files = importlib.metadata.distribution("posewire").files
    texts = {file.name: file.read_text() for file in files if file.name.startswith("LICENSE")}
    assert texts == {name: (ROOT / name).read_text() for name in ["LICENSE-APACHE", "LICENSE-MIT"]}


def test_a_second_command_line_in_a_process_is_refused():
    program = """
import posewire, sys, threading
from posewire.__main__ import main
sys.argv[1:] = ["inspect", "missing.mvnx"]
codes = []
thread = threading.Thread(target=lambda: codes.append(main()))
thread.start()
thread.join()
try:
    main()
except posewire.UsageError as error:
    print(codes, error)
"""
    ended = run("-c", program)
    assert ended.stdout.startswith("[1] expected one command line in a process, found another\nhelp: give it a process")
    assert ended.stderr.startswith("error: cannot read missing.mvnx")


def test_a_reader_that_goes_is_no_failure(tmp_path):
    datagram = (ROOT / "testdata/mxtp/02_quaternion_rev_n.bin").read_bytes()
    (tmp_path / "many.bin").write_bytes(datagram * 500)
    program = [sys.executable, "-m", "posewire", "explain", str(tmp_path / "many.bin")]
    with subprocess.Popen(program, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as explain:
        assert explain.stdout.readline().startswith("MXTP02")
        explain.stdout.close()
        assert explain.stderr.read() == "" and explain.wait(timeout=60) == 0


@pytest.mark.parametrize("encoding", ["ascii", "latin-1", "utf-8"])
def test_what_it_prints_is_utf_8_whatever_python_thinks(encoding):
    command = [sys.executable, "-m", "posewire", "explain", str(ROOT / "testdata/mxtp/12_meta_rev_n.bin")]
    environment = {**os.environ, "PYTHONIOENCODING": encoding, "LC_ALL": "C"}
    ended = subprocess.run(command, capture_output=True, timeout=60, env=environment)
    assert ended.returncode == 0 and 'name "Zoë"' in ended.stdout.decode("utf-8")


@pytest.mark.skipif(not hasattr(os, "fork"), reason="needs file names of any bytes")
def test_arguments_keep_bytes_that_are_no_text(tmp_path):
    path = os.fsencode(tmp_path) + b"/caf\xe9.mvnx"
    with open(path, "wb") as file:
        file.write(b"<mvnx")
    ended = subprocess.run([sys.executable, "-m", "posewire", "inspect", path], capture_output=True, timeout=60)
    assert ended.returncode == 1 and b"Traceback" not in ended.stderr


def test_an_interrupt_ends_the_command():
    program = [sys.executable, "-m", "posewire", "monitor", "mxtp://127.0.0.1:0", "--json"]
    with subprocess.Popen(program, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True) as monitor:
        monitor.stdout.readline()
        monitor.send_signal(2)
        assert monitor.wait(timeout=60) == 0


def loaded_by(program):
    """Names of the packages and modules that a program loads, beside those that Python has loaded by itself."""
    ended = run("-c", f"import sys\nbefore = set(sys.modules)\n{program}\nprint(*set(sys.modules) - before)")
    assert ended.returncode == 0, ended.stderr
    return {name.split(".")[0] for name in ended.stdout.split()}


def test_importing_costs_nothing_but_the_module_itself():
    assert loaded_by("import posewire") <= {"posewire", "__future__"}


def test_arrays_take_numpy_and_nothing_else():
    work = "posewire.read('synthetic:walk', duration=0.1).position"
    ours = loaded_by(f"import numpy, posewire\n{work}") - loaded_by("import numpy")
    assert ours <= {"posewire", "__future__"}
    assert "asyncio" in loaded_by("import posewire\naiter(posewire.listen('synthetic:walk'))")


def public(names):
    return {name for name in names if not name.startswith("_")}


def test_the_stubs_name_everything():
    stubs = ast.parse((pathlib.Path(posewire.__file__).with_name("_posewire.pyi")).read_text())
    described = {node.name: node for node in stubs.body if isinstance(node, (ast.ClassDef, ast.FunctionDef))}
    for name in posewire._posewire.__dict__.keys() & described.keys() | public(vars(posewire._posewire)):
        assert name in described, name
        thing = getattr(posewire._posewire, name)
        if inspect.isclass(thing):
            members = {node.name for node in described[name].body if isinstance(node, ast.FunctionDef)}
            assert public(vars(thing)) == public(members), name
            assert all(getattr(thing, member).__doc__ for member in public(vars(thing))), name
        assert thing.__doc__, name


def test_there_are_examples():
    assert len(EXAMPLES) >= 4


def run_example(path, folder, *arguments):
    for module in re.findall(r"^import (matplotlib|polars)", path.read_text(), re.M):
        pytest.importorskip(module)
    (folder / "temporary").mkdir()
    environment = {**os.environ, "MPLBACKEND": "Agg", "TMPDIR": str(folder / "temporary")}
    ended = run(str(path), *arguments, cwd=folder, env=environment)
    assert ended.returncode == 0, ended.stderr
    return ended.stdout


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_examples_run_and_leave_nothing_where_they_are(path, tmp_path):
    said = run_example(path, tmp_path)
    assert [left.name for left in tmp_path.iterdir()] == ["temporary"]
    written = [left for left in tmp_path.rglob("*") if left.is_file()]
    assert said and all(str(left) in said and left.stat().st_size for left in written)


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_examples_explain_themselves(path, tmp_path):
    assert run_example(path, tmp_path, "--help").startswith("usage: ")


def test_examples_write_where_they_are_told(tmp_path, walk):
    run_example(
        ROOT / "examples/live_angle_to_csv.py", tmp_path, "--samples", "5", "--out", "knee.csv", "--joint", "jLeftKnee"
    )
    rows = (tmp_path / "knee.csv").read_text().splitlines()
    assert len(rows) == 6 and rows[0] == "sample,time,abduction,rotation,flexion"
    assert float(rows[1].split(",")[4]) == pytest.approx(
        np.degrees(walk.joint_angles()[0, walk.joints.index("jLeftKnee"), 2]), abs=1e-3
    )


def test_the_parts_of_the_plot_can_be_imported(tmp_path, walk):
    pytest.importorskip("matplotlib")
    walk.write(tmp_path / "walk.mvnx")
    program = """
import posewire, plot_joint_angles
axes = plot_joint_angles.plot(posewire.read("walk.mvnx"))
print(len(axes.lines))
"""
    environment = {
        **os.environ,
        "MPLBACKEND": "Agg",
        "PYTHONPATH": str(ROOT / "examples"),
        "PYTHONDONTWRITEBYTECODE": "1",
    }
    ended = run("-c", program, cwd=tmp_path, env=environment)
    assert (ended.stdout, ended.returncode) == ("4\n", 0), ended.stderr


def blocks(document):
    """The blocks of Python of a document: all of them, however they are fenced."""
    found = re.findall(r"^```(\w*)\n(.*?)^```$", document.read_text(), re.M | re.S)
    assert len(re.findall(r"```", document.read_text())) == 2 * len(found), "a block that is not fenced as the others"
    assert {language for language, _ in found} <= {"python", "rust", "sh", "json"}
    return [block for language, block in found if language == "python"]


def missing_modules(program):
    modules = re.findall(r"^import (matplotlib|polars|pyarrow)", program, re.M)
    return [module for module in modules if importlib.util.find_spec(module) is None]


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: "-".join(path.parts[-2:]))
def test_documents_run_as_written(document, tmp_path, walk):
    """All blocks of a document, one after the other, in a folder that has the takes they name."""
    program = "\n".join(block for block in blocks(document) if not missing_modules(block))
    assert "posewire." in program
    (tmp_path / "takes").mkdir()
    for name in ("walk.mvnx", "takes/one.mvnx", "takes/two.mvnx"):
        walk.write(tmp_path / name, last=239)
    ended = run("-c", program, cwd=tmp_path, env={**os.environ, "MPLBACKEND": "Agg"})
    assert ended.returncode == 0, ended.stderr
