"""Hammer tests with an effect in them that their test file does not declare, and a scorer of who finds it.

The physics is its own (finite elements, a Ritz plate, Laplace transforms) and shares nothing with the crates under
test. README.md says what is drawn from where, and why.
"""

import os

# The matrices are small: threads of the linear algebra would wait for each other. Read when NumPy is first imported.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
