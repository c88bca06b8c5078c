# SPDX-License-Identifier: GPL-3.0-or-later
"""A batch on a Dask cluster that accepts TLS only: it works with the certificates and is refused without them."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from batch_meshes import off_text
from lsgp.cli import main
from meshes import grid

pytest.importorskip("distributed")

START_SECONDS = 60


@pytest.fixture(scope="module")
def certificates(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with an authority, ca.pem, and a certificate it signed, cert.pem with key.pem."""
    if shutil.which("openssl") is None:
        pytest.skip("no openssl here to make certificates with")
    folder = tmp_path_factory.mktemp("certificates")
    for words in (
        "req -x509 -newkey rsa:2048 -nodes -days 2 -subj /CN=authority -keyout ca-key.pem -out ca.pem",
        "req -newkey rsa:2048 -nodes -subj /CN=cluster -keyout key.pem -out request.pem",
        "x509 -req -days 2 -in request.pem -CA ca.pem -CAkey ca-key.pem -CAcreateserial -out cert.pem",
    ):
        subprocess.run(["openssl", *words.split()], cwd=folder, check=True, capture_output=True, timeout=60)
    return folder


def tls_options(certificates: Path) -> list[str]:
    files = {"ca-file": "ca.pem", "cert": "cert.pem", "key": "key.pem"}
    return [word for option, file in files.items() for word in (f"--tls-{option}", str(certificates / file))]


@pytest.fixture(scope="module")
def scheduler(certificates: Path) -> Iterator[str]:
    """The address of a scheduler that has a worker."""
    address_file = certificates / "scheduler.json"
    common = ["--scheduler-file", str(address_file), "--host", "tls://127.0.0.1", "--no-dashboard"]
    commands = {"scheduler": ["--port", "0"], "worker": ["--nthreads", "1", "--no-nanny"]}
    processes = []
    with (certificates / "log").open("ab") as log:
        for name, own in commands.items():
            command = [sys.executable, "-m", f"distributed.cli.dask_{name}", *own, *common, *tls_options(certificates)]
            processes.append(subprocess.Popen(command, cwd=certificates, stdout=log, stderr=log))
            end = time.monotonic() + START_SECONDS
            while not address_file.exists():
                assert time.monotonic() < end, (certificates / "log").read_text()
                time.sleep(0.1)
    try:
        yield json.loads(address_file.read_text())["address"]
    finally:
        for process in processes:
            process.kill()
            process.wait()


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "in").mkdir()
    (tmp_path / "in" / "a.off").write_text(off_text(grid(3, 3)))
    return tmp_path


def run(folder: Path, *options: str) -> int:
    return main(["batch", str(folder / "in"), "--out", str(folder / "out"), "--no-pictures", *options])


def test_with_certificates(scheduler: str, certificates: Path, folder: Path) -> None:
    assert scheduler.startswith("tls://")
    assert run(folder, "--scheduler", scheduler, *tls_options(certificates)) == 0
    assert (folder / "out" / "a.off.obj").is_file()


def test_without_certificates(
    scheduler: str, folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("lsgp.batch.dask_engine.CONNECT_SECONDS", 2)
    for address in (scheduler, scheduler.replace("tls://", "tcp://")):
        assert run(folder, "--scheduler", address) == 2
        assert f"no Dask scheduler answers at '{address}'" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--tls-cert", "cert.pem"], "are for a --scheduler"),
        (["--scheduler", "tcp://host:1", "--tls-ca-file", "ca.pem", "--tls-cert", "cert.pem"], "does not use TLS"),
        (["--scheduler", "tls://host:1", "--tls-key", "key.pem"], "belong together"),
        (["--scheduler", "tls://host:1", "--tls-ca-file", "no.pem", "--tls-cert", "no.pem"], "no file 'no.pem'"),
    ],
)
def test_wrong_usage(folder: Path, capsys: pytest.CaptureFixture[str], options: list[str], said: str) -> None:
    assert run(folder, *options) == 2
    assert said in capsys.readouterr().err


@pytest.mark.slow
def test_help_warns(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["batch", "--help"]) == 0
    assert "can run any code" in " ".join(capsys.readouterr().out.split())
