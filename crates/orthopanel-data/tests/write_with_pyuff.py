"""Writes one universal file a layout that pyuff knows into the folder given, and prints their names."""

import pathlib
import sys

import numpy as np
import pyuff

folder = pathlib.Path(sys.argv[1])
n = np.arange(11)
for binary in (0, 1):
    for even in (0, 1):
        for kind in ("real", "complex"):
            for precision in ("single", "double"):
                name = f"{'binary' if binary else 'text'}-{'even' if even else 'uneven'}-{kind}-{precision}.uff"
                data = (n + 1.0) ** 2 / 7
                if kind == "complex":
                    data = data - 3j * n
                code = {"real": 2, "complex": 5}[kind] + (precision == "double") * (2 if kind == "real" else 1)
                dataset = {
                    "type": 58, "binary": binary, "func_type": 4 if kind == "complex" else 1,
                    "rsp_node": 1, "rsp_dir": 3, "ref_node": 2, "ref_dir": 3,
                    "ord_data_type": code, "abscissa_spacing": even, "abscissa_min": 2.0, "abscissa_inc": 0.5,
                    "x": 2.0 + 0.5 * n, "data": data, "id1": name,
                    "abscissa_spec_data_type": 18, "ordinate_spec_data_type": 12, "orddenom_spec_data_type": 13,
                    "z_axis_spec_data_type": 0,
                }
                uff = pyuff.UFF(str(folder / name))
                # pyuff's "overwrite" mode garbles binary sets, so each goes into a file of its own.
                uff.write_sets(dataset, mode="add", force_double=False)
                print(name)
