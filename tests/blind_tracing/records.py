"""Playing a test: the hammer's pulses, the panel's answer, the measuring chain, the noise. SI units throughout."""

from dataclasses import dataclass

import numpy as np

from . import attachments, nonlinear
from .contour import half_sine
from .whole import WholeBench

PRE_TRIGGER = 256  # samples before the hit
PEAKS = (40.0, 160.0)  # N
FINER = 2  # samples of the restoring force per sample of the record
OVERSAMPLED = 4  # for the amplifier: the third harmonic of the band stays below half of it


@dataclass(frozen=True)
class Played:
    """Force [N] and acceleration [m/s2] (places, hits, samples), and the noise put on each channel."""

    force: np.ndarray
    acceleration: np.ndarray
    force_noise: float
    acceleration_noise: float


def play(bench, random):
    """The records of a test."""
    frequency, s = bench.sampling.lines()
    pulse = _pulses(bench, random)
    blows = np.stack([half_sine(s, *hit) for hit in pulse])
    motion = bench.motion(s, blows) if isinstance(bench, WholeBench) else _motion(bench, s, blows, pulse)
    for factor in bench.chain:
        motion = motion * factor(s)
    motion *= bench.gain * np.repeat(bench.record_gain, bench.hits)[:, None]
    if bench.saturation is None:
        acceleration = bench.sampling.samples_of(motion, frequency)
    else:
        acceleration = _saturated(bench, motion, frequency)
    force = bench.sampling.samples_of(blows, frequency)
    size = _rms(acceleration)
    if bench.hum:
        acceleration = acceleration + size * bench.hum * _hum(bench, random, len(force))
    noise = bench.noise * _rms(force), bench.noise * size
    force = force + noise[0] * random.standard_normal(force.shape)
    acceleration = acceleration + noise[1] * random.standard_normal(force.shape)
    if bench.window is not None:
        fading = np.exp(-bench.sampling.time / bench.window)
        force, acceleration = force * fading, acceleration * fading
    shape = (len(bench.forces), bench.hits, -1)
    return Played(force.reshape(shape), acceleration.reshape(shape), *noise)


def _pulses(bench, random):
    """Peak, duration and start of every hit, place by place. A harder hit is a shorter one (Hertz: peak^(-1/6))."""
    middle = np.exp(random.uniform(*np.log(bench.contact)))
    pulses = []
    for _ in range(len(bench.forces) * bench.hits):
        peak = np.exp(random.uniform(*np.log(PEAKS)))
        duration = middle * (peak / np.sqrt(PEAKS[0] * PEAKS[1])) ** (-1.0 / 6.0) * random.uniform(0.95, 1.05)
        pulses.append((peak, duration, (PRE_TRIGGER + random.random()) / bench.sampling.rate))
    return pulses


def _motion(bench, s, blows, pulse):
    """The acceleration's transform (hits, lines) where the sensor sits."""
    # A place that is struck in two records is two points: residues are a record's own.
    hits = np.column_stack([np.repeat(np.arange(len(bench.forces)), bench.hits), np.round(bench.struck().ravel(), 9)])
    spots, struck = np.unique(hits, axis=0, return_inverse=True)
    struck = struck.ravel()
    fixed = [x for x, _ in bench.attachments]
    others = np.unique(np.round([bench.sensed(), *fixed, *bench.restoring_at], 9))
    at = {x: len(spots) + i for i, x in enumerate(others)}
    index = lambda places: [at[x] for x in np.round(places, 9)]  # noqa: E731
    modes = bench.off_by_itself(bench.modes([*spots[:, 1], *others]), spots[:, 0].astype(int), at[np.round(bench.sensed(), 9)])

    def coupled(modes, columns):
        bare = lambda r, c: modes.receptance(s, r, c)  # noqa: E731
        stiffnesses = [stiffness for _, stiffness in bench.attachments]
        return attachments.coupled(bare, s, index([bench.sensed()]), columns, index(fixed), stiffnesses)[:, 0].T

    answer = np.empty_like(blows)
    for factor in np.unique(bench.drift):
        hits = np.flatnonzero(bench.drift.ravel() == factor)
        places, of = np.unique(struck[hits], return_inverse=True)
        warmed = modes if factor == 1.0 else modes.stiffer(factor)
        answer[hits] = coupled(warmed, places)[of] * blows[hits] * s**2
    if bench.restoring is not None:
        held = [*index(bench.restoring_at), *range(len(spots) + len(others), modes.points)]
        back = _restoring(bench, modes, list(struck), held, pulse, len(s))
        reach = modes.receptance(s, index([bench.sensed()]), held)[:, 0].T
        answer -= np.einsum("pl,phl->hl", reach, back) * s**2
    return answer


def _restoring(bench, modes, struck, held, pulse, lines):
    """The transform (places, hits, lines) of the restoring forces, found in time on a finer grid."""
    fine = bench.sampling.finer(FINER)
    frequency, s = fine.lines()
    blows = np.stack([half_sine(s, *hit) for hit in pulse])
    reach = modes.receptance(s, held, sorted(set(struck)))
    column = [sorted(set(struck)).index(point) for point in struck]
    moving = reach.transpose(1, 2, 0)[:, column] * blows  # places, hits, lines
    motion, speed = fine.samples_of(moving, frequency), fine.samples_of(moving * s, frequency)
    axes = (0, 2, 1)
    force = nonlinear.restoring_force(
        modes, held, motion.transpose(axes), speed.transpose(axes), 1.0 / fine.rate, bench.restoring
    )
    return fine.transform_of(force.transpose(axes), lines)


def _saturated(bench, motion, frequency):
    """An amplifier that bends towards its limit, ahead of the converter's filter."""
    fine = bench.sampling.finer(OVERSAMPLED)
    passed = motion * bench.sampling.low_pass(frequency)
    voltage = fine.samples_of(passed, frequency, filtered=False)
    limit = bench.saturation * np.median(np.max(np.abs(voltage), axis=-1))
    bent = fine.transform_of(limit * np.tanh(voltage / limit), len(frequency))
    return bench.sampling.samples_of(bent, frequency)


def _hum(bench, random, hits):
    """50 Hz and its third harmonic, rms 1, of a phase that no hit keeps."""
    phase = random.uniform(0.0, 2.0 * np.pi, (hits, 1))
    turn = 2.0 * np.pi * 50.0 * bench.sampling.time + phase
    return np.sqrt(2.0) * (0.95 * np.sin(turn) + 0.31 * np.sin(3.0 * turn))


def _rms(signal):
    """Over all hits of a test: a channel's floor does not follow the hit."""
    return float(np.sqrt(np.mean(signal**2)))
