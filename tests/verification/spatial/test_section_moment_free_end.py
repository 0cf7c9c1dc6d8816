"""Moment in sections of a swinging bar, near its free end too.

A slender bar of mass m and length L swings about a pin.  At the angle theta from the vertical the angular acceleration is
1.5 g/L sin(theta), and what lies beyond the distance x from the pin asks in the section at x for the moment

    M = (m g sin(theta)/4) x (1 - x/L)^2 ,

which vanishes with the square of the distance from the free end: found from the pin it is a difference of large
numbers.  Found from the free end its error is that of the acceleration, the mean of the last step, which is cut
short by the output interval: of first order in it, relative to the moment itself.

Kind: closed form.  Source: d'Alembert's principle; the moment in a falling chimney is the same.
"""

import numpy as np
import pytest
from tests.support.multibody.frames import structure

from crumple.multibody import Run, solve_multibody
from crumple.structure import MultibodySettings, Outputs

LENGTH, ANGLE, GRAVITY, SIDE = 2.0, 0.5, 9.81, 1e-3
PLACES = (0.4, 1.0, 1.5, 1.95)


@pytest.mark.parametrize(("every", "tolerance"), [(2e-3, 4e-3), (2e-4, 4e-4)])
@pytest.mark.parametrize("tip", [0.0, 3.0])
def test_swinging_bar(every, tolerance, tip, record_figure):
    nodes = {"o": (0.0, 0.0, 0.0), "t": (LENGTH * np.sin(ANGLE), 0.0, LENGTH * np.cos(ANGLE))}
    rigid = {"name": "h", "at": 0.05, "law": {"type": "constant", "moment": 1e5}}
    bar = {"nodes": ("o", "t"), "section": "thin", "material": "steel", "hinges": [rigid]}
    swing = structure(
        nodes,
        {"b": bar},
        sections={"thin": {"type": "square_tube", "side": SIDE, "thickness": SIDE / 4.0}},
        supports={"p": {"node": "o", "fix": ("x", "y", "z", "rx", "rz")}},
        masses={"m": {"node": "t", "mass": tip}} if tip else {},
        gravity=(0.0, 0.0, -GRAVITY),
    )
    sections = {f"s{i}": {"member": "b", "at": x} for i, x in enumerate(PLACES)}
    outputs = Outputs(nodes=("t",), section_forces=sections)
    settings = MultibodySettings(accuracy=1e-4, mechanism_check="off")
    result = solve_multibody(swing, Run(0.4, every, settings, outputs))
    lean = np.arccos((result["node.t.displacement.z"][-2] + nodes["t"][2]) / LENGTH)
    mass = 7850.0 * (SIDE**2 - (SIDE / 2.0) ** 2) * LENGTH
    # bar and tip: angular acceleration about the pin over g sin(theta)
    spin = (mass / 2.0 + tip) * LENGTH / (mass * LENGTH**2 / 3.0 + tip * LENGTH**2)
    for i, x in enumerate(PLACES):
        found = np.linalg.norm([result[f"s{i}.moment.{axis}"][-2] for axis in "xyz"])
        own, arm = mass * (1.0 - x / LENGTH), (LENGTH - x) / 2.0
        # what lies beyond: its weight's moment less what its acceleration takes
        needed = own * spin * ((x + arm) * arm + arm**2 / 3.0) + tip * spin * LENGTH * (LENGTH - x)
        expected = GRAVITY * np.sin(lean) * abs(own * arm + tip * (LENGTH - x) - needed)
        name = f"moment at {x} m, tip {tip} kg, outputs every {1e3 * every:g} ms"
        record_figure(name, found, expected, tolerance, "N*m", relative=True)
