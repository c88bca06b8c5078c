# SPDX-License-Identifier: GPL-3.0-or-later
"""Pack a folder as the same bytes each time, or list checksums.

    python tools/packaging/archive.py pack FOLDER OUT.tar.gz
    python tools/packaging/archive.py sums FOLDER

Of a folder's files the archive has names, content, links and whether they can be executed, in the order of their names,
with the time SOURCE_DATE_EPOCH. The checksums of all files in a folder go into its SHA256SUMS, for sha256sum --check.
"""

from __future__ import annotations

import gzip
import hashlib
import os
import sys
import tarfile
from pathlib import Path

SUMS = "SHA256SUMS"


def pack(folder: Path, target: Path) -> None:
    time = int(os.environ["SOURCE_DATE_EPOCH"])

    def plain(entry: tarfile.TarInfo) -> tarfile.TarInfo:
        entry.uid = entry.gid = 0
        entry.uname = entry.gname = ""
        entry.mtime = time
        entry.mode = 0o755 if entry.isdir() or entry.mode & 0o100 else 0o644
        return entry

    with (
        target.open("wb") as file,
        gzip.GzipFile(filename="", mode="wb", fileobj=file, mtime=time) as packed,
        tarfile.open(fileobj=packed, mode="w", format=tarfile.PAX_FORMAT) as archive,
    ):
        for path in sorted([folder, *folder.rglob("*")]):
            archive.add(path, path.relative_to(folder.parent), recursive=False, filter=plain)


def list_sums(folder: Path) -> None:
    files = sorted(path for path in folder.iterdir() if path.is_file() and path.name != SUMS)
    lines = [f"{hashlib.sha256(path.read_bytes()).hexdigest()}  {path.name}\n" for path in files]
    (folder / SUMS).write_text("".join(lines), encoding="ascii")


if __name__ == "__main__":
    what, *paths = sys.argv[1:]
    {"pack": pack, "sums": list_sums}[what](*map(Path, paths))
