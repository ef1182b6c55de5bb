"""Usage: isolation.py SOURCE_FOLDER ARCHIVE...

Checks that code compiled for newer processors stays apart from the rest of the program. If several objects
define an inline function, the linker keeps one copy; one with newer instructions would break older
processors. An object compiled for an instruction set may therefore not define shared symbols, and other
objects may not use registers of 256 or 512 bits. Eigen consists of such inline functions. Files in
kernels/ and terms/ and sources for an instruction set may not include it, directly or indirectly.
"""

import re
import subprocess
import sys
import tempfile
from pathlib import Path

SPECIAL = ("_avx2.cpp.o", "_avx512.cpp.o")


def output(*command, folder):
    return subprocess.run(command, cwd=folder, check=True, capture_output=True, text=True).stdout


def guarded_sources(engine):
    sources = [
        path
        for folder in ("kernels", "terms")
        for path in (engine / folder).rglob("*")
        if path.suffix in (".h", ".cpp")
    ]
    for suffix in ("baseline", "avx2", "avx512"):
        sources += engine.rglob(f"*_{suffix}.cpp")
    return sorted(set(sources))


def way_to_eigen(source, root, seen):
    """Returns the chain of includes from `source` to Eigen, or nothing; files in `seen` have none."""
    seen.add(source)
    for opening, name in re.findall(r'^\s*#\s*include\s*([<"])([^>"]+)', source.read_text(), re.MULTILINE):
        if re.match(r"(unsupported/)?Eigen/", name):
            return [source, name]
        header = root / name
        if opening == '"' and header.is_file() and header not in seen:
            if way := way_to_eigen(header, root, seen):
                return [source, *way]
    return []


def includes_of_eigen(root):
    sources, seen, faults = guarded_sources(root / "engine"), set(), []
    for source in sources:
        if source not in seen and (way := way_to_eigen(source, root, seen)):
            names = [str(step.relative_to(root)) if isinstance(step, Path) else step for step in way]
            faults.append(" includes ".join(names))
            seen -= set(way)  # other sources may use them, too
    if len(sources) < 25:
        faults.append(f"only {len(sources)} sources were found below {root}")
    return faults


def main():
    faults, special = includes_of_eigen(Path(sys.argv[1]).resolve()), 0
    with tempfile.TemporaryDirectory() as top:
        for archive in map(Path, sys.argv[2:]):
            folder = Path(top) / archive.name
            folder.mkdir()
            output("ar", "x", str(archive.resolve()), folder=folder)
            for member in sorted(folder.iterdir()):
                if member.name.endswith(SPECIAL):
                    special += 1
                    for line in output("nm", member.name, folder=folder).splitlines():
                        if line[17] in "WVu":
                            faults.append(f"{member.name} shares {line[19:]}")
                else:
                    code = output("objdump", "-d", "--no-show-raw-insn", member.name, folder=folder)
                    if "%ymm" in code or "%zmm" in code:
                        faults.append(f"{member.name} uses registers that not every processor has")
    if special != 7:
        faults.append(f"{special} objects for instruction sets were found instead of 7")
    print("\n".join(faults) or "nothing is shared")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
