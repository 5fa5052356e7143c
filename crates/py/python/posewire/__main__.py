"""The command line: python -m posewire."""

import sys

from ._posewire import main as _main


def main() -> int:
    """Runs the command line with the arguments of the process and gives its exit code."""
    return _main(["posewire", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
