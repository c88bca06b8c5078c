// SPDX-License-Identifier: GPL-3.0-or-later
// Data shared by calls on one surface: its components, and the geometry, the factored systems and, for seamless layouts
// with tiles of another size, the map of each.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "base/array.hpp"
#include "lsgp/options.hpp"
#include "lsgp/surface.hpp"
#include "mesh/mirror.hpp"
#include "pipeline/component_map.hpp"
#include "pipeline/components.hpp"
#include "prescription/component_system.hpp"
#include "seamless/feature_alignment.hpp"

namespace lsgp {

// A component's map before it is put onto a lattice, or after it was split where it overlapped itself.
struct KeptMap {
  ComponentMap map;
  std::vector<Finding> found;  // about it
};

class KeptComponents {
 public:
  // keeps_systems: from one call to the next, rather than until each component is done.
  explicit KeptComponents(bool keeps_systems) : keeps_systems_(keeps_systems) {}
  KeptComponents(const KeptComponents&) = delete;
  KeptComponents& operator=(const KeptComponents&) = delete;

  // prepare: makes the work of a call from that of the previous one. Everything below refers to the new work.
  void update(const std::function<Work(Work)>& prepare);
  Work& work() { return work_; }

  // Measured at the first call; appends to the findings.
  const Geometry& geometry_of(std::size_t i, std::vector<Finding>& findings);
  const Geometry& geometry(std::size_t i) const { return kept_[i]->geometry; }  // after that
  const Mirroring& mirroring_of(std::size_t i);

  // The system of the task's cones.
  ComponentSystem& system_of(std::size_t i, Factorization factorization);
  ComponentSystem* system(std::size_t i) { return kept_[i]->system.get(); }  // after that
  // Forgets maps that are not those of these cones and options, whose tiles may have another size.
  void keep_maps_of(const Cones& cones, const Options& options);
  const std::optional<KeptMap>& map(std::size_t i) const { return kept_[i]->map; }
  void keep_map(std::size_t i, const ComponentMap& map, const std::vector<Finding>& found);
  // Where to keep the maps of these cones and options after they were split, which are found there already if others
  // with the same maps kept them. How islands fill a square may differ.
  PerComponent<std::optional<KeptMap>>& split_maps_of(const Cones& cones, const Options& options);
  // Of the map, or empty.
  std::optional<FeatureAlignment>& alignment(std::size_t i) { return kept_[i]->alignment; }
  // Takes over the system of a component, if there is one.
  void keep_system(std::size_t i, KeptSystem system);
  void release(std::size_t i) {
    if (!keeps_systems_) system(i)->release();
  }

 private:
  struct Kept {
    Geometry geometry;
    std::optional<Mirroring> mirroring;  // where requested
    std::vector<Finding> found;          // during its construction
    KeptSystem system;
    std::optional<KeptMap> map;  // of a seamless layout
    std::optional<FeatureAlignment> alignment;
  };

  // What maps were made with.
  struct MapInput {
    Cones cones;
    Options options;
  };

  struct SplitMaps {
    MapInput of;
    PerComponent<std::optional<KeptMap>> maps;
  };

  const bool keeps_systems_;
  Work work_;
  std::optional<MapInput> of_maps_;
  Array<SplitMaps> splits_;                   // the latest last
  PerComponent<std::unique_ptr<Kept>> kept_;  // systems refer to the geometry beside them
  std::int64_t kept_of_ = 0;                  // generation of the topology it was made from
};

}  // namespace lsgp
