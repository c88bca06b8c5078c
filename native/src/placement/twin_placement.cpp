// SPDX-License-Identifier: GPL-3.0-or-later
#include "placement/twin_placement.hpp"

#include <algorithm>
#include <utility>

namespace lsgp {

namespace {

constexpr double as_good = 1.01;  // of the twin's L2 stretch

}  // namespace

TwinPlacement::TwinPlacement(Borrowed<const PerComponent<Component>> components, PlacementOptions options,
                             const std::optional<MirrorPlane>& plane)
    : components_(components), options_(std::move(options)), kept_(components_.size()) {
  if (options_.symmetric) {
    twins_ = find_mirrored_components(components_, plane);
  } else {
    twins_.resize(components_.size());
  }
}

bool TwinPlacement::is_mirrored(const Component& component) const {
  const std::ptrdiff_t own = number(component);
  return twins_[own].of != none ||
         std::any_of(twins_.begin(), twins_.end(), [&](const MirroredComponent& twin) { return twin.of == own; });
}

std::optional<PlacedCones> TwinPlacement::place(const Component& component, const PlacementTask& task,
                                                ProgressMonitor& monitor) {
  const MirroredComponent& twin = twins_[number(component)];
  if (twin.of == none || !kept_[twin.of] || !task.existing.vertices.empty()) return std::nullopt;
  const Kept& kept = *kept_[twin.of];
  ComponentCones cones = task.existing;
  for (const Index v : kept.cones.vertices) {
    if (!task.allowed[twin.image[v]]) return std::nullopt;
    cones.vertices.push_back(twin.image[v]);
  }
  cones.angles = kept.cones.angles;
  PlacementOptions options = options_;
  options.count = static_cast<int>(cones.vertices.size());
  std::vector<Finding> unsaid;
  try {
    PlacedCones placed = place_component({task, cones, task.allowed, {}}, options, unsaid, monitor);
    if (!(placed.mapped_l2 <= std::max(options.target, as_good * kept.l2))) return std::nullopt;
    return placed;
  } catch (const Error& error) {
    if (error.code() == Code::cancelled || error.code() == Code::out_of_memory) throw;
    return std::nullopt;
  }
}

void TwinPlacement::keep(const Component& component, const PlacementTask& task, const PlacedCones& placed) {
  if (!options_.symmetric || !task.existing.vertices.empty() || placed.cones.vertices.empty()) return;
  if (placed.are_too_many) return;
  kept_[number(component)] = Kept{placed.cones, placed.mapped_l2};
}

}  // namespace lsgp
