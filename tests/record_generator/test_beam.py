"""The finite element model against the seed's exact solution (equations 8 to 11), solved here by other means."""

import numpy as np
import pytest
from scipy.optimize import brentq

from . import beam

PLACES = (-0.3, 0.13, 0.3)


def waves(panel, frequency):
    """alpha, beta of equation 8 and s = rho omega^2 / (k' G), for a frequency in Hz below the cut-off."""
    square = (2.0 * np.pi * frequency) ** 2
    s = panel.mass_per_length * square / panel.shear
    r = panel.rotary_inertia * square / panel.bending
    root = np.sqrt((s - r) ** 2 + 4.0 * panel.mass_per_length * square / panel.bending)
    return np.sqrt((root + s + r) / 2.0), np.sqrt((root - s - r) / 2.0), s


def exact_frequencies(panel, up_to):
    """The roots of equation 11 below `up_to` Hz: each factor, scanned and bisected."""

    def factor(f, parity):
        alpha, beta, s = waves(panel, f)
        p, q = (alpha**2 - s) * alpha, (beta**2 + s) * beta
        x, t = alpha * panel.length / 2.0, np.tanh(beta * panel.length / 2.0)
        return p * np.cos(x) * t + q * np.sin(x) if parity == 0 else p * np.sin(x) - q * t * np.cos(x)

    grid = np.arange(5.0, up_to, 5.0)
    roots = []
    for parity in (0, 1):
        values = factor(grid, parity)
        for i in np.flatnonzero(values[:-1] * values[1:] < 0.0):
            roots.append(brentq(factor, grid[i], grid[i + 1], args=(parity,), xtol=1e-10))
    return np.sort(roots)


def exact_accelerance(panel, force_at, response_at, frequency):
    """The undamped accelerance from equation 10 on both sides of the force: eight unknowns, no modes."""
    alpha, beta, s = waves(panel, frequency)
    half = panel.length / 2.0

    def row(x, centre):
        """w, psi, psi' and the shear strain w' + psi of the four waves; cosh and sinh as exponentials about the far
        ends."""
        a, b = alpha - s / alpha, beta + s / beta
        c, d, e, f = (
            np.cos(alpha * x),
            np.sin(alpha * x),
            np.exp(beta * (x - centre[1])),
            np.exp(beta * (centre[0] - x)),
        )
        return np.array(
            [
                [c, d, e, f],
                [a * d, -a * c, -b * e, b * f],
                [a * alpha * c, a * alpha * d, -b * beta * e, -b * beta * f],
                [-s / alpha * d, s / alpha * c, -s / beta * e, s / beta * f],
            ]
        )

    left, right = (-half, force_at), (force_at, half)
    matrix, load = np.zeros((8, 8)), np.zeros(8)
    matrix[0:2, :4] = row(-half, left)[2:]
    matrix[2:4, 4:] = row(half, right)[2:]
    matrix[4:, :4], matrix[4:, 4:] = -row(force_at, left), row(force_at, right)
    load[7] = -1.0 / panel.shear  # equation 5: the shear force falls by the unit force
    known = np.linalg.solve(matrix, load)
    side, part = (left, known[:4]) if response_at <= force_at else (right, known[4:])
    return -((2.0 * np.pi * frequency) ** 2) * float(row(response_at, side)[0] @ part)


@pytest.mark.parametrize("panel", [beam.Panel(), beam.Panel(thickness=0.06, e_x=4.954e9, g_zx=2.922e8)])
def test_val_frequencies_are_the_roots_of_equation_11(panel):
    """Every mode below 11 kHz, 1e-8 relative: no root missed on either side, as their numbers agree too."""
    exact = exact_frequencies(panel, 11000.0)
    found = beam.solve(panel, PLACES, 60000.0).frequency
    found = found[found < 11000.0]
    assert len(found) == len(exact)
    np.testing.assert_allclose(found, exact, rtol=1e-8)


@pytest.mark.parametrize("force_at, response_at", [(-0.3, 0.3), (0.13, 0.3), (0.3, 0.3)])
def test_val_accelerance_is_the_exact_solution_under_a_force(force_at, response_at):
    """Modes, rigid modes and static remainder together, with no damping. What parts them from the exact answer is the
    dynamics of the modes above 65 kHz: at most omega^2 sqrt(R_11 R_xx) / ((65 kHz / f)^2 - 1) by the Cauchy-Schwarz
    inequality."""
    panel = beam.Panel()
    modes = beam.solve(panel, PLACES, 65000.0)
    i, j = modes.index(force_at), modes.index(response_at)
    frequency = np.arange(25.0, 6500.0, 190.0)
    exact = np.array([exact_accelerance(panel, force_at, response_at, f) for f in frequency])
    found = beam.accelerance(modes, beam.damping(modes, (), 0.0), force_at, response_at, frequency)
    static = (2.0 * np.pi * frequency) ** 2 * np.sqrt(modes.remainder[i, i] * modes.remainder[j, j])
    bound = static / ((65000.0 / frequency) ** 2 - 1.0)
    far = np.abs(frequency[:, None] - modes.frequency).min(axis=1) > 20.0  # at a resonance both are ill-conditioned
    assert far.sum() > 25
    assert np.all(np.abs(found.real - exact)[far] <= bound[far] + 1e-6 * np.abs(exact[far]))
    assert bound.max() < 0.02, "the bound itself is small against accelerances of 1 to 50 (m/s2)/N"


def test_val_the_lowest_line_is_the_rigid_piece():
    """Far below the first mode the piece moves as a rigid body: 1/m + x_1 x_2 / J, less 1e-4 for (1 Hz / 321 Hz)^2 of
    flexing."""
    panel = beam.Panel()
    modes = beam.solve(panel, PLACES, 20000.0)
    mass = 6.880 * 0.1 * 0.8
    inertia = mass * (0.8**2 + 0.03**2) / 12.0
    found = beam.accelerance(modes, beam.damping(modes, (), 0.0), -0.3, 0.3, [1.0])[0]
    assert found.real == pytest.approx(1.0 / mass - 0.09 / inertia, rel=1e-4)


def test_modes_do_not_depend_on_where_they_are_seen():
    """Places set the mesh; another mesh gives the same modes and the same shapes but for their sign."""
    one = beam.solve(beam.Panel(), (-0.3, 0.3), 20000.0)
    other = beam.solve(beam.Panel(), (-0.37, -0.3, 0.111, 0.3), 20000.0)
    np.testing.assert_allclose(one.frequency, other.frequency, rtol=1e-8)
    np.testing.assert_allclose(one.shape[:, 0] * one.shape[:, 1], other.shape[:, 1] * other.shape[:, 3], atol=1e-7)


@pytest.mark.parametrize("wrong", [{"length": 0.0}, {"e_x": -1.0}, {"thickness": float("nan")}])
def test_a_piece_that_cannot_be_is_refused(wrong):
    """The message names what is wrong."""
    with pytest.raises(ValueError, match=next(iter(wrong))):
        beam.Panel(**wrong)
