"""Types of arrays; shapes are given in the docstrings of the functions."""

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]
