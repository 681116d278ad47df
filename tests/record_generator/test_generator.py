"""Whole records: what an analyser would make of them must be the model that went in."""

import dataclasses

import numpy as np
import pytest

from . import beam, channel, hammer
from .records import TABLE_9_ZETA, Setup, record

# Eight seconds, so that mode 1 has decayed to 1e-17 and the Fourier transform sees a whole record.
CLEAN = Setup(noise=0.0, hits=1, samples=131072, pairs=((-0.3, 0.3), (0.3, 0.3)))
SHORT = Setup(samples=4096, hits=2)


def spectra(setup, hit):
    """Frequencies in Hz and the Fourier transforms of force and acceleration, 5 Hz to the top of the filter's flat
    part."""
    frequency = np.fft.rfftfreq(setup.samples, 1.0 / setup.sampling_rate)
    band = (frequency > 5.0) & (frequency < channel.passband(setup.sampling_rate))
    return frequency[band], np.fft.rfft(hit.force)[band], np.fft.rfft(hit.acceleration)[band]


@pytest.mark.parametrize("shape, allowed", [("haversine", 2e-6), ("half-sine", 3e-4)])
def test_val_clean_record_has_the_accelerance_of_the_modal_sum(shape, allowed):
    """Acceleration over force is equation 21 at a transfer and at a driving point. What is allowed is
    what the channel says it cannot filter: the pulse's own content about the fine sampling rate, ringing modes
    included."""
    modes, places = record(dataclasses.replace(CLEAN, pulse=shape))
    zeta = beam.damping(modes, TABLE_9_ZETA, 0.004)
    for pair, (hit,) in zip(CLEAN.pairs, places):
        frequency, force, motion = spectra(CLEAN, hit)
        expected = beam.accelerance(modes, zeta, *pair, frequency)
        assert np.abs(motion / force - expected).max() < allowed * np.abs(expected).max()


def test_val_the_force_record_has_the_spectrum_of_the_pulse():
    """In the flat part of the low pass: ripple of a 100 dB filter, 1e-5."""
    _, places = record(CLEAN)
    hit = places[0][0]
    frequency, force, _ = spectra(CLEAN, hit)
    pulse = hammer.Pulse(**hit.facts["pulses"][0])
    whole = np.abs(pulse.spectrum([0.0])[0])
    assert np.abs(force / CLEAN.sampling_rate - pulse.spectrum(frequency)).max() < 2e-5 * whole


def test_reciprocity():
    """Force and response change places: the same record, but for the rounding of sums taken in another order."""
    one = dataclasses.replace(SHORT, noise=0.0, pairs=((-0.21, 0.3),))
    other = dataclasses.replace(one, pairs=((0.3, -0.21),))
    (there,), (back,) = (record(setup)[1][0][:1] for setup in (one, other))
    assert np.abs(there.acceleration - back.acceleration).max() < 1e-9 * np.abs(there.acceleration).max()


def test_val_the_low_pass_keeps_the_band_and_stops_the_rest():
    """Tones in, tones out: 0.39 of the sampling rate within 1e-4, 0.52 and 1.3 of it 95 dB down."""
    rate, samples = 1000.0, 600
    time, kept = channel.fine_time(rate, samples), np.arange(samples) / rate
    passed = channel.sample(np.sin(2.0 * np.pi * 390.0 * time), samples, True)
    assert np.abs(passed - np.sin(2.0 * np.pi * 390.0 * kept)).max() < 1e-4
    for tone in (520.0, 1300.0):
        assert np.abs(channel.sample(np.sin(2.0 * np.pi * tone * time), samples, True)).max() < 10.0 ** (-95.0 / 20.0)


def test_without_the_low_pass_the_samples_are_the_signal():
    """The force record is the pulse at the sample instants, to rounding."""
    setup = dataclasses.replace(SHORT, noise=0.0, anti_alias=False)
    hit = record(setup)[1][0][0]
    pulse = hammer.Pulse(**hit.facts["pulses"][0])
    np.testing.assert_allclose(hit.force, pulse.force(np.arange(setup.samples) / setup.sampling_rate), atol=1e-9)


@pytest.mark.parametrize("of", ["rms", "peak"])
def test_noise_is_as_large_as_asked(of):
    """The difference to the same hit without noise; 4096 samples tell a deviation within 1.1 %, so five of these are
    allowed."""
    noisy, clean = (record(dataclasses.replace(SHORT, noise=level, noise_of=of))[1][0][0] for level in (0.01, 0.0))
    for name in ("force", "acceleration"):
        signal = getattr(clean, name)
        size = np.sqrt(np.mean(signal**2)) if of == "rms" else np.abs(signal).max()
        found = np.std(getattr(noisy, name) - signal)
        assert found == pytest.approx(0.01 * size, rel=0.055)
        assert noisy.facts[f"{name}_noise"] == pytest.approx(0.01 * size, rel=1e-12)


def test_the_seed_decides_every_record():
    """The same seed gives the same record, another seed another; a place or a hit more changes no other record."""
    one, again = (record(SHORT)[1][0][1] for _ in range(2))
    other = record(dataclasses.replace(SHORT, seed=2))[1][0][1]
    more = record(dataclasses.replace(SHORT, hits=3))[1][0][1]
    assert np.array_equal(one.force, again.force) and np.array_equal(one.acceleration, again.acceleration)
    assert not np.array_equal(one.force, other.force)
    assert np.array_equal(one.acceleration, more.acceleration)


def test_hits_differ_and_a_harder_one_is_shorter():
    """Peaks lie in the range asked and differ; duration falls as they rise."""
    hits = record(dataclasses.replace(SHORT, hits=4))[1][0]
    pulses = sorted((hit.facts["pulses"][0] for hit in hits), key=lambda p: p["peak"])
    assert 60.0 <= pulses[0]["peak"] < pulses[-1]["peak"] <= 180.0
    assert all(soft["duration"] > hard["duration"] for soft, hard in zip(pulses[:-1], pulses[1:]))


def test_a_double_hit_is_in_that_hit_alone():
    """The second contact comes 6 ms after the first at 0.4 of its peak: 98 samples later, in hit 2 and not in hit 1."""
    single, double = record(dataclasses.replace(SHORT, noise=0.0, double_hits=(2,)))[1][0]
    for hit, part in ((single, 0.0), (double, 0.4)):
        first = int(np.argmax(hit.force))
        later = hit.force[first + 80 : first + 120].max() / hit.force[first]
        assert later == pytest.approx(part, abs=0.03)  # a peak between two samples is missed by up to 3 %


def test_an_overload_is_flat_at_its_range():
    """Hit 1 is cut at 0.7 of its largest magnitude, several samples long; hit 2 is not."""
    cut, whole = record(dataclasses.replace(SHORT, overloads=(1,)))[1][0]
    limit = cut.facts["acceleration_range"]
    assert np.abs(cut.acceleration).max() == limit
    assert np.sum(np.abs(cut.acceleration) == limit) >= 2
    assert "acceleration_range" not in whole.facts


def test_sensor_sign_and_unit():
    """A sensor turned round that reads in g: the same motion divided by -9.80665."""
    setup = dataclasses.replace(SHORT, noise=0.0, hits=1)
    plain = record(setup)[1][0][0].acceleration
    turned = record(dataclasses.replace(setup, sensor_sign=-1, unit="g"))[1][0][0].acceleration
    np.testing.assert_allclose(turned * -9.80665, plain, rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize(
    "wrong, word",
    [
        ({"samples": 200}, "samples"),
        ({"pre_trigger": 3}, "pre_trigger"),
        ({"hits": 0}, "hits"),
        ({"double_hits": (6,)}, "double_hits"),
        ({"peaks": (10.0, 5.0)}, "peaks"),
        ({"zeta": (1.0,)}, "zeta"),
        ({"noise": float("nan")}, "noise"),
        ({"sensor_sign": 0}, "sensor_sign"),
    ],
)
def test_a_request_that_makes_no_sense_is_refused(wrong, word):
    """The message names the field."""
    with pytest.raises(ValueError, match=word):
        Setup(**wrong)
