"""Recordings are complete, whatever ends them."""

import os
import signal
import time

import numpy as np
import pytest
from conftest import until

import posewire

STILL = np.zeros((23, 3)), np.tile([1.0, 0, 0, 0], (23, 1))
COMPLETE = b"\x89MCAP0\r\n"


def test_what_is_recorded_can_be_read_and_played(walk, tmp_path):
    path = tmp_path / "take.mcap"
    with posewire.Recorder("mxtp://127.0.0.1:0", path=path) as recorder:
        with posewire.streamer(recorder.urls[0], names=["Ada"]) as streamer:
            for place in range(20):
                streamer.send(walk.position[place], walk.orientation[place])
    take = posewire.read(path)
    assert take.subject == "Ada" and list(take.sample) == list(range(20))
    with posewire.listen(path, speed=20, only="0") as stream:
        np.testing.assert_array_equal([frame.position for frame in stream], take.position)


def test_closing_again_does_nothing_and_the_numbers_stay(tmp_path):
    recorder = posewire.Recorder("mxtp://127.0.0.1:0", path=tmp_path / "take.mcap")
    with posewire.streamer(recorder.urls[0]) as streamer:
        streamer.send(*STILL)
    # The source goes; the recording waits for the next.
    with recorder as same:
        assert same is recorder
        with posewire.streamer(recorder.urls[0]) as streamer:
            streamer.send(*STILL, sample=1)
    told = recorder.progress()
    assert (told["frames"], told["failure"]) == (2, None) and told["bytes"] == told["file"].stat().st_size
    recorder.close()
    assert recorder.progress() == told
    with pytest.raises(posewire.ClosedError, match="the recorder is closed"):
        with recorder:
            pass
    assert told["file"].read_bytes().endswith(COMPLETE)


@pytest.mark.skipif(not hasattr(signal, "setitimer"), reason="needs a timer that signals")
def test_a_signal_while_it_closes_leaves_a_complete_file(tmp_path):
    def interrupt(number, frame):
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGALRM, interrupt)
    try:
        for place in range(10):
            path = tmp_path / f"{place}.mcap"
            recorder = posewire.Recorder("mxtp://127.0.0.1:0", path=path)
            signal.setitimer(signal.ITIMER_REAL, 0.001 * (place + 1))
            with pytest.raises(KeyboardInterrupt):
                with recorder:
                    pass
                while True:
                    time.sleep(0.001)
            recorder.close()
            assert path.read_bytes().endswith(COMPLETE)
    finally:
        signal.signal(signal.SIGALRM, before)


def test_a_file_that_is_there_is_kept(tmp_path):
    path = tmp_path / "take.mcap"
    path.write_bytes(b"precious")
    for spelled in (path, str(path), os.fsencode(path)):
        with pytest.raises(posewire.WriteError, match="take.mcap"):
            posewire.Recorder("mxtp://127.0.0.1:0", path=spelled)
    assert path.read_bytes() == b"precious"


def test_a_recorder_says_whether_it_is_closed_and_what_its_sources_said(tmp_path):
    with posewire.Recorder("mxtp+tcp://127.0.0.1:0", path=os.fsencode(tmp_path / "take.mcap")) as recorder:
        assert not recorder.closed
        with posewire.streamer(recorder.urls[0].split("?")[0], skeleton=posewire.Skeleton.standard()):
            until(lambda: any("connected" in notice for notice in recorder.notices))
    assert recorder.closed and recorder.notices
