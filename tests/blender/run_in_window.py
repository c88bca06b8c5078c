# SPDX-License-Identifier: GPL-3.0-or-later
"""Install a built extension into a throw-away profile and run the tests of in_window in this Blender's window.

    export BLENDER_USER_RESOURCES=EMPTY_FOLDER
    blender --enable-event-simulate --python-exit-code 1 --python run_in_window.py -- ZIP REPORT.xml [PART OF A NAME]

A test is a generator: it yields how many seconds Blender is to go on by itself, handling events and drawing. Only
those with the part in their file's name and theirs are run where one is given, and those marked nightly with
LSGP_FULL_SWEEP=1. Exit code 0 only when all passed; REPORT.xml is a junit report. Beside it, in the folder pictures, is
the screen as each test left it, where ImageMagick's import is installed.
``tools/packaging/test_in_blender.py --window`` does all of this.
"""

import os
import sys
import time
import traceback
from collections.abc import Generator, Iterator
from contextlib import AbstractContextManager
from importlib import import_module
from pathlib import Path
from xml.etree import ElementTree

import bpy

sys.path += [str(Path(__file__).parent), str(Path(__file__).resolve().parents[1])]
from nightly import EVERYTHING
from run_in_blender import EXTENSION, install, require_bundled_library
from windows import PICTURES, area, region, take_picture, window

TEST_SECONDS = 150


def in_view() -> AbstractContextManager:
    """The context of the 3D view, which Blender's timers do not have."""
    return bpy.context.temp_override(window=window(), area=area(), region=region())


def run(
    tests: dict[str, Generator[float]], report: Path, empty: bool = True, seconds: float = TEST_SECONDS
) -> Iterator[float]:
    """Run the tests one after the other, write the report and end Blender; yields seconds to wait.

    empty: each begins with nothing, instead of with Blender's scene of the start. seconds: that each may take.
    """
    os.environ[PICTURES] = str(report.parent / "pictures")
    suite = ElementTree.Element("testsuite", name="window", errors="0", skipped="0")
    failures = 0
    for name, test in tests.items():
        case = ElementTree.SubElement(suite, "testcase", name=name)
        begin = time.monotonic()
        bpy.ops.wm.read_homefile(use_empty=empty, use_factory_startup=True)
        yield 0.2
        try:
            while True:
                with in_view():
                    wait = next(test)
                if time.monotonic() - begin > seconds:
                    raise TimeoutError(f"{name} takes more than {seconds} seconds")
                yield wait
        except StopIteration:
            print(f"{name} passed")
        except Exception:  # whatever it is belongs into the report
            failures += 1
            ElementTree.SubElement(case, "failure").text = traceback.format_exc()
            print(f"{name} FAILED\n{traceback.format_exc()}")
        finally:
            case.set("time", f"{time.monotonic() - begin:.1f}")
            take_picture(name)
            test.close()
    suite.set("tests", str(len(tests)))
    suite.set("failures", str(failures))
    ElementTree.ElementTree(suite).write(report)
    end(1 if failures else 0)


def end(code: int) -> None:
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(code)


def main() -> None:
    os.environ["CONE_UNWRAP_EXTENSION"] = EXTENSION
    package, report, *only = sys.argv[sys.argv.index("--") + 1 :]
    bpy.context.preferences.view.show_splash = False
    # It would draw everything eight times.
    bpy.context.preferences.system.viewport_aa = "OFF"
    install(Path(package))
    require_bundled_library()
    folder = Path(__file__).parent / "in_window"
    sys.path.append(str(folder))
    tests = {}
    for path in sorted(folder.glob("*_tests.py")):
        functions = vars(import_module(path.stem))
        wanted = [
            name
            for name, test in functions.items()
            if name.startswith("test_")
            and (not only or only[0] in f"{path.stem}.{name}")
            and (EVERYTHING or all(mark.name != "nightly" for mark in getattr(test, "pytestmark", ())))
        ]
        tests |= {name: functions[name]() for name in wanted}
    running = run(tests, Path(report))
    bpy.app.timers.register(lambda: next(running), first_interval=1.0, persistent=True)


if __name__ == "__main__":
    main()
