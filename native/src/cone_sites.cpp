// SPDX-License-Identifier: GPL-3.0-or-later
#include "cone_sites.hpp"

#include <algorithm>
#include <cmath>

namespace lsgp {

namespace {

constexpr int rings_between_images = 2;  // cones side by side cancel each other

bool has_cuttable_edge(const HalfedgeMesh& mesh, Index v) {
  bool found = false;
  mesh.for_each_outgoing(v, [&](Index h) { found |= mesh.cuttable[h] != 0; });
  return found;
}

bool side_by_side(const HalfedgeMesh& mesh, Index a, Index b) {
  std::vector<Index> reached{a};
  for (int ring = 0; ring < rings_between_images; ++ring) {
    std::vector<Index> grown = reached;
    for (const Index v : reached) mesh.for_each_outgoing(v, [&](Index h) { grown.push_back(mesh.target(h)); });
    reached = std::move(grown);
  }
  return std::find(reached.begin(), reached.end(), b) != reached.end();
}

std::vector<Site> existing_sites(const HalfedgeMesh& mesh, const ComponentCones& existing,
                                 const std::vector<Index>& mirrored, std::vector<char>& taken) {
  std::vector<Index> place(mesh.vertex_count(), none);
  for (std::size_t i = 0; i < existing.vertices.size(); ++i) place[existing.vertices[i]] = static_cast<Index>(i);
  std::vector<Site> sites;
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

void mark_rings(const HalfedgeMesh& mesh, Index vertex, int rings, std::vector<char>& marked) {
  std::vector<Index> rim{vertex};
  marked[vertex] = 1;
  for (int ring = 0; ring < rings; ++ring) {
    std::vector<Index> grown;
    for (const Index v : rim) {
      mesh.for_each_outgoing(v, [&](Index h) {
        marked[mesh.target(h)] = 1;
        grown.push_back(mesh.target(h));
      });
    }
    std::sort(grown.begin(), grown.end());
    grown.erase(std::unique(grown.begin(), grown.end()), grown.end());
    rim = std::move(grown);
  }
}

ConeSites find_cone_sites(const HalfedgeMesh& mesh, const Geometry& geometry, const ComponentCones& existing,
                          const std::vector<char>& allowed, const std::vector<Index>& mirrored, int most) {
  std::vector<char> taken(mesh.vertex_count(), 0);
  ConeSites out{existing_sites(mesh, existing, mirrored, taken), 0};
  out.existing = static_cast<int>(out.sites.size());
  const auto usable = [&](Index v) {
    return !taken[v] && allowed[v] && mesh.loop_of_vertex[v] == none && has_cuttable_edge(mesh, v);
  };
  std::vector<Site> candidates;
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    if (!usable(v)) continue;
    if (mirrored.empty() || mirrored[v] == v) {
      candidates.push_back({v});
    } else if (mirrored[v] > v && usable(mirrored[v]) && !side_by_side(mesh, v, mirrored[v])) {
      candidates.push_back({v, mirrored[v]});
    }
  }
  std::stable_sort(candidates.begin(), candidates.end(), [&](const Site& a, const Site& b) {
    return std::abs(geometry.angle_defect[a.vertex]) > std::abs(geometry.angle_defect[b.vertex]);
  });
  std::vector<Site> spread = candidates;
  for (int rings = 1; static_cast<int>(spread.size()) > most; ++rings) {
    spread.clear();
    std::vector<char> near(mesh.vertex_count(), 0);
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
