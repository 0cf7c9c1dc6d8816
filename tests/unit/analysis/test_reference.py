"""The tables of docs/input.md are those of the models, and its example runs."""

import re
from pathlib import Path

from crumple.analysis import InputFile, loads
from crumple.analysis.reference import BEGIN, END, input_reference, main
from crumple.analysis.schema import models_of

DOCUMENT = Path("docs/input.md")


def test_the_document_holds_the_tables_of_the_models():
    text = DOCUMENT.read_text(encoding="utf-8")
    written = text.partition(BEGIN)[2].partition(END)[0].strip()
    assert written == input_reference(), "run: python -m crumple.analysis.reference docs/input.md"


def test_writing_again_changes_nothing(tmp_path):
    copy = tmp_path / "input.md"
    copy.write_text(DOCUMENT.read_text(encoding="utf-8"), encoding="utf-8")
    main(copy)
    main(copy)
    assert copy.read_text(encoding="utf-8") == DOCUMENT.read_text(encoding="utf-8")


def test_every_key_of_every_part_has_a_row():
    tables = input_reference()
    for model in models_of(InputFile):
        for name, field in model.model_fields.items():
            assert f"| `{field.alias or name}` |" in tables
    assert tables.count("### ") >= len(models_of(InputFile))


def test_the_examples_of_the_document_are_sound():
    example, more, obstacles, stages = re.findall(
        r"```yaml\n(.*?)```", DOCUMENT.read_text(encoding="utf-8"), re.DOTALL
    )
    assert loads(example).structure.members["arm"].hinges[0].name == "fold"
    # the second shows materials and sections alone: it replaces those of the first
    end = example.index("nodes:")
    whole = example[: example.index("materials:")] + more + example[end:]
    for name in ("rail", "sill"):
        law = "folded_profile" if name == "rail" else "constant"
        text = whole.replace("section: tube", f"section: {name}").replace("material: steel", "material: mild")
        structure = loads(text.replace("at: root", f"at: root, law: {law}")).structure
        assert {wall.material.name for wall in structure.section_of("arm").walls if wall.material} == {
            "strong"
        }
    whole = example.replace("analysis:\n  duration: 100 ms\n", obstacles + stages)
    assert [stage.name for stage in loads(whole).stages] == ["push", "impact"]
