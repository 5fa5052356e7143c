"""What the package raises: the text of each error is that of the command line, and so is its help."""

from __future__ import annotations

import builtins


class Error(Exception):
    """Something went wrong; str() has the message and, on a line of its own, the help."""

    #: What went wrong, where, what was expected and what was found.
    message: str
    #: What to do about it, where there is something to do.
    help: str | None

    def __init__(self, message: str, help: str | None = None) -> None:
        super().__init__(message, help)
        self.message = message
        self.help = help

    def __str__(self) -> str:
        return self.message if self.help is None else f"{self.message}\nhelp: {self.help}"


class UsageError(Error, ValueError):
    """An argument is not what it must be; the command line ends with exit code 2."""


class ReadError(Error):
    """A file cannot be read, or is not what its name says."""


class WriteError(Error):
    """A file cannot be written."""


class NetworkError(Error):
    """The system refuses an address, a host or an interface."""


class DecodeError(Error, ValueError):
    """Bytes that are no datagram of the protocol."""


class MissingError(Error, AttributeError, LookupError):
    """A take, a sample or a file does not have what was asked for."""


class OverflowError(Error, builtins.OverflowError):
    """Samples came faster than they were taken, and some are gone; `except OverflowError` catches it by Python's name too."""


class ClosedError(Error):
    """It has been closed, or has ended."""
