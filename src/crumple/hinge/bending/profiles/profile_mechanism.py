"""The tube's folding mechanism with the faces that a profile has: channels and hats.

The mechanism of crumple.hinge.bending.kecman_mechanism needs two webs that bulge outwards; its faces only
have to keep their lengths.  So a face may be missing, lie outside the webs (a flange in the plane of the
face follows the same hinge lines: it contains them), or be doubled (welded sheets slide on each other and
each folds with its own m_p). With a the spacing of the webs:

    W1, W2   times w_c/a     w_c = sum over sheets of the compressed face of width (t_i/t)^2
    W3       times w_t/a     w_t = the same of the stretched face
    W6       only where a stretched face holds the lower edge of the web

Limits: w_c = w_t = a with a held edge is the tube; w_c -> 0 leaves the webs alone.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from numpy.typing import ArrayLike, NDArray

from crumple.hinge.bending.kecman_mechanism import FoldMechanism
from crumple.numeric.arrays import Floats


@dataclass(frozen=True)
class ProfileMechanism(FoldMechanism):
    """Folded zone of a profile with two webs.

    Attributes
    ----------
    width, depth, thickness
        Spacing of the webs over their outer faces, their depth, and their wall [m].
    compressed_face, stretched_face
        w_c and w_t [m].

    References
    ----------
    docs/theory/folded_profile.md.  Verified in tests/verification/profiles/test_folded_profiles.py.
    """

    compressed_face: float = 0.0
    stretched_face: float = 0.0

    def energy_terms(self, rotation: ArrayLike) -> dict[str, NDArray[Any]]:
        """Plastic work of each line over m_p [m] at a rotation [rad]."""
        return self._of_faces(super().energy_terms(rotation))

    def energy_rates(self, rotation: ArrayLike) -> dict[str, Floats]:
        """Derivatives of `energy_terms` [m] by the rotation [rad], which must not be zero."""
        return self._of_faces(super().energy_rates(rotation))

    def _of_faces(self, terms: dict[str, NDArray[Any]]) -> dict[str, NDArray[Any]]:
        for name in ("W1", "W2"):
            terms[name] = terms[name] * (self.compressed_face / self.width)
        terms["W3"] = terms["W3"] * (self.stretched_face / self.width)
        if self.stretched_face == 0.0:
            terms["W6"] = 0.0 * terms["W6"]
        return terms
