# SPDX-License-Identifier: GPL-3.0-or-later
"""What can be done next, drawn at random: a step is a plain dictionary, so that it can be kept, sent and replayed.

Steps do not know the mesh they are for: vertices, edges and places are drawn from the step's own seed where it is
performed.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from .choices import Choices
from .option_values import (
    AUTO,
    OPTIONS,
    PLACEMENT,
    RARE_AUTO,
    RARE_OPTIONS,
    RARE_PLACEMENT,
    RARE_SEAMLESS,
    SEAMLESS,
)

Step = dict[str, Any]

# One choice in so many is of a value or kind that is refused, or of no use.
RARELY = 12

# What may be asked for, and, drawn rarely, what is refused.
KINDS: dict[str, tuple[list[str], list[str]]] = {
    "seams": (["none", "none", "edges", "path", "loop", "around a part", "all"], ["no edge", "outside"]),
    "borders": (["none", "none", "edges", "path", "loop", "around a part", "creases"], ["no edge", "outside"]),
    "importance": (["none", "ones", "random", "spikes", "enormous", "zeros"], ["negative", "nan"]),
    "directions": (["none", "up", "up", "one stroke", "strokes", "noise", "enormous", "zeros"], ["nan"]),
    "cut costs": (["none", "ones", "random", "spikes", "zeros", "some zeros", "seen"], ["negative", "nan", "enormous"]),
    "cuttable": (["all", "all", "most", "few", "none"], ["no edge"]),
    "cones": (
        ["own", "placed", "placed", "placed", "random", "random", "none", "border", "add", "drop", "move", "all"],
        ["twice", "outside", "isolated"],
    ),
    "angles": (
        ["automatic", "automatic", "automatic", "some", "quarter turns", "prescribed", "near", "random"],
        ["wild", "too few"],
    ),
    "pins": (
        ["none", "none", "none", "one", "two", "many", "as mapped", "folded"],
        ["same place", "twice", "outside", "nan"],
    ),
    "measured": (["last", "last", "last", "noise", "flat", "holes"], ["infinite"]),
}


def _values(choices: Choices, values: dict[str, list[Any]], rare: dict[str, list[Any]], most: int) -> Step:
    """Some of the options, each with one of its values."""
    drawn = {}
    for _ in range(choices.whole(1, most)):
        name = choices.pick(sorted(values))
        is_rare = name in rare and choices.whole(1, RARELY) == 1
        drawn[name] = choices.pick(rare[name] if is_rare else values[name])
    return drawn


def _mesh(choices: Choices, meshes: Sequence[str]) -> Step:
    """One of these, or a mixture that nobody has seen."""
    if choices.whole(1, 3) == 1:
        return {"mesh": f"mixture-seed={choices.whole(0, 10**6)}"}
    return {"mesh": choices.pick(meshes)}


def _options(choices: Choices, meshes: Sequence[str]) -> Step:
    """Some options, or, as often, a layout that is seamless."""
    changed = _values(choices, OPTIONS, RARE_OPTIONS, 4)
    if choices.pick([True, False]):
        changed["seamless"] = "asked for"
    seamless = _values(choices, SEAMLESS, RARE_SEAMLESS, 4) if changed.get("seamless") == "asked for" else {}
    return {"options": changed, "seamless": seamless, "afresh": choices.pick([True, False]), **_seed(choices)}


def _placing(choices: Choices, meshes: Sequence[str]) -> Step:
    return {"options": _values(choices, PLACEMENT, RARE_PLACEMENT, 3), "adopt": choices.pick([True, False])}


def _auto(choices: Choices, meshes: Sequence[str]) -> Step:
    return {"options": _values(choices, AUTO, RARE_AUTO, 5), **_seed(choices)}


def _shaping(choices: Choices, meshes: Sequence[str]) -> Step:
    return {
        "shape": choices.pick(["grid", "even-grid", "strip", "rectangle"]),
        "share": choices.pick([1.0, 0.5, 0.1]),
        "pins": choices.pick([0, 0, 1, 4]),
        **_seed(choices),
    }


def _cancelling(choices: Choices, meshes: Sequence[str]) -> Step:
    return {
        "verb": choices.pick(["parameterize", "solve", "place", "gains", "prescribe", "cuts"]),
        "call": choices.pick([0, 1, 2, 3, 5, 8, 13, 40]),
        "how": choices.pick(["False", "raise"]),
    }


def _command(choices: Choices, meshes: Sequence[str]) -> Step:
    return {
        "command": choices.pick(["unwrap", "unwrap", "cones"]),
        "cones": choices.pick(["given", "auto", "auto:0", "auto:1", "auto:4"]),
        "process": choices.whole(1, 20) == 1,
    }


def _seed(choices: Choices, meshes: Sequence[str] = ()) -> Step:
    return {"seed": choices.whole(0, 9999)}


def _of_kind(what: str) -> Callable[[Choices, Sequence[str]], Step]:
    def draw(choices: Choices, meshes: Sequence[str]) -> Step:
        usual, refused = KINDS[what]
        kind = choices.pick(refused if choices.whole(1, RARELY) == 1 else usual)
        return {"kind": kind, "count": choices.whole(1, 6), **_seed(choices)}

    return draw


def _plain(choices: Choices, meshes: Sequence[str]) -> Step:
    return {}


# How a step of each kind is drawn, and how often.
RULES: dict[str, tuple[int, Callable[[Choices, Sequence[str]], Step]]] = {
    "take mesh": (3, _mesh),
    "mark seams": (3, _of_kind("seams")),
    "end at borders": (2, _of_kind("borders")),
    "mark features": (2, _of_kind("borders")),
    "weigh": (2, _of_kind("importance")),
    "direct": (2, _of_kind("directions")),
    "allow cuts": (1, _of_kind("cuttable")),
    "cost cuts": (2, _of_kind("cut costs")),
    "choose cones": (5, _of_kind("cones")),
    "choose angles": (4, _of_kind("angles")),
    "pin": (2, _of_kind("pins")),
    "choose options": (9, _options),
    "parameterize": (8, _plain),
    "solve": (8, _plain),
    "cancel": (4, _cancelling),
    "place cones": (3, _placing),
    "cone gains": (2, _plain),
    "prescribe": (2, _plain),
    "find cuts": (2, _plain),
    "measure": (2, _of_kind("measured")),
    "auto unwrap": (3, _auto),
    "shape a patch": (2, _shaping),
    "command": (2, _command),
    "enter again": (1, _plain),
    "two threads": (1, _plain),
    "pickle": (1, _plain),
}


def draw_step(choices: Choices, meshes: Sequence[str], rules: Sequence[str] = tuple(RULES)) -> Step:
    """A step of one of these rules.  meshes: names of members of the zoo."""
    often = [rule for rule in rules for _ in range(RULES[rule][0])]
    return draw_step_of(choices.pick(often), choices, meshes)


def draw_step_of(rule: str, choices: Choices, meshes: Sequence[str]) -> Step:
    return {"do": rule, **RULES[rule][1](choices, meshes)}
