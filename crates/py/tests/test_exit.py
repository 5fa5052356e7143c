"""Everything ends: with Python, with the last reference, and without leaving anything behind."""

import asyncio
import gc
import os
import subprocess
import sys
import threading
import weakref

import numpy as np
import pytest

import posewire

STILL = np.zeros((23, 3)), np.tile([1.0, 0, 0, 0], (23, 1))

ASYNCHRONOUS = """
async def all(stream):
    async for frame in stream:
        pass
async def some():
    global task
    task = asyncio.ensure_future(all(posewire.listen('{url}')))
    await asyncio.sleep(0.1)
"""


@pytest.mark.parametrize(
    "program",
    [
        "stream = posewire.listen('mxtp://127.0.0.1:0')",
        "stream = posewire.listen('synthetic:walk'); next(stream)",
        "stream = posewire.listen('synthetic:walk?rate=1000&people=16'); next(stream)",
        "stream = posewire.listen('mxtp://127.0.0.1:0')\n"
        "threading.Thread(target=lambda: next(stream), daemon=True).start()",
        "stream = posewire.listen('synthetic:walk?rate=1000')\n"
        "threading.Thread(target=lambda: list(stream), daemon=True).start(); next(stream)",
        "stream = posewire.listen('synthetic:walk')\n"
        "threading.Thread(target=lambda: list(stream)).start(); next(stream); stream.close()",
        "streamer = posewire.streamer('mxtp+tcp://127.0.0.1:0?mode=listen')",
        "streamer = posewire.streamer('natnet://127.0.0.1:0?data-port=0')",
        "recorder = posewire.Recorder('mxtp://127.0.0.1:0', path=sys.argv[1])",
        # A task that is cancelled at the end, one that nobody cancels, and one of a loop that goes on beside.
        ASYNCHRONOUS.format(url="mxtp://127.0.0.1:0") + "asyncio.run(some())",
        ASYNCHRONOUS.format(url="synthetic:walk?rate=1000") + "asyncio.run(some())",
        ASYNCHRONOUS.format(url="mxtp://127.0.0.1:0")
        + "loop = asyncio.new_event_loop(); loop.run_until_complete(some()); task._log_destroy_pending = False",
        ASYNCHRONOUS.format(url="synthetic:walk?rate=1000")
        + "loop = asyncio.new_event_loop(); task = loop.create_task(some())\n"
        "threading.Thread(target=loop.run_forever, daemon=True).start(); time.sleep(0.3); task._log_destroy_pending = False",
    ],
)
def test_a_program_ends_with_everything_open(program, tmp_path):
    program = f"import asyncio, posewire, sys, threading, time\n{program}\n"
    arguments = [sys.executable, "-c", program, str(tmp_path / "take.mcap")]
    ended = subprocess.run(arguments, timeout=60, capture_output=True, text=True)
    assert (ended.returncode, ended.stderr) == (0, "")


def test_a_recording_is_complete_when_python_ends(tmp_path):
    program = """
import posewire, numpy, sys
recorder = posewire.Recorder("mxtp://127.0.0.1:0", path=sys.argv[1])
streamer = posewire.streamer(recorder.urls[0], names=["Ada"])
for _ in range(20):
    streamer.send(numpy.zeros((23, 3)), numpy.tile([1.0, 0, 0, 0], (23, 1)))
streamer.close()
"""
    path = tmp_path / "take.mcap"
    subprocess.run([sys.executable, "-c", program, str(path)], timeout=60, check=True)
    assert path.read_bytes().endswith(b"\x89MCAP0\r\n")
    assert list(posewire.read(path).sample) == list(range(20))


def used():
    """Descriptors, threads, and memory in bytes."""
    if not os.path.isdir("/proc/self/fd"):
        pytest.skip("needs /proc")
    with open("/proc/self/statm") as pages:
        memory = int(pages.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")
    return len(os.listdir("/proc/self/fd")), len(os.listdir("/proc/self/task")), memory


def exchange(_):
    """Opens both ends, sends, waits for what arrives, and closes them."""

    async def first(stream):
        return await anext(aiter(stream))

    with posewire.listen("mxtp://127.0.0.1:0") as stream:
        with posewire.streamer(stream.url) as streamer:
            streamer.send(*STILL)
            # With the second it is known that the first is complete.
            streamer.send(*STILL)
            assert asyncio.run(first(stream)).sample == 0


# What is opened and closed, and how many times as often as the slowest of them: a listener ten thousand times.
OPENED = {
    "listen": (lambda _: posewire.listen("mxtp://127.0.0.1:0").close(), 200),
    "walk": (lambda _: posewire.listen("synthetic:walk").close(), 40),
    "streamer": (lambda _: posewire.streamer("mxtp://127.0.0.1:9").close(), 40),
    "server": (lambda _: posewire.streamer("natnet://127.0.0.1:0?data-port=0").close(), 1),
    "recorder": (lambda path: posewire.Recorder("mxtp://127.0.0.1:0", path=path, overwrite=True).close(), 5),
    "exchange": (exchange, 1),
}


@pytest.mark.parametrize("name", OPENED)
def test_what_is_opened_and_closed_leaves_nothing_behind(name, tmp_path):
    cycle, often = OPENED[name]
    for _ in range(20):
        cycle(tmp_path / "take.mcap")
    descriptors, threads, memory = used()
    for _ in range(often * int(os.environ.get("POSEWIRE_CYCLES", "50"))):
        cycle(tmp_path / "take.mcap")
    now = used()
    assert now[:2] == (descriptors, threads)
    # However often. Five hundred streams that are closed and kept have 2.6 MB, as many streamers twice that.
    assert now[2] - memory < (1 << 20), f"grown by {now[2] - memory} bytes"


def test_what_is_left_open_is_seen():
    descriptors, threads, _ = used()
    with posewire.listen("mxtp://127.0.0.1:0"):
        assert used()[0] > descriptors and used()[1] > threads


@pytest.mark.parametrize(
    "make",
    [
        lambda folder: posewire.listen("mxtp://127.0.0.1:0"),
        lambda folder: posewire.Recorder("mxtp://127.0.0.1:0", path=folder / "take.mcap"),
    ],
)
def test_what_nobody_refers_to_any_more_is_closed(make, tmp_path):
    opened = make(tmp_path)
    url = opened.urls[0]
    gone = []
    weakref.finalize(opened, gone.append, url)
    del opened
    gc.collect()
    assert gone == [url]
    # Its port is free.
    posewire.listen(url).close()


def test_closing_ends_a_loop_in_another_thread():
    stream = posewire.listen("mxtp://127.0.0.1:0")
    thread = threading.Thread(target=lambda: list(stream))
    thread.start()
    stream.close()
    thread.join(timeout=30)
    assert not thread.is_alive() and stream.closed
    stream.close()
