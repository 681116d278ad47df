"""A hammer test: which places, how many hits, what goes wrong; and its records.

Every random number comes from the seed, the place and the hit, so a place more or a hit more changes no other record.
"""

from dataclasses import dataclass, field

import numpy as np

from . import beam, channel, hammer

TABLE_9_ZETA = (2.364e-3, 1.306e-3, 1.108e-3, 2.251e-3, 5.485e-3, 4.488e-3)  # piece 1, modes 1 to 6
ONE_PLACE = ((-0.3, 0.3),)
FIVE_PLACES = ((-0.3, 0.3), (-0.21, 0.3), (-0.05, 0.3), (0.13, 0.3), (0.3, 0.3))  # the last one is a driving point


@dataclass(frozen=True)
class Setup:
    """Everything a test is made from; the defaults are piece 1 of the seed with table 9's constants. SI units.

    `pairs` are (force place, response place) along x; hit numbers in `double_hits` and `overloads` start at 1 and hold
    at every place. `pulse_duration` is that of a hit at the middle of `peaks`.
    """

    panel: beam.Panel = field(default_factory=beam.Panel)
    zeta: tuple = TABLE_9_ZETA
    zeta_beyond: float = 0.004
    pairs: tuple = ONE_PLACE
    hits: int = 5
    peaks: tuple = (60.0, 180.0)  # softest and hardest hit, N
    pulse: str = "haversine"
    pulse_duration: float = 2.0e-4
    sampling_rate: float = 16384.0
    samples: int = 32768
    pre_trigger: int = 256  # samples before the hit
    anti_alias: bool = True
    noise: float = 0.003  # part of `noise_of`
    noise_of: str = "rms"  # or "peak", of the channel in this hit
    double_hits: tuple = ()
    double_after: float = 6.0e-3  # from the first contact to the second, s
    double_part: float = 0.4  # of the first peak
    overloads: tuple = ()
    overload_at: float = 0.7  # part of that hit's largest acceleration
    sensor_sign: int = 1
    unit: str = "m/s2"  # or "g"
    seed: int = 1

    def __post_init__(self):
        self._check_numbers()
        if self.noise_of not in ("rms", "peak"):
            raise ValueError(f'noise_of = "{self.noise_of}": "rms" or "peak"')
        if self.unit not in ("m/s2", "g"):
            raise ValueError(f'unit = "{self.unit}": "m/s2" or "g"')
        if self.sensor_sign not in (1, -1):
            raise ValueError(f"sensor_sign = {self.sensor_sign}: 1, or -1 for a sensor turned round")
        if self.pulse not in hammer.SHAPES:
            raise ValueError(f'pulse = "{self.pulse}": one of {", ".join(hammer.SHAPES)}')
        for name in ("double_hits", "overloads"):
            for hit in getattr(self, name):
                if not 1 <= hit <= self.hits:
                    raise ValueError(f"{name}: hit {hit} is not among hits 1 to {self.hits}")
        if len(set(self.pairs)) < len(self.pairs) or not self.pairs:
            raise ValueError("pairs: give at least one (force, response) pair, each once")
        if any(not 0.0 <= ratio < 1.0 for ratio in (*self.zeta, self.zeta_beyond)):
            raise ValueError("zeta: damping ratios must lie in [0, 1)")

    def _check_numbers(self):
        for name in ("pulse_duration", "sampling_rate", "double_after", "double_part", "overload_at"):
            value = getattr(self, name)
            if not (np.isfinite(value) and value > 0.0):
                raise ValueError(f"{name} = {value}: give a positive number")
        if not (np.isfinite(self.noise) and self.noise >= 0.0):
            raise ValueError(f"noise = {self.noise}: give zero or a positive number")
        low, high = self.peaks
        if not (0.0 < low <= high < np.inf):
            raise ValueError(f"peaks = {low} {high}: give the softest, then the hardest hit, both above zero")
        if self.hits < 1:
            raise ValueError(f"hits = {self.hits}: at least one hit is needed")
        least = channel.REACH if self.anti_alias else 0
        last = self.pre_trigger + (self.pulse_duration * 2.0 + self.double_after) * self.sampling_rate + least
        if self.pre_trigger < least:
            raise ValueError(
                f"pre_trigger = {self.pre_trigger}: the low pass rings {least} samples ahead of a hit: give that many"
            )
        if self.samples <= last:
            raise ValueError(f"samples = {self.samples}: the hit itself lasts until sample {last:.0f}: give more")


@dataclass(frozen=True)
class Hit:
    """One hit: what the file holds (`force` [N], `acceleration` in the unit and sign of the sensor) and what a scorer
    may know."""

    force: np.ndarray
    acceleration: np.ndarray
    facts: dict


def modes_of(setup):
    """The modes behind the records: dynamic up to four times the sampling rate, static above."""
    return beam.solve(setup.panel, sorted({x for pair in setup.pairs for x in pair}), 4.0 * setup.sampling_rate)


def record(setup):
    """The modes, and the hits of each pair: a list of lists of Hit in the order of `pairs`."""
    modes = modes_of(setup)
    zeta = beam.damping(modes, setup.zeta, setup.zeta_beyond)
    return modes, [
        [_hit(setup, modes, zeta, place, number) for number in range(1, setup.hits + 1)]
        for place in range(len(setup.pairs))
    ]


def _hit(setup, modes, zeta, place, number):
    """Hit `number` (from 1) at pair `place`."""
    random = np.random.default_rng([setup.seed, place, number])
    pulses = _pulses(setup, number, random)
    fine = channel.fine_time(setup.sampling_rate, setup.samples)
    pair = setup.pairs[place]
    force = channel.sample(sum(p.force(fine) for p in pulses), setup.samples, setup.anti_alias)
    motion = sum(hammer.acceleration(modes, zeta, *pair, p, fine) for p in pulses)
    motion = setup.sensor_sign * channel.sample(motion, setup.samples, setup.anti_alias)
    if setup.unit == "g":
        motion = motion / channel.STANDARD_GRAVITY
    force, force_noise = channel.with_noise(force, setup.noise, setup.noise_of, random)
    motion, motion_noise = channel.with_noise(motion, setup.noise, setup.noise_of, random)
    facts = {
        "pulses": [{"peak": p.peak, "duration": p.duration, "start": p.start} for p in pulses],
        "force_noise": force_noise,
        "acceleration_noise": motion_noise,
    }
    if number in setup.overloads:
        motion, facts["acceleration_range"] = channel.overloaded(motion, setup.overload_at)
    return Hit(force, motion, facts)


def _pulses(setup, number, random):
    """The contacts of one hit. A harder hit is a shorter one: Hertz's contact law gives duration ~ peak^(-1/6)."""
    low, high = setup.peaks
    peak = low * (high / low) ** random.random()
    duration = setup.pulse_duration * (peak / np.sqrt(low * high)) ** (-1.0 / 6.0)
    start = (setup.pre_trigger + random.random()) / setup.sampling_rate  # a hit does not wait for a sample
    pulses = [hammer.Pulse(peak, duration, start, setup.pulse)]
    if number in setup.double_hits:
        pulses.append(hammer.Pulse(setup.double_part * peak, duration, start + setup.double_after, setup.pulse))
    return pulses
