# SPDX-License-Identifier: GPL-3.0-or-later
"""The walls between the rooms of the source trees: who may import or include whom."""

from pathlib import Path

import pytest
from rooms import ROOT, TREES, Room, Tree, python_imports, python_references

BLENDER = {"bpy", "bmesh", "mathutils", "gpu", "gpu_extras", "blf"}

trees = pytest.mark.parametrize("tree", TREES, ids=lambda tree: tree.folder)


def modules_named_in(path: Path, **how: bool) -> set[str]:
    """Top-level packages that a file imports."""
    return {module.split(".")[0] for level, module, _ in python_imports(path, **how) if level == 0}


@trees
def test_rooms_use_only_rooms_that_they_may_use(tree):
    assert tree.violations() == []


@trees
def test_every_room_has_files_and_no_two_rooms_use_each_other(tree):
    before = set()
    pending = list(tree.rooms)
    while ready := [room for room in pending if before.issuperset(room.may_use)]:
        before |= {room.name for room in ready}
        pending = [room for room in pending if room not in ready]
    assert pending == [], "these rooms use each other, or rooms that do not exist"
    used = {tree.room_of(path.relative_to(ROOT / tree.folder).as_posix()).name for path in tree.files()}
    assert used == {room.name for room in tree.rooms}


def circles_among(tree: Tree, pattern: str) -> list[str]:
    """Files of a tree that use themselves by way of others, or that use such files."""
    folder = ROOT / tree.folder
    pending = {path.relative_to(folder).as_posix(): tree.references(folder, path) for path in folder.rglob(pattern)}
    while ready := {name for name, used in pending.items() if used.isdisjoint(pending)}:
        pending = {name: used for name, used in pending.items() if name not in ready}
    return sorted(pending)


@trees
def test_no_file_uses_itself_by_way_of_others(tree):
    assert circles_among(tree, tree.pattern.replace("[ch]pp", "hpp")) == [], "a circle goes through some of these"


def test_rooms_before_unfold_do_not_see_results():
    (tree,) = (tree for tree in TREES if tree.pattern == "*.[ch]pp")
    folder = ROOT / tree.folder
    included = {path.relative_to(folder).as_posix(): tree.references(folder, path) for path in tree.files()}
    sees = {"include/lsgp/result.hpp"}
    while added := {name for name, headers in included.items() if headers & sees} - sees:
        sees |= added
    names = [room.name for room in tree.rooms]
    before = set(names[: names.index("unfold")]) - {"public headers"}
    assert len(before) == 8
    assert {name for name in sees if tree.room_of(name).name in before} == set()


def test_only_the_addon_imports_blender():
    found = [path for path in (ROOT / "native").rglob("*.py") if modules_named_in(path) & BLENDER]
    assert found == []


def test_the_library_does_not_import_the_addon():
    for path in (ROOT / "native").rglob("*.py"):
        assert modules_named_in(path).isdisjoint({"addon", "cone_unwrap", "bl_ext"}), path


def test_the_addon_takes_the_library_from_one_module():
    users = {
        path.name for path in (ROOT / "addon").rglob("*.py") if "lsgp" in modules_named_in(path, type_checking=False)
    }
    assert users == {"native.py"}


def test_only_what_draws_imports_the_gpu():
    for path in (ROOT / "addon").rglob("*.py"):
        if path.parent.name not in {"overlay", "ui"}:
            assert modules_named_in(path).isdisjoint({"gpu", "gpu_extras", "blf"}), path


def test_a_use_across_a_wall_is_found(tmp_path):
    for name, text in {
        "low/__init__.py": "",
        "low/thing.py": "def f():\n    from ..high import other\n",
        "low/named.py": f"import {tmp_path.name}.high.other\n",
        "low/around.py": "from ...high import other\n",  # of the package around the tree
        "high/__init__.py": "",
        "high/other.py": "from ..low import thing\nfrom ..low.thing import f\n",
    }.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text)
    rooms = (Room("low", ("low/*",)), Room("high", ("high/*",), ("low",)))
    found = Tree(str(tmp_path), "*.py", python_references, rooms).violations()
    assert len(found) == 2 and all("low may not use high" in line for line in found)
    assert {line.split(" uses ")[0].rpartition("/")[2] for line in found} == {"thing.py", "named.py"}


def test_a_file_without_a_room_is_found(tmp_path):
    (tmp_path / "stray.py").write_text("")
    with pytest.raises(LookupError, match=r"stray\.py belongs to no room"):
        Tree(str(tmp_path), "*.py", python_references, (Room("low", ("low/*",)),)).violations()
