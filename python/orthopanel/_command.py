"""The command ``orthopanel``, as the package brings it."""

from __future__ import annotations

import signal
import sys

from . import _native


def main() -> int:
    """Runs the command with the words of this program; gives its exit status."""
    # Nothing of Python runs until it ends: Ctrl-C ends it as it ends any program.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    return _native.main(["orthopanel", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
