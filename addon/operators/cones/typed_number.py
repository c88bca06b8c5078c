# SPDX-License-Identifier: GPL-3.0-or-later
"""A number that is typed key by key, as in Blender's own modal tools."""

from __future__ import annotations


class TypedNumber:
    """text: what has been typed so far."""

    def __init__(self) -> None:
        self.text = ""

    @property
    def value(self) -> float | None:
        """None where the text is not a number yet."""
        try:
            return float(self.text)
        except ValueError:
            return None

    def press(self, key: str, character: str) -> bool:
        """Handle a key, given by Blender's name for it and the character it types.  Returns whether it was used."""
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
