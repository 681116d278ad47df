"""``python -m orthopanel``."""

import sys

from ._command import main

sys.exit(main())
