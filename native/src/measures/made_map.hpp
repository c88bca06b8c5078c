// SPDX-License-Identifier: GPL-3.0-or-later
// Maps that are compared, and the surfaces with other borders that they are made of.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "lsgp/auto_unwrap.hpp"
#include "lsgp/solver.hpp"
#include "measures/surface_parts.hpp"

namespace lsgp {

// A surface that ends at some borders, its components, and what its maps have in common.
struct BorderedSurface {
  Solver solver;
  SurfaceParts parts;
  std::shared_ptr<const PerTriangle<char>> in_tubes;  // which triangles are, or null

  // earlier: of the same surface with other borders, or null.  Throws what `parameterize` throws for invalid surfaces.
  BorderedSurface(Surface surface, std::shared_ptr<const PerTriangle<char>> in_tubes, const BorderedSurface* earlier);
  BorderedSurface(const BorderedSurface&) = delete;
  BorderedSurface& operator=(const BorderedSurface&) = delete;

  const Surface& surface() const { return solver.surface(); }
};

// The same surface with one set of borders after another; what is found for one serves the later ones.
class BorderedSurfaces {
 public:
  explicit BorderedSurfaces(Surface surface, std::shared_ptr<const PerTriangle<char>> in_tubes = {});

  const std::shared_ptr<BorderedSurface>& first() const { return all_.front(); }
  // The first one with further borders.
  std::shared_ptr<BorderedSurface> ending_at(const VertexPairs& borders);

 private:
  std::vector<std::shared_ptr<BorderedSurface>> all_;
};

struct MadeMap {
  std::shared_ptr<BorderedSurface> surface;
  CompletedCones cones;
  Result result;
  MapOptions options;              // that it was made with
  std::optional<Quality> quality;  // once it is measured, without its asymmetry
  // The layout that this was measured on, with the usual margin; none where it is not packed.
  std::optional<CornerUv> packed_quickly;
};

// Shared by choices that follow each other; only what is measured and the findings of the result change.
using Made = std::shared_ptr<MadeMap>;

// The map of one surface through cones, with some options.  Throws what `parameterize` throws.
using MapThrough = std::function<Made(const CompletedCones&, const MapOptions&, const Progress&)>;

// The map of a surface with some borders.  Throws what `complete_cones` and `parameterize` throw.
using MakeMap = std::function<Made(const std::shared_ptr<BorderedSurface>&, const Progress&)>;

// The pair's rows, then those of the other.
VertexPairs joined(const VertexPairs& one, const VertexPairs& other);

// pins: have to live as long as the function.
MapThrough maps_of(std::shared_ptr<BorderedSurface> surface, const Pins& pins);

// What `make` returns; null if the library refuses it.  Throws CANCELLED, and what progress throws.
Made attempt(const std::function<Made()>& make);

// Replaces the findings of a map by those that the caller is told: of its cones, too.
void tell_findings(MadeMap& made, const Options& options);

}  // namespace lsgp
