# SPDX-License-Identifier: GPL-3.0-or-later
"""Give Windows packages the complex functions that Wine 8 does not implement, from a library of our own.

    complex_functions.py --packages FOLDER --python FOLDER

Modules that import any of them take all functions of that system library from ours, which passes the others on.
"""

from __future__ import annotations

import argparse
import re
import subprocess
from pathlib import Path

SYSTEM = "api-ms-win-crt-math-l1-1-0.dll"
OURS = "complex-functions-for-wine.dll"  # of the same length, since it replaces the other name
PREFIX = "x86_64-w64-mingw32-"
COMPLEX = re.compile(r"(creal|cimag|cabs|carg|cexp|clog|cpow|c(?:sqrt|sinh|cosh|tanh|sin|cos|tan))([fl]?)")


def imported(module: Path) -> set[str]:
    """The functions that a module imports from the system library."""
    told = subprocess.run([f"{PREFIX}objdump", "-p", module], capture_output=True, text=True, check=True).stdout
    names, library = set(), ""
    for line in told.splitlines():
        if "DLL Name:" in line:
            library = line.split()[-1].lower()
        elif library == SYSTEM and (function := re.match(r"\t[0-9a-f]+\s+\d+\s+(\w+)$", line)):
            names.add(function[1])
    return names


def definition(name: str) -> str:
    """The line of an exported function: one of ours, or the system's."""
    found = COMPLEX.fullmatch(name)
    if found is None:
        return f"{name}=ucrtbase.{name}"
    return f"{name}=own_{found[1]}{found[2].removesuffix('l')}"  # long double is double on Windows


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--packages", type=Path, required=True)
    parser.add_argument("--python", type=Path, required=True)
    args = parser.parse_args()
    names = {module: imported(module) for kind in ("pyd", "dll") for module in args.packages.rglob(f"*.{kind}")}
    users = [module for module, taken in names.items() if any(map(COMPLEX.fullmatch, taken))]
    exported = sorted(set().union(*(names[module] for module in users)))
    exports = args.python / "complex_functions.def"
    exports.write_text("\n".join(["EXPORTS", *map(definition, exported)]) + "\n")
    source = Path(__file__).with_suffix(".c")
    compiler = [f"{PREFIX}gcc-posix", "-O1", "-shared", "-static", "-o", args.python / OURS, source, exports]
    subprocess.run(compiler, check=True)
    for module in users:
        module.write_bytes(module.read_bytes().replace(SYSTEM.encode(), OURS.encode()))


if __name__ == "__main__":
    main()
