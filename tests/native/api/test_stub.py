# SPDX-License-Identifier: GPL-3.0-or-later
"""_lsgp.pyi agrees with the compiled module: its functions and classes, their parameters and types."""

import ast
import re
from types import SimpleNamespace

import stub
from lsgp import _lsgp


def unformatted(text: str) -> str:
    return ast.unparse(ast.parse(text))


def test_the_stub_is_what_the_module_says():
    written = stub.STUB.read_text(encoding="utf-8")
    assert unformatted(written) == unformatted(stub.stub(_lsgp)), "run: python tools/stub.py"


def test_every_type_is_known_and_every_public_name_there():
    text = stub.stub(_lsgp)
    types = text.partition("import NDArray\n")[2]
    for unspecific in (r"typing\.", r"\bnumpy\.", r"\bobject\b", r"\b(list|tuple|dict)\b(?!\[)"):
        assert not re.search(unspecific, types), unspecific
    names = {node.name for node in ast.parse(text).body if isinstance(node, ast.FunctionDef | ast.ClassDef)}
    assert names == {name for name in vars(_lsgp) if not name.startswith("_")}


def test_types_are_read_from_signatures_with_nested_ones():
    array, number = "typing.Annotated[numpy.typing.ArrayLike, numpy.int32]", "typing.SupportsInt | typing.SupportsIndex"
    pair = f"tuple[{array}, {array} | None]"
    docs = {
        "f": f"f(pair: {pair}, options: dict) -> list[numpy.typing.NDArray[numpy.bool]]\n\nText (no) -> nothing.",
        "g": f"g(pair: {pair}, count: {number}) -> None",
        "h": "h() -> dict",
    }
    found = stub.stub(SimpleNamespace(**{name: SimpleNamespace(__doc__=doc) for name, doc in docs.items()}))
    assert found.splitlines()[-4:] == [
        "_Pair = tuple[_Indices, _Indices | None]",
        "def f(pair: _Pair, options: dict[str, Any]) -> list[_Flags]: ...",
        "def g(pair: _Pair, count: int) -> None: ...",
        "def h() -> dict[str, Any]: ...",
    ]
