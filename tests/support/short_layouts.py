"""The layouts of the examples, solved in a third of their time: for tests that solve them many times."""

from pathlib import Path

LAYOUTS = Path(__file__).parents[2] / "examples" / "layouts"
CHANGES = (
    ("multibody: {", "multibody: {accuracy: 1e-2, "),
    ("duration: 120 ms", "duration: 60 ms"),
    ("60 ms, 120 ms]", "60 ms]"),
)


def short_layout(name, folder):
    """Write a layout with half its duration and a lower accuracy; its path."""
    text = (LAYOUTS / f"{name}.yaml").read_text(encoding="utf-8")
    for old, new in CHANGES:
        assert old in text
        text = text.replace(old, new)
    path = folder / f"{name}.yaml"
    path.write_text(text, encoding="utf-8")
    return path
