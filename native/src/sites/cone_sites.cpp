// SPDX-License-Identifier: GPL-3.0-or-later
#include "sites/cone_sites.hpp"

#include <algorithm>
#include <cmath>

#include "cut/cut_graph.hpp"

namespace lsgp {

namespace {

constexpr int rings_between_images = 2;  // cones side by side cancel each other
constexpr int most_around = 64;          // triangles; the vertices around a hub of more are not close to each other

// Vertices that cuts can connect to all boundaries and existing cones: those of the largest network if there are
// none, or if these are not connected.
PerVertex<char> find_reachable(const HalfedgeMesh& mesh, const ComponentCones& existing) {
  const PerVertex<Index> network = find_cut_networks(mesh);
  PerVertex<Index> size(mesh.vertex_count(), 0);
  for (const Index n : network) ++size[n];
  Array<Index> wanted;
  for (const auto& loop : mesh.boundary_loops) wanted.push_back(network[loop.front()]);
  for (const Index v : existing.vertices) wanted.push_back(network[v]);
  if (wanted.empty()) wanted = network;
  const Index most =
      *std::max_element(wanted.begin(), wanted.end(), [&](Index a, Index b) { return size[a] < size[b]; });
  PerVertex<char> out(mesh.vertex_count());
  for (Index v = 0; v < mesh.vertex_count(); ++v) out[v] = network[v] == most && size[most] > 1;
  return out;
}

bool is_hub(const HalfedgeMesh& mesh, Index v) {
  Index h = mesh.outgoing[v];
  for (int around = 0; around < most_around; ++around) {
    h = mesh.rotate(h);
    if (h == none || h == mesh.outgoing[v]) return false;
  }
  return true;
}

bool side_by_side(const HalfedgeMesh& mesh, Index a, Index b) {
  Array<Index> reached{a};
  for (int ring = 0; ring < rings_between_images; ++ring) {
    Array<Index> grown = reached;
    for (const Index v : reached) mesh.for_each_outgoing(v, [&](Index h) { grown.push_back(mesh.target(h)); });
    reached = std::move(grown);
  }
  return std::find(reached.begin(), reached.end(), b) != reached.end();
}

// The fewest rings without other sites around each one that leave at most so many sites, if all vertices have six
// neighbors.
int least_rings(std::ptrdiff_t candidates, int most) {
  int rings = 1;
  const auto vertices_within = [&] { return 1.0 + 3 * rings * (rings + 1); };
  while (static_cast<double>(candidates) > most * vertices_within()) ++rings;
  return rings;
}

Array<Site> existing_sites(const HalfedgeMesh& mesh, const ComponentCones& existing, const PerVertex<Index>& mirrored,
                           PerVertex<char>& taken) {
  PerVertex<Index> place(mesh.vertex_count(), none);
  for (std::size_t i = 0; i < existing.vertices.size(); ++i) place[existing.vertices[i]] = static_cast<Index>(i);
  Array<Site> sites;
  for (const Index v : existing.vertices) {
    if (taken[v]) continue;
    Site site{v};
    const Index image = mirrored.empty() ? none : mirrored[v];
    if (image != none && image != v && !taken[image]) {
      const bool both = place[image] != none;
      const bool inside = mesh.loop_of_vertex[v] == none && mesh.loop_of_vertex[image] == none;
      const bool agree = !both || existing.angles[place[image]] == existing.angles[place[v]];
      if (agree && (both || inside)) site.mirrored = image;
    }
    taken[v] = 1;
    if (site.mirrored != none) taken[site.mirrored] = 1;
    sites.push_back(site);
  }
  return sites;
}

}  // namespace

Array<Index> rings_around(const HalfedgeMesh& mesh, Index vertex, int rings) {
  Array<Index> out{vertex}, rim{vertex};
  for (int ring = 0; ring < rings; ++ring) {
    Array<Index> grown;
    for (const Index v : rim) {
      if (is_hub(mesh, v)) continue;
      mesh.for_each_outgoing(v, [&](Index h) { grown.push_back(mesh.target(h)); });
    }
    sort_unique(grown);
    out.insert(out.end(), grown.begin(), grown.end());
    rim = std::move(grown);
  }
  sort_unique(out);
  return out;
}

void mark_rings(const HalfedgeMesh& mesh, Index vertex, int rings, PerVertex<char>& marked) {
  for (const Index v : rings_around(mesh, vertex, rings)) marked[v] = 1;
}

ConeSites find_cone_sites(const PlacementTask& task, int most) {
  const HalfedgeMesh& mesh = task.mesh;
  const Eigen::VectorXd& angle_defect = task.geometry.angle_defect;
  const PerVertex<Index>& mirrored = task.mirrored;
  PerVertex<char> taken(mesh.vertex_count(), 0);
  ConeSites out{existing_sites(mesh, task.existing, mirrored, taken), 0};
  out.existing = static_cast<int>(out.sites.size());
  const PerVertex<char> reachable = find_reachable(mesh, task.existing);
  out.reaches_all = std::find(reachable.begin(), reachable.end(), 0) == reachable.end();
  const auto usable = [&](Index v) {
    return !taken[v] && task.allowed[v] && mesh.loop_of_vertex[v] == none && reachable[v];
  };
  // Corners keep their own curvature, also next to each other.
  const auto is_sharp = [&](Index v) { return std::abs(angle_defect[v]) >= sharp_defect; };
  Array<Site> candidates;
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    if (!usable(v)) continue;
    if (mirrored.empty() || mirrored[v] == v) {
      candidates.push_back({v});
    } else if (mirrored[v] > v && usable(mirrored[v]) && (is_sharp(v) || !side_by_side(mesh, v, mirrored[v]))) {
      candidates.push_back({v, mirrored[v]});
    }
  }
  std::stable_sort(candidates.begin(), candidates.end(), [&](const Site& a, const Site& b) {
    return std::abs(angle_defect[a.vertex]) > std::abs(angle_defect[b.vertex]);
  });
  Array<Site> spread = candidates;
  for (int rings = least_rings(ssize(candidates), most); static_cast<int>(spread.size()) > most; ++rings) {
    spread.clear();
    PerVertex<char> near(mesh.vertex_count(), 0);
    for (const Site& site : candidates) {
      if (near[site.vertex]) continue;
      spread.push_back(site);
      for (const Index v : {site.vertex, site.mirrored}) {
        if (v != none) mark_rings(mesh, v, rings, near);
      }
    }
  }
  std::sort(spread.begin(), spread.end(), [](const Site& a, const Site& b) { return a.vertex < b.vertex; });
  out.sites.insert(out.sites.end(), spread.begin(), spread.end());
  return out;
}

}  // namespace lsgp
