# SPDX-License-Identifier: GPL-3.0-or-later
"""What reviewers of extensions.blender.org look for: the manifest, the code of the add-on, the zip and the pictures."""

import ast
import re
import struct
import tomllib
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
MANIFEST = tomllib.loads((ROOT / "blender_manifest.toml").read_text(encoding="utf-8"))
TAGS = {"UV", "Mesh"}  # of the platform's list for add-ons
NETWORK = {
    "asyncio",
    "ftplib",
    "http",
    "httpx",
    "requests",
    "smtplib",
    "socket",
    "ssl",
    "urllib",
    "webbrowser",
    "xmlrpc",
}
LARGEST_ZIP = 20 << 20  # bytes; the platform takes 200 MB
FILE_WRITERS = {"write_text", "write_bytes", "mkdir", "unlink", "rmdir", "rename", "replace", "touch"}
MODULES = {
    path.relative_to(ROOT).as_posix(): ast.parse(path.read_text(encoding="utf-8"))
    for path in sorted((ROOT / "addon").rglob("*.py"))
}


def calls(tree: ast.AST) -> Iterator[tuple[str, ast.Call]]:
    """The name of what is called, without what stands before its last point."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Call):
            name = getattr(node.func, "attr", None) or getattr(node.func, "id", "")
            yield name, node


def imported(tree: ast.AST) -> set[str]:
    """Top-level packages that a module imports."""
    found = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            found |= {alias.name.partition(".")[0] for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.level == 0:
            found.add(node.module.partition(".")[0])
    return found


def test_manifest_says_what_it_is_in_the_form_the_platform_wants():
    assert re.fullmatch(r"\d+\.\d+\.\d+", MANIFEST["version"])
    assert "blender" not in (MANIFEST["id"] + MANIFEST["name"]).lower()
    assert len(MANIFEST["tagline"]) <= 64 and MANIFEST["tagline"][-1].isalnum() and MANIFEST["tagline"][0].isupper()
    assert MANIFEST["website"].startswith("https://")
    assert MANIFEST["license"] == ["SPDX:GPL-3.0-or-later"]
    assert all(re.fullmatch(r"\d{4}(-\d{4})? \S.*", line) for line in MANIFEST["copyright"])
    assert set(MANIFEST["tags"]) <= TAGS
    assert "permissions" not in MANIFEST
    assert all(value not in ("", [], {}) for value in MANIFEST.values()), "optional keys are left out, not empty"


def test_everything_that_names_the_version_names_this_one():
    version, minor = MANIFEST["version"], MANIFEST["version"].rpartition(".")[0]
    assert f"\nversion: {version}\n" in (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    assert re.search(r"^## \[(\d.*)\]", (ROOT / "CHANGELOG.md").read_text(encoding="utf-8"), re.MULTILINE)[1] == version
    developing = (ROOT / "docs" / "how-to" / "developing.md").read_text(encoding="utf-8")
    assert f"find_package(lsgp {minor} " in developing and f"`liblsgp.so.{minor}`" in developing
    assert (ROOT / "docs" / "releases" / f"{version}.md").is_file()


def test_license_is_part_of_the_sources_and_named_in_every_module():
    assert "GNU GENERAL PUBLIC LICENSE" in (ROOT / "LICENSE").read_text(encoding="utf-8")
    for path in MODULES:
        first = (ROOT / path).read_text(encoding="utf-8").partition("\n")[0]
        assert first == "# SPDX-License-Identifier: GPL-3.0-or-later", path


def test_code_needs_no_network_no_other_program_and_no_path_of_its_own():
    """So that no permission is needed for the network, and packages come from wheels alone."""
    for path, tree in MODULES.items():
        called = {ast.unparse(call.func) for _, call in calls(tree)}
        attributes = {ast.unparse(node) for node in ast.walk(tree) if isinstance(node, ast.Attribute)}
        assert not imported(tree) & (NETWORK | {"subprocess", "pip", "ensurepip", "ctypes"}), path
        assert not called & {"exec", "eval", "os.system", "os.popen"}, path
        assert "sys.path" not in attributes, path


def test_only_the_command_writes_files_and_only_where_it_is_told_to():
    """Operators leave files to Blender; the command of the command line writes below --out."""
    writers = set()
    for path, tree in MODULES.items():
        for name, call in calls(tree):
            modes = [argument.value for argument in call.args[1:2] if isinstance(argument, ast.Constant)]
            opens_to_write = name == "open" and any(set(str(mode)) & set("wax+") for mode in modes)
            is_of_a_path = isinstance(call.func, ast.Attribute) and name in FILE_WRITERS and name != "replace"
            if opens_to_write or is_of_a_path or name.startswith(("save_as_mainfile", "export_")):
                writers.add(path)
    assert writers <= {"addon/jobs/batch/asset.py", "addon/jobs/batch/files.py"}


def test_zip_is_small_and_holds_no_hidden_or_compiled_files(staged):
    (archive,) = staged.parent.glob("*.zip")
    assert archive.stat().st_size < LARGEST_ZIP
    files = [path.relative_to(staged) for path in staged.rglob("*") if path.is_file()]
    assert not [path for path in files if path.name.startswith(".") or path.suffix in (".pyc", ".so", ".pyd", ".dll")]


@pytest.mark.parametrize("name, size", [("listing-icon.png", (256, 256)), ("listing-featured.png", (1920, 1080))])
def test_pictures_have_the_sizes_of_the_platform(name, size):
    head = (ROOT / "docs" / "images" / name).read_bytes()[:24]
    assert head[:8] == b"\x89PNG\r\n\x1a\n" and struct.unpack(">II", head[16:24]) == size
