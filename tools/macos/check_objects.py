# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks the libraries of a wheel for macOS: processor, oldest system, what they load, export and leave to others.

    python tools/macos/check_objects.py --processor arm64 --system 11.2 LIBRARY...

Every undefined name must come from a library that exports it beside this one, from the system, where the linker has
looked it up, or from Python, which the process has loaded. Names of Eigen and Spectra may not be exported: another
module may have others. On Intel errors must be exported, as types are compared by their address there (on arm64 by
their names), and one library must have the kernels for AVX2.
"""

from __future__ import annotations

import argparse
import re
import sys
from pathlib import Path

from macholib.mach_o import (
    CPU_TYPE_NAMES,
    LC_BUILD_VERSION,
    LC_ID_DYLIB,
    LC_LOAD_DYLIB,
    LC_RPATH,
    LC_VERSION_MIN_MACOSX,
    MH_TWOLEVEL,
    N_EXT,
    N_TYPE,
    N_UNDF,
)
from macholib.MachO import MachO
from macholib.SymbolTable import SymbolTable

PROCESSORS = {"arm64": "ARM64", "x86_64": "x86_64"}
LOCAL = "@rpath/"
FROM_THE_PROCESS = (0, 254)  # in place of the number of the library that a name comes from: Zig's linker, Apple's
OF_PYTHON = re.compile(r"__?Py")
OF_HEADERS = re.compile(r"__Z(T[ISV])?NK?(5Eigen|\d+Eigen_\w+?|7Spectra)\d")
ERRORS = "__ZTIN4lsgp5ErrorE"  # their type, which a library throws and another catches
KERNELS = "10Eigen_avx2"  # their namespace, as names of symbols have it
# Fused multiply-add of four doubles: three bytes of prefix with its size and that of the operands, and the operation.
FUSED = re.compile(
    rb"\xc4[\x02\x22\x42\x62\x82\xa2\xc2\xe2][\x85\x8d\x95\x9d\xa5\xad\xb5\xbd\xc5\xcd\xd5\xdd\xe5\xed\xf5\xfd]\xb8"
)
FEWEST_FUSED = 100


class Library:
    """A Mach-O file with a single processor's code."""

    def __init__(self, path: Path) -> None:
        image = MachO(str(path))
        (self.header,) = image.headers
        self.path = path
        self.processor = CPU_TYPE_NAMES.get(self.header.header.cputype, self.header.header.cputype)
        self.has_sources_of_names = bool(self.header.header.flags & MH_TWOLEVEL)
        names = [(entry, text(name)) for entry, name in SymbolTable(image).nlists]
        outer = [(entry, name) for entry, name in names if entry.n_type & N_EXT]
        self.names = {name for _, name in names}
        self.exported = {name for entry, name in outer if entry.n_type & N_TYPE != N_UNDF}
        # With the number of the library in the order of the load commands, from 1.
        self.wanted = {name: entry.n_desc >> 8 & 255 for entry, name in outer if entry.n_type & N_TYPE == N_UNDF}

    def strings(self, kind: int) -> list[str]:
        """The names of load commands of one kind."""
        return [text(data) for load, _, data in self.header.commands if load.cmd == kind]

    def oldest_system(self) -> str:
        for load, command, _ in self.header.commands:
            if load.cmd in (LC_BUILD_VERSION, LC_VERSION_MIN_MACOSX):
                packed = int(command.minos if load.cmd == LC_BUILD_VERSION else command.version)
                return f"{packed >> 16}.{packed >> 8 & 255}"
        return "not stated"

    def fused_operations(self) -> int:
        return len(FUSED.findall(self.path.read_bytes()))


def text(name: bytes | str) -> str:
    return name if isinstance(name, str) else bytes(name).rstrip(b"\0").decode()


def faults_of_names(library: Library, others: dict[str, Library]) -> list[str]:
    """Undefined names that nothing has."""
    loaded = library.strings(LC_LOAD_DYLIB)
    found = [] if library.has_sources_of_names else ["does not say which library a name comes from"]
    for name, number in sorted(library.wanted.items()):
        source = loaded[number - 1] if 1 <= number <= len(loaded) else ""
        beside = others.get(source.removeprefix(LOCAL)) if source.startswith(LOCAL) else None
        if beside and name not in beside.exported:
            found.append(f"takes {name} from {source}, which does not export it")
        if number in FROM_THE_PROCESS and not OF_PYTHON.match(name):
            found.append(f"takes {name}, which is not Python's, from whatever is loaded")
    return found


def faults_of_loading(library: Library, others: dict[str, Library]) -> list[str]:
    loaded = library.strings(LC_LOAD_DYLIB)
    beside = [name.removeprefix(LOCAL) for name in loaded if name.startswith(LOCAL)]
    found = [f"loads {name}, which is not beside it" for name in beside if name not in others]
    found += [
        f"loads {name}, which other Macs need not have"
        for name in loaded
        if not name.startswith((LOCAL, "/usr/lib/", "/System/"))
    ]
    if beside and "@loader_path" not in library.strings(LC_RPATH):
        found.append("looks for libraries elsewhere than beside itself")
    return found


def faults_of_exports(library: Library, processor: str) -> list[str]:
    found = [f"exports {name}" for name in sorted(library.exported) if OF_HEADERS.match(name)]
    if processor == "x86_64" and ERRORS in library.names - library.exported:
        found.append("does not export the type of its errors")
    return found


def faults(library: Library, others: dict[str, Library], processor: str, system: str) -> list[str]:
    """What is wrong with it; `others` are the libraries in the same folder by name."""
    found = []
    if library.processor != PROCESSORS[processor]:
        found.append(f"is for {library.processor}, not {processor}")
    if library.oldest_system() != system:
        found.append(f"wants macOS {library.oldest_system()}, not {system}")
    found += faults_of_exports(library, processor)
    return found + faults_of_loading(library, others) + faults_of_names(library, others)


def has_wide_kernels(library: Library) -> bool:
    return any(KERNELS in name for name in library.names) and library.fused_operations() >= FEWEST_FUSED


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--processor", choices=PROCESSORS, required=True)
    parser.add_argument("--system", required=True, help="the oldest macOS that runs them")
    parser.add_argument("libraries", type=Path, nargs="+")
    arguments = parser.parse_args()
    libraries = [Library(path) for path in arguments.libraries]
    found = []
    for library in libraries:
        names = {
            text(other.strings(LC_ID_DYLIB)[0]).removeprefix(LOCAL): other
            for other in libraries
            if other is not library
        }
        print(
            f"{library.path.name}: {library.processor}, macOS {library.oldest_system()}, "
            f"{len(library.exported)} exported and {len(library.wanted)} undefined names, "
            f"loads {', '.join(library.strings(LC_LOAD_DYLIB))}"
        )
        found += [
            f"{library.path.name} {fault}" for fault in faults(library, names, arguments.processor, arguments.system)
        ]
    if not any(name.startswith("_PyInit_") for library in libraries for name in library.exported):
        found.append("no library exports a module to Python")
    if arguments.processor == "x86_64" and not any(map(has_wide_kernels, libraries)):
        found.append("no library has the kernels for AVX2")
    print(*found, sep="\n", end="\n" if found else "")
    return bool(found)


if __name__ == "__main__":
    sys.exit(main())
