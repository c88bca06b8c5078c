// SPDX-License-Identifier: GPL-3.0-or-later
// Overlapping faces of a layout, and the parts of faces.
#pragma once

#include <algorithm>

#include "base/array.hpp"
#include "division/face_graph.hpp"
#include "plane/overlaps.hpp"

namespace lsgp {

// Each pair of faces is an entry of both; sorted by face, then partner.
struct OverlapPairs {
  Array<Index> begin;        // (faces + 1) entries of a face
  Array<Index> of, partner;  // (entries) faces
  Array<double> shared;      // (entries) area

  Index find(Index face, Index partner) const;  // none if they do not overlap

  // Whether is(partner) holds for any face that overlaps this one.
  template <typename Is>
  bool any_partner(Index face, Is is) const {
    return std::any_of(partner.begin() + begin[face], partner.begin() + begin[face + 1], is);
  }
};

// overlaps: of triangles.
OverlapPairs collect_pairs(const FaceGraph& graph, const Array<Overlap>& overlaps);

struct FaceParts {
  PerFace<Index> of_face;  // each part is connected
  Index count = 0;
};

// Connected faces of one number share a part.
FaceParts number_parts(const FaceGraph& graph, const PerFace<Index>& number);

}  // namespace lsgp
