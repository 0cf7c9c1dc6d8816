"""What is made of a description is kept, and forgotten when asked."""

from crumple.structure.remembered import forget, remembered


def test_answers_are_kept_until_they_are_forgotten():
    asked = []

    @remembered(8)
    def double(value):
        asked.append(value)
        return 2 * value

    assert [double(1), double(1), double(2)] == [2, 2, 4]
    assert asked == [1, 2]
    forget()
    assert double(1) == 2
    assert asked == [1, 2, 1]


def test_laws_are_sampled_anew(monkeypatch):
    from tests.support.result.folded_tube import analysis

    from crumple.hinge.record import recording
    from crumple.structure import placed_hinges

    sampled = []
    envelope = recording.sampled_envelope
    monkeypatch.setattr(
        recording, "sampled_envelope", lambda law, *rest: sampled.append(law) or envelope(law, *rest)
    )
    structure = analysis().structure
    forget()
    placed_hinges(structure)
    placed_hinges(structure)
    assert len(sampled) == 1
    forget()
    placed_hinges(structure)
    assert len(sampled) == 2
