"""python dump_sweeps.py DATA OUT.npz: the sweeps as Rilo's Python package reads them.

Run by the interpreter that the package was built for, whose numpy need not be that of the witnesses.
"""

import sys

import numpy as np

import rilo

arrays = {}
source = rilo.open(sys.argv[1])
count = 0
for count, sweep in enumerate(source, start=1):
    columns = {"points": sweep.points, "times": sweep.times_s, "rings": sweep.rings, "intensities": sweep.intensities}
    arrays.update({f"{name}_{count - 1}": column for name, column in columns.items() if column is not None})
    arrays[f"stamp_{count - 1}"] = np.int64(sweep.stamp_ns)
np.savez(sys.argv[2], count=count, **arrays)
