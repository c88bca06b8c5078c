# SPDX-License-Identifier: GPL-3.0-or-later
"""The archives and checksums that tools/release makes."""

import os
import subprocess
import sys
import tarfile
from pathlib import Path

import pytest

ARCHIVE = Path(__file__).resolve().parents[2] / "tools" / "packaging" / "archive.py"


def archive(*arguments: object) -> None:
    environment = os.environ | {"SOURCE_DATE_EPOCH": "1700000000"}
    subprocess.run([sys.executable, ARCHIVE, *map(str, arguments)], env=environment, check=True)


def made_folder(root: Path, names: list[str], modified: float) -> Path:
    """Its files are made in this order, as of that time."""
    folder = root / "lsgp-1.0"
    for name in names:
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(name)
        path.chmod(0o755 if name.endswith("program") else 0o640)
        os.utime(path, (modified, modified))
    return folder


@pytest.mark.skipif(os.name == "nt", reason="Windows has no bits for programs and few links")
def test_the_same_content_gives_the_same_bytes_wherever_and_whenever_it_was_made(tmp_path: Path) -> None:
    names = ["lib/one.so", "include/two.hpp", "bin/program", "LICENSE"]
    targets = []
    for number, order in enumerate((names, names[::-1])):
        folder = made_folder(tmp_path / f"place{number}", order, 1e9 + number)
        (folder / "lib" / "link.so").symlink_to("one.so")
        targets.append(tmp_path / f"{number}.tar.gz")
        archive("pack", folder, targets[-1])
    assert targets[0].read_bytes() == targets[1].read_bytes()
    with tarfile.open(targets[0]) as opened:
        entries = {entry.name: entry for entry in opened}
        assert opened.extractfile("lsgp-1.0/lib/one.so").read() == b"lib/one.so"
    assert list(entries) == sorted(entries)
    assert {f"lsgp-1.0/{name}" for name in names} < entries.keys()
    assert entries["lsgp-1.0/lib/link.so"].linkname == "one.so"
    assert entries["lsgp-1.0/bin/program"].mode == 0o755 and entries["lsgp-1.0/LICENSE"].mode == 0o644
    assert {(entry.mtime, entry.uid, entry.gid, entry.uname) for entry in entries.values()} == {(1700000000, 0, 0, "")}


@pytest.mark.skipif(os.name == "nt", reason="takes sha256sum")
def test_checksums_are_those_that_sha256sum_checks(tmp_path: Path) -> None:
    for name in ("b.whl", "a.zip"):
        (tmp_path / name).write_text(name)
    archive("sums", tmp_path)
    first = (tmp_path / "SHA256SUMS").read_bytes()
    archive("sums", tmp_path)
    assert (tmp_path / "SHA256SUMS").read_bytes() == first
    assert [line.split()[1] for line in first.decode().splitlines()] == ["a.zip", "b.whl"]
    check = ["sha256sum", "--check", "--strict", "SHA256SUMS"]
    assert subprocess.run(check, cwd=tmp_path, capture_output=True, check=False).returncode == 0
    (tmp_path / "a.zip").write_text("changed")
    assert subprocess.run(check, cwd=tmp_path, capture_output=True, check=False).returncode == 1
