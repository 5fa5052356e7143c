"""Errors: the words of the command line, in classes that programs can tell apart."""

import builtins
import socket
import subprocess
import sys

import pytest

import posewire


@pytest.fixture(scope="module")
def folder(tmp_path_factory, walk):
    """A folder with files of every fault."""
    folder = tmp_path_factory.mktemp("faults")
    walk.write(folder / "walk.mvnx", last=9)
    walk.write(folder / "there.csv", last=9)
    walk.write(folder / "walk.bvh", last=9)
    (folder / "broken.mvnx").write_text("<mvnx version='4'><mvn")
    (folder / "empty.mvnx").write_bytes(b"")
    (folder / "folder.mvnx").mkdir()
    (folder / "notes.txt").write_text("nothing of motion")
    for name, data in (("empty.mcap", b""), ("noise.mcap", b"x" * 1000), ("noise.pcap", b"x" * 1000)):
        (folder / name).write_bytes(data)
    return folder


@pytest.fixture(scope="module")
def taken():
    """A port that somebody else has."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
        other.bind(("127.0.0.1", 0))
        yield other.getsockname()[1]


def read(path):
    return ["convert", path, "out.csv"], lambda: posewire.read(path)


def write(path, *options, **keywords):
    return ["convert", "walk.mvnx", path, *options], lambda: posewire.read("walk.mvnx").write(path, **keywords)


def listen(url):
    return ["monitor", url, "--duration", "0.1"], lambda: posewire.listen(url).close()


def send(url):
    command = ["stream", "synthetic:walk", "--duration", "0.1", "--to", url]
    return command, lambda: posewire.streamer(url).close()


FAULTS = [
    (posewire.ReadError, 1, read("missing.mvnx")),
    (posewire.ReadError, 1, read("missing.mcap")),
    (posewire.ReadError, 1, read("missing.pcap")),
    (posewire.ReadError, 1, read("broken.mvnx")),
    (posewire.ReadError, 1, read("empty.mvnx")),
    (posewire.ReadError, 1, read("folder.mvnx")),
    (posewire.ReadError, 1, read("empty.mcap")),
    (posewire.ReadError, 1, read("noise.mcap")),
    (posewire.ReadError, 1, read("noise.pcap")),
    (posewire.ReadError, 1, read("notes.txt")),
    (posewire.UsageError, 2, read("take.mvn")),
    (posewire.UsageError, 2, read("walk.bvh")),
    (posewire.WriteError, 2, write("there.csv")),
    (posewire.WriteError, 2, write("out.mvnx", "--axes", "unity", axes="unity")),
    (posewire.WriteError, 1, write("no/such/folder.csv")),
    (posewire.UsageError, 2, write("out.csv", "--from", "900", first=900)),
    (posewire.UsageError, 2, listen("osc://127.0.0.1")),
    (posewire.UsageError, 2, listen("")),
    (posewire.UsageError, 2, listen("mxtp://256.0.0.1")),
    (posewire.UsageError, 2, listen("mxtp://127.0.0.1:99999")),
    (posewire.UsageError, 2, listen("mxtp://127.0.0.1?colour=red")),
    (posewire.UsageError, 2, listen("natnet://127.0.0.1?mode=loud")),
    (posewire.UsageError, 2, listen("synthetic:walk?people=0")),
    (posewire.NetworkError, 1, listen("mxtp://no-such-host.invalid")),
    (posewire.NetworkError, 1, listen("mxtp://239.1.1.1?interface=none0")),
    (posewire.NetworkError, 1, listen("mxtp://192.0.2.1")),
    (posewire.NetworkError, 1, listen("mxtp://127.0.0.1:TAKEN")),
    (posewire.UsageError, 2, send("osc://127.0.0.1")),
    (posewire.UsageError, 2, send("walk.mvnx")),
    (posewire.UsageError, 2, send("mxtp://127.0.0.1?mode=3")),
    (posewire.NetworkError, 1, send("mxtp://no-such-host.invalid")),
    (posewire.NetworkError, 1, send("natnet://192.0.2.1")),
    (posewire.NetworkError, 1, send("mxtp+tcp://192.0.2.1:1?mode=listen")),
]


@pytest.mark.parametrize(
    ("kind", "code", "fault"), FAULTS, ids=lambda value: " ".join(value[0]) if type(value) is tuple else ""
)
def test_a_fault_has_the_words_of_the_command_line(folder, taken, monkeypatch, kind, code, fault):
    monkeypatch.chdir(folder)
    command, call = fault
    if "TAKEN" in command[1]:
        command, call = listen(command[1].replace("TAKEN", str(taken)))
    with pytest.raises(kind) as raised:
        call()
    program = [sys.executable, "-m", "posewire", *command]
    ended = subprocess.run(program, capture_output=True, text=True, timeout=60, stdin=subprocess.DEVNULL)
    error = raised.value
    assert type(error) is kind and error.help and str(error) == f"{error.message}\nhelp: {error.help}"
    said = ended.stderr.replace("--overwrite", "overwrite=True").replace("--only 0", 'only="0"').replace("--to ", "")
    assert (f"error: {error}\n", code) == (said, ended.returncode)


def test_no_fault_leaves_a_file_behind(folder):
    assert not list(folder.glob("out.*"))


def test_errors_are_caught_by_the_names_that_python_has_for_them():
    for kind, theirs in (
        (posewire.UsageError, ValueError),
        (posewire.DecodeError, ValueError),
        (posewire.MissingError, AttributeError),
        (posewire.MissingError, LookupError),
        (posewire.OverflowError, builtins.OverflowError),
    ):
        assert issubclass(kind, posewire.Error) and issubclass(kind, theirs)


def test_what_stands_in_a_program_comes_as_itself():
    """What is wrong with a program, rather than with what it works on, is Python's own TypeError."""
    for call in (
        lambda: posewire.read(5),
        lambda: posewire.read("walk.mvnx", colour="red"),
        lambda: posewire.listen(None),
        lambda: posewire.decode("text"),
    ):
        with pytest.raises(TypeError):
            call()
