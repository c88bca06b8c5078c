// SPDX-License-Identifier: GPL-3.0-or-later
// Assembles the components' maps into one result in the caller's numbering.
#pragma once

#include <optional>
#include <utility>

#include "assembly/added_cuts.hpp"
#include "assembly/feature_report.hpp"
#include "assembly/one_sided_cuts.hpp"
#include "assembly/report_defects.hpp"
#include "base/array.hpp"
#include "division/face_graph.hpp"
#include "pipeline/component_map.hpp"
#include "pipeline/components.hpp"
#include "plane/layout.hpp"

namespace lsgp {

// Whether overlapping triangles are looked for in the layout.
enum class OverlapSearch { made, left_out };

class Assembly {
 public:
  // Everything is collected in `result`, which holds the findings so far.
  Assembly(const Surface& surface, const PerComponent<Component>& components, const Options& options,
           ProgressMonitor& monitor, Result& result);

  // What is known of a map, or found, for other layouts of it.
  struct KnownMaps {
    std::optional<FoundMap>& split;      // none: it is not split yet
    std::optional<DividedMap>& divided;  // of the split one; none yet
  };

  // task: must outlive this object.  A component whose map cannot be split is left out, with the findings about its
  // map.
  void add(std::size_t component_index, const ComponentTask& task, const Geometry& geometry, FoundMap mapped,
           KnownMaps known);

  // Reports components that were left out; if there are no others, rethrows the first error.
  void require_any();

  // Arranges the islands, checks the result and reports its defects.  duplicates: as in Topology.
  void finish(const Cones& cones, const Array<std::pair<Index, Index>>& duplicates, OverlapSearch search);

 private:
  struct Solved {
    const Component* component;
    const TextureDirections* directions;
    ComponentMap map;
    PerTriangle<Index> island;  // counted from the component's first
    Index island_count = 1;
    double scale = 1;               // of the map to the texel density of all
    PerPart<double> turn;           // by which each island is turned in the layout, radians
    Eigen::Index first_island = 0;  // of those to be arranged
    bool is_in_place = false;       // its islands are not to be arranged
    Eigen::Index first_corner = 0;  // in the layout
  };

  // Divides the islands of a map so that they fill the square, and straightens their sides.
  void divide(const OpenedSurface& opened, const ComponentTask& task, ComponentMap& map);

  // Writes the position of every corner to the result and to `layout_`.
  void place(const Array<Similarity>& placement);
  CornerPositions corners(const Solved& solved) const {
    return layout_.segment(solved.first_corner, solved.component->mesh.halfedge_count());
  }
  // Checks the final coordinates: a component much smaller than the others has lost digits to its position.
  void check_in_layout(Solved& solved) const;
  void collect_checks(const Component& component, const ComponentMap& map);
  void measure_directions(const Solved& solved);

  // A component is one island, or several if its cuts and seams enclose regions: these keep their size and are placed
  // individually, related across the seam by their motions. Seams that end in the interior are cut as well, and their
  // two sides coincide.
  void add_islands(const Geometry& geometry, Solved& solved);

  // Which islands have marked features along an axis, and so are only rotated by quarter turns.
  static PerPart<char> find_feature_axes(const Solved& solved);

  // Seams along which components without cones were opened count as cut, though their sides are boundaries.
  void add_opened_seams();

  // A vertex shared by components may be flat in one and a cone of another: then it is not reported as flat.
  void report_flat_cones();

  void find_overlapping();
  PerTriangle<Index> number_faces() const;

  const Surface& surface_;
  const PerComponent<Component>& components_;
  const Options& options_;
  ProgressMonitor& monitor_;
  Result& result_;
  double surface_area_ = 0;                 // of all components
  PerVertex<double> cone_angle_;            // of the caller's, NaN where none was imposed
  Array<Index> cut_edges_, required_cuts_;  // vertex pairs
  Defects defects_;
  AddedCuts added_cuts_;
  OneSidedCuts one_sided_cuts_;
  MarkedFeatures features_;
  Array<Index> flat_cones_;
  Array<Solved> solved_;
  Array<Failure> failures_;
  Array<Island> islands_;    // those to be arranged
  Eigen::VectorXcd layout_;  // u + iv at the corners of all solved components, one after the other
  Index island_count_ = 0;
  double misalignment_ = 0, directed_ = 0;  // sums over directions: of their errors by weight, of their weights
};

}  // namespace lsgp
