"""The closed forms of the pulse and of a mode's response, against quadrature and against a general ODE solver."""

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp

from . import beam, hammer

PULSES = [hammer.Pulse(100.0, 2.0e-4, 1.37e-4, shape) for shape in hammer.SHAPES]


@pytest.mark.parametrize("pulse", PULSES, ids=hammer.SHAPES)
@pytest.mark.parametrize("frequency", [0.0, 1234.5, 2500.0, 9000.0])
def test_val_spectrum_is_the_fourier_integral(pulse, frequency):
    """By quadrature; 2500 Hz is the half-sine's own frequency, where the closed form has a removable pole."""
    end = pulse.start + pulse.duration
    turn = -2.0 * np.pi * frequency
    parts = [
        quad(lambda t: float(pulse.force(np.array([t]))[0]) * wave(turn * t), pulse.start, end, epsabs=1e-14)[0]
        for wave in (np.cos, np.sin)
    ]
    assert abs(complex(*parts) - pulse.spectrum([frequency])[0]) < 1e-12


@pytest.mark.parametrize("pulse", PULSES, ids=hammer.SHAPES)
def test_pulse_peaks_where_and_as_high_as_said(pulse):
    """The middle of the contact carries the peak; nothing acts outside the contact."""
    around = pulse.start + pulse.duration * np.array([-0.01, 0.5, 1.01])
    np.testing.assert_allclose(pulse.force(around), [0.0, pulse.peak, 0.0], atol=1e-12)


@pytest.mark.parametrize("pulse", PULSES, ids=hammer.SHAPES)
@pytest.mark.parametrize("hertz, zeta", [(320.0, 2.0e-3), (2500.0, 0.0), (4000.0, 0.3)])
def test_val_one_mode_follows_equation_20(pulse, hertz, zeta):
    """Equation 20 integrated by DOP853 to 1e-11, through the contact and after it. At 2500 Hz with no damping the
    half-sine drives the mode at its own frequency: the closed form's removable pole."""
    modes = beam.Modes((0.0,), np.array([hertz]), np.array([[1.5]]), np.zeros((2, 1)), np.zeros((1, 1)))
    time = np.linspace(0.0, 2.0e-3, 2001)
    found = hammer.acceleration(modes, np.array([zeta]), 0.0, 0.0, pulse, time)
    omega = 2.0 * np.pi * hertz

    def motion(t, state):
        drive = 1.5 * pulse.force(np.array([t]))[0]
        return [state[1], drive - 2.0 * zeta * omega * state[1] - omega**2 * state[0]]

    solved = solve_ivp(motion, (0.0, 2.0e-3), [0.0, 0.0], "DOP853", time, rtol=1e-12, atol=1e-16, max_step=2.0e-6)
    expected = 1.5 * np.array([motion(t, y)[1] for t, y in zip(time, solved.y.T)])
    assert np.abs(found - expected).max() < 1e-7 * np.abs(expected).max()


def test_static_remainder_answers_with_the_second_derivative():
    """A haversine's second derivative is known: -(F/2) (2 pi/T)^2 times -cos; checked away from its two kinks."""
    pulse = PULSES[0]
    modes = beam.Modes((0.0,), np.zeros(0), np.zeros((0, 1)), np.zeros((2, 1)), np.array([[3.0e-9]]))
    time = np.arange(0.0, 5.0e-4, 1.0e-6)
    found = hammer.acceleration(modes, np.zeros(0), 0.0, 0.0, pulse, time)
    rate = 2.0 * np.pi / pulse.duration
    inside = (time > pulse.start + 3e-6) & (time < pulse.start + pulse.duration - 3e-6)
    expected = 3.0e-9 * 0.5 * pulse.peak * rate**2 * np.cos(rate * (time - pulse.start))
    np.testing.assert_allclose(found[inside], expected[inside], atol=1e-6 * np.abs(expected).max())
    assert found[time > pulse.start + pulse.duration + 3e-6].max() == 0.0


def test_damping_of_one_or_more_is_refused():
    """The closed form holds for modes that swing."""
    modes = beam.solve(beam.Panel(), (0.0,), 1000.0)
    with pytest.raises(ValueError, match="damping"):
        hammer.acceleration(modes, beam.damping(modes, (), 1.0), 0.0, 0.0, PULSES[0], np.arange(0.0, 1e-3, 1e-5))
