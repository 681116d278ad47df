"""The beam's checks of each capability flag, on the plate's FMU; sums over shapes stand in test_plate_fmu.py."""

from plate_panel import export, fmu, fmu2  # noqa: F401
from test_capabilities import *  # noqa: F403

del test_directional_derivatives_by_forces_are_sums_over_shapes  # noqa: F821
