"""Motion capture as numpy arrays: Xsens MVN (MXTP, MVNX) and OptiTrack (NatNet), live and recorded.

    take = posewire.read("walk.mvnx")
    take.position                        # (samples, segments, 3), metres

    with posewire.listen("mxtp://0.0.0.0:9763") as stream:
        for frame in stream:
            frame.orientation            # (segments, 4), w first

Metres, radians, seconds; right-handed, X forward, Y left, Z up; quaternions w, x, y, z, all the identity in the T-pose; NaN where
nothing was tracked.
"""

from __future__ import annotations

from ._errors import (
    ClosedError,
    DecodeError,
    Error,
    MissingError,
    NetworkError,
    ReadError,
    UsageError,
    WriteError,
)
from ._errors import OverflowError as OverflowError
from ._posewire import (
    Frame,
    Recorder,
    Saved,
    Skeleton,
    Stream,
    Streamer,
    Table,
    Take,
    __version__,
    decode,
    listen,
    read,
    read_all,
    streamer,
)

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Final

# OverflowError is not among them: `from posewire import *` must not hide Python's own.
__all__ = [
    "ClosedError",
    "DecodeError",
    "Error",
    "Frame",
    "LIVE",
    "LOST",
    "MissingError",
    "NetworkError",
    "ReadError",
    "Recorder",
    "STALE",
    "Saved",
    "Skeleton",
    "Stream",
    "Streamer",
    "Table",
    "Take",
    "UsageError",
    "WriteError",
    "__version__",
    "decode",
    "listen",
    "read",
    "read_all",
    "streamer",
]

#: The states of a live sample, by its age.
LIVE: Final = "LIVE"
STALE: Final = "STALE"
LOST: Final = "LOST"
