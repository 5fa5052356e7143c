"""What several tests need."""

import pathlib
import time

import pytest

import posewire

ROOT = pathlib.Path(__file__).parents[3]


def until(is_so):
    """Asks until it is so, and fails where that takes a minute."""
    end = time.monotonic() + 60
    while not is_so():
        assert time.monotonic() < end


@pytest.fixture(scope="session")
def walk():
    """Two seconds of the built-in walker at 240 Hz."""
    return posewire.read("synthetic:walk?rate=240", duration=2)


@pytest.fixture
def looped():
    """A stream that listens on a port of the system's choice, and a streamer of Ada's that sends there."""
    with posewire.listen("mxtp://127.0.0.1:0") as stream:
        with posewire.streamer(stream.url, names=["Ada"]) as streamer:
            yield stream, streamer
