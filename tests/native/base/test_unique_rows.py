# SPDX-License-Identifier: GPL-3.0-or-later
"""Different rows are those of numpy's own function, which the library does not call."""

import ast
from pathlib import Path

import lsgp
import numpy as np
import pytest
from lsgp.base.unique_rows import unique_rows


@pytest.mark.parametrize("shape", [(0, 2), (1, 2), (200, 1), (200, 2), (200, 4)])
@pytest.mark.parametrize("dtype", [np.int32, np.int64, np.float64])
def test_rows_are_those_of_numpy(shape, dtype):
    array = np.random.default_rng(7).integers(-3, 4, shape).astype(dtype)
    expected = np.unique(array, axis=0, return_index=True, return_inverse=True, return_counts=True)
    for found, wanted in zip(unique_rows(array), expected, strict=True):
        np.testing.assert_array_equal(found, wanted.reshape(found.shape))


def test_the_library_compares_no_records():
    """numpy's comparison of records turns Ctrl-C into a TypeError."""
    found = []
    for path in Path(lsgp.__file__).parent.rglob("*.py"):
        for call in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(call, ast.Call) and ast.unparse(call.func) == "np.unique":
                found += [f"{path.name}:{call.lineno}" for keyword in call.keywords if keyword.arg == "axis"]
    assert found == []
