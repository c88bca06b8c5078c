# SPDX-License-Identifier: GPL-3.0-or-later
"""Build the Blender extension: the add-on, its manifest and wheels of the native library in one zip.

    python tools/stage_extension.py --wheel WHEEL [--wheel WHEEL ...] [--out dist] [--blender-ext FILE]

Writes OUT/cone_unwrap/ (the staged folder) and OUT/cone_unwrap-VERSION.zip (the same content), then checks the zip with
Blender's own validator: ``blender_ext.py`` of the bpy package this Python has, or the one named.
"""

from __future__ import annotations

import argparse
import importlib.util
import shutil
import subprocess
import sys
import tomllib
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
ZIP_TIME = (1980, 1, 1, 0, 0, 0)


def stage(wheels: list[Path], out: Path) -> Path:
    """Put add-on, manifest and wheels into one new folder under ``out`` and return it.

    The manifest of the repository names no wheels, because they differ from build to build; the staged one does.
    """
    for wheel in wheels:
        if wheel.suffix != ".whl" or not wheel.is_file():
            raise SystemExit(f"stage_extension: {wheel} is not a wheel; build one with: pip wheel . --no-deps -w dist")
    manifest = (ROOT / "blender_manifest.toml").read_text(encoding="utf-8")
    folder = out / tomllib.loads(manifest)["id"]
    if folder.exists():
        shutil.rmtree(folder)
    shutil.copytree(ROOT / "addon", folder, ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copy2(ROOT / "LICENSE", folder)
    (folder / "wheels").mkdir()
    for wheel in wheels:
        shutil.copy2(wheel, folder / "wheels")

    listed = sorted(f"./wheels/{wheel.name}" for wheel in wheels)
    manifest += "\nwheels = [\n" + "".join(f'  "{name}",\n' for name in listed) + "]\n"
    if tomllib.loads(manifest).get("wheels") != listed:
        raise SystemExit("stage_extension: the manifest ends in a table; keep its top-level keys last")
    (folder / "blender_manifest.toml").write_text(manifest, encoding="utf-8")
    return folder


def pack(folder: Path) -> Path:
    """Zip the staged folder beside itself: same content, same bytes.  Returns the zip."""
    manifest = tomllib.loads((folder / "blender_manifest.toml").read_text(encoding="utf-8"))
    target = folder.parent / f"{manifest['id']}-{manifest['version']}.zip"
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
    parser.add_argument("--blender-ext", type=Path, default=find_validator(), help="Blender's blender_ext.py")
    arguments = parser.parse_args()

    target = pack(stage(arguments.wheel, arguments.out))
    if arguments.blender_ext is None:
        print("stage_extension: not validated, because this Python has no bpy; pass --blender-ext", file=sys.stderr)
    else:
        subprocess.run([sys.executable, str(arguments.blender_ext), "validate", str(target)], check=True)
    print(target)


if __name__ == "__main__":
    main()
