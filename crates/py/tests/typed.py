"""A program that uses the whole package, for the type checker: it is not run."""

import asyncio
import pickle
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

import posewire


def takes() -> npt.NDArray[np.float64]:
    take: posewire.Take = posewire.read("walk.mvnx", progress=lambda done, total: print(done, total))
    several: list[posewire.Take] = posewire.read_all("walk.mcap")
    take.write("walk.c3d", first=100, rate=60, axes="unity", unit="cm").left_out.sort()
    names: list[str] = take.segments + take.joints + take.skeleton.contacts
    samples: npt.NDArray[np.uint32] = take.sample
    contacts: npt.NDArray[np.bool_] = take.contacts
    print(len(several), names, samples, contacts, take.frame(-1).time + 1.0, len(take.to_arrow(["position"])))
    return take.joint_angles("xzy") + take["ergonomic_angles"]


def live() -> None:
    with posewire.listen("mxtp://0.0.0.0:9763", on_overflow="count") as stream:
        for frame in stream:
            state: Literal["LIVE", "STALE", "LOST"] | None = frame.state
            print(frame.position[0], state == posewire.LIVE)
        newest: posewire.Frame | None = stream.latest(timeout=0.1)
        if newest is not None and newest.age is not None:
            print(newest.age + 1.0, newest.orientation.dtype)
        statistics: list[dict[str, Any]] = stream.statistics()
        print(statistics)


async def soon(stream: posewire.Stream) -> list[int]:
    return [frame.sample async for frame in stream]


def send(position: npt.NDArray[np.float32]) -> None:
    skeleton = posewire.Skeleton(["Base", "Arm"], parents=[None, 0])
    with posewire.streamer("natnet://0.0.0.0", skeleton=skeleton, names=["Robot"]) as streamer:
        streamer.send(position, [[1, 0, 0, 0], [1, 0, 0, 0]], velocity=np.zeros((2, 3)))
    with posewire.Recorder("mxtp://0.0.0.0", path="take.mcap") as recorder:
        print(recorder.progress()["frames"])
    assert pickle.loads(pickle.dumps(skeleton)) == skeleton


def errors(data: bytearray) -> str | None:
    try:
        posewire.decode(np.frombuffer(data, np.uint8), protocol="natnet")
        return str(posewire.decode(memoryview(data), version="3.1")["quirks"])
    except (posewire.DecodeError, ValueError) as error:
        return error.help if isinstance(error, posewire.Error) else None


def wrong() -> None:
    """What the checker has to find: an ignored line without an error is one."""
    posewire.Take()  # type: ignore[call-arg]
    posewire.Frame()  # type: ignore[call-arg]
    posewire.Stream()  # type: ignore[call-arg]
    posewire.Streamer()  # type: ignore[call-arg]
    posewire.Saved()  # type: ignore[call-arg]
    posewire.Table()  # type: ignore[call-arg]
    posewire.read("walk.mvnx", threads="two")  # type: ignore[arg-type]
    posewire.listen("mxtp://0.0.0.0", on_overflow="ignore")  # type: ignore[arg-type]
    posewire.decode("MXTP")  # type: ignore[arg-type]
    posewire.read("walk.mvnx").position = np.zeros(3)  # type: ignore[misc]

    class Mine(posewire.Take):  # type: ignore[misc]
        pass


print(takes(), asyncio.run(soon(posewire.listen("synthetic:walk"))))
