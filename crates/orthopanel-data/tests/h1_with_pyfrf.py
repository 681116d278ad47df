"""Prints pyFRF's H1 (real, imaginary) and coherence of the hits in a universal file, one line a frequency above 0."""

import sys

import numpy as np
import pyFRF
import pyuff

sets = pyuff.UFF(sys.argv[1]).read_sets()
rate = int(round(1 / sets[0]["abscissa_inc"]))
force = np.array([s["data"] for s in sets if s["ordinate_spec_data_type"] == 13])
motion = np.array([s["data"] for s in sets if s["ordinate_spec_data_type"] == 12])
frf = pyFRF.FRF(rate, exc=force, resp=motion, exc_type="f", resp_type="a", window="none")
h1 = np.squeeze(frf.get_FRF(frf_form="accelerance"))
coherence = np.squeeze(frf.get_coherence()).real
for line in range(1, len(h1)):
    print(repr(float(h1[line].real)), repr(float(h1[line].imag)), repr(float(coherence[line])))
