"""Spot welds in shells satisfy statics: strength in shear and tension, peeling, bending of a welded hat.

- Strength: one spot between two strips of 40 x 1.5 mm.  Pulled along the strips (single lap), or apart
  where they cross, the spot alone carries the force at the supports: it fails when that is its strength.
  Tolerance: 4 % of the support force at the last output before failure, which still oscillates; 0.5 % of
  the force of the weld itself.
- Both together: the left side of (Fn/Sn)^2 + (Fs/Ss)^2 is 1 within an output interval, 2 %.
- Peeling: a plate is torn from a hat; spots fail one by one from the loaded end; the energy balance closes.
- Bending: the tip of a cantilever of hat and plate, welded along both flanges, compared with one closed
  section tied at every ring.  For a pitch of zero they are the same (2 %); the compliance grows with the
  pitch. Sheets that slide on each other deflect 1.67 times as far (the second moment of area of the hat
  alone).

Kind: closed form; invariant.  Source: derived here; derived here.
"""

import numpy as np
import pytest
from tests.support.shell.welded_parts import SETTINGS, closed_hat, cross, driven, hat_and_plate, lap

from crumple.errors import Status
from crumple.shell import ShellRun, solve_shell
from crumple.structure import Outputs, ShellSettings

SHEAR = {"shear_strength": 3000.0, "normal_strength": 9000.0}
TENSION = {"shear_strength": 9000.0, "normal_strength": 2000.0}


def failing(given, time):
    """Result, and the number of the last output before the spot fails."""
    result = solve_shell(given, ShellRun(time, 2e-6, SETTINGS, Outputs()))
    assert result.status is Status.COMPLETE
    assert result["weld.spot.failed"][-1] == 1.0
    return result, int(np.argmax(result["weld.spot.failed"] > 0.0)) - 1


def test_single_lap_fails_at_its_shear_strength(record_figure):
    result, last = failing(lap(0.4e-3, 4e-3, **SHEAR), 3e-3)
    record_figure(
        "force in the spot", result["weld.spot.shear_force"][last], 3000.0, 0.005, "N", relative=True
    )
    pulled, held = -result["support.pulled.force.x"][last], result["support.held.force.x"][last]
    record_figure("force of the puller", pulled, 3000.0, 0.04, "N", relative=True)
    record_figure("force at the clamp", held, 3000.0, 0.04, "N", relative=True)
    record_figure("energy residual", result.energy_residual, 0.0, 1e-2)
    # what is left swings, and carries nothing
    late = result.time > result.time[last] + 1e-3
    assert abs(result["support.held.force.x"][late].mean()) < 50.0


def test_crossed_strips_fail_at_the_tensile_strength(record_figure):
    result, last = failing(cross(6e-3, 6e-3, **TENSION), 6e-3)
    record_figure(
        "force in the spot", result["weld.spot.normal_force"][last], 2000.0, 0.005, "N", relative=True
    )
    lifted = -sum(result[f"support.lifted-{node}.force.z"][last] for node in "cd")
    record_figure("force of both lifted ends", lifted, 2000.0, 0.04, "N", relative=True)
    assert result["weld.spot.shear_force"][last] < 1.0
    record_figure("energy residual", result.energy_residual, 0.0, 1e-2)


def test_forces_across_and_along_count_together(record_figure):
    """The lap bends, so its spot is pulled open too: with little tensile strength it fails sooner."""
    weak = {"shear_strength": 3000.0, "normal_strength": 120.0}
    result, last = failing(lap(0.4e-3, 4e-3, **weak), 2e-3)
    across, along = result["weld.spot.normal_force"][last], result["weld.spot.shear_force"][last]
    record_figure("left side before failure", (across / 120.0) ** 2 + (along / 3000.0) ** 2, 1.0, 0.02)
    assert along < 2700.0
    assert across < 110.0


def test_a_plate_peels_off_a_hat_from_the_loaded_end(record_figure):
    supports = {name: {"node": name, "fix": "all"} for name in ("root", "tip", "plate-root")}
    supports["puller"] = driven("plate-tip", "z", -0.03, 8e-3)
    spots = {"pitch": 0.04, "normal_strength": 2000.0, "shear_strength": 4000.0, "diameter": 6e-3}
    given = hat_and_plate(0.3, spots=spots, supports=supports)
    settings = ShellSettings(element_size=8e-3, damping=300.0)
    result = solve_shell(given, ShellRun(8e-3, 4e-5, settings, Outputs()))
    assert result.status is Status.COMPLETE
    record_figure("energy residual", result.energy_residual, 0.0, 1e-2)
    work = result["energy.external_work"][-1]
    record_figure("hourglass over work", result["energy.hourglass"].max() / work, 0.0, 0.02)
    reported = [text for text in result.warnings if "failed" in text]
    assert len(reported) == 2
    for text in reported:
        places = [float(part.split(",")[0]) for part in text.split("the one at (")[1:]]
        assert places == sorted(places, reverse=True)
    # both flanges alike
    assert np.array_equal(result["weld.left.failed"], result["weld.right.failed"])


LENGTH, FORCE = 0.4, 100.0
RAMP = {"step5": {"x0": 0.0, "h0": 0.0, "x1": 6e-3, "h1": FORCE}}
BEND = ShellSettings(element_size=10e-3, damping=1500.0)


def deflection(given, settings=BEND):
    result = solve_shell(given, ShellRun(14e-3, 2e-4, settings, Outputs(nodes=("tip",))))
    assert result.energy_residual < 1e-2
    moved = result["node.tip.displacement.z"]
    assert np.ptp(moved[-8:]) < 2e-3 * moved[-1]
    return float(moved[-1])


@pytest.mark.slow
def test_welded_hat_bends_like_a_closed_one_the_more_so_the_nearer_the_spots(record_figure):
    more = {
        "supports": {"c": {"node": "root", "fix": "all"}},
        "loads": [{"node": "tip", "force": {"z": RAMP}}],
    }
    closed = deflection(closed_hat(LENGTH, **more))
    both = {**more, "supports": {**more["supports"], "c2": {"node": "plate-root", "fix": "all"}}}
    ratios = [
        deflection(hat_and_plate(LENGTH, spots={"pitch": pitch}, **both)) / closed
        for pitch in (0.04, 0.08, 0.2)
    ]
    record_figure("pitch 40 mm: deflection over that of the closed section", ratios[0], 1.0, 0.02)
    assert ratios[0] < ratios[1] < ratios[2] < 1.1
    loose = hat_and_plate(LENGTH, spots={"pitch": 0.04}, **both).model_copy(update={"spot_welds": {}})
    record_figure("without welds", deflection(loose) / closed, 1.67, 0.03)
