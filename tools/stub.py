# SPDX-License-Identifier: GPL-3.0-or-later
"""Write native/lsgp/_lsgp.pyi, the types of the compiled module: run after changing a binding.

    python tools/stub.py

needs lsgp installed. The types are those of the signatures that pybind11 writes into docstrings.
"""

from __future__ import annotations

import inspect
import re
from collections import Counter
from collections.abc import Iterable
from pathlib import Path
from typing import Any

STUB = Path(__file__).resolve().parents[1] / "native" / "lsgp" / "_lsgp.pyi"

HEAD = '''# SPDX-License-Identifier: GPL-3.0-or-later
"""Native verbs; call them through `lsgp.api`, which checks and converts.

Written by tools/stub.py. What the tuples hold is said beside them in native/bindings.
"""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
'''

ARRAYS = {"float64": "_Floats", "int32": "_Indices", "int64": "_Places", "bool": "_Flags"}
SCALARS = {"bool": "np.bool_"}

# What pybind11 writes, in this order, as patterns, and what it says. Arrays are converted before they are passed.
SPELLINGS = (
    (r"typing\.Annotated\[numpy\.typing\.ArrayLike, numpy\.(\w+)\]", lambda found: ARRAYS[found[1]]),
    (r"numpy\.typing\.NDArray\[numpy\.(\w+)\]", lambda found: ARRAYS[found[1]]),
    (r"typing\.SupportsInt \| typing\.SupportsIndex", "int"),
    (r"typing\.SupportsFloat \| typing\.SupportsIndex", "float"),
    (
        r'typing\.Annotated\[collections\.abc\.Sequence\[(\w+)\], "FixedSize\((\d+)\)"\]',
        lambda found: f"tuple[{', '.join([found[1]] * int(found[2]))}]",
    ),
    (r"numpy\.ndarray", "NDArray[Any]"),
    (r"collections\.abc\.", ""),
    (r"lsgp\._lsgp\.", ""),
    (r"\bdict\b(?!\[)", "dict[str, Any]"),
)


def stub(module: Any) -> str:
    """The text of the stub, which is still to be formatted."""
    signatures = [_signature(function) for function in _functions(module)]
    aliases = _aliases(parameter for parameters, _ in signatures for parameter in parameters)
    lines = [HEAD]
    lines += [f"{alias} = NDArray[{SCALARS.get(name, f'np.{name}')}]" for name, alias in ARRAYS.items()]
    lines += [f"{alias} = {kind}" for kind, alias in aliases.items()]
    for name, value in _members(module):
        lines += _class(name, value, aliases) if inspect.isclass(value) else [_definition(name, value, aliases)]
    return "\n".join(lines) + "\n"


def _members(owner: Any) -> list[tuple[str, Any]]:
    """Public ones, and constructors; without one, a class has that of its base, which only raises."""
    return [
        (name, value)
        for name, value in vars(owner).items()
        if not name.startswith("_") or (name == "__init__" and not isinstance(value, type(object.__init__)))
    ]


def _functions(owner: Any) -> Iterable[Any]:
    for _, value in _members(owner):
        if inspect.isclass(value):
            yield from _functions(value)
        else:
            yield _getter(value)


def _getter(value: Any) -> Any:
    return value.fget if isinstance(value, property) else value


def _class(name: str, value: type, aliases: dict[str, str]) -> list[str]:
    lines = [f"class {name}:"]
    for member, of in _members(value):
        if isinstance(of, property):
            lines.append("    @property")
        lines.append("    " + _definition(member, of, aliases))
    return lines


def _definition(name: str, value: Any, aliases: dict[str, str]) -> str:
    parameters, returned = _signature(_getter(value))
    if isinstance(value, property):
        parameters = [("self", "")]
    listed = [of if of == "self" else f"{of}: {aliases.get(kind, kind)}" for of, kind in parameters]
    return f"def {name}({', '.join(listed)}) -> {returned}: ..."


def _aliases(parameters: Iterable[tuple[str, str]]) -> dict[str, str]:
    """Names for the types that several signatures contain, by type; named after the parameters."""
    uses = Counter((name, kind) for name, kind in parameters if "," in kind and not kind.startswith("dict"))
    return {kind: f"_{name.title()}" for (name, kind), count in uses.items() if count > 1}


def _signature(function: Any) -> tuple[list[tuple[str, str]], str]:
    """The parameters, as names and types, and the returned type."""
    line = function.__doc__.splitlines()[0]
    assert "*args" not in line, "overloaded: the stub needs typing.overload"
    for pattern, spelling in SPELLINGS:
        line = re.sub(pattern, spelling, line)
    parameters, _, returned = line.partition("(")[2].rpartition(") -> ")
    assert "=" not in parameters, "defaults belong to the functions of the package"
    found = [parameter.partition(": ")[::2] for parameter in split_outside_brackets(parameters)]
    return [(name.strip(), kind) for name, kind in found], returned


def split_outside_brackets(text: str) -> list[str]:
    """Split a text at its commas."""
    found, depth = [""], 0
    for letter in text:
        depth += (letter in "([{") - (letter in ")]}")
        if letter == "," and depth == 0:
            found.append("")
        else:
            found[-1] += letter
    return found if text else []


if __name__ == "__main__":
    from lsgp import _lsgp

    STUB.write_text(stub(_lsgp), encoding="utf-8")
