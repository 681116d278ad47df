r"""The tests' authority: the Timoshenko beam by transfer matrices, exact at any complex s.

The state (w, psi, M, Q) obeys a linear equation along x; between steps its propagator is a matrix exponential, at a
point attachment or a force the shear force jumps, at a point inertia the moment. Q is the whole transverse force,
tension included. SI units.
"""

from dataclasses import replace

import numpy as np
from scipy.linalg import expm


def receptance(panel, s, force_at, response_at, attached=(), modulus=1.0):
    """w(response_at) [m] under a unit force at `force_at`, at one complex `s` [1/s]; `attached` are pairs (x, Z(s))."""
    state, seen = _carried(panel, s, force_at, response_at, attached, modulus)
    unknown = np.linalg.solve(state[2:, :2], -state[2:, 2])
    return seen[2] + seen[:2] @ unknown


def determinant(panel, s):
    """Zero where `s` is a pole of the panel."""
    state, _ = _carried(panel, s, 0.0, 0.0, (), 1.0)
    return np.linalg.det(state[2:, :2])


def _carried(panel, s, force_at, response_at, attached, modulus):
    """The state at the right end and the deflection at the response, for two unknowns at the left end and the force."""
    half = panel.length / 2.0
    stops = sorted({-half, half, force_at, response_at, *(x for x, _ in [*attached, *panel.turning]), *panel.steps})
    stops = [x for x in stops if -half <= x <= half]
    state, seen = _start(panel), None
    for i, x in enumerate(stops):
        for place, stiffness in attached:
            if abs(place - x) < 1e-12:
                state[3] += stiffness(s) * state[0]
        for place, inertia in panel.turning:
            if abs(place - x) < 1e-12:
                state[2] += inertia * s**2 * state[1]
        if x == force_at:
            state[3, 2] -= 1.0
        if x == response_at:
            seen = state[0].copy()
        if i + 1 < len(stops):
            middle = (x + stops[i + 1]) / 2.0
            state = expm(_along(_piece(panel, middle), s, modulus) * (stops[i + 1] - x)) @ state
    return state, seen


def _piece(panel, x):
    """The even panel that `panel` is around x; what varies is constant between `steps`."""
    e, g, m = (along(np.array([x]))[0] if along else 1.0 for along in (panel.bending_along, panel.shear_along, panel.mass_along))
    return replace(panel, e_x=panel.e_x * e, g_zx=panel.g_zx * g, mass_per_area=panel.mass_per_area * m)


def _start(panel):
    """States at the left end for its two unknowns, and none for the force."""
    state = np.zeros((4, 3), dtype=complex)
    if panel.left == "clamped":
        state[2, 0], state[3, 1] = 1.0, 1.0
    else:
        translation, rotation = (0.0, 0.0) if panel.left == "free" else panel.left
        state[0, 0], state[3, 0] = 1.0, translation
        state[1, 1], state[2, 1] = 1.0, rotation
    return state


def _along(panel, s, shear):
    """d(w, psi, M, Q)/dx with M = EI psi', Q = k'GA (w' + psi) + N w'."""
    shear = panel.shear * shear
    both = shear + panel.tension
    matrix = np.zeros((4, 4), dtype=complex)
    matrix[0, 1], matrix[0, 3] = -shear / both, 1.0 / both
    matrix[1, 2] = 1.0 / panel.bending
    # M' = rho I s^2 psi + k'GA (w' + psi), Q' = rho A s^2 w
    matrix[2, 1], matrix[2, 3] = panel.rotary_inertia * s**2 + shear * (1.0 - shear / both), shear / both
    matrix[3, 0] = panel.mass_per_length * s**2
    return matrix
