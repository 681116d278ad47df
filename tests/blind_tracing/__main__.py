"""`python -m blind_tracing`: see cli.py."""

import os

# The matrices are small: threads of the linear algebra would wait for each other. Read when NumPy is first imported.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from .cli import main  # noqa: E402

main()
