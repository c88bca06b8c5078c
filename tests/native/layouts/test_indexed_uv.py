# SPDX-License-Identifier: GPL-3.0-or-later
"""Texture coordinates as a list and indices: no duplicates, no losses."""

from __future__ import annotations

import lsgp
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st


@given(st.integers(0, 30), st.integers(0, 2**32 - 1))
def test_the_list_has_every_coordinate_of_a_vertex_once_in_the_order_of_the_corners(count: int, seed: int) -> None:
    rng = np.random.default_rng(seed)
    triangles = rng.integers(0, 8, (count, 3)).astype(np.int32)
    uv = rng.integers(0, 3, (count, 3, 2)) / 3
    uv[rng.random(count) < 0.2, rng.integers(0, 3)] = np.nan
    vt, ft = lsgp.index_uv(triangles, uv)
    solved = ~np.isnan(uv).any(axis=(1, 2))
    assert (vt[ft[solved]] == uv[solved]).all()
    assert (ft[~solved] == -1).all()
    corners = [
        (v, *place) for v, place in zip(triangles[solved].ravel(), uv[solved].reshape(-1, 2).tolist(), strict=True)
    ]
    assert len(vt) == len(set(corners))
    _, first = np.unique(ft[solved].ravel(), return_index=True)
    assert (np.diff(first) > 0).all()
    assert (vt.dtype, ft.dtype) == (np.float64, np.int32)


def test_shapes_that_do_not_fit_are_refused() -> None:
    for triangles, uv in ((np.zeros((2, 3)), np.zeros((3, 3, 2))), (np.zeros((2, 4)), np.zeros((2, 4, 2)))):
        with pytest.raises(lsgp.InputError) as caught:
            lsgp.index_uv(triangles.astype(np.int32), uv)
        assert caught.value.code == "WRONG_SHAPE"
