// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/wording.hpp"

#include <algorithm>
#include <cmath>

#include "base/memory.hpp"
#include "base/text.hpp"
#include "solvers/failure.hpp"

namespace lsgp {

namespace {

const char* words_for(SolverFailure::Cause cause) {
  switch (cause) {
    case SolverFailure::Cause::not_positive_definite:
      return "A linear system could not be factored: the surface has triangles too thin or too large to compute with. "
             "Clean the mesh (merge by distance, dissolve degenerate faces) and try again.";
    case SolverFailure::Cause::dependent_constraints:
      return "The boundary could not be straightened, or the pins not be met: some edges are too short. Clean the mesh "
             "(merge by distance, dissolve degenerate faces) and try again.";
    case SolverFailure::Cause::no_convergence:
      return "The spectral unfolding did not converge: several maps are about equally conformal. Use the Poisson "
             "unfolding.";
  }
  return "";
}

const char* remedy_for(GrowsWith grows_with) {
  switch (grows_with) {
    case GrowsWith::conditions: return "Use fewer cones, unwrap fewer faces at once";
    case GrowsWith::quads: return "Choose larger quads";
    case GrowsWith::input: break;
  }
  return "Unwrap fewer faces at once";
}

std::string words_for(const MemoryShortage& shortage) {
  constexpr double megabyte = 1e6;
  return concat("This surface needs ", std::ceil(shortage.needed / megabyte), " MB of memory, and ",
                std::max(0.0, std::floor(shortage.left / megabyte)), " MB are left. ", remedy_for(shortage.grows_with),
                ", or close other programs.");
}

}  // namespace

Error in_words(const Error& error) {
  if (const auto* failure = dynamic_cast<const SolverFailure*>(&error)) {
    return {error.code(), words_for(failure->cause), error.elements()};
  }
  if (const auto* shortage = dynamic_cast<const MemoryShortage*>(&error)) {
    return {error.code(), words_for(*shortage), error.elements()};
  }
  return error;
}

}  // namespace lsgp
