# SPDX-License-Identifier: GPL-3.0-or-later
"""The add-on as it is installed in this Blender, with its modules as attributes: ``addon.mesh.reports``.

To be imported once the extension is enabled.
"""

from importlib import import_module

from run_in_blender import EXTENSION

addon = import_module(EXTENSION)
