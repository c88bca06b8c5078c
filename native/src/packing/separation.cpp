// SPDX-License-Identifier: GPL-3.0-or-later
#include "packing/separation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/checkpoint.hpp"

namespace lsgp {

namespace {

// Of a body that is moved: other poses that are tried, places of each all over the tile and near where it lies, and how
// many of these are improved step by step.
constexpr int tried_poses = 3, places_anywhere = 16, places_nearby = 6, improved_places = 3;
constexpr int nearby = 12, first_step = 4;  // texels
// By how much the weights of overlaps grow in a round at most and at least, and those of others shrink.
constexpr double most_growth_of_weight = 2, least_growth_of_weight = 1.2, decay = 0.95;
// Nanoseconds of a pair of words, of an overlap besides, and of a pair of bodies whose boxes do not meet, about: of
// searches for islands of Bake they make up a third more than these take.
constexpr double cost_of_word_pair = 1, cost_of_overlap = 20, cost_of_body_pair = 3;

}  // namespace

int uniform_below(std::mt19937& random, int most) {
  return most <= 1 ? 0 : static_cast<int>(random() % static_cast<std::uint32_t>(most));
}

Separation::Separation(const Array<Array<Pose>>& poses, const Array<Index>& bodies, double gap)
    : poses_(poses), bodies_(bodies), gap_(gap), reach_(static_cast<int>(std::ceil(gap))), texels_(poses.size()) {
  for (std::size_t b = 0; b < poses.size(); ++b) texels_[b].resize(poses[b].size());
}

const Separation::Texels& Separation::texels(Index body, int pose) {
  std::optional<Texels>& found = texels_[body][pose];
  if (!found) {
    const Pose& of = poses_[body][pose];
    const int rows = static_cast<int>(of.height) + 1, columns = static_cast<int>(of.width) + 1;
    BitRows own(rows, columns), widened(rows + 2 * reach_, columns + 2 * reach_);
    draw(of.outline, 0, own);
    draw(of.outline.moved(1, Complex(reach_, reach_)), gap_, widened);
    found = Texels{BitColumns(own), BitColumns(widened)};
    work_ += 4.0 * (rows + 2 * reach_) * (columns + 2 * reach_);
  }
  return *found;
}

// The number of texels of one that are nearer to the other than the gap, or more than `most` if that is less.
int Separation::overlap(Index a, const Place& at_a, Index b, const Place& at_b, double most) {
  if (a > b) return overlap(b, at_b, a, at_a, most);
  const BitColumns& own = texels(a, at_a.pose).own;
  const BitColumns& widened = texels(b, at_b.pose).widened;
  std::ptrdiff_t words = 0;
  const int count = shared_bits(own, widened, {at_b.column - reach_ - at_a.column, at_b.row - reach_ - at_a.row},
                                static_cast<int>(std::min(most, 1e9)), words);
  work_ += cost_of_overlap + cost_of_word_pair * static_cast<double>(words);
  return count;
}

Separation::Extent Separation::extent(Index body, const Place& place, int reach) const {
  const Pose& pose = poses_[body][place.pose];
  return {place.column - reach, place.column + static_cast<int>(pose.width) + reach, place.row - reach,
          place.row + static_cast<int>(pose.height) + reach};
}

// The weighted overlaps of a body at a place, or more than `most` if that is less.
double Separation::cost(Index body, const Place& place, double most) {
  const Extent around = extent(body, place, reach_);
  double sum = 0;
  for (const Index other : bodies_) {
    if (!around.meets(extent_[other]) || other == body) continue;
    const double weight = weight_[body * ssize(poses_) + other];
    sum += weight * overlap(body, place, other, place_[other], (most - sum) / weight);
    if (sum > most) break;
  }
  work_ += cost_of_body_pair * static_cast<double>(bodies_.size());
  checkpoint(cost_of_body_pair * static_cast<double>(bodies_.size()));
  return sum;
}

void Separation::put(Index body, const Place& place) {
  place_[body] = place;
  extent_[body] = extent(body, place, 0);
}

int Separation::last_column(Index body, int pose) const {
  return static_cast<int>(std::floor(width_ - poses_[body][pose].width));
}

int Separation::last_row(Index body, int pose) const {
  return static_cast<int>(std::floor(height_ - poses_[body][pose].height));
}

// To where it overlaps less, by weights.
void Separation::move(Index body, std::mt19937& random) {
  struct Sample {
    double cost;
    Place place;
  };
  const Place now = place_[body];
  const double present = cost(body, now, std::numeric_limits<double>::infinity());
  if (present == 0) return;
  Array<Sample> best{{present, now}};
  const auto offer = [&](Place place) {
    place.column = std::clamp(place.column, 0, last_column(body, place.pose));
    place.row = std::clamp(place.row, 0, last_row(body, place.pose));
    const double most = ssize(best) < improved_places ? std::numeric_limits<double>::infinity() : best.back().cost;
    const double found = cost(body, place, most);
    if (found >= most) return;
    if (ssize(best) == improved_places) best.pop_back();
    const auto behind = std::find_if(best.begin(), best.end(), [&](const Sample& other) { return found < other.cost; });
    best.insert(behind, {found, place});
  };
  const auto pose_count = static_cast<int>(poses_[body].size());
  for (int k = 0; k <= std::min(tried_poses, pose_count - 1); ++k) {
    const int pose = k == 0 ? now.pose : uniform_below(random, pose_count);
    const int columns = last_column(body, pose) + 1, rows = last_row(body, pose) + 1;
    if (columns < 1 || rows < 1) continue;
    for (int i = 0; i < places_anywhere; ++i)
      offer({pose, uniform_below(random, columns), uniform_below(random, rows)});
    for (int i = 0; i < places_nearby; ++i) {
      offer({pose, now.column + uniform_below(random, 2 * nearby + 1) - nearby,
             now.row + uniform_below(random, 2 * nearby + 1) - nearby});
    }
  }
  Sample least = best[0];
  for (Sample sample : best) {
    for (int step = first_step; step > 0;) {
      const Sample before = sample;
      for (const auto& [across, up] :
           {std::pair(step, 0), std::pair(-step, 0), std::pair(0, step), std::pair(0, -step)}) {
        const Place place{sample.place.pose, before.place.column + across, before.place.row + up};
        if (place.column < 0 || place.row < 0 || place.column > last_column(body, place.pose) ||
            place.row > last_row(body, place.pose))
          continue;
        const double found = cost(body, place, sample.cost);
        if (found < sample.cost) sample = {found, place};
      }
      if (!(sample.cost < before.cost)) step /= 2;
    }
    if (sample.cost < least.cost) least = sample;
    if (least.cost == 0) break;
  }
  put(body, least.place);
}

// Of all pairs; the weights of those that overlap grow.
double Separation::total_overlap() {
  struct Pair {
    Index a, b;
    int texels;
  };
  Array<Pair> overlapping;
  double sum = 0;
  int largest = 0;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const Index a = bodies_[i], b = bodies_[j];
      if (!extent(a, place_[a], reach_).meets(extent_[b])) continue;
      const int found = overlap(a, place_[a], b, place_[b], std::numeric_limits<double>::infinity());
      if (found > 0) overlapping.push_back({a, b, found});
      sum += found;
      largest = std::max(largest, found);
    }
  }
  checkpoint(cost_of_body_pair * static_cast<double>(bodies_.size() * bodies_.size()));
  for (double& weight : weight_) weight = std::max(1.0, weight * decay);
  for (const auto& [a, b, found] : overlapping) {
    const double share = static_cast<double>(found) / largest;
    const double factor = (least_growth_of_weight + (most_growth_of_weight - least_growth_of_weight) * share) / decay;
    weight_[a * ssize(poses_) + b] *= factor;
    weight_[b * ssize(poses_) + a] *= factor;
  }
  return sum;
}

bool Separation::run(const SeparationLimits& limits, Array<Placed>& placed, std::mt19937& random, double& work) {
  constexpr double cost_of_run = 1e4;
  const auto [width, height, patience, most_work] = limits;
  width_ = width;
  height_ = height;
  work_ = 0;
  work += cost_of_run;
  place_.resize(poses_.size());
  extent_.resize(poses_.size());
  for (const Index b : bodies_) {
    // A pose that is too large for the tile is left for one that is not.
    const auto fits = [&](int pose) { return last_column(b, pose) >= 0 && last_row(b, pose) >= 0; };
    const auto count = static_cast<int>(poses_[b].size());
    int pose = placed[b].pose;
    for (int tried = 0, first = uniform_below(random, count); !fits(pose); ++tried) {
      if (tried == count) return false;
      pose = (first + tried) % count;
    }
    put(b, {pose, std::clamp(static_cast<int>(placed[b].at.real()), 0, last_column(b, pose)),
            std::clamp(static_cast<int>(placed[b].at.imag()), 0, last_row(b, pose))});
  }
  weight_.assign(poses_.size() * poses_.size(), 1.0);
  double least = total_overlap();
  Array<Index> order = bodies_;
  for (int waited = 0; least > 0 && waited < patience && work_ <= most_work; ++waited) {
    for (std::size_t i = order.size(); i > 1; --i)
      std::swap(order[i - 1], order[uniform_below(random, static_cast<int>(i))]);
    for (const Index b : order) {
      if (work_ > most_work) break;
      move(b, random);
    }
    const double now = total_overlap();
    if (now >= least) continue;
    least = now;
    waited = -1;
  }
  work += work_;
  if (least > 0) return false;
  for (const Index b : bodies_) placed[b] = {0, place_[b].pose, Complex(place_[b].column, place_[b].row)};
  return true;
}

}  // namespace lsgp
