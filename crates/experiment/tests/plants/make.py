"""Makes the .mat files of this folder, with scipy 1.17.1: python make.py"""

import numpy as np
from scipy.io import savemat

a = np.array([[0.0, 1.0], [-2.0, -3.0000000000000004]])
b = np.array([[0.0], [1.0]])
c = np.array([[1.0, 0.1]])
d = np.array([[0.0]])
four = {"A": a, "B": b, "C": c, "D": d, "Ts": 0.01}
savemat("plain.mat", four)
savemat("compressed.mat", four, do_compression=True)
savemat("four.mat", four, format="4")
savemat("structure.mat", {"note": "a motor", "sys": four}, do_compression=True)
savemat("whole.mat", {"A": np.array([[0, 1], [-2, -3]]), "B": b.astype("i2"), "C": c.astype("f4"), "D": 0}, do_compression=True)
savemat("transfer.mat", {"num": [1.0, 2.0], "den": [1.0, 3.0, 2.5], "Ts": 0.0})
cell = np.empty((1, 1), dtype=object)
cell[0, 0] = np.array([[2.0, 1.0]])
below = np.empty((1, 1), dtype=object)
below[0, 0] = np.array([[1.0, 0.5, 0.25]])
savemat("cells.mat", {"num": cell, "den": below})
savemat("factors.mat", {"z": np.array([[-3.0]]), "p": np.array([[-1 + 2j], [-1 - 2j]]), "k": 4.0})
w = np.logspace(-1, 2, 12)
savemat("response.mat", {"w": w, "H": 1 / (1j * w + 1)}, do_compression=True)
