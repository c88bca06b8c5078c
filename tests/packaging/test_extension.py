# SPDX-License-Identifier: GPL-3.0-or-later
"""The built extension: what is in the zip, and how it behaves without its library."""

import re
import shutil
import subprocess
import sys
import tomllib
import zipfile
from pathlib import Path

import pytest
import stage_extension

ROOT = Path(__file__).resolve().parents[2]
STAGE = ROOT / "tools" / "packaging" / "stage_extension.py"


def test_the_page_on_installing_has_a_row_for_every_zip():
    page = (ROOT / "docs" / "how-to" / "installing.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| .+ \| `cone_unwrap-…-(.+)\.zip` \|$", page, re.MULTILINE)
    assert rows == [blenders.name for blenders in stage_extension.OFFICIAL.values()]


@pytest.fixture
def archive(staged):
    (package,) = staged.parent.glob("*.zip")
    with zipfile.ZipFile(package) as opened:
        yield opened


def test_zip_holds_the_addon_the_manifest_the_license_and_the_wheel(archive, wheel):
    sources = {path.relative_to(ROOT / "addon").as_posix() for path in (ROOT / "addon").rglob("*.py")}
    expected = sources | {"blender_manifest.toml", "LICENSE", f"wheels/{wheel.name}"}
    assert set(archive.namelist()) == expected


def test_manifest_lists_the_wheel_its_platform_and_its_blenders_and_keeps_everything_else(archive, wheel):
    staged_manifest = tomllib.loads(archive.read("blender_manifest.toml").decode())
    assert staged_manifest.pop("wheels") == [f"./wheels/{wheel.name}"]
    (platform,) = staged_manifest.pop("platforms")
    assert platform == f"{sys.platform}-{'x64' if '64' in wheel.name else ''}"
    assert staged_manifest.pop("blender_version_max") == "5.1.0"  # exclusive; this Python is 3.11
    assert staged_manifest == tomllib.loads((ROOT / "blender_manifest.toml").read_text())


MANYLINUX = "manylinux_2_27_x86_64.manylinux_2_28_x86_64"
PLATFORMS = {
    MANYLINUX: "linux-x64",
    "win_amd64": "windows-x64",
    "macosx_11_0_x86_64": "macos-x64",
    "macosx_11_0_arm64": "macos-arm64",
}


def renamed(wheel: Path, folder: Path, python: str, platform: str) -> Path:
    """A copy of the wheel that says it is for another Python and platform."""
    name = f"{'-'.join(wheel.name.split('-')[:2])}-{python}-{python}-{platform}.whl"
    return Path(shutil.copy(wheel, folder / name))


def stage(python: str, out: Path, *arguments: str | Path) -> subprocess.CompletedProcess:
    """Run the staging tool with the validator of that Python's bpy."""
    command = [python, str(STAGE), "--out", str(out), *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, check=False)


@pytest.mark.parametrize(
    "python, name, first, end",
    [("cp311", "blender-4.2-to-5.0", "4.2.0", "5.1.0"), ("cp313", "blender-5.1-and-later", "5.1.0", None)],
)
def test_one_manifest_makes_a_zip_for_the_blenders_of_each_python(
    python, name, first, end, wheel, bpy_python, tmp_path
):
    wheels = [renamed(wheel, tmp_path, python, platform) for platform in PLATFORMS]
    done = stage(bpy_python, tmp_path, *(f"--wheel={path}" for path in wheels))
    assert done.returncode == 0 and "not validated" not in done.stderr, done.stderr
    manifest = tomllib.loads((tmp_path / "cone_unwrap" / "blender_manifest.toml").read_text())
    assert (tmp_path / f"cone_unwrap-{manifest['version']}-{name}.zip").is_file()
    assert {Path(path).name for path in manifest["wheels"]} == {path.name for path in wheels}
    assert manifest["platforms"] == sorted(PLATFORMS.values())
    assert (manifest["blender_version_min"], manifest.get("blender_version_max")) == (first, end)


def test_blenders_of_distributions_are_not_narrowed_by_their_python(wheel, bpy_python, tmp_path):
    other = renamed(wheel, tmp_path, "cp314", "linux_x86_64")
    done = stage(bpy_python, tmp_path, f"--wheel={other}")
    assert done.returncode != 0 and "no Blender from blender.org has the Python cp314" in done.stderr
    done = stage(bpy_python, tmp_path, f"--wheel={other}", "--any-blender")
    assert done.returncode == 0, done.stderr
    manifest = tomllib.loads((tmp_path / "cone_unwrap" / "blender_manifest.toml").read_text())
    assert manifest["blender_version_min"] == "4.2.0" and "blender_version_max" not in manifest
    assert (tmp_path / f"cone_unwrap-{manifest['version']}-cp314.zip").is_file()


def test_wheels_of_two_pythons_do_not_share_a_zip(wheel, bpy_python, tmp_path):
    wheels = [renamed(wheel, tmp_path, python, "linux_x86_64") for python in ("cp311", "cp313")]
    done = stage(bpy_python, tmp_path, *(f"--wheel={path}" for path in wheels))
    assert done.returncode != 0 and "wheels for cp311 and cp313" in done.stderr


def test_a_wheel_for_a_platform_without_blender_is_refused(wheel, bpy_python, tmp_path):
    other = renamed(wheel, tmp_path, "cp311", "win32")
    done = stage(bpy_python, tmp_path, f"--wheel={other}")
    assert done.returncode != 0 and "win32, which Blender does not have" in done.stderr


def test_released_wheels_are_those_the_zips_are_made_of():
    builds = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["cibuildwheel"]["build"]
    workflow = (ROOT / ".github" / "workflows" / "wheels.yml").read_text()
    assert {f"{tag}-*" for tag in stage_extension.OFFICIAL} < set(builds)
    assert f"for python in {' '.join(stage_extension.OFFICIAL)};" in workflow


def test_wheel_brings_the_native_library_and_no_numpy(archive, wheel, tmp_path):
    archive.extract(f"wheels/{wheel.name}", tmp_path)
    with zipfile.ZipFile(tmp_path / "wheels" / wheel.name) as opened:
        packages = {name.split("/")[0] for name in opened.namelist()}
        native = [name for name in opened.namelist() if name.endswith((".so", ".dylib", ".pyd"))]
    module, library = sorted(native)
    assert module.startswith("lsgp/_lsgp.") and library.startswith("lsgp/liblsgp.")
    assert not any("numpy" in package for package in packages)


def test_the_version_stands_in_the_manifest_alone(wheel):
    version = tomllib.loads((ROOT / "blender_manifest.toml").read_text())["version"]
    assert wheel.name.split("-")[1] == version
    with zipfile.ZipFile(wheel) as opened:
        (metadata,) = (name for name in opened.namelist() if name.endswith(".dist-info/METADATA"))
        assert f"\nVersion: {version}\n" in opened.read(metadata).decode()
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    assert "version" not in project and project["dynamic"] == ["version"]
    for path in [ROOT / "CMakeLists.txt", *(ROOT / "native").rglob("*.py"), *(ROOT / "addon").rglob("*.py")]:
        assert f'"{version}"' not in path.read_text(encoding="utf-8"), path


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


REGISTER = """
import os, sys
sys.path[:0] = sys.argv[1:]
import bpy
bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
import cone_unwrap
cone_unwrap.register()
from cone_unwrap.core.native import library_state
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


def damaged_library(wheel: Path, folder: Path, name: str, keep: float) -> None:
    """Unpack the wheel and keep only this share of its module "_lsgp" or its library "liblsgp"; 0 removes the file."""
    with zipfile.ZipFile(wheel) as opened:
        opened.extractall(folder)
    (native,) = (path for path in (folder / "lsgp").glob(f"{name}.*") if path.suffix != ".pyi")
    content = native.read_bytes()
    native.unlink()
    if keep:
        native.write_bytes(content[: int(keep * len(content))])


@pytest.mark.parametrize("damage", [None, ("_lsgp", 0.0), ("_lsgp", 0.5), ("liblsgp", 0.0), ("liblsgp", 0.5)], ids=str)
def test_extension_registers_without_its_library_and_says_so_in_one_sentence(
    damage, copy_of_staged, wheel, bpy_python, tmp_path
):
    library = tmp_path / "library"
    library.mkdir()
    if damage is None:
        # Hides an lsgp that this Python may have installed.
        (library / "lsgp.py").write_text("raise ModuleNotFoundError(\"No module named 'lsgp'\")\n")
    else:
        damaged_library(wheel, library, *damage)
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
    version = tomllib.loads((ROOT / "blender_manifest.toml").read_text())["version"]
    assert said["STATE"] == [f"Computing library {version} loaded from {library / 'lsgp' / '__init__.py'}"]
    assert "mark cones" in said["CALL"][0].lower()
    assert said["CALL"][1] == "{'FINISHED'}"
