"""Ride comfort by ISO 2631-1: accelerations weighted by W_k, whole-body vibration along z."""

import numpy as np

# Annex A of ISO 2631-1:1997, table A.1: corners [Hz] and quality factors of W_k.
HIGH_PASS, LOW_PASS, TRANSITION_ZERO = 0.4, 100.0, 12.5
TRANSITION_POLE, TRANSITION_Q = 12.5, 0.63
STEP_ZERO, STEP_ZERO_Q, STEP_POLE, STEP_POLE_Q = 2.37, 0.91, 3.35, 0.91


def w_k(frequency):
    """Complex factor of W_k at a frequency [Hz]: band limits, transition from acceleration to velocity, upward step."""
    s = 2j * np.pi * np.asarray(frequency, dtype=float)

    def second_order(corner, quality):
        omega = 2.0 * np.pi * corner
        return s**2 + omega / quality * s + omega**2

    butterworth = 1.0 / np.sqrt(2.0)
    high = s**2 / second_order(HIGH_PASS, butterworth)
    low = (2.0 * np.pi * LOW_PASS) ** 2 / second_order(LOW_PASS, butterworth)
    zero, pole = 2.0 * np.pi * TRANSITION_ZERO, 2.0 * np.pi * TRANSITION_POLE
    transition = (1.0 + s / zero) * pole**2 / second_order(TRANSITION_POLE, TRANSITION_Q)
    # Written for a gain of (STEP_ZERO / STEP_POLE)^2 at rest and 1 far above.
    step = second_order(STEP_ZERO, STEP_ZERO_Q) / second_order(STEP_POLE, STEP_POLE_Q)
    return high * low * transition * step


def weighted_rms(omegas, amplitudes):
    """Weighted rms acceleration [m/s2] of lines: amplitudes [m/s2] at omegas [rad/s]."""
    return np.sqrt(0.5 * np.sum(np.abs(w_k(omegas / (2.0 * np.pi)) * amplitudes) ** 2))


def lines_of(signal, count):
    """Complex amplitudes of the first `count` lines above zero of a signal that is sampled over one period."""
    return 2.0 * np.fft.rfft(signal)[1 : count + 1] / len(signal)
