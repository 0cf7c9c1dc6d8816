"""From a measured curve to a law file."""

from __future__ import annotations

import math

from crumple.characterisation.crush import Crush
from crumple.characterisation.curve import LawCurve
from crumple.characterisation.sub_model import SubModel
from crumple.hinge.law import SofteningVariable, Source, Trust, Validity
from crumple.hinge.measured.place_hash import CORNER, PLACE, REVISION
from crumple.hinge.measured.stored import StoredCurve, StoredLaw
from crumple.version import __version__

CORNER_METHOD = 5
"""Number of the way in which sub-models of corners are built and measured; before 4 the pieces of deep
sections at steep angles were too short for a mitre, and before 5 those of rectangular tubes about their
bisector for what the corner distorts."""
CITATION = "shell sub-model, docs/theory/characterisation.md"


def law_of(
    model: SubModel, curve: LawCurve, opposite: LawCurve | None, facts: dict[str, str], error: float | None
) -> StoredLaw:
    """Law of a sub-model, ready for its file.

    Parameters
    ----------
    model
        What was solved.
    curve, opposite
        Law in the sense of the model, and in the other sense; None: the section is the same in both.
    facts
        Entries of the law file on the run, by key.
    error
        Relative error of the energy, estimated on other meshes; None where only one was solved.

    Returns
    -------
    StoredLaw
        Its positive sense is that of the hinge: positive about the axis.
    """
    positive, negative = (curve, opposite) if model.sense > 0 else (opposite, curve)
    points = [_points(one if one is not None else curve) for one in (positive, negative)]
    slip = isinstance(model, Crush)
    if isinstance(model, Crush):
        points[0] = ((0.0,), (model.squash_force,))
    reach = min(float(one.rotation[-1]) for one in (curve, opposite) if one is not None)
    material = model.material
    origin = {
        "method": "shell",
        **model.origin,
        PLACE: model.place,
        "material": f"E {material.youngs_modulus / 1e9:g} GPa, yield {material.yield_stress / 1e6:g} MPa",
        "made_by": f"crumple {__version__}, crumple characterise",
        **facts,
    }
    if CORNER in origin:
        origin[REVISION] = str(CORNER_METHOD)
    far = f"shortening of {1e3 * reach:.4g} mm" if slip else f"rotation of {math.degrees(reach):.0f} deg"
    basis = f"shell sub-model solved up to a plastic {far}"
    return StoredLaw(
        title=model.title,
        law="shell",
        origin=tuple(origin.items()),
        curve=StoredCurve(*points),
        source=Source(CITATION, Trust.COMPUTED, "as good as shells are for this section"),
        validity=Validity(reach, basis, (), error),
        softening_variable=SofteningVariable.PEAK,
        elastic_stiffness=curve.stiffness,
        slip=slip,
    )


def _points(curve: LawCurve) -> tuple[tuple[float, ...], tuple[float, ...]]:
    return tuple(curve.rotation.tolist()), tuple(curve.moment.tolist())
