// SPDX-License-Identifier: GPL-3.0-or-later
// Errors and findings: cause, place in the caller's numbering, amount and remedy.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "lsgp/export.hpp"
#include "lsgp/surface.hpp"

namespace lsgp {

enum class ElementKind { vertices, edges, triangles };

struct Elements {
  ElementKind kind = ElementKind::vertices;
  std::vector<Index> indices;  // edges: two vertices each
};

enum class Code {
  // InputError
  empty_mesh,
  index_out_of_range,
  bad_face,
  non_finite_position,
  scale_range,
  degenerate_mesh,
  edge_not_in_mesh,
  seam_not_an_edge,
  cone_index,
  cone_duplicate,
  cone_not_on_surface,
  angle_count,
  cone_angle_non_finite,
  loop_turning,
  pin_index,
  pin_non_finite,
  pins_conflict,
  wrong_parameter,
  shape_impossible,  // of single patches a finding
  // TopologyError
  not_orientable,
  too_few_cones,
  cuts_blocked,
  cut_not_movable,
  open_surface,
  seams_incomplete,  // of single components a finding
  // CurvatureError
  cone_angle_range,
  gauss_bonnet,
  angles_impossible,
  seamless_impossible,
  // SolverError
  solver_failed,
  grid_too_coarse,
  out_of_memory,
  solver_busy,
  time_limit,  // also a finding
  // Cancelled
  cancelled,
  // warnings
  component_skipped,
  isolated_vertices,
  degenerate_faces,
  duplicate_face,
  non_manifold_edge,
  split_vertex,
  reoriented,
  seams_opened,
  cuts_added,
  cuts_not_mirrored,
  cone_on_boundary,
  junction_share,
  straightness_failed,
  spectral_needs_closed,
  high_distortion,
  inexact_seams,
  inexact_angles,
  flipped_triangles,
  wrong_angle_sums,
  flat_cones,
  grid_refined,
  grid_distorts,
  features_off_lattice,
  features_released,
  cones_merged,
  cones_not_snapped,
  angles_adjusted,
  overlapping_triangles,
  placement_not_reached,
  not_symmetric,
};

enum class ErrorKind { input, topology, curvature, solver, cancelled };

LSGP_API const char* name(Code code);  // "EMPTY_MESH", ...
LSGP_API const char* name(ElementKind kind);
LSGP_API ErrorKind error_kind(Code code);  // of the codes that are thrown

class LSGP_API Error : public std::runtime_error {
 public:
  Error(Code code, const std::string& message, Elements elements = {})
      : std::runtime_error(message), code_(code), elements_(std::move(elements)) {}
  Code code() const { return code_; }
  const Elements& elements() const { return elements_; }

 private:
  Code code_;
  Elements elements_;
};

// A note about a usable result.
struct Finding {
  Code code;
  std::string message;
  Elements elements;
};

}  // namespace lsgp
