"""Datagrams of a streamer, for tests that send them as a network might."""

import socket

import posewire


def of_samples(walk, numbers, names=("Ada",), timecodes=False):
    """What is sent of samples with these numbers: the descriptions, and for each number its datagrams.

    These are of type 02, and with timecodes one of type 25 for each.
    """
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as receiver:
        receiver.bind(("127.0.0.1", 0))
        receiver.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 20)
        receiver.settimeout(0)
        with posewire.streamer(f"mxtp://127.0.0.1:{receiver.getsockname()[1]}", names=list(names)) as streamer:
            for place, number in enumerate(numbers):
                timecode = {"timecode": place / 60} if timecodes else {}
                for subject in range(len(names)):
                    streamer.send(
                        walk.position[place], walk.orientation[place], subject=subject, sample=number, **timecode
                    )
        received = list(_all(receiver))
    descriptions = [datagram for datagram in received if datagram[4:6] in (b"12", b"13")]
    samples = {number: [] for number in numbers}
    for datagram in received:
        if datagram not in descriptions:
            samples[int.from_bytes(datagram[6:10], "big")].append(datagram)
    assert descriptions and all(samples.values())
    return descriptions, samples


def _all(receiver):
    while True:
        try:
            yield receiver.recv(65536)
        except BlockingIOError:
            return


class Sender:
    """Sends datagrams to where a stream listens."""

    def __init__(self, url):
        self._to = ("127.0.0.1", int(url.rsplit(":", 1)[1]))
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)

    def send(self, datagrams):
        for datagram in datagrams:
            self._socket.sendto(datagram, self._to)

    def __enter__(self):
        return self

    def __exit__(self, *raised):
        self._socket.close()
