# SPDX-License-Identifier: GPL-3.0-or-later
"""The architecture page has a line and a node for every room, and the arrows that the sources have."""

import re

import pytest
from rooms import ROOT, TREES, Tree

PAGE = (ROOT / "docs" / "explanation" / "architecture.md").read_text(encoding="utf-8")
DIAGRAM = re.compile(r"```mermaid\nflowchart BT\n  %% (\S+)\n(.*?)```", re.DOTALL)
FOLDERS = {tree.folder: tree.folder for tree in TREES} | {"native": "native/src"}
OUTSIDE = {"public headers", "bindings"}

trees = pytest.mark.parametrize("tree", TREES, ids=lambda tree: tree.folder)


def section_of(tree: Tree) -> str:
    """The text of the section whose heading ends with the tree's folder."""
    (section,) = (text for text in PAGE.split("\n## ") if text.splitlines()[0].endswith(f": {FOLDERS[tree.folder]}"))
    return section


@trees
def test_every_room_has_a_line_in_the_order_in_which_rooms_may_use_each_other(tree):
    rows = re.findall(r"^\| `(\w+)` \| (.+) \| (.+) \|$", section_of(tree), re.MULTILINE)
    rooms = [room for room in tree.rooms if room.name not in OUTSIDE]
    assert [name for name, _, _ in rows] == [room.name for room in rooms]
    for position, room in enumerate(rooms):
        assert set(room.may_use) - OUTSIDE <= {other.name for other in rooms[:position]}


@trees
def test_every_folder_is_a_room(tree):
    folders = {path.name for path in (ROOT / FOLDERS[tree.folder]).iterdir() if path.is_dir()} - {"__pycache__"}
    assert folders <= {room.name for room in tree.rooms}


@trees
def test_the_diagram_has_the_direct_uses_of_the_sources(tree):
    diagrams = dict(DIAGRAM.findall(section_of(tree)))
    shown = set(re.findall(r"^  (\w+) --> (\w+)$", diagrams[FOLDERS[tree.folder]], re.MULTILINE))
    direct = {(room, other) for room, other in tree.direct_uses() if OUTSIDE.isdisjoint({room, other})}
    assert shown == direct
