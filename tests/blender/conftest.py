# SPDX-License-Identifier: GPL-3.0-or-later
"""The add-on's tests run inside Blender, through run_in_blender.py; elsewhere they are not collected.

tests/packaging/test_in_blender.py starts them from an ordinary pytest run, or is skipped with the reason.
"""

import os
import sys
from pathlib import Path

import pytest

if "CONE_UNWRAP_EXTENSION" not in os.environ:
    collect_ignore_glob = ["test_*.py", "*/test_*.py"]
else:
    import bpy

    sys.path.append(str(Path(__file__).resolve().parents[1]))
    from nightly import leave_out_nightly

    def pytest_addoption(parser):
        parser.addoption("--few-tries", action="store_true", help="look for large layouts in few ways, which is fast")

    def pytest_collection_modifyitems(config, items):
        leave_out_nightly(config, items)

    @pytest.fixture(autouse=True)
    def tries(request, monkeypatch):
        """With --few-tries layouts are packed with little effort: how much of the square they fill no Blender changes,
        and all else is so after any effort."""
        if request.config.getoption("few_tries") and not request.node.get_closest_marker("all_tries"):
            from lsgp import pack_islands

            monkeypatch.setitem(pack_islands.__kwdefaults__, "effort", "quick")

    @pytest.fixture(autouse=True)
    def empty_scene():
        """Every test starts in an empty file; the extension stays enabled."""
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)

    @pytest.fixture
    def printed(capfd):
        """All that Blender and Python printed so far, the outputs of results and of errors: call it to read and forget
        them."""
        import ctypes

        c_library = ctypes.CDLL("ucrtbase" if os.name == "nt" else None)

        def read() -> tuple[str, str]:
            c_library.fflush(None)
            return tuple(capfd.readouterr())

        return read

    @pytest.fixture
    def reports(printed):
        """What Blender reported so far, as printed in background mode: call it to read and forget it."""
        return lambda: printed()[0]
