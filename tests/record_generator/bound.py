r"""The least standard deviations that any unbiased reading of a test's records can have (Cramer and Rao).

Of each pair's averaged accelerance H with the error
$$ e = \frac{\sum \bar F_i (\alpha_i - H \nu_i)}{\sum |F_i|^2} , $$
alpha_i and nu_i the spectra of white noise on both channels, the force's left only within `half_width` samples of the
hit's peak. So it ties lines together: C = D + U U^T, U a column a sample kept, and J^T C^{-1} J follows by Woodbury's
identity. Noise on the force in S_ff itself is left out.

    python -c "from record_generator import bound, records; print(bound.percent(records.Setup(...)))"
"""

import dataclasses

import numpy as np

from . import beam, records

STEP = 1e-5  # of a logarithm, for central differences


def percent(setup, half_width=40, drop=30.0):
    """The bounds of E_x, G_zx and of each damping ratio of `setup.zeta`, in per cent, on the lines up to where the force
    has fallen by `drop` dB. The damping of modes beyond those is free too."""
    clean = dataclasses.replace(setup, noise=0.0)
    _, places = records.record(clean)
    frequency = np.fft.rfftfreq(setup.samples, 1.0 / setup.sampling_rate)[1:]
    spectra = [[np.fft.rfft(hit.force)[1:] for hit in hits] for hits in places]
    power = [sum(np.abs(one) ** 2 for one in place) for place in spectra]
    ends = [int(np.argmax(one < one.max() * 10.0 ** (-drop / 10.0))) or len(one) for one in power]
    frequency = frequency[: max(ends)]
    seen = int(np.sum(records.modes_of(clean).frequency < frequency[-1]))
    more = max(seen - len(setup.zeta), 0)
    start = np.log([setup.panel.e_x, setup.panel.g_zx, *setup.zeta, *[setup.zeta_beyond] * more])

    values = _accelerances(setup, start, frequency)
    derivatives = [
        [(up - down) / (2.0 * STEP) for up, down in zip(*(_accelerances(setup, at, frequency) for at in both))]
        for both in ((start + step, start - step) for step in STEP * np.eye(len(start)))
    ]
    information = np.zeros((len(start), len(start)))
    for place, hits in enumerate(places):
        lines = slice(0, ends[place])
        parts = [one[lines].conj() / power[place][lines] for one in spectra[place]]
        deviations = [[_size(channel, setup) for channel in (hit.force, hit.acceleration)] for hit in hits]
        alone = sum(np.abs(part) ** 2 * setup.samples * motion**2 for part, (_, motion) in zip(parts, deviations))
        weight = np.sqrt(2.0 / alone)
        tied = [
            (values[place][lines] * part * weight)[:, None] * force * _turns(hit, lines, setup, half_width)
            for part, hit, (force, _) in zip(parts, hits, deviations)
        ]
        tied = _real(np.concatenate(tied, axis=1))
        rows = _real(np.stack([by[place][lines] * weight for by in derivatives], axis=1))
        shared = tied.T @ rows
        among = np.eye(tied.shape[1]) + tied.T @ tied
        information += rows.T @ rows - shared.T @ np.linalg.solve(among, shared)
    return 100.0 * np.sqrt(np.diag(np.linalg.inv(information)))[: 2 + len(setup.zeta)]


def _accelerances(setup, logarithms, frequency):
    """Every pair's accelerance at the logarithms of E_x, G_zx and the damping ratios."""
    e_x, g_zx, *zeta = np.exp(logarithms)
    panel = dataclasses.replace(setup.panel, e_x=e_x, g_zx=g_zx)
    modes = beam.solve(panel, sorted({x for pair in setup.pairs for x in pair}), 3.0 * frequency[-1])
    ratios = beam.damping(modes, zeta, setup.zeta_beyond)
    return [beam.accelerance(modes, ratios, *pair, frequency) for pair in setup.pairs]


def _turns(hit, lines, setup, half_width):
    """exp(-j omega t) of each sample kept, a column a sample."""
    peak = int(np.argmax(np.abs(hit.force)))
    kept = np.arange(max(peak - half_width, 0), min(peak + half_width + 1, setup.samples))
    return np.exp(-2.0j * np.pi / setup.samples * np.outer(np.arange(1, lines.stop + 1), kept))


def _size(channel, setup):
    """Deviation of the noise on a channel, as `channel.with_noise` has it."""
    of = np.sqrt(np.mean(channel**2)) if setup.noise_of == "rms" else np.max(np.abs(channel))
    return setup.noise * of


def _real(rows):
    """Real parts above imaginary ones."""
    return np.concatenate([rows.real, rows.imag])
