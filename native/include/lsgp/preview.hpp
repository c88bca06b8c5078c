// SPDX-License-Identifier: GPL-3.0-or-later
// Maps of large surfaces at the speed of small ones, for instance while a cone is dragged.
#pragma once

#include <memory>

#include "lsgp/export.hpp"
#include "lsgp/options.hpp"
#include "lsgp/progress.hpp"
#include "lsgp/result.hpp"
#include "lsgp/surface.hpp"

namespace lsgp {

// Approximates the maps of one surface by those of a surface with fewer triangles, which is made once. Boundaries,
// seams, borders and features stay as they are.
class LSGP_API Preview {
 public:
  // triangles: about how many the surface is reduced to; if it has no more, maps are exact.
  // Throws what `parameterize` throws for invalid surfaces, CANCELLED.
  explicit Preview(Surface surface, Index triangles = 8000, const Progress& progress = {});
  ~Preview();
  Preview(Preview&&) noexcept;

  // The map, of which `corner_uv`, `log_scale` and the cuts are carried over from the smaller surface, to which the
  // cones are added; what is measured is measured there, and no element that is flipped or overlaps is named. May be
  // called by several threads. Throws what `parameterize` throws; WRONG_PARAMETER for seamless layouts, which must be
  // exact.
  Result parameterize(const Cones& cones, const Options& options = {}, const Progress& progress = {}) const;

 private:
  struct Kept;
  std::unique_ptr<const Kept> kept_;
};

}  // namespace lsgp
