// SPDX-License-Identifier: GPL-3.0-or-later
#include "lsgp/errors.hpp"

namespace lsgp {

const char* name(Code code) {
  switch (code) {
    case Code::empty_mesh: return "EMPTY_MESH";
    case Code::index_out_of_range: return "INDEX_OUT_OF_RANGE";
    case Code::bad_face: return "BAD_FACE";
    case Code::non_finite_position: return "NON_FINITE_POSITION";
    case Code::scale_range: return "SCALE_RANGE";
    case Code::degenerate_mesh: return "DEGENERATE_MESH";
    case Code::edge_not_in_mesh: return "EDGE_NOT_IN_MESH";
    case Code::seam_not_an_edge: return "SEAM_NOT_AN_EDGE";
    case Code::cone_index: return "CONE_INDEX";
    case Code::cone_duplicate: return "CONE_DUPLICATE";
    case Code::cone_not_on_surface: return "CONE_NOT_ON_SURFACE";
    case Code::angle_count: return "ANGLE_COUNT";
    case Code::cone_angle_non_finite: return "CONE_ANGLE_NON_FINITE";
    case Code::loop_turning: return "LOOP_TURNING";
    case Code::pin_index: return "PIN_INDEX";
    case Code::pin_non_finite: return "PIN_NON_FINITE";
    case Code::pins_conflict: return "PINS_CONFLICT";
    case Code::wrong_parameter: return "WRONG_PARAMETER";
    case Code::shape_impossible: return "SHAPE_IMPOSSIBLE";
    case Code::not_orientable: return "NOT_ORIENTABLE";
    case Code::too_few_cones: return "TOO_FEW_CONES";
    case Code::cuts_blocked: return "CUTS_BLOCKED";
    case Code::cut_not_movable: return "CUT_NOT_MOVABLE";
    case Code::open_surface: return "OPEN_SURFACE";
    case Code::seams_incomplete: return "SEAMS_INCOMPLETE";
    case Code::cone_angle_range: return "CONE_ANGLE_RANGE";
    case Code::gauss_bonnet: return "GAUSS_BONNET";
    case Code::angles_impossible: return "ANGLES_IMPOSSIBLE";
    case Code::seamless_impossible: return "SEAMLESS_IMPOSSIBLE";
    case Code::solver_failed: return "SOLVER_FAILED";
    case Code::grid_too_coarse: return "GRID_TOO_COARSE";
    case Code::out_of_memory: return "OUT_OF_MEMORY";
    case Code::solver_busy: return "SOLVER_BUSY";
    case Code::time_limit: return "TIME_LIMIT";
    case Code::cancelled: return "CANCELLED";
    case Code::component_skipped: return "COMPONENT_SKIPPED";
    case Code::isolated_vertices: return "ISOLATED_VERTICES";
    case Code::degenerate_faces: return "DEGENERATE_FACES";
    case Code::duplicate_face: return "DUPLICATE_FACE";
    case Code::non_manifold_edge: return "NON_MANIFOLD_EDGE";
    case Code::split_vertex: return "SPLIT_VERTEX";
    case Code::reoriented: return "REORIENTED";
    case Code::seams_opened: return "SEAMS_OPENED";
    case Code::cuts_added: return "CUTS_ADDED";
    case Code::cuts_not_mirrored: return "CUTS_NOT_MIRRORED";
    case Code::cone_on_boundary: return "CONE_ON_BOUNDARY";
    case Code::junction_share: return "JUNCTION_SHARE";
    case Code::straightness_failed: return "STRAIGHTNESS_FAILED";
    case Code::spectral_needs_closed: return "SPECTRAL_NEEDS_CLOSED";
    case Code::high_distortion: return "HIGH_DISTORTION";
    case Code::inexact_seams: return "INEXACT_SEAMS";
    case Code::inexact_angles: return "INEXACT_ANGLES";
    case Code::flipped_triangles: return "FLIPPED_TRIANGLES";
    case Code::wrong_angle_sums: return "WRONG_ANGLE_SUMS";
    case Code::flat_cones: return "FLAT_CONES";
    case Code::grid_refined: return "GRID_REFINED";
    case Code::grid_distorts: return "GRID_DISTORTS";
    case Code::features_off_lattice: return "FEATURES_OFF_LATTICE";
    case Code::features_released: return "FEATURES_RELEASED";
    case Code::cones_merged: return "CONES_MERGED";
    case Code::cones_not_snapped: return "CONES_NOT_SNAPPED";
    case Code::angles_adjusted: return "ANGLES_ADJUSTED";
    case Code::overlapping_triangles: return "OVERLAPPING_TRIANGLES";
    case Code::placement_not_reached: return "PLACEMENT_NOT_REACHED";
    case Code::not_symmetric: return "NOT_SYMMETRIC";
  }
  return "UNKNOWN";
}

const char* name(ElementKind kind) {
  switch (kind) {
    case ElementKind::vertices: return "vertices";
    case ElementKind::edges: return "edges";
    case ElementKind::triangles: return "triangles";
  }
  return "unknown";
}

ErrorKind error_kind(Code code) {
  switch (code) {
    case Code::not_orientable:
    case Code::too_few_cones:
    case Code::cuts_blocked:
    case Code::cut_not_movable:
    case Code::open_surface:
    case Code::seams_incomplete: return ErrorKind::topology;
    case Code::cone_angle_range:
    case Code::gauss_bonnet:
    case Code::angles_impossible:
    case Code::seamless_impossible: return ErrorKind::curvature;
    case Code::solver_failed:
    case Code::grid_too_coarse:
    case Code::out_of_memory:
    case Code::solver_busy:
    case Code::time_limit: return ErrorKind::solver;
    case Code::cancelled: return ErrorKind::cancelled;
    default: return ErrorKind::input;
  }
}

}  // namespace lsgp
