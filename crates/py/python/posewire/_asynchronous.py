"""Samples of a stream for asyncio."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ._posewire import Frame, Stream


class Samples:
    """An asynchronous iterator of all samples. It waits on a thread of the loop's own pool, for a moment at a time."""

    def __init__(self, stream: Stream) -> None:
        self._stream = stream

    def __aiter__(self) -> Samples:
        return self

    async def __anext__(self) -> Frame:
        while (frame := self._stream._take()) is None:
            if self._stream.closed:
                # One may have come between the two questions.
                if (frame := self._stream._take()) is not None:
                    return frame
                raise StopAsyncIteration
            await asyncio.get_running_loop().run_in_executor(None, self._stream._wait)
        return frame
