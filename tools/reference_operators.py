# SPDX-License-Identifier: GPL-3.0-or-later
"""Write docs/reference/operators.md: run after changing an operator or one of its arguments.

    python tools/reference_operators.py        (a Python with bpy 4.5; the add-on is taken from the checkout)

What stands after "<!-- operators -->" is replaced. The test of the page passes the operators of the extension that is
installed in Blender instead.
"""

from __future__ import annotations

import sys
from collections.abc import Iterable
from pathlib import Path

import bpy
from bpy_program import run_as_program

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs" / "reference" / "operators.md"
BEGIN = "<!-- operators -->\n"
EDITORS = {"uv": "UV maps", "mesh": "Meshes", "object": "Objects"}
TYPES_OWN = 2e9  # bounds beyond are those of the type itself


def page(operators: Iterable[type[bpy.types.Operator]]) -> str:
    """The page as it should be, with a section for each of the registered operators."""
    named = sorted(operators, key=lambda operator: operator.bl_idname)
    head = PAGE.read_text(encoding="utf-8").partition(BEGIN)[0]
    parts = [head + BEGIN]
    for module, title in EDITORS.items():
        parts.append(f"## {title}\n")
        parts += [_section(operator) for operator in named if operator.bl_idname.startswith(f"{module}.")]
    return "\n".join(parts)


def _section(operator: type[bpy.types.Operator]) -> str:
    """Label, call, description and a table of the arguments."""
    module, name = operator.bl_idname.split(".")
    rna = getattr(getattr(bpy.ops, module), name).get_rna_type()
    lines = [f"### {rna.name}", "", f"`bpy.ops.{operator.bl_idname}()`", "", f"{rna.description}.", ""]
    arguments = [prop for prop in rna.properties if prop.identifier != "rna_type" and not prop.is_hidden]
    if arguments:
        lines += ["| argument | value | default | meaning |", "|---|---|---|---|"]
        lines += [_row(prop) for prop in arguments]
        lines.append("")
    return "\n".join(lines)


def _row(prop: bpy.types.Property) -> str:
    meaning = f"*{prop.name}*: {prop.description}" if prop.description else f"*{prop.name}*"
    cells = (f"`{prop.identifier}`", _values(prop), f"`{_default(prop)}`", meaning)
    return "| " + " | ".join(" ".join(cell.split()).replace("|", "\\|") for cell in cells) + " |"


def _values(prop: bpy.types.Property) -> str:
    """The type, or the choices."""
    if prop.type == "ENUM":
        choices = prop.enum_items_static or prop.enum_items
        return ", ".join(f"`'{choice.identifier}'`" for choice in choices) or "a choice of the scene"
    kind = {"BOOLEAN": "`bool`", "INT": "`int`", "FLOAT": "`float`", "STRING": "`str`"}[prop.type]
    if prop.type in ("INT", "FLOAT"):
        bounds = {"from": prop.hard_min, "to": prop.hard_max}
        kind = " ".join([kind, *(f"{word} {_plain(end)}" for word, end in bounds.items() if abs(end) < TYPES_OWN)])
    if getattr(prop, "is_array", False):
        kind = f"{prop.array_length} times {kind}"
    return kind


def _plain(number: float) -> str:
    """Digits that single precision has, without an exponent where it is an integer."""
    return str(int(number)) if number == int(number) else f"{number:.6g}"


def _default(prop: bpy.types.Property) -> str:
    if prop.type == "ENUM":
        return repr(prop.default) if not prop.is_enum_flag else repr(set(prop.default_flag))
    if getattr(prop, "is_array", False):
        return "(" + ", ".join(_plain(value) for value in prop.default_array) + ")"
    return _plain(prop.default) if prop.type == "FLOAT" else repr(prop.default)


def main() -> None:
    sys.path.insert(0, str(ROOT))
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    import addon

    addon.register()
    operators = [cls for cls in addon.registration.CLASSES if issubclass(cls, bpy.types.Operator)]
    PAGE.write_text(page(operators), encoding="utf-8", newline="\n")


if __name__ == "__main__":
    run_as_program(main)
