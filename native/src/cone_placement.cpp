// SPDX-License-Identifier: GPL-3.0-or-later
// Cones at the extrema of the log scale factor, one after the other (Ben-Chen, Gotsman, Bunin 2008).
#include <algorithm>
#include <cmath>
#include <limits>

#include "components.hpp"
#include "lsgp/lsgp.hpp"

namespace lsgp {

namespace {

constexpr double wanted_l2 = 1.1;    // of the harmonic angles; least distortion then reaches about 1.05
constexpr int most_automatic = 60;   // cones of one component
constexpr int fewest_on_sphere = 4;  // a closed surface of genus 0 needs 3; 4 keep their angles moderate

class GreedyPlacement {
 public:
  GreedyPlacement(const HalfedgeMesh& mesh, const Geometry& geometry, const std::vector<Index>& existing)
      : mesh_(mesh),
        geometry_(geometry),
        scale_(mesh, geometry, free_border(mesh, {})),
        blocked_(mesh.vertex_count(), 0) {
    scale_.add_cones(existing);
    block();
  }

  std::vector<Index> place(int count) {
    while (!enough(count)) {
      const Index v = largest_scale();
      if (v != none) {
        scale_.add_cones({v});
      } else if (free_rings_ > 0 && (count >= 0 || too_few())) {
        --free_rings_;  // a coarse mesh: cones have to come closer to each other
      } else {
        break;
      }
      block();
    }
    return scale_.cones();
  }

 private:
  bool enough(int count) const {
    const int cones = scale_.cone_count();
    if (count >= 0) return cones >= count;
    if (too_few()) return false;
    return cones >= most_automatic || scale_.predicted_l2(harmonic_scale()) <= wanted_l2;
  }

  bool too_few() const { return mesh_.closed() && mesh_.euler != 0 && scale_.cone_count() < fewest_on_sphere; }

  // y = 0 at the cones; before the first cone of a closed surface, the metric of constant curvature.
  Eigen::VectorXd harmonic_scale() const {
    if (scale_.cone_count() > 0 || !mesh_.closed()) return scale_.evaluate(scale_.harmonic_curvature());
    const double density = 2 * M_PI * mesh_.euler / geometry_.total_area;
    Eigen::VectorXd y = scale_.solve(density * geometry_.vertex_area - geometry_.angle_defect);
    y.array() -= geometry_.vertex_area.dot(y) / geometry_.total_area;
    return y;
  }

  Index largest_scale() const {
    Eigen::VectorXd y = harmonic_scale();
    if (scale_.cone_count() > 0)
      y.array() -= y[scale_.cones().front()];
    else if (!mesh_.closed())
      y.array() -= y[mesh_.boundary_loops.front().front()];
    Index best = none;
    for (Index v = 0; v < mesh_.vertex_count(); ++v) {
      if (!blocked_[v] && (best == none || std::abs(y[v]) > std::abs(y[best]))) best = v;
    }
    return best;
  }

  // Cones side by side cancel each other: the rings around each stay free of others.  None lies on a border.
  void block() {
    std::fill(blocked_.begin(), blocked_.end(), 0);
    for (const Index v : scale_.cones()) blocked_[v] = 1;
    for (int ring = 0; ring < free_rings_; ++ring) {
      const std::vector<char> inner = blocked_;
      for (Index v = 0; v < mesh_.vertex_count(); ++v) {
        if (inner[v]) mesh_.for_each_outgoing(v, [&](Index h) { blocked_[mesh_.target(h)] = 1; });
      }
    }
    for (const auto& loop : mesh_.boundary_loops) {
      for (const Index v : loop) blocked_[v] = 1;
    }
  }

  const HalfedgeMesh& mesh_;
  const Geometry& geometry_;
  LogScale scale_;
  std::vector<char> blocked_;
  int free_rings_ = 2;
};

}  // namespace

Placement place_cones(const Surface& surface, const Cones& existing, const PlacementOptions& placement,
                      const Progress&) {
  Placement out;
  Options options;
  options.prescription = PrescriptionRule::manual;
  options.seams = placement.seams;
  if (placement.lattice) {
    options.seamless.emplace();
    options.seamless->lattice = *placement.lattice;
  }
  const Work work = prepare(surface, existing, options, out.warnings);
  const std::vector<Component>& components = work.topology.components;
  Cones all = existing;
  for_each_component(components, out.warnings, [&](std::size_t i) {
    const Component& component = components[i];
    const Geometry geometry = require_geometry(component, out.warnings);
    const std::vector<Index>& kept = work.tasks[i].cones.vertices;
    const std::vector<Index> placed =
        GreedyPlacement(component.mesh, geometry, kept).place(placement.count.value_or(-1));
    for (std::size_t k = kept.size(); k < placed.size(); ++k) {
      all.vertices.push_back(component.source_vertex[placed[k]]);
      all.angles.push_back(std::nullopt);
    }
  });
  const Prescription prescription = prescribe_curvature(surface, all, options);
  out.cones = prescription.cones;
  out.cone_angles = prescription.cone_angles;
  out.log_scale = prescription.log_scale;
  out.predicted_l2 = prescription.predicted_l2;
  return out;
}

ConeGains cone_gains(const Surface& surface, const Cones& existing, SeamMode seams, const Progress& progress) {
  ConeGains out;
  out.predicted_l2 = Eigen::VectorXd::Constant(surface.positions.rows(), std::numeric_limits<double>::quiet_NaN());
  PlacementOptions options;
  options.seams = seams;
  options.count = static_cast<int>(existing.vertices.size()) + 1;
  const Placement placed = place_cones(surface, existing, options, progress);
  if (placed.cones.size() <= existing.vertices.size()) return out;
  out.best = placed.cones.back();
  out.predicted_l2[out.best] = placed.predicted_l2;
  return out;
}

}  // namespace lsgp
