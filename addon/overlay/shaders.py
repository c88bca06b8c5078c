# SPDX-License-Identifier: GPL-3.0-or-later
"""Batches for the GPU, and the one shader that Blender does not have: round points with two rims."""

from __future__ import annotations

from functools import cache

import gpu
import numpy as np
from gpu_extras.batch import batch_for_shader
from numpy.typing import NDArray

FloatArray = NDArray[np.float32]

_VERTEX = """
void main() {
  gl_Position = ModelViewProjectionMatrix * vec4(position, 1.0);
  gl_PointSize = size;
  tint = color;
}
"""
_FRAGMENT = """
void main() {
  float away = 2.0 * length(gl_PointCoord - vec2(0.5));
  if (away > 1.0) discard;
  // The color inside a white rim inside a black one, so that cones differ from selected vertices.
  fragColor = away < 0.58 ? tint : vec4(vec3(away < 0.76 ? 1.0 : 0.0), tint.a);
}
"""


@cache
def discs() -> gpu.types.GPUShader:
    """Points as discs. Attributes position, color; uniform size in pixels."""
    info = gpu.types.GPUShaderCreateInfo()
    info.push_constant("MAT4", "ModelViewProjectionMatrix")
    info.push_constant("FLOAT", "size")
    info.vertex_in(0, "VEC3", "position")
    info.vertex_in(1, "VEC4", "color")
    between = gpu.types.GPUStageInterfaceInfo("cone_unwrap_disc")
    between.smooth("VEC4", "tint")
    info.vertex_out(between)
    info.fragment_out(0, "VEC4", "fragColor")
    info.vertex_source(_VERTEX)
    info.fragment_source(_FRAGMENT)
    return gpu.shader.create_from_info(info)


def lines() -> gpu.types.GPUShader:
    """Lines of any width. Attributes pos, color; uniforms viewportSize, lineWidth."""
    return gpu.shader.from_builtin("POLYLINE_FLAT_COLOR")


def triangles() -> gpu.types.GPUShader:
    """Filled triangles. Attributes pos, color."""
    return gpu.shader.from_builtin("FLAT_COLOR")


def disc_batch(places: FloatArray, colors: FloatArray) -> gpu.types.GPUBatch:
    """places: (k, 3). colors: (k, 4)."""
    return batch_for_shader(discs(), "POINTS", {"position": _packed(places), "color": _packed(_linear(colors))})


def line_batch(segments: FloatArray, colors: FloatArray) -> gpu.types.GPUBatch:
    """segments: (s, 2, 3). colors: (s, 4)."""
    return _batch(lines(), "LINES", segments, colors)


def triangle_batch(corners: FloatArray, colors: FloatArray) -> gpu.types.GPUBatch:
    """corners: (t, 3, 3). colors: (t, 4)."""
    return _batch(triangles(), "TRIS", corners, colors)


def _batch(shader: gpu.types.GPUShader, kind: str, corners: FloatArray, colors: FloatArray) -> gpu.types.GPUBatch:
    each = np.repeat(colors, corners.shape[1], axis=0)
    return batch_for_shader(shader, kind, {"pos": _packed(corners.reshape(-1, 3)), "color": _packed(each)})


def _packed(values: FloatArray) -> FloatArray:
    return np.ascontiguousarray(values, np.float32)


def _linear(colors: FloatArray) -> FloatArray:
    """Display colors in linear space, as the 3D view's buffer needs them; Blender's own shaders convert them."""
    colors = colors.copy()
    shares = colors[:, :3]
    colors[:, :3] = np.where(shares <= 0.04045, shares / 12.92, ((shares + 0.055) / 1.055) ** 2.4)
    return colors
