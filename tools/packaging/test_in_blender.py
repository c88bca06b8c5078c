# SPDX-License-Identifier: GPL-3.0-or-later
"""Run the add-on's tests inside a Blender, with the built extension installed from its zip.

    python tools/packaging/test_in_blender.py ...
        --python PYTHON                    a Python that has bpy
        --python PYTHON --blender BLENDER  an executable and the Python of its version
        --chroot FOLDER                    an installation of ../shared/tools/real-blender

Builds the wheel with that Python, stages and zips the extension, installs the zip into a throw-away profile, runs
tests/blender there and prints the counts. --wheel takes a wheel instead; --library-of takes only the library of one,
where its C runtime permits, and builds the Python module. With --window, what needs events is tried at the same time,
in a window on a virtual screen, and then the first session of a new user; that takes an executable and xvfb-run. All
three begin with empty profiles. Where ImageMagick is installed there, the folders window/pictures and newcomer/pictures
of --out have the screen at the end of every such test and at every step of the session. Exit code 0 only when tests
passed, none failed and none was skipped. Arguments after "--" go to pytest.
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import zipfile
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

ROOT = Path(__file__).resolve().parents[2]
REAL_BLENDER = ROOT.parent / "shared" / "tools" / "real-blender"
EIGEN = ("/usr/include/eigen3", "/usr/share/eigen3")
TEST_SECONDS = 1800


@dataclass(frozen=True)
class Command:
    """A program as a list of arguments, and the variables that its environment needs in addition to ours."""

    arguments: list[str]
    environment: dict[str, str]

    def followed_by(self, *arguments: str) -> Command:
        """The same program with further arguments before those of a run."""
        return Command([*self.arguments, *arguments], self.environment)

    def run(self, *arguments: str | Path, timeout: float | None = None, **environment: str) -> None:
        """Run in the repository's root; raises CalledProcessError or TimeoutExpired."""
        subprocess.run(
            [*self.arguments, *map(str, arguments)],
            cwd=ROOT,
            env={**os.environ, **self.environment, **environment},
            timeout=timeout,
            check=True,
        )


def loads(python: Command, library: Path) -> bool:
    """Whether the system of this Python can load a library; its C runtime may be too old for it."""
    try:
        python.run("-c", "import ctypes, sys; ctypes.CDLL(sys.argv[1])", library)
    except subprocess.CalledProcessError:
        return False
    return True


def build_wheel(python: Command, folder: Path, other: Path | None) -> Path:
    """Build the wheel of this repository for the Python of the Blender under test.

    Of another wheel it takes the library, which all Pythons share, and compiles the module alone.
    """
    options = ["--no-deps", "--quiet", "--wheel-dir", folder, "--config-settings", f"build-dir={folder / 'native'}"]
    if other is not None:
        with zipfile.ZipFile(other) as archive:
            library = Path(archive.extract("lsgp/liblsgp.so", folder / "library"))
        if loads(python, library):
            options += ["--config-settings", f"cmake.define.LSGP_LIBRARY={library}"]
        else:
            print(f"test_in_blender: the library of {other.name} does not load here and is built again")
    python.run("-m", "pip", "wheel", ".", *options)
    return next(folder.glob("lsgp-*.whl"))


def in_window(program: Command) -> Command:
    """The same program on a virtual screen, with rendering by software."""
    screen = ["--auto-servernum", "--server-args=-screen 0 1280x900x24"]
    environment = {"LIBGL_ALWAYS_SOFTWARE": "1"}
    if program.arguments[0] == str(REAL_BLENDER):
        inside = {**program.environment, **environment, "BLENDER_EXE": "xvfb-run"}
        return Command([*program.arguments, *screen, "blender"], inside)
    return Command(["xvfb-run", *screen, *program.arguments], {**program.environment, **environment})


def counts(report: Path) -> dict[str, int]:
    """Numbers of tests in a junit report: tests, failures, errors, skipped."""
    suites = ElementTree.parse(report).getroot().iter("testsuite")
    totals = dict.fromkeys(("tests", "failures", "errors", "skipped"), 0)
    for suite in suites:
        for key in totals:
            totals[key] += int(suite.get(key, "0"))
    return totals


def require_all(report: Path, what: str) -> None:
    """Print the counts of a report; ends the program where there is no test, or one that did not pass."""
    found = counts(report)
    numbers = ", ".join(f"{found[key]} {key}" for key in ("failures", "errors", "skipped"))
    print(f"test_in_blender: {found['tests']} {what}, {numbers}")
    if found["tests"] == 0 or any(found[key] for key in ("failures", "errors", "skipped")):
        raise SystemExit("test_in_blender: every test has to run and pass inside Blender")


def run_suite(program: Command, script: str, package: Path, folder: Path, what: str, *options: str) -> None:
    """Run a script of tests/blender in an empty profile; ends the program where not all tests of its report passed.

    The folder is made, for profile and report.
    """
    profile, report = folder / "profile", folder / "report.xml"
    profile.mkdir(parents=True)
    # PYTHONPATH could put another build of the native module before the one in the extension.
    isolation = {"BLENDER_USER_RESOURCES": str(profile), "PYTHONDONTWRITEBYTECODE": "1", "PYTHONPATH": ""}
    arguments = (ROOT / "tests" / "blender" / script, "--", package, report, *options)
    try:
        program.run(*arguments, timeout=TEST_SECONDS, **isolation)
        require_all(report, what)
    except (subprocess.CalledProcessError, subprocess.TimeoutExpired) as error:
        raise SystemExit(f"test_in_blender: {error}") from None


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--python", help="the Blender's Python; it runs the tests itself unless --blender is given")
    parser.add_argument("--blender", help="Blender executable")
    parser.add_argument("--chroot", type=Path, help="folder of a Blender installed by ../shared/tools/real-blender")
    parser.add_argument("--window", action="store_true", help="run the tests that need a window as well")
    parser.add_argument(
        "--validate",
        metavar="ZIP",
        type=Path,
        action="append",
        default=[],
        help="let the executable check this as well",
    )
    parser.add_argument("--wheel", type=Path, help="take this wheel instead of building one")
    parser.add_argument(
        "--library-of",
        metavar="WHEEL",
        type=Path,
        help="build only the Python module, and take the library of this wheel of the same sources for another Python",
    )
    parser.add_argument(
        "--out", type=Path, default=ROOT / "build" / "in_blender", help="folder for wheel, zip, profile and report"
    )
    parser.add_argument("pytest", nargs="*", help="arguments for pytest, after --")
    arguments = parser.parse_args()
    if (arguments.python is None) == (arguments.chroot is None):
        parser.error("give either --python or --chroot")
    if arguments.window and arguments.blender is None and arguments.chroot is None:
        parser.error("--window takes a Blender executable, by --blender or --chroot")
    if arguments.validate and arguments.blender is None and arguments.chroot is None:
        parser.error("--validate takes a Blender executable, by --blender or --chroot")

    out = arguments.out.resolve()
    shutil.rmtree(out, ignore_errors=True)
    out.mkdir(parents=True)

    blender = None
    if arguments.chroot is not None:
        inside = [str(REAL_BLENDER), "run", str(arguments.chroot)]
        environment = {"BLENDER_EXE": "python3"}
        if "SSL_CERT_FILE" in os.environ:
            # The certificates that ours trusts are not in the chroot; the output folder is.
            environment["SSL_CERT_FILE"] = str(shutil.copy(os.environ["SSL_CERT_FILE"], out / "certificates.pem"))
        python, blender = Command(inside, environment), Command(inside, {})
        if arguments.library_of is not None and all(map(os.path.isdir, EIGEN)):
            # Its interface has types of Eigen: the module is compiled with the headers that the library was.
            python = Command(inside, environment | {"BLENDER_BIND": " ".join(EIGEN)})
    else:
        python = Command([arguments.python], {})
        if arguments.blender is not None:
            blender = Command([arguments.blender], {})

    wheel = arguments.wheel or build_wheel(python, out, arguments.library_of)
    # Executables here mostly come from a distribution, with a Python of its own.
    blenders = [] if blender is None else ["--any-blender"]
    python.run(ROOT / "tools" / "packaging" / "stage_extension.py", "--wheel", wheel, "--out", out, *blenders)
    package = next(out.glob("cone_unwrap-*.zip"))
    if blender is not None:
        for checked in (package, *arguments.validate):
            blender.run("--command", "extension", "validate", checked, timeout=TEST_SECONDS)

    def in_background() -> None:
        start = ["--background", "--python-exit-code", "1", "--python"]
        runner = python if blender is None else blender.followed_by(*start)
        run_suite(runner, "run_in_blender.py", package, out / "background", "tests", *arguments.pytest)

    def with_events() -> None:
        start = ["--factory-startup", "--enable-event-simulate", "--python-exit-code", "1", "--python"]
        runner = in_window(blender).followed_by(*start)
        run_suite(runner, "run_in_window.py", package, out / "window", "tests in a window")
        run_suite(runner, "run_as_newcomer.py", package, out / "newcomer", "first session of a new user")

    with ThreadPoolExecutor() as pool:
        suites = [pool.submit(in_background)]
        if arguments.window:
            suites.append(pool.submit(with_events))
    for suite in suites:
        suite.result()


if __name__ == "__main__":
    main()
