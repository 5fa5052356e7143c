"""Live streams: what is sent arrives, and what is lost is told."""

import math
import signal
import threading

import numpy as np
import pytest
from conftest import until

import posewire


def send(streamer, take, count, first=0):
    for place in range(first, first + count):
        streamer.send(take.position[place], take.orientation[place])


def test_every_sample_that_is_sent_arrives_in_order(walk, looped):
    stream, streamer = looped
    send(streamer, walk, 100)
    frames = [stream.next(timeout=10) for _ in range(100)]
    assert [frame.sample for frame in frames] == list(range(100))
    assert {frame.subject for frame in frames} == {"Ada"} and stream.subjects == ["Ada"]
    np.testing.assert_array_equal([frame.position for frame in frames], np.float32(walk.position[:100]).astype(float))
    np.testing.assert_allclose([frame.orientation for frame in frames], walk.orientation[:100], atol=1e-6)
    assert frames[-1].segments == walk.segments and frames[-1].time == pytest.approx(99 / 240, abs=2e-3)
    assert stream.dropped == 0 and stream.next(timeout=0) is None


def test_the_latest_is_the_newest_with_its_age(walk):
    with posewire.listen("mxtp://127.0.0.1:0", lost_after=math.inf) as stream:
        assert stream.latest(timeout=0) is None
        with posewire.streamer(stream.url, names=["Ada"]) as streamer:
            send(streamer, walk, 1)
            assert stream.latest(timeout=10).sample == 0 and stream.latest().age >= 0
            assert stream.latest(subject="Bob", timeout=0) is None
            send(streamer, walk, 1, first=1)
        until(lambda: stream.latest().sample == 1)
        until(lambda: stream.latest().state == posewire.STALE)
        assert stream.latest().age >= 0.1
        assert stream.latest(subject="Ada").sample == 1


def test_a_stream_survives_its_source(walk):
    with posewire.listen("mxtp://127.0.0.1:0", lost_after=0.2) as stream:
        for _ in range(2):
            with posewire.streamer(stream.url) as streamer:
                send(streamer, walk, 5)
            assert stream.next(timeout=10) is not None
            until(lambda: stream.latest(timeout=10).state == posewire.LOST)
        assert not stream.closed


@pytest.mark.parametrize("on_overflow", ["raise", "count"])
def test_what_finds_no_room_is_told(walk, looped, on_overflow):
    with posewire.listen("mxtp://127.0.0.1:0", capacity=10, on_overflow=on_overflow) as stream:
        with posewire.streamer(stream.url) as streamer:
            send(streamer, walk, 20)
            until(lambda: stream.latest(timeout=10).sample == 19)
            # Nobody had begun to read: the newest ten are there, and nothing is missed.
            assert stream.next(timeout=10).sample == 10 and stream.dropped == 0
            send(streamer, walk, 20)
            until(lambda: stream.latest().sample == 39)
        if on_overflow == "raise":
            with pytest.raises(posewire.OverflowError, match="19 samples are gone"):
                stream.next()
        assert stream.dropped == 19 and stream.next().sample == 11


def test_a_played_take_ends_the_loop(walk, tmp_path):
    walk.write(tmp_path / "walk.mvnx", last=59)
    with posewire.listen(str(tmp_path / "walk.mvnx"), speed=100) as stream:
        assert [frame.sample for frame in stream] == list(range(60))
        assert stream.closed and stream.next() is None


def test_natnet_serves_and_listens(walk):
    with posewire.streamer("natnet://127.0.0.1:0?data-port=0", names=["Ada", "Bob"]) as streamer:
        with posewire.listen(streamer.urls[0]) as stream:
            # A minute at most: who connects meanwhile sees what is sent from then on.
            for place in (turn % 480 for turn in range(6000)):
                streamer.send(walk.position[place], walk.orientation[place])
                streamer.send(walk.position[place], walk.orientation[place], subject=1)
                frame = stream.next(timeout=0.01)
                if frame is not None and frame.sample >= 5:
                    break
            np.testing.assert_allclose(frame.position, walk.position[frame.sample % 480], atol=1e-5)
            assert frame.subject in ("Ada", "Bob")


def test_what_is_not_tracked_is_nan(looped):
    stream, streamer = looped
    position, orientation = np.zeros((23, 3)), np.tile([1.0, 0, 0, 0], (23, 1))
    position[5] = orientation[5] = np.nan
    streamer.send(position, orientation)
    frame = stream.latest(timeout=10)
    assert np.isnan(frame.position[5]).all() and np.isnan(frame.orientation[5]).all()
    assert not np.isnan(frame.position[4]).any()


def test_wrong_arguments_are_named(looped):
    stream, streamer = looped
    with pytest.raises(
        posewire.UsageError, match=r"expected an array of \(23, 3\) as position, found one of \(22, 3\)"
    ):
        streamer.send(np.zeros((22, 3)), np.zeros((23, 4)))
    with pytest.raises(posewire.UsageError, match="there is no section"):
        streamer.send(np.zeros((23, 3)), np.zeros((23, 4)), speed=np.zeros((23, 3)))
    streamer.close()
    with pytest.raises(posewire.ClosedError):
        streamer.send(np.zeros((23, 3)), np.zeros((23, 4)))
    with pytest.raises(posewire.UsageError, match="unknown scheme"):
        posewire.listen("osc://127.0.0.1:9000")
    with pytest.raises(posewire.NetworkError):
        posewire.listen(stream.url)
    with pytest.raises(posewire.UsageError):
        posewire.streamer(stream.url, types="99")


def test_statistics_are_those_of_the_command_line(looped, walk):
    stream, streamer = looped
    send(streamer, walk, 10)
    until(lambda: any(record["kind"] == "statistics" for record in stream.statistics()))
    by_kind = {record["kind"]: record for record in stream.statistics()}
    assert by_kind["receiver"]["malformed"] == 0
    assert by_kind["statistics"]["name"] == "Ada" and "missing" in by_kind["statistics"]


@pytest.mark.skipif(not hasattr(signal, "setitimer"), reason="needs a timer that signals")
@pytest.mark.parametrize(
    "wait", [next, lambda stream: stream.next(timeout=60), lambda stream: stream.latest(timeout=60)]
)
def test_a_signal_ends_waiting(wait):
    def interrupt(number, frame):
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGALRM, interrupt)
    try:
        with posewire.listen("mxtp://127.0.0.1:0") as stream:
            signal.setitimer(signal.ITIMER_REAL, 0.05)
            with pytest.raises(KeyboardInterrupt):
                wait(stream)
    finally:
        signal.signal(signal.SIGALRM, before)


def test_other_threads_run_while_one_waits(walk, looped):
    stream, streamer = looped
    taken = []
    thread = threading.Thread(target=lambda: taken.append(stream.next(timeout=60)))
    thread.start()
    send(streamer, walk, 2)
    thread.join(timeout=60)
    assert taken[0].sample == 0
