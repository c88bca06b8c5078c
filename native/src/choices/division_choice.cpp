// SPDX-License-Identifier: GPL-3.0-or-later
#include "choices/division_choice.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "base/progress_share.hpp"

namespace lsgp {

namespace {

// What is expected of other divisions, as multiples of the islands of the usual one and of the part of the square that
// it fills: about the medians of 172.
struct Expected {
  double islands, filled;
};

constexpr Expected further_islands{1.4, 1.15};

Expected fewer_islands(Compactness usual) { return {0.6, usual == Compactness::full ? 0.85 : 0.7}; }

// More of the square is rarely filled.
double most_filled(Compactness usual) { return usual == Compactness::full ? 0.72 : 0.55; }

// Where the square stays empty, islands are divided as if they had so many of them.
constexpr double squares_of_more = 2;

// With so many islands that fill this multiple of the square.
Quality with_islands(Quality quality, double islands, double filled, Compactness usual) {
  const double present = 1 / (1 + quality.empty);
  quality.islands = islands;
  quality.empty = 1 / std::min(std::max(present, most_filled(usual)), present * filled) - 1;
  return quality;
}

}  // namespace

Made best_division(const Made& usual, const MapOptions& options, Objective& objective, const Progress& progress) {
  const Compactness compact = options.of_map.compact;
  if (compact == Compactness::off || options.of_map.square_share != 1 || options.of_map.seamless) return usual;
  const Progress untimed = share_of(progress, 1, 1);
  const Quality quality = objective.quality(*usual, untimed);
  const double least = usual->surface->parts.count();
  // Islands that are not divided.
  const PerComponent<char>& are_plain = usual->surface->parts.are_plain();
  const auto whole = static_cast<double>(std::count(are_plain.begin(), are_plain.end(), 1));
  const Pins no_pins;
  const auto divided = [&](const MapOptions& others) {
    const Made made = maps_of(usual->surface, no_pins)(usual->cones, others, untimed);
    tell_findings(*made, options.of_map);
    return made;
  };
  const auto measure = [&](const Made& made, const Progress& packing) { return objective.quality(*made, packing); };
  MapOptions further = options;
  further.of_map.border = usual->options.of_map.border;
  MapOptions fewer = further;
  further.of_map.square_share = squares_of_more;
  fewer.of_map.compact = compact == Compactness::sparing ? Compactness::off : Compactness::sparing;

  const auto expected_further = [&]() -> std::optional<double> {
    if (1 / (1 + quality.empty) >= most_filled(compact)) return {};
    const double islands = std::max(quality.islands + 1, whole + (quality.islands - whole) * further_islands.islands);
    return cost(with_islands(quality, islands, further_islands.filled, compact), objective.weights());
  };
  const auto expected_fewer = [&]() -> std::optional<double> {
    if (quality.islands <= least) return {};
    const Expected expected = fewer_islands(compact);
    const double islands = std::max(least, whole + (quality.islands - whole) * expected.islands);
    return cost(with_islands(quality, islands, expected.filled, compact), objective.weights());
  };
  const auto as_they_are = [&](const Progress&) { return usual; };
  const auto divided_further = [&](const Progress&) { return divided(further); };
  const auto divided_less = [&](const Progress&) { return divided(fewer); };
  return objective.choose({{"islands as they are", [] { return 0.0; }, as_they_are, measure, {}},
                           {"further islands", expected_further, divided_further, measure, {}},
                           {"fewer islands", expected_fewer, divided_less, measure, {}}},
                          untimed);
}

}  // namespace lsgp
