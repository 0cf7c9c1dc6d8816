"""Input without effect: refused, or reported with the result."""

import pytest
from tests.support.shell.structures import cantilever, thrown

from crumple.analysis import Analysis
from crumple.errors import InputError, Status
from crumple.multibody import Run, solve_multibody
from crumple.shell import ShellRun, solve_shell
from crumple.structure import MultibodySettings, Outputs, ShellSettings, Stage

COARSE = {"element_size": 24e-3}


@pytest.mark.parametrize(
    ("idle", "beside"),
    [
        ({"fine_length": 0.1}, {"fine_size": 6e-3}),
        ({"growth": 1.3}, {"fine_size": 6e-3}),
        ({"fine_at": [{"member": "tube", "at": 0.5}]}, {"fine_size": 6e-3}),
        ({"coarse_sections": "on"}, {"fine_size": 6e-3}),
        ({"hourglass": "viscous", "element": "stabilised"}, {"element": "belytschko-tsay"}),
        ({"hourglass_coefficient": 0.05, "element": "stabilised"}, {"element": "belytschko-tsay"}),
        ({"drill_stiffness": 0.02}, {"warping_correction": "on"}),
    ],
)
def test_settings_without_effect_are_refused_with_what_they_need(idle, beside):
    key = next(iter(idle))
    with pytest.raises(InputError) as caught:
        ShellSettings(element_size=25e-3, **idle)
    (problem,) = caught.value.problems
    assert f"'{key}' would have no effect" in problem.what
    assert problem.where == key
    ShellSettings(**{"element_size": 25e-3, **idle, **beside})


def test_friction_without_contact_is_refused_unless_members_touch():
    idle = ShellSettings(self_contact="off", contact_friction=0.2)
    with pytest.raises(InputError, match="'contact_friction' would have no effect"):
        Analysis(structure=thrown(), duration=1e-3, shell=idle)
    touching = thrown().model_copy(update={"member_contact": {"friction": 0.1, "restitution": 0.5}})
    Analysis(structure=touching, duration=1e-3, shell=idle)
    message = " ".join(
        solve_shell(touching, ShellRun(1e-4, 1e-4, ShellSettings(**COARSE, self_contact="off"))).assumptions
    )
    assert "self-contact on." in message
    assert "Self-contact is on despite its setting" in message
    assert "restitution of member contact" in message
    plain = " ".join(solve_shell(thrown(), ShellRun(1e-4, 1e-4, ShellSettings(**COARSE))).assumptions)
    assert "despite" not in plain
    assert "restitution" not in plain


def test_coarser_sections_without_space_are_reported():
    settings = ShellSettings(element_size=30e-3, fine_size=20e-3, fine_length=40e-3, coarse_sections="on")
    result = solve_shell(cantilever(), ShellRun(1e-5, 1e-5, settings))
    assert any("There are no coarser sections" in text for text in result.assumptions)


def test_pictures_after_an_early_end_are_reported():
    """The tip has moved by 2 mm long before the end."""
    way = [{"distance": 2e-3, "between": ("root", "tip")}]
    stages = (Stage(name="throw", duration=2e-3, until=[{"energy": 1e9}, *way]),)
    asked = Outputs(pictures=(1e-4, 1e-3, 1.9e-3))
    result = solve_shell(
        cantilever(
            masses={"m": {"node": "tip", "mass": 6.0}},
            initial_velocity=[{"nodes": ["tip"], "translation": (15.0, 0.0, 0.0)}],
        ),
        ShellRun(2e-3, 2e-4, ShellSettings(**COARSE), asked, stages=stages),
    )
    assert result.status is Status.COMPLETE
    assert result.time[-1] < 1e-3
    (message,) = [text for text in result.warnings if "no pictures at" in text]
    assert "no pictures at 1 ms, 1.9 ms." in message
    precise = MultibodySettings(accuracy=1e-10)
    run = Run(0.05, 0.005, settings=precise, outputs=Outputs(pictures=(0.0, 0.05)))
    shares = [0.0]
    stopped = solve_multibody(thrown(), run, shares.append, lambda: shares[-1] > 0.0)
    assert stopped.status is Status.CANCELLED
    assert any("no pictures at 50 ms." in text for text in stopped.warnings)
    whole = solve_multibody(thrown(), run)
    assert not [text for text in whole.warnings if "pictures" in text]
