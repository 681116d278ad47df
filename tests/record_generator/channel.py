"""The measuring chain: from motion as it is to the numbers in a file. Both channels pass through the same chain.

1. Anti-alias: the exact signals are taken on a grid OVERSAMPLE times finer, pass a linear-phase low pass (flat to 0.4
   and 100 dB down from 0.5 of the sampling rate) and every OVERSAMPLE-th sample is kept, as a sigma-delta converter
   does. The filter's delay is taken out, so a pulse rings a little before it begins. The filter is the same in both
   channels and cancels in their ratio. Left unfiltered are tones within half a sampling rate of multiples of the fine
   rate (above 515 kHz for 16384 Hz): 3e-7 of the spectrum of a haversine of 0.2 ms, 3e-5 of a half-sine.
2. Sensor: sign of the mounting, unit of the calibration.
3. Noise: white and Gaussian, added to the samples; its deviation is a part of the channel's rms or peak in this hit.
4. Overload: the samples are cut at the range, so a clipped record is flat with no noise on the flat.
"""

import numpy as np
from scipy.signal import firwin, kaiser_beta, upfirdn

OVERSAMPLE = 32
REACH = 32  # samples each side that the filter sees
STANDARD_GRAVITY = 9.80665  # m/s2


def fine_time(sampling_rate, samples):
    """The instants in s at which the exact signals are wanted; zero is the first sample of the record."""
    count = (samples - 1) * OVERSAMPLE + 1
    around = REACH * OVERSAMPLE
    return np.arange(-around, count + around) / (sampling_rate * OVERSAMPLE)


def sample(fine, samples, anti_alias):
    """The record of `samples` values from the signal on `fine_time`; without the low pass, its values at those
    instants."""
    if not anti_alias:
        return fine[REACH * OVERSAMPLE :: OVERSAMPLE][:samples].copy()
    # Middle of the transition at 0.45 of the sampling rate; the fine Nyquist frequency is 1 for firwin.
    taps = firwin(2 * REACH * OVERSAMPLE + 1, 0.9 / OVERSAMPLE, window=("kaiser", kaiser_beta(100.0)))
    return upfirdn(taps, fine, down=OVERSAMPLE)[2 * REACH : 2 * REACH + samples]


def passband(sampling_rate):
    """The frequency in Hz up to which the low pass is flat."""
    return 0.4 * sampling_rate


def with_noise(signal, level, reference, random):
    """`signal` with white noise of deviation `level` times its rms or peak (`reference`), and that deviation."""
    size = np.sqrt(np.mean(signal**2)) if reference == "rms" else np.max(np.abs(signal))
    deviation = level * float(size)
    return signal + deviation * random.standard_normal(len(signal)), deviation


def overloaded(signal, part):
    """`signal` cut at `part` of its largest magnitude, and that range."""
    limit = part * float(np.max(np.abs(signal)))
    return np.clip(signal, -limit, limit), limit
