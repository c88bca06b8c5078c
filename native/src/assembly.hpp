// SPDX-License-Identifier: GPL-3.0-or-later
// From the maps of the components to one result in the caller's numbering.
#pragma once

#include <utility>
#include <vector>

#include "component_map.hpp"
#include "layout.hpp"

namespace lsgp {

class Assembly {
 public:
  // Everything is collected in `result`, which holds the findings so far.
  Assembly(const Surface& surface, const std::vector<Component>& components, const Options& options, Monitor& monitor,
           Result& result);

  void add(std::size_t component_index, const ComponentCones& cones, const Geometry& geometry, ComponentMap map);

  // Arranges the islands, checks what is returned and names what is wrong.  duplicates: as in Topology.
  void finish(const Cones& cones, const std::vector<std::pair<Index, Index>>& duplicates);

 private:
  struct Solved {
    const Component* component;
    ComponentMap map;
    std::vector<Index> part;  // (m) the island of every triangle, counted from the component's first
    Index part_count = 1;
    double scale = 1;               // of the map to the texel density of all
    std::size_t first_island = 0;   // of those to be arranged
    bool is_in_place = false;       // nothing of it is to be arranged
    Eigen::Index first_corner = 0;  // in the layout
  };

  // Writes where every corner comes to lie, in the result and in `layout_`.
  void place(const std::vector<Similarity>& placement);
  CornerPositions corners(const Solved& solved) const {
    return layout_.segment(solved.first_corner, solved.component->mesh.halfedge_count());
  }
  // Checks the coordinates that are returned: a component much smaller than the others has lost digits to its place.
  void check_in_layout(Solved& solved) const;
  void collect_checks(const Component& component, const ComponentMap& map);

  // Halfedges at which a component's layout may end besides its cuts, (3m).
  std::vector<char> open_seams(const HalfedgeMesh& mesh) const;

  // A component is one island, or several where its cuts and seams together close off parts: those keep their size and
  // are placed one by one, related across the seam by how they were moved.
  void add_islands(const Geometry& geometry, Solved& solved);

  // Triangles that lie on one of a skipped component were skipped with it.
  void name_unmapped(const std::vector<std::pair<Index, Index>>& duplicates);

  void share_map(Index triangle, Index original);
  void find_overlapping();
  void report_defects();
  void report_overlapping();

  const Surface& surface_;
  const std::vector<Component>& components_;
  const Options& options_;
  Monitor& monitor_;
  Result& result_;
  std::vector<double> cone_angle_;                // by the caller's vertex, NaN where none was imposed
  std::vector<Index> cut_edges_, inexact_seams_;  // vertex pairs
  std::vector<Index> inexact_angles_;
  std::vector<Solved> solved_;
  std::vector<Island> islands_;  // those to be arranged
  Eigen::VectorXcd layout_;      // u + iv at the corners of all solved components, one after the other
  Index island_count_ = 0;
};

}  // namespace lsgp
