"""What an analyser keeps of a test: one accelerance a place, and no hits."""

import numpy as np
import pyuff

from . import files
from .contour import Sampling

SAMPLING = Sampling(samples=131072)  # 6.4 s: what rings longer leaks, and an analyser's user takes a longer record
BAND = (20.0, 6000.0)  # Hz: above, a hammer's pulse has little left
RESPONSE_FUNCTION, FREQUENCY = 4, 18  # codes of dataset 58


def h1(played, sampling):
    """Frequencies [Hz] of the band and H1 (places, lines) [m/s2/N] over each place's hits: mean F* A over mean F* F."""
    frequency = np.fft.rfftfreq(sampling.samples, 1.0 / sampling.rate)
    force, acceleration = np.fft.rfft(played.force), np.fft.rfft(played.acceleration)
    kept = (frequency >= BAND[0]) & (frequency <= BAND[1])
    crossed = np.mean(np.conj(force) * acceleration, axis=1)
    return frequency[kept], (crossed / np.mean(np.abs(force) ** 2, axis=1))[:, kept]


def write_case(folder, bench, played):
    """The folder of one case: test.toml and a UFF 58b file a place."""
    folder.mkdir(parents=True)
    plan = [files.piece_text(bench)]
    frequency, accelerances = h1(played, bench.sampling)
    for place, (x, accelerance) in enumerate(zip(bench.forces, accelerances, strict=True)):
        name = f"point-{place}.uff"
        _write(folder / name, (place + 1, len(bench.forces) + 1), frequency, accelerance)
        plan.append(files.measurement_text("accelerance", name, x, bench.response))
    (folder / "test.toml").write_text("\n".join(plan), encoding="utf-8")


def _write(path, nodes, frequency, accelerance):
    """One place's accelerance as a UFF 58b file."""
    record = pyuff.prepare_58(
        binary=1,
        id1="H1",
        func_type=RESPONSE_FUNCTION,
        rsp_node=nodes[1],
        rsp_dir=files.Z_TRANSLATION,
        ref_node=nodes[0],
        ref_dir=files.Z_TRANSLATION,
        abscissa_spacing=1,
        abscissa_spec_data_type=FREQUENCY,
        abscissa_axis_units_lab="Hz",
        ordinate_spec_data_type=files.ACCELERATION,
        ordinate_axis_units_lab="m/s2",
        orddenom_spec_data_type=files.FORCE,
        orddenom_axis_units_lab="N",
        x=frequency,
        data=accelerance,
    )
    pyuff.UFF(str(path)).write_sets([record], mode="add")
