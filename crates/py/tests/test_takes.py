"""Takes: what is read is what the file says, and arrays are views."""

import gc
import pathlib
import signal
import subprocess
import sys
import threading
import xml.etree.ElementTree as ElementTree

import numpy as np
import pytest
from conftest import ROOT

import posewire

REFERENCE = ROOT.parent / "shared" / "data" / "mvnx"


def test_arrays_have_a_row_for_each_sample(walk):
    assert walk.rate == 240 and len(walk) == 480
    assert walk.position.shape == (480, 23, 3) and walk.orientation.shape == (480, 23, 4)
    assert walk.joint_angles("zxy").shape == walk.joint_angles("xzy").shape == (480, 22, 3)
    assert walk.center_of_mass.shape == (480, 3)
    assert walk.contacts.shape == (480, 4) and walk.contacts.dtype == bool
    assert walk.sample.tolist() == list(range(480)) and walk.sample.dtype == np.uint32
    np.testing.assert_allclose(walk.time, np.arange(480) / 240, atol=1e-9)
    np.testing.assert_allclose(np.linalg.norm(walk.orientation, axis=-1), 1)
    assert len(walk.segments) == 23 and walk.segments[6] == "Head"
    assert len(walk.joints) == 22 and walk.skeleton.parents[0] is None


def test_arrays_are_read_only_views_that_keep_the_take_alive(walk):
    take = posewire.read("synthetic:walk", duration=1)
    one, two = take.position, take["position"]
    assert one.ctypes.data == two.ctypes.data, "no copy"
    assert not one.flags.owndata and one.flags.c_contiguous
    with pytest.raises(ValueError):
        one[0] = 0
    expected = one.copy()
    del take, two
    gc.collect()
    np.testing.assert_array_equal(one, expected)


def test_a_sample_is_a_row_of_the_take(walk):
    frame = walk.frame(-1)
    assert frame.sample == 479 and frame.age is None and frame.state is None
    for section in walk.sections:
        np.testing.assert_array_equal(frame[section], walk[section][-1])
    with pytest.raises(IndexError):
        walk.frame(480)


def test_what_a_take_lacks_is_named_and_can_be_computed(walk, tmp_path):
    walk.write(tmp_path / "poses.mvnx", sections=["position", "orientation"])
    take = posewire.read(tmp_path / "poses.mvnx")
    assert not hasattr(take, "velocity")
    with pytest.raises(posewire.MissingError, match="the take has no velocity: it has position, orientation"):
        take.velocity
    whole = take.complete()
    assert whole.velocity.shape == whole.position.shape
    assert take.complete("joint_angles").sections == ["position", "orientation", "joint_angles"]


def sections_by_numpy(path):
    """What numpy makes of the XML by itself."""
    frames = [frame for frame in ElementTree.parse(path).iter() if frame.tag.endswith("}frame")]
    frames = [frame for frame in frames if frame.get("type") == "normal"]
    for child in frames[0]:
        yield child.tag.split("}")[1], np.array([frame.findtext(child.tag).split() for frame in frames], float)


def assert_equals_numpy(path):
    take, compared = posewire.read(path), 0
    for tag, numbers in sections_by_numpy(path):
        name = {"jointAngle": "joint_angles", "angularVelocity": "angular_velocity"}.get(tag, tag)
        if name not in ("position", "orientation", "velocity", "acceleration", "angular_velocity", "joint_angles"):
            continue
        found = take[name].reshape(len(take), -1)
        if name == "joint_angles":
            np.testing.assert_array_equal(found, np.radians(numbers))
        else:
            np.testing.assert_array_equal(found, numbers)
        compared += 1
    assert compared >= 2


def test_numbers_are_those_that_numpy_reads(walk, tmp_path):
    walk.write(tmp_path / "walk.mvnx")
    assert_equals_numpy(tmp_path / "walk.mvnx")


def test_numbers_of_mvn_are_those_that_numpy_reads():
    paths = [path for path in sorted(REFERENCE.glob("*.mvnx")) if 'version="4"' in path.read_text("utf-8-sig")[:2000]]
    if not paths:
        pytest.skip("reference data not here")
    for path in paths:
        assert_equals_numpy(path)


@pytest.mark.parametrize("ending", "mvnx mvnx.gz csv bvh c3d trc mot sto gltf glb npz".split())
def test_every_format_is_written(walk, tmp_path, ending):
    path = tmp_path / f"walk.{ending}"
    saved = walk.write(path, progress=lambda done, total: None)
    assert [pathlib.Path(file) for file in saved.files] == [path]
    assert path.stat().st_size == saved.bytes > 0
    with pytest.raises(posewire.WriteError):
        walk.write(path)
    walk.write(path, overwrite=True)


def test_writing_cuts_turns_and_resamples(walk, tmp_path):
    walk.write(tmp_path / "cut.npz", first=24, last=47, rate=60, axes="unity", sections=["position"])
    archive = np.load(tmp_path / "cut.npz")
    assert archive["position"].shape == (6, 23, 3)
    x, y, z = np.moveaxis(walk.position[24], -1, 0)
    np.testing.assert_allclose(archive["position"][0], np.stack([-y, z, x], -1), atol=1e-6)
    with pytest.raises(TypeError):
        walk.write(tmp_path / "cut.npz", colour="red")


def test_a_recording_gives_the_take_that_was_sent(walk, tmp_path):
    path = tmp_path / "take.mcap"
    with posewire.Recorder("mxtp://127.0.0.1:0", path=path) as recorder:
        with (
            posewire.listen("synthetic:walk") as pace,
            posewire.streamer(*recorder.urls, names=["Ada", "Bob"]) as streamer,
        ):
            for frame, _ in zip(pace, range(60)):
                streamer.send(frame.position, frame.orientation)
                streamer.send(frame.position, frame.orientation, subject=1)
        while recorder.progress()["frames"] < 110:
            pass
    with pytest.raises(posewire.MissingError, match="expected one take, found Ada, Bob"):
        posewire.read(path)
    takes = posewire.read_all(path)
    assert [take.subject for take in takes] == ["Ada", "Bob"]
    take = posewire.read(path, subject="Bob")
    assert take.rate == pytest.approx(240, rel=0.02), "by the clock of the stream, whose milliseconds leave it open"
    np.testing.assert_allclose(take.position, walk.position[take.sample], atol=1e-5)


def test_progress_counts_to_the_end(walk, tmp_path):
    walk.write(tmp_path / "walk.mvnx")
    told = []
    posewire.read(tmp_path / "walk.mvnx", progress=lambda done, total: told.append((done, total)))
    assert told[-1][0] == told[-1][1] == (tmp_path / "walk.mvnx").stat().st_size


def test_an_interrupt_ends_reading(tmp_path):
    def interrupt(done, total):
        signal.raise_signal(signal.SIGINT)

    with pytest.raises(KeyboardInterrupt):
        posewire.read("synthetic:walk", duration=3600, progress=interrupt)


def test_other_threads_run_while_one_reads():
    done = threading.Event()
    turns = 0

    def read():
        posewire.read("synthetic:walk", duration=20)
        done.set()

    threading.Thread(target=read).start()
    while not done.is_set():
        turns += 1
    assert turns > 1000, "a reader that keeps the interpreter lets nobody else have a turn"


@pytest.mark.parametrize(
    ("path", "kind"),
    [
        ("missing.mvnx", posewire.ReadError),
        ("broken.mvnx", posewire.ReadError),
        ("take.mvn", posewire.UsageError),
        ("empty.mcap", posewire.ReadError),
    ],
)
def test_errors_have_the_words_of_the_command_line(tmp_path, path, kind):
    (tmp_path / "broken.mvnx").write_text("<mvnx version='4'><mvn")
    (tmp_path / "empty.mcap").write_bytes(b"")
    with pytest.raises(kind) as raised:
        posewire.read(tmp_path / path)
    command = [sys.executable, "-m", "posewire", "convert", str(tmp_path / path), str(tmp_path / "out.csv")]
    ended = subprocess.run(command, capture_output=True, text=True)
    assert ended.returncode == (2 if kind is posewire.UsageError else 1)
    assert f"error: {raised.value}\n" in ended.stderr
    assert isinstance(raised.value, posewire.Error) and raised.value.help


def test_tables_are_arrow(walk):
    pyarrow = pytest.importorskip("pyarrow")
    polars = pytest.importorskip("polars")
    table = walk.to_arrow()
    frame = polars.DataFrame(table)
    assert frame.height == len(walk) and frame.columns == table.columns
    np.testing.assert_array_equal(frame["position_Pelvis_x"].to_numpy(), walk.position[:, 0, 0])
    np.testing.assert_array_equal(frame["orientation_Head_w"].to_numpy(), walk.orientation[:, 6, 0])
    arrow = pyarrow.table(walk.to_arrow(["center_of_mass"]))
    assert arrow.column_names == [
        "subject",
        "sample",
        "time",
        "center_of_mass_x",
        "center_of_mass_y",
        "center_of_mass_z",
    ]
