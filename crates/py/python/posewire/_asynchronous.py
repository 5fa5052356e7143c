"""Samples of a stream for asyncio, and for every event loop that has its interface."""

from __future__ import annotations

import asyncio
import atexit
import itertools
import os
import threading
from typing import TYPE_CHECKING

from ._posewire import Bell

if TYPE_CHECKING:
    from ._posewire import Frame, Stream


class Samples:
    """An asynchronous iterator of all samples."""

    def __init__(self, stream: Stream) -> None:
        self._stream = stream
        self._at_once = 0

    def __aiter__(self) -> Samples:
        return self

    async def __anext__(self) -> Frame:
        self._at_once += 1
        if self._at_once == _MOST_AT_ONCE:
            # Where samples are always there, other tasks come to their turn too.
            self._at_once = 0
            await asyncio.sleep(0)
        while (frame := self._stream._take()) is None:
            if self._stream.closed:
                # One may have come between the two questions.
                if (frame := self._stream._take()) is not None:
                    return frame
                raise StopAsyncIteration
            self._at_once = 0
            await _sleepers().sleep(self._stream)
        return frame


class _Sleepers:
    """Those who wait for samples, on whatever event loop. One thread wakes them all, when the engine rings for them."""

    def __init__(self) -> None:
        self._bell = Bell()
        self._numbers = itertools.count()
        self._futures: dict[int, asyncio.Future[None]] = {}
        self._thread = threading.Thread(target=self._wake, name="posewire-asyncio", daemon=True)
        self._thread.start()

    async def sleep(self, stream: Stream) -> None:
        """Waits until the stream has a sample or has ended; now and then for nothing, if another task has taken it."""
        future = asyncio.get_running_loop().create_future()
        number = next(self._numbers)
        self._futures[number] = future
        try:
            if stream._wake(self._bell, number):
                await future
        finally:
            self._futures.pop(number, None)
            stream._let_sleep(number)

    def end(self) -> None:
        self._bell.end()
        self._thread.join(timeout=10)

    def _wake(self) -> None:
        while (numbers := self._bell.wait()) is not None:
            for number in numbers:
                future = self._futures.get(number)
                if future is None:
                    continue
                try:
                    future.get_loop().call_soon_threadsafe(_wake, future)
                except RuntimeError:
                    # The loop is closed, and its task would be kept for ever.
                    self._futures.pop(number, None)


def _wake(future: asyncio.Future[None]) -> None:
    if not future.done():
        future.set_result(None)


_MOST_AT_ONCE = 32
_lock = threading.Lock()
_all: _Sleepers | None = None


def _sleepers() -> _Sleepers:
    global _all
    with _lock:
        if _all is None:
            _all = _Sleepers()
        return _all


@atexit.register
def _end() -> None:
    """Ends the thread before Python does, which could not wake it any more."""
    global _all
    with _lock:
        ended, _all = _all, None
    if ended is not None:
        ended.end()


def _forget() -> None:
    """In a child of fork(), which has no thread of its parent's and may have the lock as another thread held it."""
    global _all, _lock
    _all, _lock = None, threading.Lock()


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_forget)
