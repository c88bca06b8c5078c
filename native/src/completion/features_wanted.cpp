// SPDX-License-Identifier: GPL-3.0-or-later
#include "completion/features_wanted.hpp"

namespace lsgp {

namespace {

bool may_align(const Surface& surface, const MapOptions& options) {
  return !options.prescription && surface.seams.rows() == 0;
}

}  // namespace

bool follows_features(const Surface& surface, const MapOptions& options) {
  const bool is_square = options.of_map.seamless && options.of_map.seamless->lattice == Lattice::square;
  return is_square && (options.of_map.straighten || surface.features.rows() > 0) && may_align(surface, options);
}

bool straightens_marked(const Surface& surface, const MapOptions& options) {
  const bool is_low_stretch = !options.of_map.seamless && options.of_map.mode == Mode::low_stretch;
  return is_low_stretch && surface.features.rows() > 0 && options.of_map.border == BorderMode::free &&
         may_align(surface, options);
}

bool aligns_features(const Surface& surface, const MapOptions& options) {
  return follows_features(surface, options) || straightens_marked(surface, options);
}

bool has_strokes(const Surface& surface) {
  const Eigen::Index directed = (surface.directions.array() != 0).rowwise().any().count();
  return 1 < directed && directed < surface.triangles.rows();
}

}  // namespace lsgp
