"""Derivatives of final quantities with respect to parameters, integrated along with one run."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from crumple.errors import Status
from crumple.multibody.kernel_choice import why_spatial
from crumple.multibody.run import Cancel, Run, outcome_status
from crumple.multibody.variants.batch import Batch, PlanarBatch, SpatialBatch
from crumple.multibody.variants.directions import planar_ends
from crumple.multibody.variants.followers import spatial_ends
from crumple.structure import Structure, placed_hinges, with_elastic_members


@dataclass(frozen=True, eq=False)
class Sensitivities:
    """Final quantities of one run and their derivatives.

    Attributes
    ----------
    quantities
        Final values by name, as in `VariantTable`.
    derivatives
        By quantity, then by parameter: d quantity/d parameter in SI units; factors count from 1.
    status, reason
        How the run ended.
    """

    quantities: Mapping[str, float]
    derivatives: Mapping[str, Mapping[str, float]]
    status: Status
    reason: str

    def __getitem__(self, quantity: str) -> Mapping[str, float]:
        """Derivatives of a quantity, by parameter."""
        return self.derivatives[quantity]


def sensitivities(
    structure: Structure,
    run: Run,
    parameters: str | Sequence[str] | Mapping[str, float],
    cancel: Cancel | None = None,
) -> Sensitivities:
    """Derivatives of the final quantities of a run.

    Parameters
    ----------
    structure, run
        The structure; the quantities are those of `solve_variants`.
    parameters
        Paths and factors as in `solve_variants`, or one of them; as a mapping, with the step [SI] by which
        each is moved to see how the model's arrays follow it, needed where its value is zero.
    cancel
        As in `solve_multibody`.

    Returns
    -------
    Sensitivities
        Of the very motion that `solve_variants` finds.

    Raises
    ------
    InputError
        If the structure cannot be solved, a parameter does not exist, or it cannot be moved either way; in
        space also if there is contact, or a stage is quasi-static or ends on a condition.

    Notes
    -----
    The derivatives are those of the chain of steps that was taken.  They hold on one side alone where the
    answer has a kink: a hinge that just does not open, a stop that is just touched.  In space a derivative is
    NaN where a run close by cannot be solved in the same steps.

    References
    ----------
    Derivation and limits in docs/theory/sensitivities.md.
    Verified in tests/verification/derivatives/test_sensitivities.py and test_space_sensitivities.py.
    """
    structure = with_elastic_members(structure, run.settings, run.time_in_motion)
    given = {parameters: None} if isinstance(parameters, str) else parameters
    steps = given if isinstance(given, Mapping) else dict.fromkeys(given)
    in_space = why_spatial(structure, placed_hinges(structure), run) is not None
    batch: Batch = SpatialBatch(run) if in_space else PlanarBatch(run)
    poll = None if cancel is None else lambda _: not cancel()
    found = (spatial_ends if in_space else planar_ends)(batch, structure, steps, poll)
    quantities = {name: value for name, value in found.quantities.items() if name != "energy_residual"}
    derivatives = {
        quantity: {name: moved.slope(quantity) for name, moved in found.moved.items()}
        for quantity in quantities
    }
    bound = run.settings.energy_residual_bound
    status, reason = outcome_status(found.outcome, found.reason, found.residual, bound)
    return Sensitivities(quantities, derivatives, status, reason)
