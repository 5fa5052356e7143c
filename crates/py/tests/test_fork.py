"""A child of fork() has copies of what its parent opened, and cannot do any harm with them."""

import os
import subprocess
import sys
import textwrap

import pytest

pytestmark = pytest.mark.skipif(not hasattr(os, "fork"), reason="needs fork")

OPEN = """
import multiprocessing, os, sys, threading, warnings
import numpy as np
import posewire

warnings.simplefilter("ignore", DeprecationWarning)
still = np.zeros((23, 3)), np.tile([1.0, 0, 0, 0], (23, 1))
busy = posewire.listen("synthetic:walk?people=8&rate=1000")
stream = posewire.listen("mxtp://127.0.0.1:0")
streamer = posewire.streamer(stream.url)
recorder = posewire.Recorder("mxtp://127.0.0.1:0", path=sys.argv[1])
streamer.send(*still)
next(stream)
busy.latest()

def refused(use):
    try:
        use()
    except posewire.ClosedError as error:
        assert "was opened in another process" in error.message, error
        return
    raise AssertionError("it can be used")

def child():
    for use in (stream.latest, stream.next, stream.statistics, lambda: next(stream), lambda: stream.subjects, busy.latest,
                lambda: stream.dropped, lambda: stream.notices, recorder.progress, recorder.__enter__,
                lambda: streamer.send(*still),
                streamer.progress, lambda: streamer.notices, lambda: streamer.dropped):
        refused(use)
    assert stream.closed and streamer.closed and stream.url
    stream.close()
    busy.close()
    recorder.close()
    streamer.close()
    with posewire.listen("synthetic:walk") as own:
        assert next(own).sample == 0

def succeeds(pid):
    assert os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1]) == 0

def go_on():
    \"\"\"What the parent opened goes on as if there had been no child.\"\"\"
    streamer.send(*still)
    assert next(stream).sample == 1 and busy.latest() is not None
    assert recorder.progress()["failure"] is None
    recorder.close()
    with open(sys.argv[1], "rb") as file:
        assert file.read().endswith(b"\\x89MCAP0\\r\\n")
"""


@pytest.mark.parametrize(
    "program",
    [
        # Uses and closes what it cannot, and ends as a program does.
        """
        if (pid := os.fork()) == 0:
            child()
            sys.exit()
        succeeds(pid)
        """,
        # Only ends, with everything dropped on the way.
        """
        for _ in range(20):
            if (pid := os.fork()) == 0:
                del stream, busy, recorder, streamer
                sys.exit()
            succeeds(pid)
        """,
        """
        process = multiprocessing.get_context("fork").Process(target=child)
        process.start()
        process.join()
        assert process.exitcode == 0
        """,
        # In both processes an event loop waits.
        """
        import asyncio

        async def first(stream):
            return (await anext(aiter(stream))).sample

        def waits():
            with posewire.listen("mxtp://127.0.0.1:0") as own:
                sender = posewire.streamer(own.url)
                threading.Timer(0.1, sender.send, still).start()
                assert asyncio.run(first(own)) == 0
                sender.close()

        waits()
        if (pid := os.fork()) == 0:
            waits()
            sys.exit()
        succeeds(pid)
        waits()
        """,
    ],
)
def test_a_child_leaves_its_parent_s_alone(program, tmp_path):
    program = OPEN + textwrap.dedent(program) + "\ngo_on()\n"
    arguments = [sys.executable, "-c", program, str(tmp_path / "take.mcap")]
    ended = subprocess.run(arguments, timeout=30, capture_output=True, text=True)
    assert (ended.returncode, ended.stderr) == (0, "")
