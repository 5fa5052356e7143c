"""Takes of recordings and captures: what was sent, up to the damage."""

import os
import pathlib
import subprocess
import sys

import numpy as np
import pytest
from conftest import until

import posewire


def run(*arguments):
    command = [sys.executable, "-m", "posewire", *arguments]
    return subprocess.run(command, capture_output=True, text=True, timeout=120)


@pytest.fixture(scope="module")
def recording(tmp_path_factory):
    """Half a second of Ada and Bob at one port, and of Eve at another."""
    path = tmp_path_factory.mktemp("recordings") / "take.mcap"
    urls = ["mxtp://127.0.0.1:0"] * 2
    with posewire.Recorder(*urls, path=path) as recorder:
        first, second = recorder.urls
        with (
            posewire.listen("synthetic:walk") as pace,
            posewire.streamer(first, names=["Ada", "Bob"]) as pair,
            posewire.streamer(second, names=["Eve"]) as single,
        ):
            for frame, _ in zip(pace, range(120)):
                pair.send(frame.position, frame.orientation)
                pair.send(frame.position, frame.orientation, subject=1)
                single.send(frame.position, frame.orientation)
        until(lambda: recorder.progress()["frames"] >= 340)
    return path


@pytest.fixture(scope="module", params=["pcap", "pcapng"])
def capture(request, recording):
    """The same packet by packet."""
    path = recording.with_suffix("." + request.param)
    assert run("convert", str(recording), str(path)).returncode == 0
    return path


def cut(path, name, share=0.6):
    """The beginning of a file, as when its writer was killed."""
    whole = path.read_bytes()
    short = path.with_name(name)
    short.write_bytes(whole[: int(len(whole) * share)])
    return short


def test_a_recording_gives_the_takes_that_were_sent(recording, walk):
    with pytest.raises(posewire.MissingError, match="expected one take, found Ada, Bob, Eve"):
        posewire.read(recording)
    takes = posewire.read_all(recording)
    assert [take.subject for take in takes] == ["Ada", "Bob", "Eve"]
    take = posewire.read(recording, subject="Bob")
    assert take.damage is None
    assert take.rate == pytest.approx(240, rel=0.02), "by the clock of the stream, whose milliseconds leave it open"
    np.testing.assert_allclose(take.position, walk.position[take.sample], atol=1e-5)


def test_one_source_is_chosen(recording):
    assert [take.subject for take in posewire.read_all(recording, only="0")] == ["Ada", "Bob"]
    assert posewire.read(recording, only=1).subject == posewire.read(recording, only="1").subject == "Eve"
    with pytest.raises(TypeError, match="expected the number of a source or a part of its name"):
        posewire.read(recording, only=0.5)
    with pytest.raises(posewire.UsageError) as raised:
        posewire.read(recording, only="7")
    assert 'expected one source "7", found 0 mxtp://127.0.0.1:' in raised.value.message
    assert raised.value.help == 'choose one by number or name, as in only="0"'


def test_packets_give_the_takes_of_the_recording(recording, capture):
    takes = sorted(posewire.read_all(capture), key=lambda take: take.subject)
    for expected, take in zip(posewire.read_all(recording), takes, strict=True):
        assert (take.subject, take.rate, take.damage) == (expected.subject, expected.rate, None)
        for name in ("sample", "time", "position", "orientation"):
            np.testing.assert_array_equal(getattr(take, name), getattr(expected, name))
    sources = [[take.subject for take in posewire.read_all(capture, only=source)] for source in "01"]
    assert sorted(sources) == [["Ada", "Bob"], ["Eve"]]


def assert_is_used_up_to_the_damage(short, whole):
    with pytest.raises(posewire.ReadError) as raised:
        posewire.read_all(short)
    error = raised.value
    assert error.message.startswith(f"{short}: the file is damaged: ") and "salvage=True" in error.help
    converted = run("convert", str(short), str(short.with_suffix(".csv")), "--overwrite")
    assert converted.returncode == 3, "data is lost"
    assert error.message.removeprefix(f"{short}: ") in converted.stderr
    for expected, take in zip(posewire.read_all(whole), posewire.read_all(short, salvage=True), strict=True):
        assert take.damage and f": {take.damage}" in error.message
        assert 0 < len(take) < len(expected)
        np.testing.assert_array_equal(take.position, expected.position[: len(take)])


def test_a_recording_that_was_cut_off_is_used_when_asked(recording):
    assert_is_used_up_to_the_damage(cut(recording, "short.mcap"), recording)


def test_packets_that_were_cut_off_are_used_when_asked(capture):
    assert_is_used_up_to_the_damage(cut(capture, f"short{capture.suffix}"), capture)


def test_damage_in_the_middle_ends_a_recording(recording):
    whole = bytearray(recording.read_bytes())
    whole[len(whole) * 6 // 10] ^= 0xFF
    path = recording.with_name("flipped.mcap")
    path.write_bytes(whole)
    assert_is_used_up_to_the_damage(path, recording)


def test_what_was_recovered_is_whole(recording):
    short, mended = cut(recording, "killed.mcap"), recording.with_name("mended.mcap")
    assert run("inspect", str(short), "--recover", "-o", str(mended)).returncode in (0, 3)
    expected = posewire.read_all(short, salvage=True)
    for take, used in zip(posewire.read_all(mended), expected, strict=True):
        assert take.damage is None
        np.testing.assert_array_equal(take.position, used.position)


def test_an_interrupt_ends_reading_a_recording(recording, walked):
    class Interrupted(Exception):
        pass

    def interrupt(done, total):
        raise Interrupted

    for path in recording, walked:
        with pytest.raises(Interrupted):
            posewire.read_all(path, progress=interrupt)


def test_names_need_not_be_utf8(recording, capture):
    for path in recording, capture:
        name = os.fsencode(path.with_name("x")) + b"\xff" + os.fsencode(path.suffix)
        try:
            pathlib.Path(os.fsdecode(name)).write_bytes(path.read_bytes())
        except OSError:
            pytest.skip("this file system wants UTF-8")
        for spelled in name, os.fsdecode(name), pathlib.Path(os.fsdecode(name)):
            assert len(posewire.read_all(spelled)) == 3


@pytest.fixture(scope="module")
def walked(tmp_path_factory):
    """The walker, which has no datagrams, recorded for a moment."""
    path = tmp_path_factory.mktemp("walked") / "walk.mcap"
    ended = run("record", "synthetic:walk?people=2&props=1", "-o", str(path), "--duration", "0.5")
    assert ended.returncode == 0, ended.stderr
    return path


def test_poses_alone_are_takes(walked, tmp_path):
    expected = posewire.read_all("synthetic:walk?people=2&props=1", duration=2)
    for take, walk in zip(posewire.read_all(walked), expected, strict=True):
        assert len(take) > 60 and take.rate == 240 and take.damage is None
        assert (take.subject, take.segments, take.joints) == (walk.subject, walk.segments, walk.joints)
        assert take.sections == ["position", "orientation"]
        for name in ("position", "orientation", "time"):
            np.testing.assert_array_equal(getattr(take, name), getattr(walk, name)[take.sample])
        angles = take.complete("joint_angles").joint_angles()
        np.testing.assert_allclose(angles, walk.joint_angles()[take.sample], atol=1e-9)
    short = cut(walked, "short.mcap")
    with pytest.raises(posewire.ReadError, match="the file is damaged: the recording was cut off"):
        posewire.read_all(short)
    assert all(take.damage for take in posewire.read_all(short, salvage=True))


def test_poses_beside_datagrams_are_told_of_and_read_when_they_are_named(tmp_path):
    path = tmp_path / "both.mcap"
    skeleton = posewire.Skeleton.standard()
    with posewire.Recorder("mxtp://127.0.0.1:0", "synthetic:walk", path=path) as recorder:
        with posewire.streamer(recorder.urls[0], skeleton=skeleton, names=["Robot"]) as streamer:

            def recorded():
                streamer.send(skeleton.origins, np.tile([1.0, 0, 0, 0], (len(skeleton), 1)))
                return recorder.progress()["datagrams"] > 5 and recorder.progress()["frames"] > 40

            until(recorded)
    words = "both.mcap: left out: the poses of 1 synthetic:walk"
    with pytest.warns(UserWarning, match=words):
        assert posewire.read(path).subject == "Robot"
    walk = posewire.read(path, only=1)
    assert walk.subject != "Robot" and len(walk) > 5
    with pytest.raises(posewire.UsageError):
        posewire.read(path, only=2)
    ended = run("convert", str(path), str(tmp_path / "robot.csv"))
    assert ended.returncode == 0 and words in ended.stderr
    ended = run("convert", str(path), str(tmp_path / "walk.csv"), "--only", "synthetic")
    assert ended.returncode == 0 and words not in ended.stderr


def test_the_command_line_plays_poses_alone(walked, tmp_path):
    ended = run("convert", str(walked), str(tmp_path / "walk.csv"))
    assert ended.returncode == 0, ended.stderr
    assert len(list(tmp_path.glob("walk_*.csv"))) == 2
    ended = run("stream", str(walked), "--to", "mxtp://127.0.0.1:9")
    assert ended.returncode == 0, ended.stderr
    for arguments in (
        ["replay", str(walked), "--to", "mxtp://127.0.0.1:9"],
        ["monitor", str(walked), "--json"],
        ["doctor", str(walked)],
        ["convert", str(walked), str(tmp_path / "walk.pcapng")],
        ["convert", str(walked), str(tmp_path / "other.mcap")],
    ):
        ended = run(*arguments)
        assert ended.returncode == 1, arguments
        assert f"error: {walked}: expected datagrams, found poses alone" in ended.stderr
        assert f"help: posewire stream {walked} --to mxtp://127.0.0.1 sends them" in ended.stderr
    assert not list(tmp_path.glob("*.pcapng")) and not list(tmp_path.glob("*.mcap"))


def test_poses_alone_are_listened_to(walked):
    with posewire.listen(str(walked), speed=10) as stream:
        frame = next(stream)
        assert frame.subject and frame.position.shape == (24, 3)
