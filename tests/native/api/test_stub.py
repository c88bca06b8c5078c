# SPDX-License-Identifier: GPL-3.0-or-later
"""_lsgp.pyi says what the compiled module has: its functions and classes, their parameters and defaults."""

import ast
import inspect
from collections.abc import Iterator
from pathlib import Path

from lsgp import _lsgp

STUB = Path(__file__).resolve().parents[3] / "native" / "lsgp" / "_lsgp.pyi"

Parameters = list[tuple[str, str | None]]
"""Names, and defaults as Python would print them; None: has to be given."""


def in_stub() -> dict[str, Parameters]:
    """By qualified name."""
    tree = ast.parse(STUB.read_text(encoding="utf-8"))
    found = {}
    for node in tree.body:
        if isinstance(node, ast.FunctionDef):
            found[node.name] = _of_definition(node)
        elif isinstance(node, ast.ClassDef):
            methods = [member for member in node.body if isinstance(member, ast.FunctionDef)]
            found |= {f"{node.name}.{method.name}": _of_definition(method) for method in methods}
    return found


def _of_definition(node: ast.FunctionDef) -> Parameters:
    names = [argument.arg for argument in node.args.posonlyargs + node.args.args]
    defaults = [ast.unparse(default) for default in node.args.defaults]
    given = list(zip(names, [None] * (len(names) - len(defaults)) + defaults, strict=True))
    assert not (node.args.vararg or node.args.kwarg or node.args.kwonlyargs), node.name
    return given


def in_module() -> dict[str, Parameters]:
    """The same of the module: pybind11 writes signatures into the docstrings."""
    found = {}
    for name, value in vars(_lsgp).items():
        if inspect.isclass(value):
            members = {member: method for member, method in vars(value).items() if _is_public_method(member, method)}
            found |= {f"{name}.{member}": _of_signature(method) for member, method in members.items()}
            properties = [member for member, of in vars(value).items() if isinstance(of, property)]
            found |= {f"{name}.{member}": [("self", None)] for member in properties}
        elif callable(value):
            found[name] = _of_signature(value)
    return found


def _is_public_method(name: str, value: object) -> bool:
    if name == "__init__":  # without a constructor it is a slot of the base, which only raises
        return not isinstance(value, type(object.__init__))
    return callable(value) and not name.startswith("_")


def _of_signature(function: object) -> Parameters:
    signature = function.__doc__.splitlines()[0]
    assert "*args" not in signature, "overloaded: the stub needs typing.overload"
    listed = signature[signature.index("(") + 1 : signature.rindex(") -> ")]
    return [_parameter(text) for text in _split_outside_brackets(listed, ",")]


def _parameter(text: str) -> tuple[str, str | None]:
    name = text.partition(":")[0].strip()
    with_default = list(_split_outside_brackets(text, "="))
    return name, with_default[1].strip() if len(with_default) == 2 else None


def _split_outside_brackets(text: str, separator: str) -> Iterator[str]:
    depth, begin = 0, 0
    for i, letter in enumerate(text):
        depth += (letter in "([{") - (letter in ")]}")
        if letter == separator and depth == 0:
            yield text[begin:i]
            begin = i + 1
    if text:
        yield text[begin:]


def test_the_stub_names_what_the_module_has():
    assert set(in_stub()) == set(in_module())


def test_parameters_and_defaults_are_the_same():
    module = in_module()
    for name, parameters in in_stub().items():
        assert parameters == module[name], name


def test_signatures_are_read_with_nested_types_and_defaults():
    def function() -> None: ...

    function.__doc__ = "f(a: tuple[int, dict[str, int]], b: bool = True, c: object = (1, 2)) -> list[int]\n\nText = no."
    assert _of_signature(function) == [("a", None), ("b", "True"), ("c", "(1, 2)")]
    function.__doc__ = "f() -> None"
    assert _of_signature(function) == []
