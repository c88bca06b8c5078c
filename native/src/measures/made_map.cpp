// SPDX-License-Identifier: GPL-3.0-or-later
#include "measures/made_map.hpp"

#include <new>
#include <utility>

namespace lsgp {

BorderedSurface::BorderedSurface(Surface surface, std::shared_ptr<const PerTriangle<char>> in_tubes,
                                 const BorderedSurface* earlier)
    : solver(earlier == nullptr ? Solver(std::move(surface)) : Solver(std::move(surface), earlier->solver)),
      parts(std::cref(solver.surface())),
      in_tubes(std::move(in_tubes)) {}

BorderedSurfaces::BorderedSurfaces(Surface surface, std::shared_ptr<const PerTriangle<char>> in_tubes)
    : all_{std::make_shared<BorderedSurface>(std::move(surface), std::move(in_tubes), nullptr)} {}

std::shared_ptr<BorderedSurface> BorderedSurfaces::ending_at(const VertexPairs& borders) {
  Surface opened = first()->surface();
  opened.borders = joined(opened.borders, borders);
  all_.push_back(std::make_shared<BorderedSurface>(std::move(opened), first()->in_tubes, all_.back().get()));
  return all_.back();
}

VertexPairs joined(const VertexPairs& one, const VertexPairs& other) {
  VertexPairs out(one.rows() + other.rows(), 2);
  if (one.rows() > 0) out.topRows(one.rows()) = one;
  if (other.rows() > 0) out.bottomRows(other.rows()) = other;
  return out;
}

MapThrough maps_of(std::shared_ptr<BorderedSurface> surface, const Pins& pins) {
  return [surface = std::move(surface), &pins](const CompletedCones& cones, const MapOptions& options,
                                               const Progress& progress) {
    Options of_map = options.through(cones.cones);
    of_map.mirrored_cuts = of_map.mirrored_cuts || cones.is_symmetric;
    Result result = surface->solver.parameterize(cones.cones, of_map, pins, progress);
    return std::make_shared<MadeMap>(MadeMap{surface, cones, std::move(result), options, {}, {}});
  };
}

Made attempt(const std::function<Made()>& make) try { return make(); } catch (const Error& error) {
  if (error.code() == Code::cancelled) throw;
  return nullptr;
} catch (const std::bad_alloc&) {
  return nullptr;
}

void tell_findings(MadeMap& made, const Options& options) {
  made.result.warnings = findings_of(made.cones, made.result, options);
}

}  // namespace lsgp
