"""The pages under docs and the README: links, paths and names in them exist, and their examples run."""

import importlib
import re
from fnmatch import fnmatch
from pathlib import Path

import pytest

import crumple

PAGES = [
    *(Path(name) for name in ("README.md", "CONTRIBUTING.md", "CHANGELOG.md")),
    *sorted(Path("docs").rglob("*.md")),
]
PATHS = re.compile(r"(?<![\w./-])(?:src|native|tests|tools|docs|examples)/[\w.*/-]*[\w*/]")
"""Paths from the root of the repository, in prose and code."""
LINKS = re.compile(r"\[[^\]]*\]\(([^)\s]+)\)")
NAMES = re.compile(r"`(crumple(?:\.\w+)+)")
"""Dotted Python names in code."""


def prose(page):
    """Text of a page without its fenced code, whose brackets are no links."""
    return re.sub(r"^```.*?^```", "", page.read_text(encoding="utf-8"), flags=re.MULTILINE | re.DOTALL)


def anchors(page):
    """Headings of a page as GitHub links them."""
    headings = re.findall(r"^#+ (.*)$", prose(page), re.MULTILINE)
    plain = [re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading) for heading in headings]
    return {re.sub(r"[^\w\- ]", "", text.lower()).replace(" ", "-") for text in plain}


@pytest.mark.parametrize("page", PAGES, ids=str)
def test_links_lead_somewhere(page):
    wrong = []
    for target in LINKS.findall(re.sub(r"\s+", " ", prose(page))):
        if target.startswith("http"):
            continue
        name, _, anchor = target.partition("#")
        file = page.parent / name if name else page
        if not file.exists() or (anchor and anchor not in anchors(file)):
            wrong.append(target)
    assert not wrong


@pytest.mark.parametrize("page", PAGES, ids=str)
def test_paths_exist(page):
    wrong = [
        path
        for path in PATHS.findall(page.read_text(encoding="utf-8"))
        if not list(Path().glob(path.rstrip("/")))
    ]
    assert not wrong


@pytest.mark.parametrize("page", PAGES, ids=str)
def test_python_names_exist(page):
    assert [name for name in NAMES.findall(page.read_text(encoding="utf-8")) if not importable(name)] == []


def importable(name):
    """Whether a dotted name is a module, or an attribute of one."""
    parts = name.split(".")
    for count in range(len(parts), 0, -1):
        try:
            found = importlib.import_module(".".join(parts[:count]))
        except ModuleNotFoundError:
            continue
        for part in parts[count:]:
            found = getattr(found, part, None)
        return found is not None
    return False


def test_readme_example_runs(capsys):
    (code,) = re.findall(
        r"^```python\n(.*?)^```", Path("README.md").read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL
    )
    stated = code.rstrip().rpartition("\n# ")[2]
    exec(compile(code, "README.md", "exec"), {})
    assert capsys.readouterr().out.strip() == stated


def channel_rows():
    """Patterns of channel names and their units, from the table of docs/conventions.md."""
    table = (
        Path("docs/conventions.md")
        .read_text(encoding="utf-8")
        .partition("## Channels")[2]
        .partition("**Hinges with")[0]
    )
    rows = {}
    for line in table.splitlines():
        if not line.startswith("| `"):
            continue
        names, units = line.split("|")[1:3]
        for pattern in spelt_out(names):
            rows[pattern] = {unit.strip() for unit in units.split(",")}
    return rows


def spelt_out(names):
    """Patterns of one cell: `.x` … `.z` stands for three, a name that begins with a point for another end."""
    found = []
    for text in re.findall(r"`([^`]+)`", names):
        if not text.startswith("."):
            found.append(text)
        elif text == ".z":
            found += [found[-1][:-1] + "y", found[-1][:-1] + "z"]
        else:
            # the last parts of the first name are replaced
            parts = found[0].split(".")
            found.append(".".join(parts[: len(parts) - text.count(".")]) + text)
    return [re.sub(r"NAME|HINGE", "*", text) for text in found]


@pytest.mark.parametrize("example", ["01_tube_bending", "03_measured_hinge", "11_front_rails"])
def test_channels_are_those_of_the_table(example):
    result = crumple.solve(crumple.load(f"examples/{example}.yaml"))
    rows = channel_rows()
    assert len(rows) > 40
    unknown = [
        name
        for name, channel in result.channels.items()
        if "." in name and not is_listed(rows, name, channel.unit)
    ]
    assert not unknown


def is_listed(rows, name, unit):
    """Whether a row has this channel, or the hinge's channel of which it is a component."""
    of_hinge = re.sub(r"^(hinge\.[^.]+\.\w+)\.[xyz]$", r"\1", name)
    return any(unit in units for pattern, units in rows.items() if fnmatch(of_hinge, pattern))
