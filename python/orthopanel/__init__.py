"""From a hammer test of a honeycomb sandwich panel to its elastic constants, the name of what its model lacks, and an FMU.

>>> import orthopanel as op
>>> test = op.Test(op.Piece(length=0.8, width=0.1, thickness=0.03, mass_per_area=6.88))
>>> test.add_frequencies([321.3, 837.5, 1520.0, 2312.5, 3150.0, 3987.5])
>>> fit = op.identify(test)
>>> round(fit.value("e_x") / 1e10, 3)
1.071

SI units everywhere: m, kg, s, N, Pa, Hz, with accelerations in m/s2. Places are (x, y) from the piece's centre, a single number is x.
The convention of complex numbers is e^(+j omega t).
"""

from ._errors import FileError, InputError, MissingFileError, OrthopanelError, RefusedError
from ._fit import Accelerance, Fit
from ._model import Model
from ._native import __version__
from ._piece import Piece
from ._test import Test, identify, trace
from ._trace import Trace

from . import campaign  # isort: skip

__all__ = [
    "Accelerance",
    "FileError",
    "Fit",
    "InputError",
    "MissingFileError",
    "Model",
    "OrthopanelError",
    "Piece",
    "RefusedError",
    "Test",
    "Trace",
    "__version__",
    "campaign",
    "identify",
    "trace",
]
