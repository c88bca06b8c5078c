# SPDX-License-Identifier: GPL-3.0-or-later
"""Workflows that cannot run here: what they call exists, actions are pinned, and tokens may only read, but for the job
that publishes."""

from __future__ import annotations

import re
import subprocess
import tomllib
from collections.abc import Iterator
from pathlib import Path

import pytest

yaml = pytest.importorskip("yaml")

ROOT = Path(__file__).resolve().parents[2]
FOLDER = ROOT / ".github" / "workflows"
WORKFLOWS = {path.name: yaml.safe_load(path.read_text(encoding="utf-8")) for path in sorted(FOLDER.glob("*.yml"))}
OUR_FOLDERS = ("tools", "tests", "addon", "native", ".ci")
# What cibuildwheel builds on each runner: the images of GitHub and the processors they have.
PLATFORMS = {
    "ubuntu-latest": ["manylinux_x86_64"],
    "ubuntu-24.04-arm": ["manylinux_aarch64"],
    "windows-latest": ["win_amd64"],
    "windows-11-arm": ["win_arm64"],
    "macos-latest": ["macosx_x86_64", "macosx_arm64"],
}


def steps() -> Iterator[tuple[str, dict]]:
    """Workflow and step of every job."""
    for name, workflow in WORKFLOWS.items():
        for job in workflow["jobs"].values():
            yield from ((name, step) for step in job.get("steps", ()))


def commands() -> list[tuple[str, str]]:
    """Workflow and script of every step that has one; expressions of workflows become a word."""
    return [(name, re.sub(r"\$\{\{.*?\}\}", "value", step["run"])) for name, step in steps() if "run" in step]


def missing_paths(script: str) -> list[str]:
    """Words of a script that name a file or folder in ours which is not there."""
    words = re.findall(r"[\w./-]+", script)
    return [word for word in words if word.split("/")[0] in OUR_FOLDERS and not (ROOT / word).exists()]


@pytest.mark.parametrize(("workflow", "script"), commands())
def test_what_a_step_runs_exists_and_is_a_script(workflow: str, script: str) -> None:
    assert missing_paths(script) == []
    done = subprocess.run(["bash", "-n"], input=script, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_a_file_that_is_gone_would_be_found() -> None:
    assert missing_paths("python tools/no_such_program.py --out dist") == ["tools/no_such_program.py"]


def test_actions_are_pinned_by_hash_and_checkouts_keep_no_credentials() -> None:
    used = {(name, step["uses"]) for name, step in steps() if "uses" in step}
    assert [entry for entry in used if not re.fullmatch(r"[\w./-]+@[0-9a-f]{40}", entry[1])] == []
    checkouts = [step for _, step in steps() if step.get("uses", "").startswith("actions/checkout@")]
    assert checkouts and all(step["with"]["persist-credentials"] is False for step in checkouts)


def test_one_action_has_one_hash() -> None:
    hashes = {tuple(step["uses"].split("@")) for _, step in steps() if "uses" in step}
    assert len(hashes) == len({action for action, _ in hashes})


@pytest.mark.parametrize("name", WORKFLOWS)
def test_workflows_may_only_read(name: str) -> None:
    assert WORKFLOWS[name]["permissions"] == {"contents": "read"}
    jobs = {job for job, content in WORKFLOWS[name]["jobs"].items() if "permissions" in content}
    assert jobs == ({"publish"} if name == "release.yml" else set())


def test_the_job_that_may_write_runs_nothing_of_the_sources() -> None:
    job = WORKFLOWS["release.yml"]["jobs"]["publish"]
    assert job["permissions"] == {"contents": "write"}
    assert "tag" in job["if"]
    assert [step["uses"].partition("@")[0] for step in job["steps"] if "uses" in step] == ["actions/download-artifact"]
    assert all("tools/" not in step.get("run", "") for step in job["steps"])


def test_workflows_that_are_called_can_be() -> None:
    called = [job["uses"] for workflow in WORKFLOWS.values() for job in workflow["jobs"].values() if "uses" in job]
    assert called == ["./.github/workflows/wheels.yml"]
    assert all("workflow_call" in WORKFLOWS[Path(path).name][True] for path in called)


def test_what_cibuildwheel_calls_exists() -> None:
    settings = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["cibuildwheel"]
    assert missing_paths(settings["test-command"].replace("{project}/", "")) == []


def test_wheels_are_built_for_every_platform_of_blender() -> None:
    systems = WORKFLOWS["wheels.yml"]["jobs"]["wheels"]["strategy"]["matrix"]["system"]
    assert sorted(systems) == sorted(PLATFORMS)
    settings = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["cibuildwheel"]
    for system in ("linux", "windows"):
        assert settings[system]["archs"] == ["auto64"]
    built = {platform.split("_", 1)[1] for platform in PLATFORMS["macos-latest"]}
    assert set(settings["macos"]["archs"]) == built
    images = {f"manylinux_{key.split('-')[1]}" for key in settings["linux"] if key.startswith("manylinux-")}
    assert images == {platform for name in systems for platform in PLATFORMS[name] if "linux" in platform}
    assert all(settings["linux"][f"manylinux-{image[10:]}-image"] == "manylinux_2_28" for image in images)


def test_proposed_changes_are_tested_on_three_systems() -> None:
    workflow = WORKFLOWS["tests.yml"]
    assert "pull_request" in workflow[True]  # YAML 1.1 reads "on" as a truth value
    assert {name.split("-")[0] for name in workflow["jobs"]["library"]["strategy"]["matrix"]["system"]} == {
        "ubuntu",
        "windows",
        "macos",
    }
