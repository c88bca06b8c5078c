# SPDX-License-Identifier: GPL-3.0-or-later
"""The rooms of the source trees, and which rooms each may use. To add a tree or a room is to add a row."""

from __future__ import annotations

import ast
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from fnmatch import fnmatch
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


@dataclass(frozen=True)
class Room:
    """Files of a tree.

    files: patterns of paths relative to the tree; a file belongs to the first room that has it. may_use: other rooms of
    the tree.
    """

    name: str
    files: tuple[str, ...]
    may_use: tuple[str, ...] = ()


@dataclass(frozen=True)
class Tree:
    """A source tree.

    pattern: of the names of its files. references: given the tree's folder and a file, the files of the tree that it
    uses, relative to the tree.
    """

    folder: str
    pattern: str
    references: Callable[[Path, Path], set[str]]
    rooms: tuple[Room, ...]

    def files(self) -> Iterator[Path]:
        return (ROOT / self.folder).rglob(self.pattern)

    def room_of(self, path: str) -> Room:
        """The room of a file, by its path relative to the tree; raises LookupError where it has none."""
        for room in self.rooms:
            if any(_matches(path, pattern) for pattern in room.files):
                return room
        raise LookupError(f"{self.folder}/{path} belongs to no room")

    def uses(self) -> Iterator[tuple[str, Room, str, Room]]:
        """A file, its room, a file of another room that it uses, and that room; in order."""
        folder = ROOT / self.folder
        for path in sorted(self.files()):
            name = path.relative_to(folder).as_posix()
            room = self.room_of(name)
            for used in sorted(self.references(folder, path)):
                if (other := self.room_of(used)) is not room:
                    yield name, room, used, other

    def violations(self) -> list[str]:
        """Uses of rooms that a file's room may not use."""
        return [
            f"{self.folder}/{name} uses {used}, but {room.name} may not use {other.name}"
            for name, room, used, other in self.uses()
            if other.name not in room.may_use
        ]

    def direct_uses(self) -> set[tuple[str, str]]:
        """Pairs of a room and one that it uses, but for those that it also gets to by way of another room."""
        used: dict[str, set[str]] = {room.name: set() for room in self.rooms}
        for _, room, _, other in self.uses():
            used[room.name].add(other.name)
        behind: dict[str, set[str]] = {}

        def all_behind(name: str) -> set[str]:
            if name not in behind:
                behind[name] = used[name].union(*map(all_behind, used[name]))
            return behind[name]

        return {
            (name, other)
            for name, others in used.items()
            for other in others
            if not any(other in all_behind(between) for between in others)
        }


def _matches(path: str, pattern: str) -> bool:
    """Whether a path is of a pattern, in which a * stands for names in one folder."""
    parts, patterns = path.split("/"), pattern.split("/")
    return len(parts) == len(patterns) and all(map(fnmatch, parts, patterns))


def python_imports(path: Path, *, type_checking: bool = True) -> Iterator[tuple[int, str, tuple[str, ...]]]:
    """Level, module and names of each import of a Python file.

    type_checking: with the imports for type checkers, which do not run.
    """
    pending = [ast.parse(path.read_text(encoding="utf-8"))]
    while pending:
        node = pending.pop()
        if isinstance(node, ast.Import):
            for alias in node.names:
                yield 0, alias.name, ()
        elif isinstance(node, ast.ImportFrom):
            yield node.level, node.module or "", tuple(alias.name for alias in node.names)
        elif type_checking or not (isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING"):
            pending.extend(ast.iter_child_nodes(node))
        else:
            pending.extend(node.orelse)


def python_references(folder: Path, path: Path) -> set[str]:
    """Modules of the tree, which is a package, that are imported relatively or by the package's name."""
    found = set()
    package = path.relative_to(folder).parent.parts
    for level, module, names in python_imports(path):
        parts = tuple(part for part in module.split(".") if part)
        if level > len(package) + 1:
            continue  # from the packages around the tree
        if level:
            base = (*package[: len(package) - level + 1], *parts)
        elif parts[:1] == (folder.name,):
            base = parts[1:]
        else:
            continue
        # A name may be a submodule or something that the module defines.
        for target in [(*base, name) for name in names] or [base]:
            found |= _module_files(folder, target) or _module_files(folder, target[:-1])
    return found


def _module_files(folder: Path, parts: tuple[str, ...]) -> set[str]:
    module = Path(*parts)
    candidates = [*(module.with_suffix(suffix) for suffix in (".py", ".pyi") if parts), module / "__init__.py"]
    return {path.as_posix() for path in candidates if (folder / path).is_file()}


def cxx_references(folder: Path, path: Path) -> set[str]:
    """Headers of the tree that are included, by their path from any of its folders named in the tables or beside it."""
    included = re.findall(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', path.read_text(encoding="utf-8"), re.MULTILINE)
    roots = [path.parent, folder, folder / "include", folder / "src"]
    found = set()
    for name in included:
        header = next((root / name for root in roots if (root / name).is_file()), None)
        if header is not None:
            found.add(header.resolve().relative_to(folder.resolve()).as_posix())
    return found


# Modules of the Python package itself that are its interface and know arrays only.
API = (
    "api",
    "certificate",
    "cut_moving",
    "cut_paths",
    "edge_directions",
    "features",
    "indexed_uv",
    "lattice",
    "ledger",
    "options",
    "results",
    "shaping",
    "stitching",
    "surface",
    "triangles",
)
LIBRARY = ("base", "API", "images", "layouts", "presets", "quads", "io")
# Folders between the surface and the public functions, without which those do that call the latter.
BY_PUBLIC_FUNCTIONS = (
    *("solvers", "plane", "cut", "transitions", "creases", "systems", "unfold", "prescription", "sites", "search"),
    *("repair", "pipeline", "division", "pieces", "split", "placement", "seamless", "quads", "assembly", "kept"),
    *("packing", "api"),
)
# Folders of native/src, each of which may use those before it, but for those it has to do without.
SOURCES = {
    "base": (),
    "solvers": (),
    "mesh": ("solvers",),
    "plane": ("solvers",),
    "cut": ("solvers", "plane"),
    "transitions": ("solvers",),
    "creases": ("solvers", "plane", "transitions"),
    "systems": ("plane", "creases"),
    "unfold": (),
    "prescription": (),
    "sites": (),
    "search": (),
    "repair": ("plane", "sites", "search"),
    "pipeline": ("sites", "search"),
    "division": ("sites", "search"),
    "pieces": ("sites", "search"),
    "split": ("sites", "search"),
    "placement": ("division", "pieces", "split"),
    "seamless": ("sites", "search", "placement"),
    "quads": (
        *("solvers", "plane", "cut", "transitions", "creases", "systems", "unfold", "prescription", "sites", "search"),
        *("repair", "pipeline", "division", "pieces", "split", "placement", "seamless"),
    ),
    "assembly": ("sites", "search", "placement", "quads"),
    "kept": ("quads", "assembly"),
    "packing": (
        *("solvers", "cut", "transitions", "creases", "systems", "unfold", "prescription", "sites", "search", "repair"),
        *("pipeline", "division", "pieces", "split", "placement", "seamless", "quads", "assembly", "kept"),
    ),
    "api": (),
    # These and what follows make maps by the public functions.
    "measures": BY_PUBLIC_FUNCTIONS,
    "completion": BY_PUBLIC_FUNCTIONS,
    "choices": BY_PUBLIC_FUNCTIONS,
    "unwrap": tuple(room for room in BY_PUBLIC_FUNCTIONS if room != "pipeline"),
    "shaping": (
        *("solvers", "plane", "cut", "transitions", "systems", "unfold", "prescription", "sites", "search", "repair"),
        *("division", "pieces", "split", "placement", "seamless", "quads", "kept", "packing", "api", "measures"),
        *("completion", "choices", "unwrap"),
    ),
}


def source_rooms() -> Iterator[Room]:
    """The rooms of native/src."""
    before = ["public headers"]
    for name, without in SOURCES.items():
        yield Room(name, (f"src/{name}/*",), tuple(room for room in before if room not in without))
        before.append(name)


TREES = (
    Tree(
        "addon",
        "*.py",
        python_references,
        (
            Room("core", ("core/*",)),
            Room("mesh", ("mesh/*",), ("core",)),
            Room("jobs", ("jobs/*", "jobs/*/*"), ("core", "mesh")),
            Room("overlay", ("overlay/*",), ("core", "mesh", "jobs")),
            Room("operators", ("operators/*", "operators/*/*"), ("core", "mesh", "jobs", "overlay")),
            Room("ui", ("ui/*",), ("core", "mesh", "jobs", "overlay")),
            Room("presets", ("presets/operator/*/*",)),
            Room(
                "registration",
                ("__init__.py", "registration.py"),
                ("core", "mesh", "jobs", "overlay", "operators", "ui"),
            ),
        ),
    ),
    Tree(
        "addon/jobs",
        "*.py",
        python_references,
        (
            Room("tasks", ("__init__.py", "tasks/*")),
            Room("uv_maps", ("uv_maps/*",)),
            Room("angles", ("angles/*",), ("tasks",)),
            Room("layouts", ("layouts/*",), ("tasks", "uv_maps")),
            Room("sessions", ("sessions/*",), ("tasks", "uv_maps", "angles", "layouts")),
            Room("batch", ("batch/*",), ("tasks", "layouts")),
        ),
    ),
    Tree(
        "addon/operators",
        "*.py",
        python_references,
        (
            Room("shared", ("__init__.py", "shared/*")),
            Room("unwrapping", ("unwrapping/*",), ("shared",)),
            Room("cones", ("cones/*",), ("shared", "unwrapping")),
            Room("angles", ("angles/*",), ("shared",)),
            Room("cuts", ("cuts/*",), ("shared",)),
            Room("inspection", ("inspection/*",), ("shared",)),
            Room("texels", ("texels/*",), ("shared",)),
            Room("islands", ("islands/*",), ("shared",)),
            Room("quads", ("quads/*",), ("shared", "unwrapping")),
        ),
    ),
    Tree(
        "native/lsgp",
        "*.py",
        python_references,
        (
            Room("base", ("base/*", "errors.py", "_lsgp.pyi")),
            Room("API", tuple(f"{name}.py" for name in API), ("base",)),
            Room("images", ("images/*",), ("base", "API")),
            Room("layouts", ("layouts/*",), ("base", "API")),
            Room("presets", ("presets/*",), ("base", "API", "layouts")),
            Room("quads", ("quads/*",), ("base", "API")),
            Room("io", ("io/*",), ("base", "API")),
            Room("package", ("__init__.py",), LIBRARY),
            Room("run", ("run/*",), LIBRARY),
            Room("batch", ("batch/*",), (*LIBRARY, "package", "run")),
            Room("cli", ("cli/*", "__main__.py"), (*LIBRARY, "package", "run", "batch")),
        ),
    ),
    Tree(
        "native",
        "*.[ch]pp",
        cxx_references,
        (
            Room("public headers", ("include/lsgp/*",)),
            *source_rooms(),
            Room("bindings", ("bindings/*",), ("public headers",)),
        ),
    ),
)
