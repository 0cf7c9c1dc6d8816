"""Compile the kernels for other compilers, processors and systems, run what can be run, compare the figures.

What is not installed is left out, and the reason printed; only the machine's own compiler has to be there:

    clang++                           Clang on this machine
    aarch64-linux-gnu-g++             GCC for arm64; run by qemu-aarch64-static
    x86_64-w64-mingw32-g++, clang++   Clang for Windows, with MinGW's headers and library; run by wine64
    the same two                      Clang with the binary interface of MSVC, with those headers; not linked
    clang++                           the options of clang-cl that CMakeLists.txt gives
    qemu-x86_64-static                the choice of the instruction set on older processors

The bindings stay out: they need Python's headers of the target.
"""

from __future__ import annotations

import os
import platform
import re
import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
NATIVE = ROOT / "native"
PROGRAM = ROOT / "tests" / "portability" / "kernels.cpp"
BUILD = ROOT / "build" / "portability"
# Exit code of the program if the processor lacks the instruction set that is selected.
LACKS_INSTRUCTIONS = 3
# Processors of QEMU, and the message of the program about its choice there.
OLDER = {"core2duo": "lacks the x86-64-v2 instructions", "Nehalem": "x86-64-v2", "Haswell": "x86-64-v3"}
WARNINGS = ("-Wall", "-Wextra", "-Werror")
X86 = ("v2", "v3", "v4")
ON_X86 = platform.machine() in ("x86_64", "AMD64")
# The C libraries differ in the last bit of their functions, and 200 yielding steps carry that along; a wrong
# lane or rounding shows at once.  Residuals are differences of nearly equal energies.
RELATIVE, ABSOLUTE = 1e-9, 1e-12
# The headers are written for GCC, so Clang must not pass as MSVC; layout, names and calls stay its.
LIKE_GCC = (
    *("-fno-ms-compatibility", "-fdeclspec", "-fmsc-version=0", "-U_MSC_VER", "-U_MSC_FULL_VER"),
    *("-D__MINGW32__", "-D__MINGW64__", "-D__declspec=__declspec"),
)


@dataclass(frozen=True)
class Target:
    """A compiler for a machine."""

    name: str
    compiler: tuple[str, ...]
    kernels: tuple[str, ...]
    """Levels of x86-64, or ("generic",)."""
    needs: tuple[str, ...] = ()
    """Programs beside the compiler."""
    run: tuple[str, ...] | None = ()
    """What to put before the program; None: it is compiled and not run."""
    link: tuple[str, ...] = ("-pthread",)

    def lacking(self) -> list[str]:
        """Programs without which nothing can be compiled."""
        return [name for name in (self.compiler[0], *self.needs) if shutil.which(name) is None]


def mingw() -> str:
    """MinGW's compiler: the one with the threads of C++ where a system has two."""
    name = "x86_64-w64-mingw32-g++"
    return f"{name}-posix" if shutil.which(f"{name}-posix") else name


def mingw_headers() -> tuple[str, ...]:
    """Folders of the C++ library and the C headers for Windows, as its own compiler names them."""
    compiler = shutil.which(mingw())
    if compiler is None:
        return ()
    report = subprocess.run(
        [compiler, "-E", "-x", "c++", "-v", os.devnull], capture_output=True, text=True, check=True
    ).stderr
    listed = report.split("#include <...> search starts here:")[1].split("End of search list.")[0]
    # not the compiler's own folder: Clang has its own headers of intrinsics
    folders = [line.strip() for line in listed.splitlines() if line.strip()]
    kept = [name for name in folders if not re.search(r"/gcc/[^/]+/[^/]+/include(-fixed)?$", name)]
    return tuple(word for name in kept for word in ("-isystem", name))


def mingw_libraries() -> tuple[str, ...]:
    """Folder of the C++ library for Windows that belongs to these headers."""
    compiler = shutil.which(mingw())
    if compiler is None:
        return ()
    library = subprocess.run(
        [compiler, "-print-libgcc-file-name"], capture_output=True, text=True, check=True
    ).stdout
    return (f"-L{Path(library.strip()).parent}",)


def wine() -> str:
    """Wine's loader; Debian keeps it apart from the other programs."""
    return shutil.which("wine64", path=os.pathsep.join((os.environ["PATH"], "/usr/lib/wine"))) or "wine64"


def targets() -> list[Target]:
    """The machine's own compiler first: the others are compared with it."""
    own = (os.environ.get("CXX", "c++"),)
    x86 = X86 if ON_X86 else ("generic",)
    headers = mingw_headers()
    windows = ("clang++", "--target=x86_64-w64-windows-gnu", *headers)
    msvc = ("clang++", "--target=x86_64-pc-windows-msvc", *LIKE_GCC, *headers)
    whole = ("-static", "-pthread")
    return [
        Target("this machine", own, x86),
        Target("Clang", ("clang++",), x86),
        Target("arm64", ("aarch64-linux-gnu-g++",), ("generic",), run=("qemu-aarch64-static",), link=whole),
        Target("Windows", windows, X86, (mingw(),), run=(wine(),), link=(*mingw_libraries(), *whole)),
        Target("MSVC's binary interface", msvc, X86, (mingw(),), run=None),
    ]


def arithmetic() -> tuple[str, ...]:
    """The options that CMakeLists.txt gives for floating-point arithmetic."""
    found = re.search(
        r"^set\(arithmetic (.*)\)$", (ROOT / "CMakeLists.txt").read_text(encoding="utf-8"), re.MULTILINE
    )
    assert found is not None, "CMakeLists.txt has no line set(arithmetic ...)"
    return tuple(found[1].split())


def units(kernels: tuple[str, ...]) -> list[tuple[str, Path, tuple[str, ...]]]:
    """Object name, source and options of everything but the bindings."""
    element = NATIVE / "shell" / "element" / "kernel.cpp"
    blocks = NATIVE / "spatial" / "solve" / "block_kernels.cpp"
    tangent = NATIVE / "planar" / "tangent.cpp"
    again = [
        NATIVE / name for name in re.findall(r'#include "(.*\.cpp)"', tangent.read_text(encoding="utf-8"))
    ]
    found: list[tuple[str, Path, tuple[str, ...]]] = [("program", PROGRAM, ())]
    for source in sorted(NATIVE.rglob("*.cpp")):
        name = "_".join(source.relative_to(NATIVE).with_suffix("").parts)
        if "bind" in name or source in (element, tangent, blocks):
            continue
        # of the sources that are compiled once more for derivatives, one is for these alone
        if source in again:
            found.append((f"{name}_tangent", source, ("-DCRUMPLE_TANGENT",)))
        if source.stem != "directions":
            found.append((name, source, ()))
    found.append(("blocks_plain", blocks, ("-O3", "-DCRUMPLE_BLOCKS=blocks_plain")))
    if "v3" in kernels:
        found.append(("blocks_v3", blocks, ("-O3", "-DCRUMPLE_BLOCKS=blocks_v3", "-march=x86-64-v3")))
    for level in kernels:
        name = level if level == "generic" else f"x86-64-{level}"
        options = (
            "-Wno-psabi",
            "-O3",
            f"-DCRUMPLE_KERNELS=kernels_{level}",
            f'-DCRUMPLE_KERNELS_NAME="{name}"',
        )
        if level == "v4":
            # GCC 12 warns of its own AVX-512 header, see native/shell/shell.cmake; Clang has no such option
            options += ("-Wno-uninitialized", "-Wno-unknown-warning-option", "-Wno-maybe-uninitialized")
        found.append(
            (f"kernel_{level}", element, options if level == "generic" else (*options, f"-march={name}"))
        )
    return found


def compiled(target: Target) -> list[str]:
    """Compile all sources of a target; the objects.  The first error ends the program."""
    folder = BUILD / target.name.replace(" ", "_").replace("'", "")
    folder.mkdir(parents=True, exist_ok=True)
    launcher = os.environ.get("CMAKE_CXX_COMPILER_LAUNCHER", "").split()

    def compile_one(unit: tuple[str, Path, tuple[str, ...]]) -> str:
        name, source, options = unit
        out = str(folder / f"{name}.o")
        command = [
            *launcher,
            *target.compiler,
            "-std=c++17",
            "-O2",
            *arithmetic(),
            *WARNINGS,
            f"-I{NATIVE}",
            *options,
        ]
        done = subprocess.run(
            [*command, "-c", str(source), "-o", out], capture_output=True, text=True, check=False
        )
        if done.returncode != 0 or done.stderr.strip():
            sys.exit(f"{target.name}: {source.relative_to(ROOT)}:\n{done.stderr}")
        return out

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        return list(pool.map(compile_one, units(target.kernels)))


def linked(target: Target, objects: list[str]) -> str:
    """Link the objects; the program."""
    program = str(Path(objects[0]).with_name("kernels.exe"))
    command = [*target.compiler, *objects, *target.link, "-o", program]
    # MinGW's linker warns that GCC's and Clang's type information differ in size
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{target.name}: {done.stderr}")
    return program


def figures(command: list[str]) -> dict[str, float]:
    """What the program prints; nothing where the processor lacks the instructions. A failure ends all."""
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode == LACKS_INSTRUCTIONS:
        return {}
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)} failed:\n{done.stdout}{done.stderr}")
    return {name: float(value) for name, value in map(str.split, done.stdout.splitlines())}


def differing(own: dict[str, float], other: dict[str, float]) -> list[str]:
    """Figures that two builds do not share."""
    return [
        f"{name}: {other.get(name)} instead of {value!r}"
        for name, value in own.items()
        if name not in other or abs(other[name] - value) > RELATIVE * abs(value) + ABSOLUTE
    ]


def check_older_processors() -> str:
    """Whether the levels of older processors are recognised, which QEMU stands for."""
    emulator, program = shutil.which("qemu-x86_64-static"), BUILD / "this_machine" / "kernels.exe"
    if emulator is None or not ON_X86:
        return "skipped: " + ("qemu-x86_64-static not installed" if ON_X86 else "this is another processor")
    for processor, message in OLDER.items():
        command = [emulator, "-cpu", processor, str(program)]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if message not in done.stderr:
            sys.exit(f"{' '.join(command)}: {message!r} expected\n{done.stdout}{done.stderr}")
    return ", ".join(f"{processor}: {message}" for processor, message in OLDER.items())


def check_clang_cl() -> str:
    """Whether clang-cl takes the options that CMakeLists.txt gives it: of others it only warns."""
    if shutil.which("clang++") is None:
        return "skipped: clang++ is not installed"
    given = ["/W4", "/O2", "/EHsc", "-Werror", "-Wno-psabi", "-march=x86-64-v3"]
    given += [f"/clang:{option}" for option in ("-O3", *arithmetic())]
    command = [
        "clang++",
        "--driver-mode=cl",
        "--target=x86_64-pc-windows-msvc",
        "-###",
        "/c",
        *given,
        # a path that starts with a slash would be an option
        "--",
        str(PROGRAM),
    ]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    unknown = [line for line in done.stderr.splitlines() if "warning:" in line or "error:" in line]
    if unknown:
        sys.exit("clang-cl: " + "\n".join(unknown))
    return "takes all options"


def check(target: Target, reference: dict[str, float]) -> str:
    """Compile and, if that can be, run; `reference` gets the figures where it is empty."""
    lacking = target.lacking()
    if lacking:
        return f"skipped: {' and '.join(lacking)} not installed"
    objects = compiled(target)
    done = f"{len(objects)} sources compile"
    if target.run is None:
        return done
    program = linked(target, objects)
    if target.run and shutil.which(target.run[0]) is None:
        return f"{done} and link; not run: {target.run[0]} not installed"
    ran = []
    names = [level if level == "generic" else f"x86-64-{level}" for level in target.kernels]
    for isa in names:
        found = figures([*target.run, program, isa])
        if not found:
            continue
        ran.append(isa)
        if not reference:
            reference.update(found)
        wrong = differing(reference, found)
        if wrong:
            sys.exit(f"{target.name}, {isa}: other figures than the first target\n" + "\n".join(wrong))
    return f"{done}; the same figures from {', '.join(ran)}"


def main() -> None:
    """Check every target that can be."""
    reference: dict[str, float] = {}
    for target in targets():
        print(f"{target.name}: {check(target, reference)}", flush=True)
    print(f"older processors: {check_older_processors()}")
    print(f"clang-cl: {check_clang_cl()}")


if __name__ == "__main__":
    main()
