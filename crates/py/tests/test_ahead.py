"""`latest()` is never older than the newest complete sample that arrived, and `age` is the time since it did."""

import random
import time

import pytest
from conftest import until
from datagrams import Sender, of_samples

import posewire

# A sample that lacks something holds those behind it back for a tenth of a second.
AT_ONCE = 0.05


def begun(stream, sender, descriptions, samples, count):
    """Sends the first samples: which datagrams a sample has is known when the second one begins."""
    sender.send(descriptions)
    for number in range(count):
        sender.send(samples[number])
    return [stream.next(timeout=10).sample for _ in range(count)]


def delay(stream, sender, datagrams, number):
    """Sends a sample; how long it took to be the newest."""
    sender.send(datagrams)
    start = time.monotonic()
    until(lambda: stream.latest().sample == number)
    return time.monotonic() - start


def numbers_of(frames):
    return [frame.sample for frame in frames]


@pytest.mark.parametrize("withheld", [0, 1])
def test_a_complete_sample_is_the_newest_at_once_though_one_before_it_is_not(walk, withheld):
    descriptions, samples = of_samples(walk, range(60), timecodes=True)
    with posewire.listen("mxtp://127.0.0.1:0") as stream, Sender(stream.url) as sender:
        assert begun(stream, sender, descriptions, samples, 10) == list(range(10))
        delays = []
        for number in range(10, 60):
            if number % 10 == 0:
                sender.send(samples[number][1 - withheld : 2 - withheld])
            else:
                delays.append(delay(stream, sender, samples[number], number))
            assert stream.latest(subject="Ada").sample == stream.latest().sample
        # A busy machine may be slow once.
        assert sum(delay > AT_ONCE for delay in delays) <= 1, delays
        frames = [stream.next(timeout=10) for _ in range(50)]
        assert numbers_of(frames) == list(range(10, 60)) and stream.next(timeout=0) is None
        lacking = [frame.sample for frame in frames if len(frame.sections) < 2 or frame.timecode is None]
        assert lacking == list(range(10, 60, 10))


def test_the_newest_is_never_behind_where_one_datagram_in_fifty_is_lost(walk):
    chance, count = random.Random(1), 400
    descriptions, samples = of_samples(walk, range(count), timecodes=True)
    with posewire.listen("mxtp://127.0.0.1:0") as stream, Sender(stream.url) as sender:
        begun(stream, sender, descriptions, samples, 10)
        newest, delays, gone = 9, [], []
        for number in range(10, count):
            arrives = [datagram for datagram in samples[number] if number > count - 10 or chance.random() > 0.02]
            if len(arrives) == 2:
                newest = number
                delays.append(delay(stream, sender, arrives, number))
            else:
                sender.send(arrives)
                gone += [number] * (not arrives)
                assert stream.latest().sample in (newest, number)
        assert len(delays) < count - 15 and sum(delay > AT_ONCE for delay in delays) <= 2, delays
        expected = [number for number in range(10, count) if number not in gone]
        assert numbers_of(stream.next(timeout=10) for _ in expected) == expected
        assert stream.next(timeout=0) is None and stream.latest().sample == count - 1


def test_the_newest_follows_a_source_that_begins_again_while_a_sample_is_waited_for(walk):
    descriptions, samples = of_samples(walk, range(5000, 5010), timecodes=True)
    _, again = of_samples(walk, range(10), timecodes=True)
    with posewire.listen("mxtp://127.0.0.1:0") as stream, Sender(stream.url) as sender:
        sender.send(descriptions)
        for number in range(5000, 5006):
            sender.send(samples[number])
        sender.send(samples[5006][:1])
        for number in (5007, 5008):
            delay(stream, sender, samples[number], number)
        # Eight show that it began again.
        for number in range(7):
            sender.send(again[number])
        for number in range(7, 10):
            delay(stream, sender, again[number], number)
        assert numbers_of(stream.next(timeout=10) for _ in range(19)) == [*range(5000, 5009), *range(10)]


def test_a_sample_that_was_held_is_as_old_as_its_arrival(walk):
    descriptions, samples = of_samples(walk, range(1))
    with posewire.listen("mxtp://127.0.0.1:0") as stream, Sender(stream.url) as sender:
        sender.send(descriptions + samples[0])
        sent = time.monotonic()
        frame = stream.latest(timeout=10)
        since = time.monotonic() - sent
        assert since - 0.05 < frame.age < since + 0.5
        assert frame.age >= 1 and frame.state == posewire.LOST
        assert abs(time.time_ns() - frame.received - frame.age * 1e9) < 0.5e9


def test_a_source_that_is_lost_is_not_live_again_without_a_datagram(walk):
    descriptions, samples = of_samples(walk, range(5), timecodes=True)
    with posewire.listen("mxtp://127.0.0.1:0", lost_after=0.3) as stream, Sender(stream.url) as sender:
        begun(stream, sender, descriptions, samples, 4)
        sender.send(samples[4][:1])
        states = []
        until(lambda: states.append(stream.latest().state) or stream.latest().sample == 4)
        states.append(stream.latest().state)
        assert list(dict.fromkeys(states))[-1] == posewire.LOST
        assert states == sorted(states, key=[posewire.LIVE, posewire.STALE, posewire.LOST].index)
