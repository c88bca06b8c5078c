# SPDX-License-Identifier: GPL-3.0-or-later
"""A number that is typed key by key, as in Blender's own modal tools."""

from __future__ import annotations


class TypedNumber:
    """text: what was typed so far."""

    def __init__(self) -> None:
        self.text = ""

    @property
    def value(self) -> float | None:
        """None where the text is no number yet."""
        try:
            return float(self.text)
        except ValueError:
            return None

    def press(self, key: str, character: str) -> bool:
        """Take a key, by Blender's name of it and the character it writes.  Returns whether it belongs to a number."""
        if key == "BACK_SPACE":
            self.text = self.text[:-1]
            return True
        character = character.replace(",", ".")
        if not (character.isdecimal() or (character == "." and "." not in self.text)):
            return False
        self.text += character
        return True

    def clear(self) -> None:
        self.text = ""
