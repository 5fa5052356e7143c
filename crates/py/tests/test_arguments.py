"""What makes no sense to listen to or to record is refused at once, in the words of the command line."""

import math
import pathlib

import numpy as np
import pytest

import posewire

LIVE = "mxtp://127.0.0.1:0"


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"capacity": 0}, "expected a whole number from 1 to 100000000 as capacity, found 0"),
        ({"capacity": -3}, "expected a whole number from 1 to 100000000 as capacity, found -3"),
        ({"stale_after": 2.0}, "expected stale_after to be no longer than lost_after, found 2 and 1"),
        ({"stale_after": -0.1}, "expected seconds as stale_after, 0 or more, found -0.1"),
        ({"stale_after": math.nan}, "expected seconds as stale_after, 0 or more, found NaN"),
        ({"lost_after": math.nan}, "expected seconds as lost_after, 0 or more, found NaN"),
        ({"on_overflow": "drop"}, 'expected on_overflow "raise" or "count", found "drop"'),
        ({"speed": 0}, "expected a finite playback speed above 0, found 0"),
        ({"speed": -1}, "expected a finite playback speed above 0, found -1"),
        ({"speed": math.nan}, "expected a finite playback speed above 0, found NaN"),
        ({"speed": math.inf}, "expected a finite playback speed above 0, found inf"),
        ({"speed": 2}, "speed= is for files, recordings and captures, and mxtp://127.0.0.1:0 is none"),
        ({"loop": True}, "loop= is for files, recordings and captures, and mxtp://127.0.0.1:0 is none"),
        ({"only": "0"}, "only= is for recordings and captures, and mxtp://127.0.0.1:0 is none"),
    ],
)
def test_listening_refuses(arguments, message):
    with pytest.raises(posewire.UsageError) as raised:
        posewire.listen(LIVE, **arguments)
    assert raised.value.message == message


def test_what_cannot_be_listened_to_is_named():
    with pytest.raises(posewire.UsageError, match="expected where to listen, found nothing"):
        posewire.listen()
    with pytest.raises(posewire.UsageError, match="expected each url once, found mxtp://0.0.0.0:9763 twice"):
        posewire.listen("mxtp://0.0.0.0:9763", "mxtp://0.0.0.0")
    for wrong in (b"mxtp://127.0.0.1:0", 9763, None, ["mxtp://127.0.0.1:0"]):
        with pytest.raises(TypeError, match=f"a str or os.PathLike, found {type(wrong).__name__}"):
            posewire.listen(wrong)
    with pytest.raises(posewire.UsageError, match="expected seconds as the timeout, found NaN"):
        with posewire.listen("synthetic:walk") as stream:
            next(stream)
            stream.latest(timeout=math.nan)


def test_paths_are_played(walk, tmp_path):
    walk.write(tmp_path / "walk.mvnx", last=9)
    for path in (tmp_path / "walk.mvnx", str(tmp_path / "walk.mvnx"), pathlib.PurePath(tmp_path, "walk.mvnx")):
        with posewire.listen(path, speed=50) as stream:
            assert [frame.sample for frame in stream] == list(range(10))
    with pytest.raises(posewire.UsageError, match="only= is for recordings and captures"):
        posewire.listen(tmp_path / "walk.mvnx", only="0")
    with pytest.raises(posewire.ReadError, match="missing.mvnx"):
        posewire.listen(tmp_path / "missing.mvnx")


def test_a_sample_may_live_for_ever():
    with posewire.listen("synthetic:walk", stale_after=math.inf, lost_after=math.inf) as stream:
        assert next(stream).state == posewire.LIVE
    with posewire.listen("synthetic:walk", stale_after=0, lost_after=math.inf) as stream:
        assert next(stream).state == posewire.STALE


@pytest.mark.parametrize(
    ("urls", "arguments", "message"),
    [
        ([], {}, "expected what to record, found nothing"),
        ([LIVE], {"split_megabytes": 0}, "expected a whole number from 1 to 1000000 as split_megabytes, found 0"),
        ([LIVE], {"split_megabytes": -1}, "expected a whole number from 1 to 1000000 as split_megabytes, found -1"),
        ([LIVE], {"path": "take.mvnx"}, "record writes MCAP files, take.mvnx says mvnx"),
        ([LIVE], {"path": "take.pcapng"}, "record writes MCAP files, take.pcapng says pcapng"),
        (["take.mvnx"], {}, "expected a live stream to record, as mxtp://0.0.0.0:9763, found take.mvnx"),
    ],
)
def test_recording_refuses(tmp_path, urls, arguments, message):
    with pytest.raises(posewire.UsageError) as raised:
        posewire.Recorder(*urls, **{"path": tmp_path / "take.mcap", **arguments})
    assert raised.value.message == message
    assert not list(tmp_path.iterdir())


def test_where_nothing_can_be_recorded_is_said(tmp_path):
    with pytest.raises(posewire.WriteError, match="missing/take.mcap") as raised:
        posewire.Recorder(LIVE, path=tmp_path / "missing" / "take.mcap")
    assert raised.value.help == "make the folder first, or write elsewhere"
    # The file to write was given as the source.
    with pytest.raises(posewire.ReadError, match="take.mcap"):
        posewire.Recorder(tmp_path / "take.mcap", path=tmp_path / "other.mcap")
    with pytest.raises(TypeError, match="path"):
        posewire.Recorder(LIVE, str(tmp_path / "take.mcap"))


def test_a_lone_name_is_no_list_of_names(walk, tmp_path):
    skeleton = posewire.Skeleton.standard()
    for ask in (
        lambda: posewire.Skeleton("abc"),
        lambda: posewire.Skeleton.standard(sensors="abc"),
        lambda: walk.to_arrow("abc"),
        lambda: walk.write(tmp_path / "x.csv", sections="abc"),
    ):
        with pytest.raises(TypeError, match="expected a list of names, found 'abc'"):
            ask()
    with pytest.raises(TypeError, match=r"expected a list of names, found \(\['velocity'\],\)"):
        walk.complete(["velocity"])
    with posewire.streamer("mxtp://127.0.0.1:9", skeleton=skeleton) as streamer:
        with pytest.raises(posewire.UsageError) as raised:
            streamer.send(np.full((len(skeleton), 3), 1e300), np.tile([1.0, 0, 0, 0], (len(skeleton), 1)))
    assert "found [1e300, 1e300, 1e300]" in raised.value.message
