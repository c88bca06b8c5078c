// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "lsgp/errors.hpp"
#include "lsgp/linear_algebra.hpp"
#include "lsgp/stage_seconds.hpp"
#include "lsgp/surface.hpp"

namespace lsgp {

// Quality of a map (the paper's section 7.1).  sigma_1 >= sigma_2: singular values of a triangle's map 3D -> UV.
struct Distortion {
  double quasi_conformal = 0;                // mean of sigma_1 / sigma_2 over triangles
  double quasi_conformal_area_weighted = 0;  // the same, weighted by 3D area
  double area = 0;                           // mean of (share of 3D area) / (share of UV area) over triangles
  double area_p10 = 0, area_p90 = 0;         // its percentiles
  double l2_stretch = 0;                     // Sander et al. 2001, normalized: 1 is isometric
};

// How exactly the two sides of every cut are related by one rotation and one translation, in the returned coordinates.
struct SeamQuality {
  double sister_ratio_max = 1;      // longer to shorter side of a cut edge (the paper's sister edges)
  double rotation_residual = 0;     // angle between a cut edge's rotation and that of its cut, radians
  double translation_residual = 0;  // distance of a vertex to the image of its copy, relative to its islands' size
};

// The transition of a cut in a seamless layout, from its left side to its right one: z -> e^{2 pi i turns / q} z + t
// with t = cell (translation[0] + translation[1] g), where g is i on square lattices and e^{i pi / 3} on triangular
// ones.
struct SeamlessCut {
  Index tail, head;                           // vertices
  int turns;                                  // 0 .. q - 1
  std::array<std::int64_t, 2> translation{};  // in cells
  double error = 0;  // largest distance of a vertex, as stored in float32, from the image of its copy, in cells
};

// The certificate of a seamless layout, and the cost of rounding.
struct SeamlessReport {
  int rotation_order = 4;                      // q
  double tiles = 0;                            // cells along the layout's longer side, before rounding
  double tile_size = 0;                        // side of a cell on the surface, smaller on small components
  double cell = 1;                             // the same in texture coordinates
  double energy_before = 1, energy_after = 1;  // symmetric Dirichlet energy before and after rounding, 1 is isometric
  std::vector<SeamlessCut> cuts;
  double error = 0;                  // the largest of the cuts'
  std::vector<Index> flat_cones;     // rounded to zero curvature, now ordinary vertices
  std::vector<Index> merged_cones;   // merged with another within a cell
  std::vector<Index> relaxed_cones;  // off the lattice: the cuts to them show a seam
  // With Options::straighten: share of the length of the creases of hard surfaces that runs along the lattice exactly,
  // as stored in float32; none without creases.
  std::optional<double> feature_share;
  std::vector<Index> creases;           // those creases, pairs of vertices
  std::vector<char> is_crease_aligned;  // of each of them: whether it runs there
};

// Why a marked feature does not run straight along u or v.
enum class ReleaseReason {
  curved,         // it turns away from both axes or is between them, and no corner or cone lets it
  contradiction,  // together with features that have precedence it would fold the map or lose its length
  stretch,        // it would cost too much L2 stretch
  lattice,        // no layout with tiles of this size keeps it
  unsupported,    // with these options no feature is aligned
};

struct ReleasedFeature {
  std::vector<Index> path;  // vertices
  ReleaseReason reason;
  double share;  // of the length of all marked features
};

// What became of the surface's features, as stored in float32.
struct FeatureReport {
  double share = 1;  // of their length that runs straight along u or v, on both sides of a cut
  std::vector<ReleasedFeature> released;
};

// Defects of the first unfolding, and the work of repairing and relaxing the map.
struct RepairReport {
  Index flipped_before = 0, wrong_angle_sums_before = 0;  // of the first unfolding
  int iterations = 0;                                     // of Newton's method, low stretch included
};

struct CutPaths {
  VertexPairs edges;                      // (c, 2)
  std::vector<std::vector<Index>> paths;  // vertices from node to node
};

// A part of the surface bounded by its marked seams and boundaries, and its map without cones and further cuts.
struct Chart {
  std::vector<Index> triangles;
  int euler = 0, borders = 0;          // 1 and 1: a disk; one-sided: 0 and 0
  bool is_mapped = false;              // a handle, a closed part or a one-sided one cannot be
  double l2_stretch = 1;               // at a scale of its own; of a chart without a map infinite
  Index flipped = 0, overlapping = 0;  // triangles
  // Cuts that leave it as a disk, but for holes about which its metric nearly turns once, (e, 2).
  VertexPairs missing;
};

// Why the edges of a path are cut: marked seams; cones, handles and boundaries that need it; or anything else, such as
// creases and overlaps.
enum class CutPathKind { seam, required, added };

struct Prescription {
  std::vector<Index> cones;         // (k)
  std::vector<double> cone_angles;  // (k) radians
  Eigen::VectorXd log_scale;        // (n) area-weighted mean 0 on every island
  double predicted_l2 = 1;          // over the whole surface
  std::vector<Finding> warnings;
};

struct Result {
  CornerUv corner_uv;         // (3m, 2), NaN where not solved
  std::vector<Index> island;  // (m), -1 where not solved
  VertexPairs cut_edges;      // (c, 2)
  VertexPairs required_cuts;  // (r, 2) those of them that cones, handles and boundaries need
  // Cut edges and the surface's borders, each path of one kind: vertices from node to node, as of split_into_paths.
  // Nodes are the cones, and where kinds meet.
  std::vector<std::vector<Index>> cut_paths;
  std::vector<CutPathKind> cut_kinds;  // (paths)
  std::vector<Index> cones;            // (k) those of solved components
  std::vector<double> cone_angles;     // (k) imposed, radians
  Distortion distortion;
  SeamQuality seams;
  std::vector<Index> flipped;           // triangles with UV area <= 0
  std::vector<Index> wrong_angle_sums;  // vertices whose UV angles are off by more than a degree
  std::vector<Index> overlapping;       // triangles that overlap others
  double overlap_area = 0;              // total of all pairs of triangles, as a share of the layout's area
  RepairReport repair;
  double cone_angle_error = 0;  // largest deviation of a cone's UV angle sum, radians
  Eigen::VectorXd log_scale;    // (n) as in Prescription
  // (m) angle between a triangle's direction and v, modulo a seamless layout's rotations, radians, NaN without
  // direction; empty if none are given.
  Eigen::VectorXd direction_errors;
  std::optional<double> direction_error;  // their mean by area and length of the directions
  std::optional<SeamlessReport> seamless;
  std::optional<FeatureReport> features;  // none without marked ones
  std::vector<Finding> warnings;
  StageSeconds stage_seconds;
  LinearAlgebra linear_algebra;
};

struct Measurement {
  Distortion distortion;
  SeamQuality seams;
  std::vector<Index> flipped;  // against the majority of their island
  VertexPairs cut_edges;
  std::vector<Index> island;
};

}  // namespace lsgp
