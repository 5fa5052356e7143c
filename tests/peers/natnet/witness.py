"""A socket that gets the frames which a client gets at the data port, and reads them all."""

import socket
import struct

FRAME = 7
# To the server another host, though it is this one: it sends there what it sends to the client.
ADDRESS = "127.0.0.3"
ANY_LENGTH = 65_536
# A frame may have come to the client and not to the witness yet.
PATIENCE = 2.0


class Witness:
    def __init__(self, arguments):
        """Listens in the group, or has the server send copies here."""
        self.numbers = []
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        self.socket.bind((arguments.group or ADDRESS, arguments.data_port))
        self.socket.setblocking(False)
        if arguments.group:
            membership = socket.inet_aton(arguments.group) + socket.inet_aton("127.0.0.1")
            self.socket.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, membership)
        else:
            with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as command:
                command.bind((ADDRESS, 0))
                command.sendto(bytes(4), (arguments.server, arguments.port))

    def read(self):
        """Takes in what has come."""
        try:
            while True:
                self._take(self.socket.recv(ANY_LENGTH))
        except BlockingIOError:
            return

    def has_all(self, count):
        """Whether so many frames have come, and none between them is missing."""
        self.socket.settimeout(PATIENCE)
        try:
            while len(self.numbers) < count:
                self._take(self.socket.recv(ANY_LENGTH))
        except TimeoutError:
            return False
        return {after - before for before, after in zip(self.numbers, self.numbers[1:])} == {1}

    def _take(self, packet):
        message, _, number = struct.unpack_from("<HHi", packet)
        if message == FRAME:
            self.numbers.append(number)
