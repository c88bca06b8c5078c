# SPDX-License-Identifier: GPL-3.0-or-later
"""Install a built extension into a throw-away profile and run the add-on's tests inside this Blender.

    export BLENDER_USER_RESOURCES=EMPTY_FOLDER
    blender --background --python-exit-code 1 --python run_in_blender.py -- ZIP REPORT.xml
    python run_in_blender.py -- ZIP REPORT.xml          (a Python with bpy)

Arguments after these two go to pytest. Exit code 0 only when all tests passed; REPORT.xml is pytest's junit report, by
which the caller sees how many there were. ``tools/packaging/test_in_blender.py`` does all of this.
"""

import os
import sys
import traceback
from pathlib import Path

EXTENSION = "bl_ext.user_default.cone_unwrap"


def install(package: Path) -> None:
    """Install and enable the extension; raises where Blender did not do so, which it does not say by itself."""
    import bpy

    profile = os.environ["BLENDER_USER_RESOURCES"]
    if not Path(bpy.utils.resource_path("USER")).samefile(profile):
        raise RuntimeError(f"Blender does not use the throw-away profile {profile}")
    bpy.ops.extensions.package_install_files(filepath=str(package), repo="user_default", enable_on_install=True)
    if EXTENSION not in bpy.context.preferences.addons:
        raise RuntimeError(f"{package} was not enabled after its installation")


def require_bundled_library() -> None:
    """The native module must be the one of the extension's wheel, not one found elsewhere on the path."""
    import lsgp._lsgp as native_module

    loaded = Path(native_module.__file__).resolve()
    extensions = Path(os.environ["BLENDER_USER_RESOURCES"], "extensions").resolve()
    if extensions not in loaded.parents:
        raise RuntimeError(f"the native module is {loaded}, not the one installed with the extension in {extensions}")


def run(arguments: list[str]) -> int:
    package, report, *pytest_arguments = arguments
    install(Path(package))
    require_bundled_library()
    import pytest

    tests = Path(__file__).parent
    # The long form of tracebacks prints the arguments of calls into Blender, which crashed Blender 4.3.
    options = [f"--junitxml={report}", f"--rootdir={tests}", "--tb=short", "-p", "no:cacheprovider", "-q"]
    return int(pytest.main([str(tests), *options, *pytest_arguments]))


if __name__ == "__main__":
    os.environ["CONE_UNWRAP_EXTENSION"] = EXTENSION
    try:
        code = run(sys.argv[sys.argv.index("--") + 1 :])
    except Exception:  # whatever it is must reach the caller as an exit code
        traceback.print_exc()
        code = 1
    sys.stdout.flush()
    sys.stderr.flush()
    # bpy as a module may crash or hang at a regular exit while classes are registered.
    os._exit(code)
