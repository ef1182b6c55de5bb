"""Usage: isolation.py ARCHIVE...

What is compiled for newer processors must not leak into the rest of the program: where several objects define the same
inline function, the linker keeps one copy, and if that is the one with the newer instructions the program no longer
runs everywhere. So no object compiled for an instruction set may define a symbol that others could share, and no other
object may contain registers of 256 or 512 bits.
"""

import subprocess
import sys
import tempfile
from pathlib import Path

SPECIAL = ("_avx2.cpp.o", "_avx512.cpp.o")


def output(*command, folder):
    return subprocess.run(command, cwd=folder, check=True, capture_output=True, text=True).stdout


def main():
    faults, special = [], 0
    with tempfile.TemporaryDirectory() as top:
        for archive in map(Path, sys.argv[1:]):
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
    if special != 9:
        faults.append(f"{special} objects for instruction sets were found instead of 9")
    print("\n".join(faults) or "nothing is shared")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
