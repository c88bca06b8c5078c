// SPDX-License-Identifier: GPL-3.0-or-later
// Arrays over the elements of a surface. The comment beside one names the surface where it is not the component's own.
#pragma once

#include "base/array_per.hpp"

namespace lsgp {

struct VertexKind;
struct HalfedgeKind;
struct TriangleKind;
struct EdgeKind;
struct LoopKind;
struct PartKind;
struct ComponentKind;

template <typename T>
using PerVertex = ArrayPer<VertexKind, T>;
template <typename T>
using PerHalfedge = ArrayPer<HalfedgeKind, T>;  // or per corner, which has the number of the halfedge that leaves it
template <typename T>
using PerTriangle = ArrayPer<TriangleKind, T>;
template <typename T>
using PerEdge = ArrayPer<EdgeKind, T>;  // of an EdgeTable
template <typename T>
using PerLoop = ArrayPer<LoopKind, T>;  // boundary loops
template <typename T>
using PerPart = ArrayPer<PartKind, T>;  // parts into which open edges divide triangles, as of label_parts
template <typename T>
using PerComponent = ArrayPer<ComponentKind, T>;

}  // namespace lsgp
