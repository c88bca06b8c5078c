// SPDX-License-Identifier: GPL-3.0-or-later
#include "choices/symmetry_choice.hpp"

#include <algorithm>
#include <cmath>

#include "base/progress_share.hpp"
#include "completion/merged_findings.hpp"
#include "measures/map_comparison.hpp"
#include "mesh/topology.hpp"

namespace lsgp {

namespace {

constexpr double placing = 0.6;  // of the time of cones and maps
// Of the islands of one map, what is hoped of another; over 88 pairs of maps the mean is 0.95.
constexpr double islands_of_others = 0.75;
// Of the stretch of one map, what others are expected to have at least: where many times the target is left, cones at
// other places hardly reach it either.
constexpr double left_by_others = 0.5;
constexpr double half_symmetric = 0.5;  // cones, and not cuts

// Those that concern marked vertices, or no elements.
std::vector<Finding> findings_on(const Placement& placement, const Surface& surface, const PerVertex<char>& is_marked,
                                 char mark) {
  std::vector<Finding> out;
  std::copy_if(placement.warnings.begin(), placement.warnings.end(), std::back_inserter(out), [&](const Finding& of) {
    const bool has_triangles = of.elements.kind == ElementKind::triangles;
    const auto is_concerned = [&](Index i) {
      if (!has_triangles) return is_marked[i] == mark;
      const auto corners = surface.triangles.row(i);
      return std::any_of(corners.begin(), corners.end(), [&](Index v) { return is_marked[v] == mark; });
    };
    const std::vector<Index>& indices = of.elements.indices;
    return indices.empty() || std::any_of(indices.begin(), indices.end(), is_concerned);
  });
  return out;
}

}  // namespace

SymmetryChoice::SymmetryChoice(BorderedSurface& surface, Borrowed<const MapThrough> maps,
                               Borrowed<const GivenCones> given, Symmetry symmetry, Objective& objective)
    : surface_(surface),
      maps_(maps),
      given_(given),
      objective_(objective),
      tries_symmetry_(symmetry == Symmetry::tried && given_.cones.vertices.empty()) {}

Made SymmetryChoice::best(const MapOptions& options, const Progress& progress) {
  options_ = options;
  made_.clear();
  beyond_.reset();
  std::vector<Candidate> candidates;
  if (tries_symmetry_) candidates.push_back(candidate(Kind::symmetric, 0));
  if (tries_symmetry_ && !options.of_map.mirrored_cuts) {
    candidates.push_back(candidate(Kind::free_cuts, half_symmetric));
  }
  candidates.push_back(candidate(Kind::usual, 1));
  if (tries_symmetry_ && surface_.parts.count() > 1) candidates.push_back(candidate(Kind::partly, half_symmetric));
  return objective_.choose(std::move(candidates), progress);
}

Candidate SymmetryChoice::candidate(Kind kind, double asymmetry) {
  const auto name = [kind] {
    switch (kind) {
      case Kind::symmetric: return "symmetric cones and cuts";
      case Kind::free_cuts: return "symmetric cones, other cuts";
      case Kind::usual: return "usual cones";
      case Kind::partly: return "some cones symmetric";
    }
    return "";
  };
  Candidate out;
  out.name = name();
  out.expected = [this, kind] { return expected(kind); };
  out.make = [this, kind](const Progress& progress) { return make(kind, progress); };
  out.quality = [this, kind, asymmetry](const Made& map, const Progress& progress) {
    made_.push_back({kind, map, objective_.quality(*map, progress, asymmetry * share_)});
    return made_.back().quality;
  };
  // Where no component is symmetric, symmetric cones are the usual ones.
  out.name_of_made = [this, name] { return alike_ || !tries_symmetry_ ? name() : "usual cones"; };
  return out;
}
std::optional<double> SymmetryChoice::expected(Kind kind) const {
  switch (kind) {
    case Kind::symmetric: return 0;
    case Kind::free_cuts: return expected_of_others(kind, half_symmetric);
    case Kind::usual:
      // Without cones these are the symmetric ones.
      if (alike_ && alike_->cones.vertices.empty() && made(Kind::free_cuts) != nullptr) return {};
      if (!made_.empty()) return expected_of_others(kind, 1);
      if (!beyond_ || beyond_->defects > 0) return Objective::infinity;
      if (!alike_) return {};  // they are the same
      return cost(with_stretch_of_others(*beyond_), objective_.weights());
    case Kind::partly: return expected_of_partly();
  }
  return {};
}

Made SymmetryChoice::make(Kind kind, const Progress& progress) {
  const Progress mapping = share_of(progress, placing, 1);
  switch (kind) {
    case Kind::symmetric: return through_first(symmetric_cones(progress), mapping);
    case Kind::free_cuts: {
      CompletedCones cones = *alike_;
      cones.is_symmetric = false;
      return through(cones, progress);
    }
    case Kind::usual: return through_first(placed(Placing::usual, progress), mapping);
    case Kind::partly: {
      const PerVertex<char> is_cheaper = vertices_on(surface_.parts, are_cheaper_symmetric());
      CompletedCones cones =
          joined(made(Kind::usual)->map->cones, made(Kind::symmetric)->map->cones, surface_.surface(), is_cheaper);
      cones.is_symmetric = true;
      return through(cones, progress);
    }
  }
  return nullptr;
}

Made SymmetryChoice::through(const CompletedCones& cones, const Progress& progress) const {
  return maps_(cones, options_, progress);
}

Made SymmetryChoice::through_first(const CompletedCones& cones, const Progress& progress) {
  if (objective_.bounds_whole(surface_.parts)) {
    const Quality expected = objective_.expected_through(surface_.parts, cones, options_.of_map);
    if (objective_.is_beyond_bound(expected)) {
      beyond_ = expected;
      return nullptr;
    }
  }
  return through(cones, progress);
}

CompletedCones SymmetryChoice::placed(Placing how, const Progress& progress) const {
  CompletionOptions completion;
  completion.count = given_.count;
  completion.target = given_.target;
  completion.symmetric = how == Placing::symmetric;
  completion.without = given_.without;
  if (objective_.bounds_whole(surface_.parts)) completion.most = objective_.most_cones(surface_.parts);
  return complete_cones(surface_.solver, given_.cones, completion, options_, share_of(progress, 0, placing));
}

CompletedCones SymmetryChoice::symmetric_cones(const Progress& progress) {
  if (alike_) return *alike_;
  const SurfaceParts& parts = surface_.parts;
  CompletedCones cones = placed(Placing::symmetric, progress);
  if (!cones.placement) return cones;
  PerTriangle<char> is_odd(parts.of_triangle().size(), 0);
  std::vector<Finding>& findings = cones.placement->warnings;
  for (const Finding& finding : findings) {
    if (finding.code != Code::not_symmetric) continue;
    for (const Index f : finding.elements.indices) is_odd[f] = 1;
  }
  // Those without cones and cuts are symmetric or not, whatever is chosen.
  for (std::size_t f = 0; f < is_odd.size(); ++f) {
    const Index part = parts.of_triangle()[f];
    if (part != none && parts.are_plain()[part]) is_odd[f] = 1;
  }
  const auto says_odd = [](const Finding& finding) { return finding.code == Code::not_symmetric; };
  findings.erase(std::remove_if(findings.begin(), findings.end(), says_odd), findings.end());
  double even = 0, whole = 0;
  for (std::size_t f = 0; f < is_odd.size(); ++f) {
    whole += parts.triangle_areas()[f];
    if (!is_odd[f]) even += parts.triangle_areas()[f];
  }
  cones.is_symmetric = std::count(is_odd.begin(), is_odd.end(), 0) > 0;
  if (cones.is_symmetric) {
    alike_ = cones;
    share_ = even / whole;
  }
  return cones;
}

std::optional<double> SymmetryChoice::expected_of_others(Kind kind, double asymmetry) const {
  if (made_.empty() || !alike_) return {};
  const Weights& weights = objective_.weights();
  const auto cheapest =
      std::min_element(made_.begin(), made_.end(), [&](const MadeCandidate& one, const MadeCandidate& other) {
        return cost(one.quality, weights) < cost(other.quality, weights);
      });
  // Through the same cones maps are stretched alike, wherever cuts run.
  const MadeCandidate* same_cones = kind == Kind::free_cuts ? made(Kind::symmetric) : nullptr;
  const MadeCandidate& like = same_cones != nullptr ? *same_cones : *cheapest;
  Quality other = like.quality;
  if (other.cuts == 0) return {};  // so there are no other ones
  if (other.asymmetry > asymmetry * share_) return {};
  other.islands = std::max<double>(surface_.parts.count(), islands_of_others * other.islands);
  if (same_cones == nullptr) other = with_stretch_of_others(other);
  other.asymmetry = asymmetry * share_;
  other.on_lattice = cost_on_even_lattice(like.map->result);
  if (!may_cost_less(like, other)) return {};
  return cost(other, weights);
}

// Through as many cones at other places.
Quality SymmetryChoice::with_stretch_of_others(Quality quality) const {
  const double placed_for = 100 * (given_.target - 1) * left_of_stretch(options_.of_map.mode);
  quality.stretch = std::min(quality.stretch, std::max(placed_for, left_by_others * quality.stretch));
  return quality;
}

// Whether a map could cost less than one that is made if all went well: with no stretch, cuts or cones, and as few
// islands as there are components. Maps without any of these cost the same.
bool SymmetryChoice::may_cost_less(const MadeCandidate& made, Quality other) const {
  if (made.quality.left_out > 0 || made.quality.defects > 0) return true;
  other.islands = std::min<double>(made.quality.islands, surface_.parts.count());
  other.stretch = other.cuts = other.costly_cuts = other.cones = other.bent_tubes = 0;
  const Weights& weights = objective_.weights();
  return cost(other, weights) < cost(made.quality, weights) - rounding_of_costs;
}

std::optional<double> SymmetryChoice::expected_of_partly() const {
  const MadeCandidate *symmetric = made(Kind::symmetric), *usual = made(Kind::usual);
  if (symmetric == nullptr || usual == nullptr || !alike_) return {};
  const PerComponent<char> is_cheaper = are_cheaper_symmetric();
  const auto kept = std::count(is_cheaper.begin(), is_cheaper.end(), 1);
  if (kept == 0 || kept == ssize(is_cheaper)) return {};
  const PerComponent<double> costs = costs_of(*symmetric), others = costs_of(*usual);
  double saved = 0;
  for (std::size_t i = 0; i < costs.size(); ++i) {
    if (!is_cheaper[i]) saved += costs[i] - others[i];
  }
  return cost(symmetric->quality, objective_.weights()) - saved;
}

const SymmetryChoice::MadeCandidate* SymmetryChoice::made(Kind kind) const {
  const auto found = std::find_if(made_.begin(), made_.end(), [&](const auto& of) { return of.kind == kind; });
  return found == made_.end() ? nullptr : &*found;
}

PerComponent<char> SymmetryChoice::are_cheaper_symmetric() const {
  const PerComponent<double> costs = costs_of(*made(Kind::symmetric)), others = costs_of(*made(Kind::usual));
  PerComponent<char> out(costs.size(), 0);
  for (std::size_t i = 0; i < costs.size(); ++i) out[i] = costs[i] <= others[i];
  return out;
}

PerComponent<double> SymmetryChoice::costs_of(const MadeCandidate& candidate) const {
  const SurfaceParts& parts = surface_.parts;
  PerComponent<double> out = costs_on(parts, *candidate.map, objective_.weights()).whole;
  const PerComponent<Index> defects = defects_on(parts, candidate.map->result);
  for (Index i = 0; i < parts.count(); ++i) {
    if (candidate.quality.asymmetry > 0) out[i] += objective_.weights().symmetry * parts.areas()[i] / parts.area();
    if (defects[i] > 0) out[i] = Objective::infinity;
  }
  return out;
}

CompletedCones joined(const CompletedCones& cones, const CompletedCones& others, const Surface& surface,
                      const PerVertex<char>& is_of_others) {
  CompletedCones out;
  const auto add = [&](const Cones& from, char mark) {
    for (std::size_t i = 0; i < from.vertices.size(); ++i) {
      if (is_of_others[from.vertices[i]] != mark) continue;
      out.cones.vertices.push_back(from.vertices[i]);
      out.cones.angles.push_back(from.angles[i]);
    }
  };
  add(cones.cones, 0);
  add(others.cones, 1);
  out.placement = cones.placement;
  if (out.placement) {
    out.placement->warnings = findings_on(*cones.placement, surface, is_of_others, 0);
    if (others.placement) {
      out.placement->warnings =
          merged(std::move(out.placement->warnings), findings_on(*others.placement, surface, is_of_others, 1));
    }
  }
  out.target = cones.target;
  out.is_symmetric = cones.is_symmetric;
  return out;
}

PerVertex<char> vertices_on(const SurfaceParts& parts, const PerComponent<char>& is_marked) {
  PerVertex<char> out(parts.of_vertex().size(), 0);
  for (std::size_t v = 0; v < out.size(); ++v) {
    out[v] = parts.of_vertex()[v] != none && is_marked[parts.of_vertex()[v]];
  }
  return out;
}

}  // namespace lsgp
