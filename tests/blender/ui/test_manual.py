# SPDX-License-Identifier: GPL-3.0-or-later
"""Online Manual in context menus: every operator and every setting has a page."""

from pathlib import Path

import bpy
import pytest
from installed import addon

DOCS = Path(__file__).resolve().parents[3] / "docs"
OURS = [cls for cls in addon.registration.CLASSES if issubclass(cls, bpy.types.Operator)]
SETTINGS = ["ConeUnwrapOverlay.show", "ConeUnwrapTexels.density", "ConeUnwrapPreferences.threads"]


def page_of(rna_id):
    """What Blender opens for an identifier as its context menu has it."""
    return bpy.types.WM_OT_doc_view_manual._lookup_rna_url(rna_id, verbose=False)


@pytest.mark.parametrize("name", [*(f"bpy.ops.{cls.bl_idname}" for cls in OURS), *(f"bpy.types.{n}" for n in SETTINGS)])
def test_everything_has_a_page_of_the_documentation(name):
    home, _, page = page_of(name).partition("#")
    assert home == addon.core.identifiers.HOME_PAGE
    assert (DOCS / f"{page}.md").is_file()


def test_blenders_own_operators_keep_their_pages():
    assert page_of("bpy.ops.uv.unwrap").startswith("https://docs.blender.org/")
