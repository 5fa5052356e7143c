"""`latest()` never steps back, whatever the network does, and follows a source that begins again."""

import pytest
from datagrams import Sender, of_samples

import posewire


def sent(walk, stream, sender, samples, order):
    """Sends samples in this order and takes them all; what `latest` said after each."""
    latest = []
    for number in order:
        sender.send(samples[number])
        while True:
            frame = stream.next(timeout=10)
            latest.append((frame.sample, stream.latest().sample))
            if frame.sample == number:
                break
    return latest


def begun(stream, sender, descriptions, samples, first):
    """Sends the first samples: which datagrams a sample has is known when the second one begins."""
    sender.send(descriptions)
    for number in first:
        sender.send(samples[number])
    return [stream.next(timeout=10).sample for _ in first]


@pytest.mark.parametrize("first", [0, 5000, 2**32 - 6])
def test_a_sample_that_others_have_overtaken_is_given_and_is_not_the_newest(walk, first):
    numbers = [(first + place) % 2**32 for place in range(10)]
    descriptions, samples = of_samples(walk, numbers)
    with posewire.listen("mxtp://127.0.0.1:0") as stream, Sender(stream.url) as sender:
        assert begun(stream, sender, descriptions, samples, numbers[:4]) == numbers[:4]
        five, six, seven, eight, nine, ten = numbers[4:]
        order = [five, seven, eight, six, ten, nine]
        newest = [five, seven, eight, eight, ten, ten]
        assert sent(walk, stream, sender, samples, order) == list(zip(order, newest))
        assert not stream.latest().late and stream.latest(subject="Ada").sample == ten


def test_a_late_sample_says_so(walk):
    descriptions, samples = of_samples(walk, range(8))
    with posewire.listen("mxtp://127.0.0.1:0") as stream, Sender(stream.url) as sender:
        begun(stream, sender, descriptions, samples, range(4))
        for number in (5, 4, 6):
            sender.send(samples[number])
        assert [(frame.sample, frame.late) for frame in (stream.next(timeout=10) for _ in range(3))] == [
            (5, False),
            (4, True),
            (6, False),
        ]


def test_the_newest_follows_a_source_that_begins_again(walk):
    before, after = range(5000, 5008), range(10)
    descriptions, samples = of_samples(walk, before)
    samples |= of_samples(walk, after)[1]
    with posewire.listen("mxtp://127.0.0.1:0") as stream, Sender(stream.url) as sender:
        begun(stream, sender, descriptions, samples, before)
        for number in (0, 1, 3, 2, 4, 5, 6):
            sender.send(samples[number])
        # With fewer than eight they may be copies that were long on their way.
        assert stream.next(timeout=0.1) is None and stream.latest().sample == 5007
        sender.send(samples[7])
        assert [stream.next(timeout=10).sample for _ in range(8)] == list(range(8))
        assert stream.latest().sample == 7
        assert sent(walk, stream, sender, samples, [9, 8]) == [(9, 9), (8, 9)]


def test_a_take_that_is_played_in_a_loop_goes_on(walk, tmp_path):
    walk.write(tmp_path / "walk.mvnx", last=9)
    with posewire.listen(tmp_path / "walk.mvnx", loop=True, speed=20) as stream:
        newest = -1
        while newest < 40:
            sample = stream.latest(timeout=10).sample
            assert sample >= newest
            newest = sample


def test_of_several_sources_the_newest_is_the_one_that_arrived_last(walk):
    one, two = (of_samples(walk, range(first, first + 6), [name]) for first, name in ((900, "Ada"), (0, "Bob")))
    with posewire.listen("mxtp://127.0.0.1:0", "mxtp://127.0.0.1:0") as stream:
        with Sender(stream.urls[0]) as to_one, Sender(stream.urls[1]) as to_two:
            begun(stream, to_one, *one, range(900, 904))
            assert stream.latest().subject == "Ada"
            begun(stream, to_two, *two, range(4))
            assert (stream.latest().subject, stream.latest().sample) == ("Bob", 3)
            sent(walk, stream, to_one, one[1], [905])
            assert (stream.latest().subject, stream.latest().sample) == ("Ada", 905)
            sent(walk, stream, to_two, two[1], [5])
            # What comes late is no news of Ada.
            sent(walk, stream, to_one, one[1], [904])
            assert (stream.latest().subject, stream.latest(subject="Ada").sample) == ("Bob", 905)
