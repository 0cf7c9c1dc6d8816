"""Refuse files, functions and folders that outgrew their noun: `python tools/sizes.py`.

Ceilings: file 400 lines (Python, C++, TypeScript), function body 60 lines (no docstring; not TypeScript),
6 positional arguments, 16 source files in a folder.  Aside: lines of literal tables at module level,
keyword-only options, `self` and `cls`, the `__init__.py` of a folder, and scripts of pages, which are made of
the TypeScript in `web/`.
"""

from __future__ import annotations

import ast
import re
import subprocess
import sys
from collections import Counter
from collections.abc import Iterable, Iterator
from pathlib import Path

FILE, BODY, ARGUMENTS, FOLDER = 400, 60, 6, 16
ROOT = Path(__file__).parent.parent
SUFFIXES = (".py", ".cpp", ".hpp", ".ts")

# argument order and number are ADAMS's
MORE_ARGUMENTS = {
    ("src/crumple/function/contact.py", "impact"),
    ("src/crumple/function/contact.py", "bistop"),
}

Function = ast.FunctionDef | ast.AsyncFunctionDef


def table_lines(tree: ast.Module) -> int:
    """Lines of literal containers assigned at module level."""
    literal = (ast.Dict, ast.List, ast.Tuple, ast.Set)
    assigned = (node for node in tree.body if isinstance(node, (ast.Assign, ast.AnnAssign)))
    values = (node.value for node in assigned if isinstance(node.value, literal))
    return sum((value.end_lineno or value.lineno) - value.lineno for value in values)


def python_findings(path: str, text: str) -> Iterator[str]:
    """What is too large in a Python file."""
    tree = ast.parse(text)
    lines = text.count("\n") - table_lines(tree)
    if lines > FILE:
        yield f"{path}: {lines} lines, at most {FILE}"
    for node in ast.walk(tree):
        if not isinstance(node, Function):
            continue
        body = node.body[1:] if ast.get_docstring(node) else node.body
        length = (body[-1].end_lineno or 0) - body[0].lineno + 1 if body else 0
        if length > BODY:
            yield f"{path}:{node.lineno} {node.name}: body of {length} lines, at most {BODY}"
        arguments = [a.arg for a in (*node.args.posonlyargs, *node.args.args) if a.arg not in ("self", "cls")]
        if len(arguments) > ARGUMENTS and (path, node.name) not in MORE_ARGUMENTS:
            yield f"{path}:{node.lineno} {node.name}: {len(arguments)} arguments, at most {ARGUMENTS}"


def cpp_findings(path: str, text: str) -> Iterator[str]:
    """What is too large in a C++ file; a function body is a brace after a closing parenthesis outside one."""
    lines = text.count("\n")
    if lines > FILE:
        yield f"{path}: {lines} lines, at most {FILE}"
    # comments and texts hold braces too; keep the line breaks
    blank = re.sub(
        r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])\'',
        lambda m: "\n" * m[0].count("\n"),
        text,
        flags=re.DOTALL,
    )
    start, depth, inside, head = 0, 0, -1, ""
    for match in re.finditer(r"[^{};]*[{};]", blank):
        head, mark = match[0][:-1].strip(), match[0][-1]
        line = blank.count("\n", 0, match.end()) + 1
        if mark == "{":
            depth += 1
            opens = re.search(r"\)\s*(const|noexcept|override|->|:|$)", head) and not re.match(
                r"namespace\b", head
            )
            if inside < 0 and opens:
                start, inside = line, depth
        elif mark == "}":
            if depth == inside:
                if line - start - 1 > BODY:
                    yield f"{path}:{start}: function body of {line - start - 1} lines, at most {BODY}"
                inside = -1
            depth -= 1


def other_findings(path: str, text: str) -> Iterator[str]:
    """What is too large in a file whose functions are not looked at."""
    lines = text.count("\n")
    if lines > FILE:
        yield f"{path}: {lines} lines, at most {FILE}"


def folder_findings(paths: Iterable[Path]) -> Iterator[str]:
    """Which folders hold too many source files."""
    counts = Counter(path.parent for path in paths if path.name != "__init__.py")
    for folder, files in sorted(counts.items()):
        if files > FOLDER:
            yield f"{folder.as_posix()}: {files} source files, at most {FOLDER}"


def main() -> int:
    """Print every finding; the number of findings decides the exit code."""
    command = ["git", "ls-files", "--cached", "--others", "--exclude-standard"]
    names = subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True).stdout.split("\n")
    sources = [
        name for name in sorted(set(names)) if Path(name).suffix in SUFFIXES and (ROOT / name).is_file()
    ]
    findings = list(folder_findings(map(Path, sources)))
    for name in sources:
        read = {".py": python_findings, ".ts": other_findings}.get(Path(name).suffix, cpp_findings)
        findings += read(name, (ROOT / name).read_text(encoding="utf-8"))
    print("\n".join(findings) if findings else "sizes: every file, function and folder is within its ceiling")
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main())
