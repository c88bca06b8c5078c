# SPDX-License-Identifier: GPL-3.0-or-later
"""Build the Blender extension: the add-on, its manifest and wheels of the native library in one zip.

    python tools/packaging/stage_extension.py --wheel WHEEL [--wheel WHEEL ...] [--out dist] [--any-blender]
        [--blender-ext FILE]

All wheels are for one version of Python, each for another platform. Writes OUT/cone_unwrap/ (the staged folder) and
OUT/cone_unwrap-VERSION-BLENDERS.zip (the same content), then checks the zip with Blender's own validator:
``blender_ext.py`` of the bpy package this Python has, or the one named.
"""

from __future__ import annotations

import argparse
import importlib.util
import re
import shutil
import subprocess
import sys
import tomllib
import zipfile
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
ZIP_TIME = (1980, 1, 1, 0, 0, 0)


@dataclass(frozen=True)
class Blenders:
    """Versions of Blender that have one Python: from `first` on, before `end`."""

    name: str
    first: str
    end: str | None


# The Pythons of the Blenders from blender.org. Distributions build Blender with their own.
OFFICIAL = {
    "cp311": Blenders("blender-4.2-to-5.0", "4.2.0", "5.1.0"),
    "cp313": Blenders("blender-5.1-and-later", "5.1.0", None),
}
SYSTEMS = {"manylinux": "linux", "linux": "linux", "win": "windows", "macosx": "macos"}
MACHINES = {"x86_64": "x64", "amd64": "x64", "aarch64": "arm64", "arm64": "arm64"}


def python_tag(wheels: list[Path]) -> str:
    """The one Python all wheels are for (cp311, ...).  Ends the program where there is none.

    Blender 4.2.0 installs wheels of other Pythons, too, so that they cannot share a zip.
    """
    for wheel in wheels:
        if wheel.suffix != ".whl" or not wheel.is_file() or len(wheel.stem.split("-")) < 5:
            raise SystemExit(f"stage_extension: {wheel} is not a wheel; build one with: pip wheel . --no-deps -w dist")
    tags = sorted({wheel.stem.split("-")[-3] for wheel in wheels})
    if len(tags) > 1:
        raise SystemExit(f"stage_extension: wheels for {' and '.join(tags)}; stage those of each Python by themselves")
    return tags[0]


def platform(wheel: Path) -> str:
    """Blender's name of a wheel's platform: linux-x64, ...  Ends the program where Blender has none."""
    tag = wheel.stem.split("-")[-1]
    found = re.match(r"(manylinux|linux|win|macosx).*?_(x86_64|amd64|aarch64|arm64)(\.|$)", tag)
    if found is None:
        raise SystemExit(f"stage_extension: {wheel.name} is for the platform {tag}, which Blender does not have")
    return f"{SYSTEMS[found[1]]}-{MACHINES[found[2]]}"


def staged_manifest(wheels: list[Path], blenders: Blenders | None) -> str:
    """The manifest with the entries that follow from the wheels: the list, platforms, and versions of Blender."""
    manifest = (ROOT / "blender_manifest.toml").read_text(encoding="utf-8")
    added = {
        "platforms": sorted({platform(wheel) for wheel in wheels}),
        "wheels": sorted(f"./wheels/{wheel.name}" for wheel in wheels),
    }
    lines = [f"{key} = [\n" + "".join(f'  "{value}",\n' for value in values) + "]" for key, values in added.items()]
    if blenders is not None:
        added["blender_version_min"] = blenders.first
        manifest = re.sub(r'(?m)^blender_version_min = ".*"$', f'blender_version_min = "{blenders.first}"', manifest)
        if blenders.end is not None:
            added["blender_version_max"] = blenders.end
            lines.append(f'blender_version_max = "{blenders.end}"')
    manifest += "\n" + "\n".join(lines) + "\n"
    if not added.items() <= tomllib.loads(manifest).items():
        raise SystemExit("stage_extension: the manifest ends in a table; keep its top-level keys last")
    return manifest


def official_blenders(tag: str) -> Blenders:
    if tag not in OFFICIAL:
        raise SystemExit(
            f"stage_extension: no Blender from blender.org has the Python {tag}; for one of a distribution "
            "give --any-blender"
        )
    return OFFICIAL[tag]


def stage(wheels: list[Path], out: Path, blenders: Blenders | None) -> Path:
    """Put add-on, manifest and wheels into one new folder under ``out`` and return it.

    blenders: the versions it is for; None: those of the repository's manifest.
    """
    folder = out / tomllib.loads((ROOT / "blender_manifest.toml").read_text(encoding="utf-8"))["id"]
    if folder.exists():
        shutil.rmtree(folder)
    shutil.copytree(ROOT / "addon", folder, ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copy2(ROOT / "LICENSE", folder)
    (folder / "wheels").mkdir()
    for wheel in wheels:
        shutil.copy2(wheel, folder / "wheels")
    manifest = staged_manifest(list((folder / "wheels").iterdir()), blenders)
    (folder / "blender_manifest.toml").write_text(manifest, encoding="utf-8")
    return folder


def pack(folder: Path, name: str) -> Path:
    """Zip the staged folder beside itself: same content, same bytes.  Returns the zip; its name ends in `name`."""
    manifest = tomllib.loads((folder / "blender_manifest.toml").read_text(encoding="utf-8"))
    target = folder.parent / f"{manifest['id']}-{manifest['version']}-{name}.zip"
    with zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED) as archive:
        for path in sorted(folder.rglob("*")):
            if path.is_file():
                entry = zipfile.ZipInfo(path.relative_to(folder).as_posix(), ZIP_TIME)
                entry.external_attr = 0o644 << 16
                archive.writestr(entry, path.read_bytes(), zipfile.ZIP_DEFLATED)
    return target


def find_validator() -> Path | None:
    """``blender_ext.py`` inside the bpy package of this Python, found without importing bpy; None without one."""
    spec = importlib.util.find_spec("bpy")
    if spec is None or spec.origin is None:
        return None
    return next(Path(spec.origin).parent.glob("*/scripts/addons_core/bl_pkg/cli/blender_ext.py"), None)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--wheel", type=Path, action="append", required=True, help="wheel to bundle; repeat for more")
    parser.add_argument("--out", type=Path, default=ROOT / "dist", help="folder for the result")
    parser.add_argument(
        "--any-blender",
        action="store_true",
        help="for a Blender with another Python than those from blender.org: leave the range of versions as it is",
    )
    parser.add_argument("--blender-ext", type=Path, default=find_validator(), help="Blender's blender_ext.py")
    arguments = parser.parse_args()

    tag = python_tag(arguments.wheel)
    blenders = None if arguments.any_blender else official_blenders(tag)
    target = pack(stage(arguments.wheel, arguments.out, blenders), tag if blenders is None else blenders.name)
    if arguments.blender_ext is None:
        print("stage_extension: not validated, because this Python has no bpy; pass --blender-ext", file=sys.stderr)
    else:
        subprocess.run([sys.executable, str(arguments.blender_ext), "validate", str(target)], check=True)
    print(target)


if __name__ == "__main__":
    main()
