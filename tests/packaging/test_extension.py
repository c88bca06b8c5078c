# SPDX-License-Identifier: GPL-3.0-or-later
"""The built extension: what is in the zip, and how it behaves without its library."""

import ast
import subprocess
import sys
import tomllib
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
STAGE = ROOT / "tools" / "stage_extension.py"


@pytest.fixture
def archive(staged):
    (package,) = staged.parent.glob("*.zip")
    with zipfile.ZipFile(package) as opened:
        yield opened


def test_zip_holds_the_addon_the_manifest_the_licence_and_one_wheel(archive, wheel):
    sources = {path.relative_to(ROOT / "addon").as_posix() for path in (ROOT / "addon").rglob("*.py")}
    expected = sources | {"blender_manifest.toml", "LICENSE", f"wheels/{wheel.name}"}
    assert set(archive.namelist()) == expected


def test_manifest_lists_the_wheel_and_keeps_everything_else(archive, wheel):
    staged_manifest = tomllib.loads(archive.read("blender_manifest.toml").decode())
    assert staged_manifest.pop("wheels") == [f"./wheels/{wheel.name}"]
    assert staged_manifest == tomllib.loads((ROOT / "blender_manifest.toml").read_text())


def test_wheel_brings_the_native_library_and_no_numpy(archive, wheel, tmp_path):
    archive.extract(f"wheels/{wheel.name}", tmp_path)
    with zipfile.ZipFile(tmp_path / "wheels" / wheel.name) as opened:
        packages = {name.split("/")[0] for name in opened.namelist()}
        native = [name for name in opened.namelist() if name.startswith("lsgp/_lsgp.") and not name.endswith(".pyi")]
    assert len(native) == 1
    assert not any("numpy" in package for package in packages)


def test_manifest_and_wheel_have_the_same_version(wheel):
    manifest = tomllib.loads((ROOT / "blender_manifest.toml").read_text())
    assert wheel.name.split("-")[1] == manifest["version"]


def test_manifest_asks_for_no_permission_and_follows_blenders_limits():
    manifest = tomllib.loads((ROOT / "blender_manifest.toml").read_text())
    assert "permissions" not in manifest
    assert len(manifest["tagline"]) <= 64 and manifest["tagline"][-1].isalnum()
    assert manifest["license"] == ["SPDX:GPL-3.0-or-later"]


def test_same_input_gives_the_same_zip(staged, wheel, bpy_python, tmp_path):
    subprocess.run([bpy_python, str(STAGE), "--wheel", str(wheel), "--out", str(tmp_path)], check=True)
    (first,), (second,) = staged.parent.glob("*.zip"), tmp_path.glob("*.zip")
    assert first.read_bytes() == second.read_bytes()


def test_a_file_that_is_no_wheel_is_refused_by_name(tmp_path):
    wrong = tmp_path / "lsgp.zip"
    wrong.write_bytes(b"")
    command = [sys.executable, str(STAGE), "--wheel", str(wrong), "--out", str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode != 0
    assert f"{wrong} is not a wheel" in done.stderr


def test_only_the_addon_imports_bpy_and_the_library_only_through_one_module():
    for path in (ROOT / "native" / "lsgp").rglob("*.py"):
        assert not imported_packages(path) & {"bpy", "bmesh"}, path
    for path in (ROOT / "addon").rglob("*.py"):
        if path.name != "native.py":
            assert "lsgp" not in imported_packages(path), path


def imported_packages(path: Path) -> set[str]:
    """Top-level packages a file imports when it runs; imports for type checkers only do not count."""
    found = set()

    class Imports(ast.NodeVisitor):
        def visit_If(self, node):
            if not (isinstance(node.test, ast.Name) and node.test.id == "TYPE_CHECKING"):
                self.generic_visit(node)

        def visit_Import(self, node):
            found.update(alias.name.split(".")[0] for alias in node.names)

        def visit_ImportFrom(self, node):
            if node.level == 0:
                found.add(node.module.split(".")[0])

    Imports().visit(ast.parse(path.read_text(encoding="utf-8")))
    return found


REGISTER = """
import os, sys
sys.path[:0] = sys.argv[1:]
import bpy
bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
import cone_unwrap
cone_unwrap.register()
from cone_unwrap.preferences import library_state
print("STATE", library_state())
bpy.ops.mesh.primitive_cube_add()
for call in (bpy.ops.uv.cone_unwrap, bpy.ops.mesh.cone_place):
    try:
        print("CALL", call())
    except RuntimeError as error:
        print("CALL", str(error).strip().replace("\\n", " "))
bpy.ops.object.mode_set(mode="EDIT")
print("MARK", bpy.ops.mesh.cone_mark(), bpy.context.object.vertex_groups.keys())
cone_unwrap.unregister()
print("GONE", not hasattr(bpy.types, "UV_OT_cone_unwrap"))
sys.stdout.flush()
os._exit(0)
"""


def register_staged(python: str, *folders: Path) -> dict[str, list[str]]:
    """Register the extension in a fresh bpy with these folders on its path; the printed lines by their first word."""
    command = [python, "-c", REGISTER, *map(str, folders)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == 0, done.stderr
    lines: dict[str, list[str]] = {}
    for line in done.stdout.splitlines():
        key, _, rest = line.partition(" ")
        lines.setdefault(key, []).append(rest)
    return lines


def damaged_library(wheel: Path, folder: Path, keep: float) -> None:
    """Unpack the wheel and keep only this share of its native module; 0 removes the file."""
    with zipfile.ZipFile(wheel) as opened:
        opened.extractall(folder)
    (native,) = (path for path in (folder / "lsgp").glob("_lsgp.*") if path.suffix != ".pyi")
    content = native.read_bytes()
    native.unlink()
    if keep:
        native.write_bytes(content[: int(keep * len(content))])


@pytest.mark.parametrize("damage", ["no wheel", "no native module", "truncated native module"])
def test_extension_registers_without_its_library_and_says_so_in_one_sentence(
    damage, copy_of_staged, wheel, bpy_python, tmp_path
):
    library = tmp_path / "library"
    library.mkdir()
    if damage == "no wheel":
        # Hides an lsgp that this Python may have installed.
        (library / "lsgp.py").write_text("raise ModuleNotFoundError(\"No module named 'lsgp'\")\n")
    else:
        damaged_library(wheel, library, keep=0.0 if damage == "no native module" else 0.5)
    said = register_staged(bpy_python, copy_of_staged.parent, library)
    (sentence,) = said["STATE"]
    assert sentence.startswith("Cone Unwrap cannot load its computing library; install the extension built for Python")
    assert sentence.endswith("and restart Blender")
    assert len(said["CALL"]) == 2
    assert all(sentence in refusal for refusal in said["CALL"])
    assert said["MARK"] == ["{'FINISHED'} ['uv_cones']"]
    assert said["GONE"] == ["True"]


def test_extension_registers_with_its_library_and_computes(copy_of_staged, wheel, bpy_python, tmp_path):
    library = tmp_path / "library"
    with zipfile.ZipFile(wheel) as opened:
        opened.extractall(library)
    said = register_staged(bpy_python, copy_of_staged.parent, library)
    assert said["STATE"] == [f"Computing library loaded from {library / 'lsgp' / '__init__.py'}"]
    assert "mark cones" in said["CALL"][0].lower()
    assert said["CALL"][1] == "{'FINISHED'}"
