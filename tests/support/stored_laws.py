"""Laws of a store made up for tests: a constant moment for each sense, with the hash of a place."""

from crumple.hinge.law import Source, Trust, Validity
from crumple.hinge.measured.law_file import write_law
from crumple.hinge.measured.place_hash import CORNER, JOINT, PLACE
from crumple.hinge.measured.stored import StoredCurve, StoredLaw


def law_text(
    place, positive=400.0, negative=300.0, *, corner=None, joint=None, stiffness=None, error=None, reach=0.5
):
    """Text of a law file; `place`: hash, `corner`: angle, `joint`: kind, as text."""
    origin = {"method": "shell", PLACE: place} | ({} if corner is None else {CORNER: corner})
    origin |= {} if joint is None else {JOINT: joint}
    at = (0.0, reach)
    return write_law(
        StoredLaw(
            title="made up",
            law="shell",
            origin=tuple(origin.items()),
            curve=StoredCurve((at, (positive, positive)), (at, (negative, negative))),
            source=Source("a test", Trust.COMPUTED),
            validity=Validity(reach, "a test", (), error),
            elastic_stiffness=stiffness,
        )
    )


def store_of(folder, *texts):
    """Write a store of laws to a folder."""
    folder.mkdir(parents=True, exist_ok=True)
    for i, text in enumerate(texts):
        (folder / f"{i}.law.yaml").write_text(text, encoding="utf-8")
    return folder
