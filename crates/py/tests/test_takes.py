"""Takes: what is read is what the file says, and arrays are views."""

import gc
import os
import pathlib
import re
import signal
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
    assert [walk.frame(place).time for place in range(480)] == walk.time.tolist()
    for place in 480, -481, 10**30:
        with pytest.raises(IndexError, match="the take has 480 samples, found "):
            walk.frame(place)


def test_what_a_take_lacks_is_named_and_can_be_computed(walk, tmp_path):
    walk.write(tmp_path / "poses.mvnx", sections=["position", "orientation"])
    take = posewire.read(tmp_path / "poses.mvnx")
    assert not hasattr(take, "velocity")
    with pytest.raises(posewire.MissingError, match="the take has no velocity: it has position, orientation"):
        take.velocity
    for ask in take.to_arrow, lambda sections: take.write(tmp_path / "x.csv", sections=sections):
        with pytest.raises(posewire.MissingError, match="the take has no sensor_magnetic_field: it has position"):
            ask(["position", "sensor_magnetic_field"])
    assert not (tmp_path / "x.csv").exists()
    take.write(tmp_path / "x.csv", sections=["velocity"])
    whole = take.complete()
    assert whole.velocity.shape == whole.position.shape
    assert take.complete("joint_angles").sections == ["position", "orientation", "joint_angles"]


def sections_by_numpy(path):
    """What numpy makes of the XML by itself."""
    frames = [frame for frame in ElementTree.parse(path).iter() if frame.tag.endswith("}frame")]
    frames = [frame for frame in frames if frame.get("type") == "normal"]
    for child in frames[0]:
        yield child.tag.split("}")[1], np.array([frame.findtext(child.tag).split() for frame in frames], float)


def times_by_numpy(path):
    """The clock of the file, whole milliseconds, in seconds."""
    frames = [frame for frame in ElementTree.parse(path).iter() if frame.tag.endswith("}frame")]
    return np.array([float(frame.get("time")) for frame in frames if frame.get("type") == "normal"]) / 1000.0


def assert_equals_numpy(path):
    take, compared = posewire.read(path), 0
    np.testing.assert_array_equal(take.time, times_by_numpy(path))
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


def test_progress_counts_to_the_end(walk, tmp_path):
    walk.write(tmp_path / "walk.mvnx")
    told = []
    posewire.read(tmp_path / "walk.mvnx", progress=lambda done, total: told.append((done, total)))
    assert told[-1][0] == told[-1][1] == (tmp_path / "walk.mvnx").stat().st_size


def test_an_interrupt_ends_reading():
    def interrupt(done, total):
        signal.raise_signal(signal.SIGINT)

    # What a shell starts in the background has none.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        with pytest.raises(KeyboardInterrupt):
            posewire.read("synthetic:walk", duration=3600, progress=interrupt)
    finally:
        signal.signal(signal.SIGINT, before)


def test_other_threads_run_while_one_reads():
    done = threading.Event()
    turns = 0

    def read():
        try:
            posewire.read("synthetic:walk", duration=20)
        finally:
            done.set()

    threading.Thread(target=read).start()
    while not done.is_set():
        turns += 1
    assert turns > 1000, "a reader that keeps the interpreter lets nobody else have a turn"


def test_tables_are_arrow(walk):
    pyarrow = pytest.importorskip("pyarrow")
    polars = pytest.importorskip("polars")
    table = walk.to_arrow()
    assert repr(type(table)) == "<class 'posewire.Table'>" and isinstance(table, posewire.Table)
    for frame in polars.DataFrame(table), polars.from_arrow(table):
        assert frame.height == len(walk) and frame.columns == table.columns
        np.testing.assert_array_equal(frame["position_Pelvis_x"].to_numpy(), walk.position[:, 0, 0])
        np.testing.assert_array_equal(frame["orientation_Head_w"].to_numpy(), walk.orientation[:, 6, 0])
        flexion = walk.joint_angles("zxy")[:, walk.joints.index("jLeftKnee"), 2]
        np.testing.assert_array_equal(frame["joint_angles_jLeftKnee_z"].to_numpy(), flexion)
        np.testing.assert_array_equal(frame["contact_LeftFoot_Heel"].to_numpy(), walk.contacts[:, 0])
    arrow = pyarrow.table(walk.to_arrow(["center_of_mass"]))
    assert arrow.column_names == [
        "subject",
        "sample",
        "time",
        "timecode",
        "center_of_mass_x",
        "center_of_mass_y",
        "center_of_mass_z",
    ]


@pytest.fixture
def marked(walk, tmp_path):
    """Four samples, the first without a time of day, the third with two events."""
    path = tmp_path / "marked.mvnx"
    walk.write(path, last=3)
    frames = path.read_text().split("<frame ")
    for place, frame in enumerate(frames):
        if 'index="0"' in frame:
            frames[place] = re.sub(' (tc|ms)="[^"]*"', "", frame)
        if 'index="2"' in frame:
            frames[place] = frame.replace("</frame>", "<marker>step</marker><marker>left</marker></frame>")
    path.write_text("<frame ".join(frames))
    return posewire.read(path)


def test_tables_have_times_of_day_events_and_contacts(marked):
    pyarrow = pytest.importorskip("pyarrow")
    assert marked.events == [(2, "step"), (2, "left")]
    table = pyarrow.table(marked.to_arrow())
    assert table.schema.field("timecode").type == pyarrow.time32("ms")
    times = table["timecode"].to_pylist()
    since_midnight = [3600 * t.hour + 60 * t.minute + t.second + t.microsecond / 1e6 for t in times[1:]]
    assert times[0] is None and np.isnan(marked.timecode[0])
    np.testing.assert_allclose(since_midnight, marked.timecode[1:], atol=1e-6)
    assert table["event"].to_pylist() == [None, None, "step; left", None]
    contacts = [name for name in table.column_names if name.startswith("contact_")]
    assert len(contacts) == 4
    np.testing.assert_array_equal(np.stack([table[name] for name in contacts], -1), marked.contacts)
    assert pyarrow.table(marked.to_arrow(["position"])).column_names[3:5] == ["timecode", "position_Pelvis_x"]


def test_tables_are_asked_with_sql(marked):
    pytest.importorskip("pyarrow")
    duckdb = pytest.importorskip("duckdb")
    rows = marked.to_arrow()
    events = duckdb.sql("select sample, event from rows where event is not null").fetchall()
    assert events == [(2, "step; left")]
    highest = duckdb.from_arrow(rows).aggregate("max(position_Head_z), count(timecode)").fetchall()
    assert highest == [(marked.position[:, 6, 2].max(), 3)]


def test_columns_are_those_of_parquet(marked, tmp_path):
    polars = pytest.importorskip("polars")
    path = tmp_path / "marked.parquet"
    try:
        marked.write(path)
    except posewire.UsageError as error:
        assert error.help == 'pip install ./crates/py -C build-args="--features parquet"'
        pytest.skip("this build has no Parquet")
    names = polars.read_parquet(path).columns
    assert names == [name.replace("timecode", "timecode_ms") for name in marked.to_arrow().columns]


@pytest.mark.parametrize(
    ("name", "options", "message", "help"),
    [
        ("x.foo", {}, "x.foo: expected a name that ends in .mvnx .mvnx.gz .csv .bvh ", 'format="csv"'),
        ("x", {}, "x: expected a name that ends in .mvnx ", 'format="csv"'),
        ("x.mcap", {}, "x.mcap is made of a recording or capture, found a take: ", "posewire.Recorder"),
        ("x.mvn", {}, "x.mvn: the .mvn format is proprietary: expected a name that ends in ", "write .mvnx"),
        ("x.csv", {"format": "bvh"}, "x.csv ends as CSV does, and format= says BVH", "leave format out"),
        ("x.csv", {"format": "xls"}, 'unknown format "xls", expected mvnx, ', 'format="csv"'),
        ("x.csv", {"first": -1}, "expected a whole number from 0 to 4294967295 as first, found -1", None),
        ("x.csv", {"last": 2**80}, "expected a whole number from 0 to 4294967295 as last, found one of more", None),
        ("x.mvnx", {"mvnx_version": -4}, "there is no MVNX of version -4", "use 3 or 4"),
        ("x.csv", {"bvh_t_pose": True}, "bvh_t_pose= is for BVH, and CSV is written", "leave bvh_t_pose out"),
    ],
)
def test_what_cannot_be_written_says_what_can(walk, tmp_path, monkeypatch, name, options, message, help):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(posewire.UsageError) as raised:
        walk.write(name, **options)
    assert raised.value.message.startswith(message)
    assert raised.value.help is None if help is None else help in raised.value.help
    assert list(tmp_path.iterdir()) == []


def test_a_file_that_is_there_is_kept(walk, tmp_path):
    (tmp_path / "x.csv").touch()
    with pytest.raises(posewire.WriteError) as raised:
        walk.write(tmp_path / "x.csv")
    assert raised.value.help == "choose another name, or replace it with overwrite=True"


def test_paths_are_what_open_takes(walk, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name in "a.mvnx", b"b.mvnx", pathlib.Path("c.mvnx"), b"\xff.mvnx":
        walk.write(name, last=1)
        assert len(posewire.read(name)) == 2
    for name in None, 5, ["a.mvnx"]:
        with pytest.raises(TypeError, match="expected str, bytes or os.PathLike object, not"):
            posewire.read(name)


@pytest.mark.parametrize(
    ("path", "kind", "message", "help"),
    [
        ("", posewire.UsageError, 'expected the path of a file, found ""', 'as in read("walk.mvnx")'),
        ("folder", posewire.ReadError, "cannot read folder: is a directory", "name a file in this folder"),
        (
            "pipe.mvnx",
            posewire.ReadError,
            "cannot read pipe.mvnx: expected a file, found a pipe or a device",
            "copy it",
        ),
        (
            "pipe.mcap",
            posewire.ReadError,
            "cannot read pipe.mcap: expected a file, found a pipe or a device",
            "copy it",
        ),
        ("http://h/a.mvnx", posewire.UsageError, 'http://h/a.mvnx: unknown scheme "http"', "or the path of a file"),
        ("mxtp://127.0.0.1", posewire.UsageError, "expected a file, found mxtp://127.0.0.1:9763", "posewire.listen("),
    ],
)
def test_what_is_no_file_is_told(tmp_path, monkeypatch, path, kind, message, help):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "folder").mkdir()
    if path.startswith("pipe"):
        os.mkfifo(path)
    with pytest.raises(kind) as raised:
        posewire.read(path)
    assert raised.value.message.startswith(message) and help in raised.value.help


@pytest.mark.parametrize(
    ("path", "options", "message"),
    [
        ("synthetic:walk", {"duration": 1, "salvage": True}, "salvage= is for files, and synthetic:walk is the walker"),
        ("synthetic:walk", {"duration": 1, "threads": 2}, "threads= is for MVNX, and synthetic:walk is the walker"),
        ("x.mcap", {"threads": 2}, "threads= is for MVNX, and x.mcap is a recording or capture"),
        ("x.mvnx", {"only": "0"}, "only= is for recordings and captures, and x.mvnx is a file of a take"),
        ("x.mvnx", {"duration": 1}, "duration= is for synthetic:walk, and x.mvnx is a file of a take"),
        ("x.pcap", {"duration": 1}, "duration= is for synthetic:walk, and x.pcap is a recording or capture"),
        ("synthetic:walk", {}, "synthetic:walk never ends"),
        ("x.mvnx", {"threads": -1}, "expected a whole number from 0 to 4096 as threads, found -1"),
        ("synthetic:walk", {"duration": -1}, "expected seconds above 0 as the duration, found -1"),
        ("synthetic:walk", {"duration": float("nan")}, "expected seconds above 0 as the duration, found NaN"),
    ],
)
def test_arguments_that_cannot_be_heeded_are_refused(path, options, message):
    for read in posewire.read, posewire.read_all:
        with pytest.raises(posewire.UsageError) as raised:
            read(path, **options)
        assert raised.value.message == message


def test_a_damaged_take_says_how_it_is_used(walk, tmp_path):
    path = tmp_path / "cut.mvnx"
    walk.write(path)
    assert posewire.read(path).damage is None and posewire.read(path, salvage=True).damage is None
    path.write_bytes(path.read_bytes()[:-100_000])
    with pytest.raises(posewire.ReadError) as raised:
        posewire.read(path)
    assert raised.value.help.startswith("salvage=True uses the frames before the damage")
    take = posewire.read(path, salvage=True)
    assert 0 < len(take) < len(walk) and take.damage
