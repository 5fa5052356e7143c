"""Samples for event loops: one thread wakes them all, and waiting ends whenever it is to end."""

import asyncio
import concurrent.futures
import gc
import threading
import time

import numpy as np
import pytest
from conftest import until

import posewire
from posewire import _asynchronous

STILL = np.zeros((23, 3)), np.tile([1.0, 0, 0, 0], (23, 1))


def waiting():
    """How many wait for samples in this process."""
    return len(_asynchronous._all._futures) if _asynchronous._all else 0


async def until_so(is_so):
    """Lets other tasks run until it is so, and fails where that takes a minute."""
    end = time.monotonic() + 60
    while not is_so():
        assert time.monotonic() < end
        await asyncio.sleep(0.001)


async def until_waiting(count):
    await until_so(lambda: waiting() == count)


async def first(stream):
    return (await anext(aiter(stream))).sample


def test_samples_come_to_every_loop():
    async def count(stream, most):
        samples = []
        async for frame in stream:
            samples.append(frame.sample)
            if len(samples) == most:
                return samples

    async def both():
        with posewire.listen("synthetic:walk") as one, posewire.listen("synthetic:walk") as two:
            return await asyncio.gather(count(one, 30), count(two, 30))

    assert asyncio.run(both()) == [list(range(30))] * 2


class Refusing(concurrent.futures.ThreadPoolExecutor):
    def submit(self, *arguments):
        raise AssertionError("waiting takes no thread of a pool")


@pytest.mark.parametrize("module", ["asyncio", "uvloop"])
def test_thirty_streams_wait_without_threads_of_their_own(module):
    async def run():
        asyncio.get_running_loop().set_default_executor(Refusing())
        streams = [posewire.listen("mxtp://127.0.0.1:0") for _ in range(30)]
        tasks = [asyncio.ensure_future(first(stream)) for stream in streams]
        await until_waiting(30)
        assert [thread.name for thread in threading.enumerate()].count("posewire-asyncio") == 1
        assert threading.active_count() <= before + 1
        for stream in reversed(streams):
            with posewire.streamer(stream.url) as streamer:
                streamer.send(*STILL)
        samples = await asyncio.gather(*tasks)
        for stream in streams:
            stream.close()
        return samples

    before = threading.active_count()
    loop = pytest.importorskip(module).new_event_loop()
    try:
        assert loop.run_until_complete(run()) == [0] * 30
    finally:
        loop.close()
    assert waiting() == 0


def test_waiting_that_is_cancelled_loses_no_sample_and_leaves_nothing_behind():
    async def run():
        with posewire.listen("mxtp://127.0.0.1:0") as stream:
            task = asyncio.ensure_future(first(stream))
            await until_waiting(1)
            task.cancel()
            with pytest.raises(asyncio.CancelledError):
                await task
            for _ in range(100):
                with pytest.raises(asyncio.TimeoutError):
                    await asyncio.wait_for(first(stream), 0)
            assert waiting() == 0
            with posewire.streamer(stream.url) as streamer:
                streamer.send(*STILL)
            return await first(stream)

    assert asyncio.run(run()) == 0


def test_several_tasks_share_the_samples_of_a_stream():
    async def take(stream, taken):
        async for frame in stream:
            taken.append(frame.sample)

    async def run():
        with posewire.listen("mxtp://127.0.0.1:0") as stream:
            taken = [[], [], []]
            tasks = [asyncio.ensure_future(take(stream, samples)) for samples in taken]
            await until_waiting(3)
            with posewire.streamer(stream.url) as streamer:
                for _ in range(50):
                    streamer.send(*STILL)
                    await asyncio.sleep(0)
            await until_so(lambda: sum(map(len, taken)) == 50)
            await until_waiting(3)
            stream.close()
            await asyncio.gather(*tasks)
            return sorted(sum(taken, []))

    assert asyncio.run(run()) == list(range(50))


@pytest.mark.parametrize("by", ["thread", "task"])
def test_closing_ends_a_loop_that_waits(by):
    async def run():
        stream = posewire.listen("mxtp://127.0.0.1:0")
        taken = asyncio.ensure_future(every(stream))
        await until_waiting(1)
        if by == "thread":
            threading.Thread(target=stream.close).start()
        else:
            stream.close()
        return await taken

    async def every(stream):
        return [frame async for frame in stream]

    assert asyncio.run(run()) == []


def test_a_loop_that_is_closed_meanwhile_keeps_no_other_from_waiting():
    with posewire.listen("mxtp://127.0.0.1:0") as stream, posewire.streamer(stream.url) as streamer:
        abandoned = asyncio.new_event_loop()
        task = abandoned.create_task(first(stream))
        abandoned.run_until_complete(until_waiting(1))
        abandoned.close()

        async def run():
            task = asyncio.ensure_future(first(stream))
            await until_waiting(2)
            streamer.send(*STILL)
            return await task

        assert asyncio.run(run()) == 0
        # Python would say of it that it was destroyed, which is so.
        task._log_destroy_pending = False
        del task
        gc.collect()
        assert waiting() == 0


def test_loops_of_several_threads_wait_at_once():
    def run():
        with posewire.listen("mxtp://127.0.0.1:0") as stream, posewire.streamer(stream.url) as streamer:
            for _ in range(20):
                streamer.send(*STILL)
            streamer.close()
            taken.append(asyncio.run(take(stream)))

    async def take(stream):
        samples = aiter(stream)
        return [(await anext(samples)).sample for _ in range(20)]

    taken = []
    threads = [threading.Thread(target=run) for _ in range(6)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(timeout=60)
    assert taken == [list(range(20))] * 6


def test_what_finds_no_room_is_raised():
    async def run():
        with posewire.listen("mxtp://127.0.0.1:0", capacity=5) as stream:
            with posewire.streamer(stream.url) as streamer:
                task = asyncio.ensure_future(first(stream))
                await until_waiting(1)
                for _ in range(10):
                    streamer.send(*STILL)
                until(lambda: stream.latest(timeout=10).sample == 9)
                # The task has not had its turn: five are there, and five are gone.
                with pytest.raises(posewire.OverflowError, match="5 samples are gone"):
                    await task
                assert await first(stream) == 0

    asyncio.run(run())


def test_a_stream_that_always_has_samples_lets_others_run():
    async def run():
        with posewire.listen("synthetic:walk", speed=1000, capacity=100_000) as stream:
            other = asyncio.ensure_future(asyncio.sleep(0, "had its turn"))
            async for _ in stream:
                if other.done():
                    return other.result()

    assert asyncio.run(asyncio.wait_for(run(), 60)) == "had its turn"
