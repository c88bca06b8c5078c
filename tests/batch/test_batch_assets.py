# SPDX-License-Identifier: GPL-3.0-or-later
"""The assets of a run, their names and shards, and the order in which they are distributed to workers."""

from __future__ import annotations

import argparse
import os
from collections import Counter
from pathlib import Path, PurePath, PurePosixPath, PureWindowsPath

import pytest
from lsgp.batch.assets import (
    Asset,
    Shard,
    find_assets,
    output_name,
    require_distinct_files,
    rootless,
    shard_option,
)
from lsgp.batch.chunks import MOST_ASSETS, Queue
from lsgp.io.side_files import UsageError

SUFFIXES = (".obj", ".off", ".ply")


def touch(folder: Path, *names: str) -> None:
    for name in names:
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(b"x" * len(name))


def names(assets: list[Asset]) -> list[str]:
    return [asset.name for asset in assets]


def test_folder_at_any_depth_without_the_results(tmp_path: Path) -> None:
    touch(tmp_path, "b.OBJ", "a/b/c.ply", "a/note.txt", "a.off", "out/b.OBJ", "a/out/x.obj")
    found = find_assets(tmp_path, tmp_path / "out", SUFFIXES).assets
    assert names(found) == ["a.off", "a/b/c.ply", "a/out/x.obj", "b.OBJ"]
    assert [asset.size for asset in found] == [len(asset.name) for asset in found]
    assert all(asset.path == tmp_path / asset.name for asset in found)


def test_list_is_relative_to_its_folder_and_may_lead_anywhere(tmp_path: Path) -> None:
    touch(tmp_path, "in/a.obj", "in/deep/b b.ply", "beside.off")
    absolute = tmp_path / "beside.off"
    lines = ["a.obj", "", "  deep/b b.ply  ", "../beside.off", str(absolute), "gone.obj", "model.stl"]
    (tmp_path / "in" / "list.txt").write_text("\r\n".join(lines))
    found = find_assets(tmp_path / "in" / "list.txt", tmp_path / "out", SUFFIXES).assets
    outside = rootless(absolute)
    assert names(found) == sorted(["a.obj", "deep/b b.ply", "gone.obj", "model.stl", outside])
    by_name = {asset.name: asset for asset in found}
    assert by_name["deep/b b.ply"].path.read_bytes() == b"x" * len("in/deep/b b.ply")
    assert (by_name["gone.obj"].size, by_name[outside].path.resolve()) == (0, absolute.resolve())


@pytest.mark.parametrize(
    ("path", "name"),
    [
        (PurePosixPath("/a/x.obj"), "a/x.obj"),
        (PureWindowsPath(r"C:\a\x.obj"), "C/a/x.obj"),
        (PureWindowsPath(r"D:\a\x.obj"), "D/a/x.obj"),
        (PureWindowsPath(r"\\server\share\a\x.obj"), "server/share/a/x.obj"),
        (PureWindowsPath(r"\\?\C:\a\x.obj"), "C/a/x.obj"),
    ],
)
def test_names_of_assets_elsewhere_have_their_drive(path: PurePath, name: str) -> None:
    assert rootless(path) == name
    assert not (type(path)("out") / name).anchor


def test_nothing_to_do_is_wrong_usage(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match=r"no assets \(.obj, .off, .ply\)"):
        find_assets(tmp_path, tmp_path / "out", SUFFIXES)


def test_shards_are_a_partition_that_other_assets_do_not_change(tmp_path: Path) -> None:
    touch(tmp_path, *(f"mesh {i}.obj" for i in range(100)))
    whole = names(find_assets(tmp_path, tmp_path / "out", SUFFIXES).assets)
    parts = [names(find_assets(tmp_path, tmp_path / "out", SUFFIXES, Shard(i, 7)).assets) for i in range(1, 8)]
    assert sorted(name for part in parts for name in part) == sorted(whole)
    assert min(map(len, parts)) > 0
    touch(tmp_path, *(f"another {i}.obj" for i in range(50)))
    again = [names(find_assets(tmp_path, tmp_path / "out", SUFFIXES, Shard(i, 7)).assets) for i in range(1, 8)]
    assert all(set(part) <= set(larger) for part, larger in zip(parts, again, strict=True))


@pytest.mark.parametrize("text", ["0/4", "5/4", "1", "1/", "/4", "-1/4", "1/4/2", "one/two", "1/0"])
def test_shards_that_are_none(text: str) -> None:
    with pytest.raises(argparse.ArgumentTypeError, match="i"):
        shard_option(text)


def test_results_have_names_of_their_own() -> None:
    assert [output_name(name) for name in ("a/b.obj", "a/b.OBJ", "a/b.ply", "c.off")] == [
        *["a/b.obj", "a/b.OBJ", "a/b.ply.obj", "c.off.obj"]
    ]
    results = [(name, output_name(name)) for name in ("b.ply", "b.ply.obj")]
    with pytest.raises(UsageError, match=r"'b.ply' and 'b.ply.obj' would both be written to 'b.ply.obj'"):
        require_distinct_files(Path("out"), results, [])


@pytest.mark.skipif(os.name != "posix", reason="names that are no text are a POSIX matter")
def test_names_that_are_no_text(tmp_path: Path) -> None:
    (tmp_path / os.fsdecode(b"b\xe4r.obj")).write_bytes(b"")
    (found,) = find_assets(tmp_path, tmp_path / "out", SUFFIXES).assets
    assert os.fsencode(found.name) == b"b\xe4r.obj"


def test_queue_hands_out_everything_once_large_ones_first_and_alone() -> None:
    assets = [Asset(f"{i}", Path(f"{i}"), size) for i, size in enumerate([2_000_000] * 3 + [1000] * 900)]
    queue = Queue(assets, workers=2)
    chunks = []
    while queue:
        chunks.append(queue.take())
    assert Counter(asset.name for chunk in chunks for asset in chunk) == Counter(asset.name for asset in assets)
    assert [len(chunk) for chunk in chunks[:3]] == [1, 1, 1]
    sizes = [asset.size for chunk in chunks for asset in chunk]
    assert sizes == sorted(sizes, reverse=True)
    assert max(map(len, chunks)) == MOST_ASSETS
    assert len(chunks[-1]) == 1


def test_queue_gives_what_was_put_back_next() -> None:
    assets = [Asset(f"{i:02}", Path(f"{i}"), 100) for i in range(40)]
    queue = Queue(assets, workers=1)
    first = queue.take()
    assert len(first) > 1
    queue.put_back(first[1:])
    rest = []
    while queue:
        rest += queue.take()
    assert names(rest) == names(first[1:]) + names(assets[len(first) :])
