"""Which of the candidate's modes of collapse the reference follows."""

from dataclasses import replace

import pytest
from tests.support.result.folded_tube import analysis, folded_result

from crumple.analysis import solve
from crumple.comparison import compare, with_frames
from crumple.result.nearby import Mode, Modes


@pytest.mark.parametrize(
    ("largest", "other", "text"),
    [
        (0.545, 0.1, "of 2 modes of collapse of the multibody model, the shell run follows its result"),
        (0.2, 0.1, "nearest to one that is not its result: root 5.7°, which it has with 'less friction'"),
        (0.2, None, ""),
    ],
)
def test_the_mode_nearest_to_the_shells_is_named(largest, other, text):
    case = analysis()
    result = solve(with_frames(case, 21))
    own = Mode(("root",), (result.hinges["root"].rotation_max,), ("as given",))
    others = () if other is None else (Mode(("root",), (other,), ("less friction",)),)
    trust = compare(
        replace(result, modes=Modes((own, *others))), folded_result(largest=largest), case.structure
    ).trust
    said = [one for one in (*trust.facts, *trust.cautions) if "modes of collapse of" in one]
    assert len(said) == bool(text)
    assert all(text.lower() in one.lower() for one in said)
    assert ("not its result" in text) == any("modes of collapse of" in one for one in trust.cautions)


def test_nothing_is_said_of_hinges_that_have_no_fold():
    case = analysis()
    modes = Modes((Mode(("other",), (0.5,), ("as given",)), Mode((), (), ("stiffer",))))
    found = compare(replace(solve(with_frames(case, 21)), modes=modes), folded_result(), case.structure)
    assert not any("modes of collapse of" in one for one in (*found.trust.facts, *found.trust.cautions))
