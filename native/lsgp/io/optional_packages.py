# SPDX-License-Identifier: GPL-3.0-or-later
"""Packages that some formats of files take and that need not be installed."""

from __future__ import annotations

from importlib.util import find_spec
from typing import Literal

from ..errors import InputError

Extra = Literal["formats", "images"]
"""Those of this package, by which pip installs them."""


def is_installed(package: str) -> bool:
    """Whether a package can be imported; the empty name needs none."""
    return not package or find_spec(package) is not None


def installation(extra: Extra) -> str:
    """The command that installs what is missing."""
    return f"pip install 'lsgp[{extra}]'"


def not_installed(purpose: str, package: str, extra: Extra, remark: str) -> InputError:
    """The error for what takes a package that is missing.

    purpose: the subject of the message's first sentence. remark: how the message goes on after the command.
    """
    return InputError("FORMAT_NOT_INSTALLED", f"{purpose} takes the package {package}: {installation(extra)}{remark}")
