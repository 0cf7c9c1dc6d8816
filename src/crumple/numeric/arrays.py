"""Types of arrays; shapes stand in the docstrings of those who take or give them."""

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]
